"""Table 3 of 004: joint angles of the four points."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from compare.audit.paper_file import load_papers
from compare.audit.printed import values
from compare.papers.inverse import make_inverse
from compare.papers.item import Item, Shown, Table
from compare.papers.measure import triple
from formulations.arms import load_arm


def make_angles(full: bool) -> dict[str, Any]:
    """The points of Table 2 solved to joints; what the printed arm and the text's point miss by."""
    paper, arm = load_papers("cobot")[0], load_arm("cobot")
    assert paper.waypoints is not None
    table = tuple(p for p in paper.points if p.where.startswith("Table 2"))
    text = next(p for p in paper.points if p not in table)
    tool = arm.chain.forward(paper.waypoints)[:, :3, 3]
    return {
        **make_inverse(replace(paper, points=table)),
        "table": (1e3 * np.array([values(p.position) * p.metre for p in table])).tolist(),
        "tool": (1e3 * tool).tolist(),
        "text_z": str(text.position[2]),
        "text_miss": 1e3
        * float(np.linalg.norm(tool[text.waypoint] - values(text.position) * text.metre)),
    }


def show_angles(data: dict[str, Any]) -> Shown:
    """Points, then angles."""
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
    apart = np.abs(np.subtract([p["found"] for p in points], [p["printed"] for p in points]))
    worst = int(apart.max(axis=1).argmax())
    return Shown(
        [places, angles],
        [
            f"Reproduced, but by another arm: a chain with three parallel axes, fitted to the paper's own "
            f"numbers, leads from Table 3 to Table 2 within {1e3 * max(p['miss'] for p in points):.3f} mm; the "
            f"PUMA560 of Table 1 misses its points by {min(misses):.0f} to {max(misses):.0f} mm.",
            f"Solved from Table 2, going to the nearest of the branches each time, the angles come back within "
            f"{np.rad2deg(apart.max()):.1e} deg, farthest at X{worst}"
            + (
                ", where a digit of the printed y is probably wrong: it is "
                f"{abs(data['table'][worst][1] - data['tool'][worst][1]):.3f} mm off, the other points at most "
                f"{1e3 * sorted(p['miss'] for p in points)[-2]:.3f} mm."
                if points[worst]["miss"] > 10.0 * sorted(p["miss"] for p in points)[-2]
                else "."
            ),
            f"The other reading of X1, z = {data['text_z']} mm in the text, is {data['text_miss']:.1f} mm "
            "off: a misprint.",
        ],
    )


ITEMS: tuple[Item, ...] = (
    Item(
        "Table 3",
        "joint angles of the four points",
        make_angles,
        show_angles,
        "The arm is printed as a PUMA560, which its own numbers contradict; the chain used is the one that "
        "fits them. Only positions are printed: orientations are those of the printed angles.",
    ),
)
