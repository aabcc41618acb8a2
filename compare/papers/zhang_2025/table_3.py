"""Zhang 2025, Table 3: the joint angles of the four points."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from compare.audit.paper.digits import values
from compare.papers.inverse import make_inverse
from compare.papers.item import Item, Shown, Table
from compare.papers.verdicts import Reproduction
from compare.papers.words import triple
from compare.papers.zhang_2025.paper import paper
from formulations.arms import load_arm

_FITS = 1.0  # mm: an arm leads to the printed points


def make_angles(full: bool) -> dict[str, Any]:
    """Solve Table 2 for joint angles; measure the misses of the printed arm and of the text's point."""
    printed, arm = paper(), load_arm("cobot")
    assert printed.waypoints is not None
    table = tuple(p for p in printed.points if p.where.startswith("Table 2"))
    text = next(p for p in printed.points if p not in table)
    tool = arm.chain.forward(printed.waypoints)[:, :3, 3]
    return {
        **make_inverse(replace(printed, points=table)),
        "table": (1e3 * np.array([values(p.position) * p.metre for p in table])).tolist(),
        "tool": (1e3 * tool).tolist(),
        "text_z": str(text.position[2]),
        "text_miss": 1e3
        * float(np.linalg.norm(tool[text.waypoint] - values(text.position) * text.metre)),
    }


def show_angles(data: dict[str, Any]) -> Shown:
    """Show the points, then the angles."""
    points = data["points"]
    places = Table(
        ["point", "Table 2 [mm]", "tool at the angles of Table 3 [mm]", "away [mm]", "branches"],
        [
            [f"X{i}", triple(data["table"][i]), triple(data["tool"][i]), f"{1e3 * p['miss']:.3f}",
             str(p["branches"])]
            for i, p in enumerate(points)
        ],
        "Points by forward kinematics of the fitted chain; how many sets of angles lead to each.",
        (1, 2, 3, 4),
    )  # fmt: skip
    lines = []
    for i, p in enumerate(points):
        lines.append([f"X{i}, printed", *(f"{a:.0f}" for a in np.rad2deg(p["printed"]))])
        lines.append(
            [f"X{i}, reproduced", *(f"{a:.4f}" for a in np.round(np.rad2deg(p["found"]), 4) + 0.0)]
        )
    angles = Table(
        ["angles [deg]", *(f"joint {j + 1}" for j in range(6))], lines,
        "Table 3: printed, and solved from Table 2, each nearest to the one before.", range(1, 7),
    )  # fmt: skip
    misses = [1e3 * p["miss_as_printed"] for p in points]
    fitted = 1e3 * max(p["miss"] for p in points)
    apart = np.abs(np.subtract([p["found"] for p in points], [p["printed"] for p in points]))
    worst = int(apart.max(axis=1).argmax())
    others = sorted(p["miss"] for p in points)[-2]
    outcome = Reproduction.REPRODUCED if fitted <= _FITS else Reproduction.NOT
    by = "the arm as printed" if min(misses) <= _FITS else "another arm than the printed one"
    return Shown(
        [places, angles],
        [
            f"{outcome} by {by}: a chain with three parallel axes, fitted to the paper's own numbers, "
            "leads from "
            f"Table 3 to Table 2 within {fitted:.3f} mm; the PUMA560 of Table 1 misses the points by "
            f"{min(misses):.0f} to {max(misses):.0f} mm.",
            "Solved from Table 2, with the nearest of the branches each time, the angles come back within "
            f"{np.rad2deg(apart.max()):.1e} deg, farthest at X{worst}"
            + (
                ", where a digit of the printed y is probably wrong: it is "
                f"{abs(data['table'][worst][1] - data['tool'][worst][1]):.3f} mm off, the other points at most "
                f"{1e3 * others:.3f} mm."
                if points[worst]["miss"] > 10.0 * others
                else "."
            ),
            f"The other reading of X1, z = {data['text_z']} mm in the text, is {data['text_miss']:.1f} mm off"
            + (": a misprint." if data["text_miss"] > 10.0 * fitted else "."),
        ],
    )


TABLE_3 = Item(
    "Table 3",
    "joint angles of the four points",
    make_angles,
    show_angles,
    "The arm is printed as a PUMA560, which its own numbers contradict; the chain used is the one that fits "
    "them. Only positions are printed: the orientations are those of the printed angles.",
)
