"""Wang 2025, Figs 7 to 9: the curves of every joint with 2 s a segment."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.verdicts import agrees, held, smooth, yes_no
from compare.papers.wang_2025.motions import PLAN, curves, motions
from formulations import load


def make_curves(full: bool) -> dict[str, Any]:
    """Judge the plan; find its peaks and jumps."""
    limits = np.degrees(load("sr4c").limits.derivatives[:2]).tolist()
    return {"motions": motions([PLAN]), "limits": limits}


def show_curves(data: dict[str, Any]) -> Shown:
    """Show every joint with its limits, and the peaks as a table."""
    plan, limits = data["motions"][PLAN], data["limits"]
    rows = [
        [str(j + 1), *(cell for order in range(2) for cell in (
            f"{limits[order][j]:g}", f"{plan['peaks'][order][j]:.2f}",
            f"{100 * plan['peaks'][order][j] / limits[order][j]:.1f} %"))]
        for j in range(len(limits[0]))
    ]  # fmt: skip
    header = [
        "joint",
        "velocity limit [deg/s]",
        "peak",
        "used",
        "acceleration limit [deg/s²]",
        "peak",
        "used",
    ]
    joined = smooth(*plan["jumps"])
    remarks = [
        f"The plan takes {plan['seconds']:g} s and keeps the limits of Table 6: {yes_no(plan['keeps'])} "
        f"({plan['most']}). Position, velocity and acceleration are "
        f"{'continuous' if joined else 'not continuous'} at the waypoints, {agrees(joined)} (largest jump "
        f"{max(plan['jumps']):.1g} deg, deg/s or deg/s²).",
        "The curves of the result, which the paper exports from the controller, are Figs 17-19.",
    ]
    verdict = ItemVerdict("that the plan is continuous at the waypoints", held(joined))
    return Shown([curves(data["motions"]), Table(header, rows, "", range(1, 7))], remarks, [verdict])


FIGURES_7_9 = Item(
    "Figs 7-9",
    "angle, velocity and acceleration of every joint, 2 s a segment",
    make_curves,
    show_curves,
    "The spline of eq. 3 and 4 through the angles of Table 5, under the limits of Table 6.",
    cost=0.5,
)
