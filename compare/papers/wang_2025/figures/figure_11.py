"""Wang 2025, Fig. 11: the path of the tool."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.audit.paper.digits import halves, values
from compare.papers.item import Item, ItemVerdict, Shown
from compare.papers.measure import spline
from compare.papers.pictures.paths import length, path_views, tool_path
from compare.papers.verdicts import held
from compare.papers.wang_2025.motions import BEST, RULE, STYLES, label, motions
from compare.papers.wang_2025.paper import paper
from formulations import load
from formulations.arms import load_arm


def make_path(full: bool) -> dict[str, Any]:
    """Measure the paths, and how far the tool passes from the printed points."""
    problem, arm = load("sr4c"), load_arm("sr4c")
    found = motions(list(STYLES))
    for motion in found.values():
        motion["length"] = length(tool_path(arm, spline(problem, motion["durations"]), 4000))
    points = np.array([values(p.position) * p.metre for p in paper().points])
    misses = {
        name: np.linalg.norm(chain.forward(problem.waypoints)[:, :3, 3] - points, axis=1).tolist()
        for name, chain in (("resolved", arm.chain), ("printed", arm.printed))
    }
    rounding = max(float(np.linalg.norm(halves(p.position) * p.metre)) for p in paper().points)
    return {"motions": found, "points": points.tolist(), "misses": misses, "rounding": rounding}


def show_path(data: dict[str, Any]) -> Shown:
    """Show three views of the paths."""
    problem, arm, found = load("sr4c"), load_arm("sr4c"), data["motions"]
    drawn = [
        (label(name, m), STYLES[name], spline(problem, m["durations"])) for name, m in found.items()
    ]
    figure = path_views(arm, drawn, np.array(data["points"]), ["1", "2", "3", "4"])
    resolved, printed_ = (data["misses"][name] for name in ("resolved", "printed"))
    best, rule = found[BEST], found[RULE]
    passed = held(max(resolved) <= 2.0 * data["rounding"])
    remarks = [
        f"That the path passes the four points of Table 4 is {passed.inside}: by forward kinematics with the "
        "joint offsets, the tool passes them within "
        f"{1e3 * max(resolved):.2f} mm. Rounding of the points alone allows {1e3 * data['rounding']:.2f} mm, "
        "and rounding of the angles as much again.",
        f"The other reading, Table 1 as printed and without offsets, misses the points by "
        f"{1e3 * min(printed_):.0f} to {1e3 * max(printed_):.0f} mm.",
        f"The path of the printed result is {rule['length']:.3f} m long, the path of the optimum "
        f"{best['length']:.3f} m. Both pass the same points; the shape depends on the ratio of the times.",
    ]
    return Shown([figure], remarks, [ItemVerdict("that the path passes the points of Table 4", passed)])


FIGURE_11 = Item(
    "Fig 11",
    "path of the tool",
    make_path,
    show_path,
    "The path of the printed result, by forward kinematics; the plan and the optimum beside it.",
    cost=3.0,
)
