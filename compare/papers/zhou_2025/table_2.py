"""Zhou 2025, Table 2: joint angles where a numeric inverse kinematics stopped before points out of reach."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import least_squares, minimize_scalar

from compare.audit.paper import load_papers
from compare.audit.paper.digits import values
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.verdicts import held
from compare.papers.words import triple
from formulations import load
from formulations.arms import distance_to, load_arm
from formulations.arms.kinematics import error_of
from formulations.problem.arrays import Array

_SAME_ANGLE = 2.0  # deg: two orientations, or two sets of joint angles, count as the same
_IN_REACH = 0.5  # mm, half a unit of the printed points
_UPRIGHT = np.diag([-1.0, -1.0, 1.0, 1.0])  # orientation of the tool at the printed angles, to a degree


def approach(position: Array, weight: float) -> Array:
    """Minimise the pose error by Newton steps from zero angles.

    Parameters
    ----------
    position : Array, shape (3,) [m]
        The point.
    weight : float [m/rad]
        What a rotation counts beside a distance.

    Returns
    -------
    Array, shape (6,) [rad]
        The joint angles at which the steps come to rest.
    """
    arm, pose = load_arm("ur5"), _UPRIGHT.copy()
    pose[:3, 3] = position
    scale = np.repeat([1.0, weight], 3)
    tight = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15}
    found = least_squares(
        lambda q: scale * error_of(pose, arm.chain.forward(q)), np.zeros(arm.dof), **tight
    )
    return np.asarray(found.x)


def make_angles(full: bool) -> dict[str, Any]:
    """Compute the tool at the printed angles, the reach of the printed points, and angles solved again."""
    paper, arm = load_papers("ur5")[0], load_arm("ur5")
    printed, restored = load("ur5").waypoints, load("ur5-corrected").waypoints
    points = [values(p.position) * p.metre for p in paper.points]

    def apart(weight: float) -> Array:
        solved = np.array([approach(point, weight) for point in points])
        return np.abs((solved - restored + np.pi) % (2.0 * np.pi) - np.pi)

    weight = minimize_scalar(
        lambda w: float(apart(w).max()), bounds=(0.3, 1.5), method="bounded", options={"xatol": 1e-3}
    ).x
    rows = []
    for index, point in enumerate(points):
        tool = arm.chain.forward(restored[index])
        lost = arm.chain.forward(printed[index])[:3, :3]
        upright = _UPRIGHT[:3, :3]
        rows.append(
            {
                "point": (1e3 * point).tolist(),
                "tool": (1e3 * tool[:3, 3]).tolist(),
                "miss": 1e3 * float(np.linalg.norm(tool[:3, 3] - point)),
                "out_of_reach": 1e3 * distance_to(arm, point)[0],
                "tilt": _turn(tool[:3, :3], upright),
                "tilt_as_printed": _turn(lost, upright),
                "printed": np.rad2deg(printed[index]).tolist(),
                "solved": np.rad2deg(approach(point, 1.0)).tolist(),
            }
        )
    return {
        "rows": rows,
        "apart": float(np.rad2deg(apart(1.0).max())),
        "best_weight": float(weight),
        "best_apart": float(np.rad2deg(apart(float(weight)).max())),
    }


def _turn(a: Array, b: Array) -> float:
    """Angle between two orientations [deg]."""
    return float(np.rad2deg(np.arccos(np.clip((np.trace(a @ b.T) - 1.0) / 2.0, -1.0, 1.0))))


def show_angles(data: dict[str, Any]) -> Shown:
    """Show points and reach; printed and reproduced angles."""
    reach = Table(
        ["point", "printed [mm]", "tool at the printed angles [mm]", "away [mm]", "out of reach by [mm]"],
        [
            [f"P{i + 1}", triple(r["point"], 0), triple(r["tool"], 1), f"{r['miss']:.1f}",
             f"{r['out_of_reach']:.1f}"]
            for i, r in enumerate(data["rows"])
        ],
        "The points of sec. 5.1, the tool at the angles of Table 2 by forward kinematics, and how near the "
        "tool gets to the point in any orientation.",
        (1, 2, 3, 4),
    )  # fmt: skip
    lines = []
    for i, r in enumerate(data["rows"]):
        lines.append([f"P{i + 1}, printed", *map(_angle, r["printed"])])
        lines.append([f"P{i + 1}, reproduced", *map(_angle, r["solved"])])
    angles = Table(
        ["angles [deg]", *(f"joint {j + 1}" for j in range(6))], lines,
        "Table 2, printed and reproduced.", range(1, 7),
    )  # fmt: skip
    away = [r["miss"] for r in data["rows"]]
    out = [r["out_of_reach"] for r in data["rows"]]
    tilts = [r["tilt"] for r in data["rows"]]
    lost = data["rows"][0]["tilt_as_printed"]
    near = data["apart"] <= _SAME_ANGLE
    outcome, reached = held(near), held(max(away) <= _IN_REACH)
    restored = max(tilts) <= _SAME_ANGLE < lost
    return Shown(
        [reach, angles],
        [
            f"{sum(o > _IN_REACH for o in out)} of {len(out)} points are out of reach, by {min(out):.1f} to "
            f"{max(out):.1f} mm. The printed angles leave the tool {min(away):.1f} to {max(away):.1f} mm away "
            "from the points; no other angles bring it closer than the distance out of reach. That they lead "
            f"to the points is {reached.inside}.",
            f"{outcome}: a least-squares inverse kinematics "
            "from zero "
            "angles, "
            f"with one metre weighing as much as one radian, stops within {data['apart']:.2f} deg of every "
            f"angle of Table 2 (within {data['best_apart']:.2f} deg if a radian weighs as much as "
            f"{data['best_weight']:.2f} m)."
            + (
                " The table is where a numeric solver stopped before points out of reach."
                if near
                else ""
            ),
            f"With a minus sign at joint 6 of P1 the tool stands within {max(tilts):.2f} deg of one and "
            "the same "
            f"orientation at all four points; as printed it is {lost:.1f} deg off at P1."
            + (" The sign is lost in print." if restored else ""),
        ],
        [
            ItemVerdict("the joint angles, as a solver leaves them", outcome),
            ItemVerdict("that the angles lead to the points", reached),
        ],
    )


def _angle(a: float) -> str:
    return f"{a:.4f}".replace("-0.0000", "0.0000")


TABLE_2 = Item(
    "Table 2",
    "joint angles of the four points",
    make_angles,
    show_angles,
    "The paper does not say how its inverse kinematics was solved, nor in which orientation. It is read as the "
    "unit-weight least squares of a robotics toolbox, in the orientation that the printed angles have.",
)
