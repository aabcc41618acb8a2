"""Wang 2025, Figs 7 to 9 and Fig. 11: the joints' curves and the path of the tool."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.audit.paper import settings
from compare.audit.paper.digits import halves, values
from compare.papers.item import Item, Shown, Table
from compare.papers.measure import judged, judged_row, least, peaks, spline
from compare.papers.pictures.panels import Curve, panels
from compare.papers.pictures.paths import length, path_views, tool_path
from compare.papers.verdicts import agrees, smooth, yes_no
from compare.papers.wang_2025.paper import paper
from compare.papers.words import above, listed, seconds
from compare.report.style import BLUE, ORANGE, VERMILION
from formulations import load
from formulations.arms import load_arm

PLAN, RULE, BEST = "2 s a segment, printed plan", "sec. 4.2.2, printed result", "certified optimum"
STYLES = {PLAN: (ORANGE, "-"), RULE: (VERMILION, "-"), BEST: (BLUE, "--")}


def _three_motions() -> dict[str, dict[str, Any]]:
    """Judge the plan, the printed result and the optimum."""
    problem = load("sr4c")
    whole = next(row for row in paper().rows if row.joint is None)
    durations = {
        PLAN: settings("sr4c")["first_plan"]["times"],
        RULE: values(whole.times).tolist(),
        BEST: least(problem)["durations"],
    }
    found = {name: judged(problem, times) for name, times in durations.items()}
    found[RULE]["digits"] = judged_row(paper(), whole)["keeps"]
    return found


# --- Figs 7-9 -------------------------------------------------------------------------------------


def make_curves(full: bool) -> dict[str, Any]:
    """Judge the plan, the printed result and the optimum; find their peaks and jumps."""
    problem = load("sr4c")
    found = _three_motions()
    for motion in found.values():
        trajectory = spline(problem, motion["durations"])
        motion["peaks"] = np.degrees(peaks(trajectory)).tolist()
        motion["jumps"] = np.degrees(trajectory.jumps.max(axis=1)).tolist()
    return {"motions": found, "limits": np.degrees(problem.limits.derivatives[:2]).tolist()}


def show_curves(data: dict[str, Any]) -> Shown:
    """Show every joint with its limits, and the peaks as a table."""
    problem, motions = load("sr4c"), data["motions"]
    splines = {name: spline(problem, m["durations"]) for name, m in motions.items()}
    columns = [
        (f"joint {j + 1}", [Curve(_label(name, motions[name]), STYLES[name], problem, splines[name], j)
                            for name in motions])
        for j in range(problem.dof)
    ]  # fmt: skip
    names = ["plan", "result", "optimum"]
    header = ["joint", "speed limit", *names, "acceleration limit", *names]
    rows = []
    for j in range(problem.dof):
        row = [str(j + 1)]
        for order in range(2):
            row.append(f"{data['limits'][order][j]:g}")
            row += [f"{m['peaks'][order][j]:.2f}" for m in motions.values()]
        rows.append(row)
    table = Table(
        header,
        rows,
        "Peaks of speed [deg/s] and of acceleration [deg/s²]: of the plan, the printed result and the optimum.",
        range(1, 9),
    )
    plan, rule, best = (motions[name] for name in (PLAN, RULE, BEST))
    grown = [r / p for r, p in zip(rule["peaks"][1], plan["peaks"][1], strict=True)]
    most = sorted(range(problem.dof), key=lambda j: -grown[j])
    joined = smooth(*plan["jumps"])
    remarks = [
        f"The plan takes {plan['seconds']:g} s and keeps the limits of Table 6: {yes_no(plan['keeps'])} "
        f"({plan['most']}). Position, speed and acceleration are "
        f"{'continuous' if joined else 'not continuous'} at the waypoints, {agrees(joined)} (largest jump "
        f"{max(plan['jumps']):.1g} deg, deg/s or deg/s²).",
        f"The printed result takes {rule['seconds']:.4f} s and keeps the limits: {rule['digits']} "
        f"({rule['most']}). Sec. 4.3.2 says that the acceleration grows markedly at joints 1 and 5. Against "
        "the plan it grows " + listed([f"{grown[j]:.2f} times at joint {j + 1}" for j in most]) + ".",
        f"The optimum of the same spline family takes {best['seconds']:.4f} s: "
        f"{above(best['seconds'], rule['seconds'])} against the printed result and "
        f"{above(best['seconds'], plan['seconds'])} against the plan.",
    ]
    return Shown([panels(columns), table], remarks)


def _label(name: str, motion: dict[str, Any]) -> str:
    return f"{name}, {seconds(motion['seconds'])} s"


# --- Fig. 11 --------------------------------------------------------------------------------------


def make_path(full: bool) -> dict[str, Any]:
    """Measure the paths, and how far the tool passes from the printed points."""
    problem, arm = load("sr4c"), load_arm("sr4c")
    found = _three_motions()
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
    problem, arm, motions = load("sr4c"), load_arm("sr4c"), data["motions"]
    drawn = [
        (_label(name, m), STYLES[name], spline(problem, m["durations"])) for name, m in motions.items()
    ]
    figure = path_views(arm, drawn, np.array(data["points"]), ["1", "2", "3", "4"])
    resolved, printed_ = (data["misses"][name] for name in ("resolved", "printed"))
    best, rule = motions[BEST], motions[RULE]
    remarks = [
        f"By forward kinematics with the joint offsets, the tool passes the four points of Table 4 within "
        f"{1e3 * max(resolved):.2f} mm. Rounding of the points alone allows {1e3 * data['rounding']:.2f} mm, "
        "and rounding of the angles as much again.",
        f"The other reading, Table 1 as printed and without offsets, misses the points by "
        f"{1e3 * min(printed_):.0f} to {1e3 * max(printed_):.0f} mm.",
        f"The path of the printed result is {rule['length']:.3f} m long, the path of the optimum "
        f"{best['length']:.3f} m. Both pass the same points; the shape depends on the ratio of the times.",
    ]
    return Shown([figure], remarks)


FIGURES_7_9 = Item(
    "Figs 7-9",
    "angle, speed and acceleration of every joint, 2 s a segment",
    make_curves,
    show_curves,
    "The printed pictures show the plan of 2 s a segment alone. The printed result and the optimum are added.",
    cost=3.0,
)
FIGURE_11 = Item(
    "Fig 11",
    "path of the tool",
    make_path,
    show_path,
    "The path of the printed result, by forward kinematics; the plan and the optimum beside it.",
    cost=3.0,
)
