"""Printed joint angles beside the ones that inverse kinematics finds for the printed points."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.audit.paper import Paper, Point
from compare.audit.paper.digits import halves, values
from compare.papers.item import ItemVerdict, Shown, Table
from compare.papers.verdicts import held
from formulations.arms import Arm, branches, nearest, pose_of
from formulations.arms.kinematics import error_of
from formulations.problem.arrays import Array

_DUST = 1e-9  # rad, rounding of the solver


def make_inverse(paper: Paper) -> dict[str, Any]:
    """Solve the printed points of a paper for joint angles.

    The first point takes the solution nearest to the printed angles, each other point the one nearest to the
    point before. Where no orientation is printed, that of the printed angles is kept.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Returns
    -------
    dict
        points: printed and found angles [rad], number of solutions, what rounding allows [rad], misses
        [m, rad]; oriented: whether orientations are printed.
    """
    assert paper.arm is not None
    assert paper.waypoints is not None
    assert paper.halves is not None
    arm = paper.arm
    near, points = paper.waypoints[0], []
    for point in paper.points:
        asked = paper.waypoints[point.waypoint]
        tool = arm.chain.forward(asked)
        pose = tool.copy()
        pose[:3, 3] = values(point.position) * point.metre
        if point.rpy is not None:
            pose = pose_of(pose[:3, 3], values(point.rpy))
        near = nearest(arm, pose, near)
        error = error_of(pose, tool)
        off = error_of(pose, arm.printed.forward(asked))
        points.append({
            "where": point.where,
            "printed": asked.tolist(),
            "found": near.tolist(),
            "branches": len(branches(arm, pose)),
            "allowed": _allowed(arm, point, asked, paper.halves[point.waypoint]).tolist(),
            "miss": float(np.linalg.norm(error[:3])), "turn": float(np.linalg.norm(error[3:])),
            "miss_as_printed": float(np.linalg.norm(off[:3])),
        })  # fmt: skip
    return {"points": points, "oriented": all(p.rpy is not None for p in paper.points)}


def _allowed(arm: Arm, point: Point, joints: Array, blur: Array) -> Array:
    """Greatest distance of the angles by rounding of point and angles, to first order, (dof,) [rad]."""
    turn = np.zeros(3) if point.rpy is None else np.full(3, halves(point.rpy).sum())
    moved = np.concatenate([halves(point.position) * point.metre, turn])
    return np.asarray(np.abs(np.linalg.inv(arm.chain.jacobian(joints))) @ moved + 2.0 * blur)


def show_inverse(data: dict[str, Any]) -> Shown:
    """Show two lines per point, printed and reproduced, and what rounding does not explain.

    Parameters
    ----------
    data : dict
        Of ``make_inverse``.

    Returns
    -------
    Shown
    """
    dof = len(data["points"][0]["printed"])
    header = ["point", "joint angles [rad]", *map(str, range(1, dof + 1)), "most apart [rad]"]
    rows, outside, apart = [], [], 0.0
    for number, point in enumerate(data["points"], start=1):
        printed, found, allowed = (np.array(point[name]) for name in ("printed", "found", "allowed"))
        gap = np.abs(found - printed)
        apart = max(apart, float(gap.max()))
        for name, angles, last in (("printed", printed, ""), ("reproduced", found, f"{gap.max():.1e}")):
            cells = [f"{round(q, 4) + 0.0:.4f}" for q in angles.tolist()]  # no -0.0000
            rows.append([f"{number}", name, *cells, last])
        outside += [
            f"joint {j + 1} of {point['where']} ({gap[j]:.1e} rad where {allowed[j]:.1e} is allowed)"
            for j in np.flatnonzero(gap > allowed + _DUST)
        ]
    counts = [point["branches"] for point in data["points"]]
    misses, turns = ([point[name] for point in data["points"]] for name in ("miss", "turn"))
    as_printed = [point["miss_as_printed"] for point in data["points"]]
    outcome = held(not outside)
    remarks = [
        f"{outcome} within what the digits allow: printed and reproduced angles are at most {apart:.1e} rad "
        "apart; "
        + (
            f"rounding does not explain: {'; '.join(outside)}."
            if outside
            else "rounding explains all of it."
        ),
        f"By forward kinematics the printed angles lead to the printed points within {1e3 * max(misses):.3g} mm"
        + (f" and {np.degrees(max(turns)):.2g} deg." if data["oriented"] else "."),
        f"Each point has {' or '.join(map(str, sorted(set(counts))))} solutions. Another choice among them "
        "gives another motion.",
    ]
    if max(as_printed) > 2.0 * max(misses):
        remarks.append(
            "The other reading, the DH table as printed and without offsets, misses the printed points by "
            f"{1e3 * min(as_printed):.0f} to {1e3 * max(as_printed):.0f} mm."
        )
    verdict = ItemVerdict("the joint angles, within what the digits allow", outcome)
    return Shown([Table(header, rows, "", range(2, dof + 3))], remarks, [verdict])
