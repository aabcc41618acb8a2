"""Zhou 2025, Figs 5 to 7: the path of the tool, the convergence and the joints' curves."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.audit.paper import load_papers, settings
from compare.audit.paper.digits import values
from compare.papers.item import Item, ItemVerdict, Shown
from compare.papers.measure import judged, least, spline, summary, trials
from compare.papers.pictures.descent import descent, draw_descent
from compare.papers.pictures.panels import all_joints, panels, verdict_told
from compare.papers.pictures.paths import length, path_views, tool_path
from compare.papers.verdicts import held, same_order, same_times, smooth
from compare.papers.words import listed
from compare.papers.zhou_2025.paper import BUDGET, RUNS, SWARMS, as_meant, printed_ends
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, styled
from formulations import load, longest_segment
from formulations.arms import load_arm
from formulations.problem.arrays import Array

_POINT_HALF = 0.5  # mm, half a unit of the printed points
_OVERSHOOT = 1.0  # deg


def make_plans(full: bool) -> dict[str, Any]:
    """Judge the first plan, the motion of Table 6, and ISSA's: each joint alone, then the longest times."""
    paper, problem = as_meant()
    row = next(r for r in paper.rows if r.joint is None and r.by == "ISSA")
    alone = [summary(trials(problem.joint(j), "issa", BUDGET, RUNS[full])) for j in range(problem.dof)]
    rule = longest_segment(problem, [np.array(found["durations"]) for found in alone])
    return {
        "total": str(row.total),
        "before": judged(problem, settings("ur5")["first_plan"]["times"]),
        "printed": judged(problem, values(row.times)),
        "reproduced": judged(problem, rule.claimed),
    }


# --- Fig. 5 ---------------------------------------------------------------------------------------


def make_path(full: bool) -> dict[str, Any]:
    """Judge both motions, and measure how far they pass from the printed points [m]."""
    problem, arm = load("ur5-corrected"), load_arm("ur5")
    tool = arm.chain.forward(problem.waypoints)[:, :3, 3]
    return {**make_plans(full), "miss": np.linalg.norm(tool - _points(), axis=1).tolist()}


def _points() -> Array:
    """The points of sec. 5.1, (4, 3) [m]."""
    return np.array([values(p.position) * p.metre for p in load_papers("ur5")[0].points])


def show_path(data: dict[str, Any]) -> Shown:
    """Show both paths in three views."""
    problem, arm = load("ur5-corrected"), load_arm("ur5")
    motions = []
    for name, style in (("printed", (VERMILION, "-")), ("reproduced", (BLUE, "--"))):
        motion = spline(problem, data[name]["durations"])
        motions.append((f"{name} times, {motion.seconds:.3f} s", style, motion))
    long = [length(tool_path(arm, motion)) for _, _, motion in motions]
    miss = [1e3 * m for m in data["miss"]]
    outcome = held(max(miss) <= _POINT_HALF)
    return Shown(
        [path_views(arm, motions, _points(), [f"P{i + 1}" for i in range(4)])],
        [
            f"That the path passes P1 to P4 is {outcome.inside}: it passes them at a distance of "
            f"{listed([f'{m:.0f}' for m in miss])} mm (see Table 2).",
            "The times change the shape of the path, not only the speed along it: with the printed times the "
            f"tool goes {long[0]:.2f} m, with the reproduced ones {long[1]:.2f} m.",
        ],
        [ItemVerdict("that the path passes P1 to P4", outcome)],
    )


# --- Fig. 6 ---------------------------------------------------------------------------------------


def make_descents(full: bool) -> dict[str, Any]:
    """Follow the best time of joint 1 over the iterations, by algorithm."""
    joint = load("ur5-corrected").joint(0)
    found = {}
    for name, swarm in SWARMS.items():
        runs = trials(joint, swarm, BUDGET, RUNS[full])
        traces = [graded.traces[0] for graded in runs]
        found[name] = descent(traces, BUDGET.population, BUDGET.iterations)
    return {"descents": found, "bound": least(joint)["bound"], "runs": RUNS[full]}


STYLE = {"PSO": (GREEN, "-"), "SSA": (ORANGE, "-"), "ISSA": (BLUE, "-")}


@styled
def descent_figure(data: dict[str, Any]) -> Figure:
    """Draw the gaps of the reproduced curves to the certified bound, and all ends in seconds."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.9), width_ratios=(2, 1))
    bound, printed = data["bound"], printed_ends()
    for row, (name, found) in enumerate(data["descents"].items()):
        draw_descent(left, found, f"{name}: median, quartiles", STYLE[name], above=bound)
        ends = printed[name], found["quartiles"][1][-1]
        for x, marker, word in zip(ends, "Xo", ("printed", "reproduced"), strict=True):
            right.plot(x, row, marker, color=STYLE[name][0], ms=7)
            right.annotate(f"{word}: {x:.5g}", (x, row), (0, 8), textcoords="offset points",
                           ha="left" if word == "printed" else "right", fontsize=8)  # fmt: skip
    left.set_yscale("log")
    left.set_xlabel("iteration (as many evaluations as there are individuals)")
    left.set_ylabel("best time of joint 1 over its certified bound, minus 1")
    left.legend(fontsize=8, frameon=False)
    right.axvspan(0.0, bound, color=GREY, alpha=0.15, lw=0)
    right.axvline(bound, color=BLACK, lw=1.0, ls="--")
    right.text(0.5 * bound, 2.75, f"no spline below {bound:.3f} s", ha="center", fontsize=8)
    right.set_xlim(0.0, 1.1 * bound)
    right.set_ylim(-0.5, 3.1)
    right.set_yticks(range(3), list(data["descents"]))
    right.set_xlabel("end of the curve [s]")
    return figure


def show_descents(data: dict[str, Any]) -> Shown:
    """Show the picture, and how it compares."""
    ends = {name: found["quartiles"][1][-1] for name, found in data["descents"].items()}
    within = {}
    for name, found in data["descents"].items():
        middle = np.array(found["quartiles"][1], dtype=float)
        near = np.flatnonzero(middle <= data["bound"] * 1.01)
        within[name] = found["iterations"][near[0]] if len(near) else None
    printed, bound = printed_ends(), data["bound"]
    fast = ", ".join(f"{n} {'never' if i is None else int(i)}" for n, i in within.items())
    below = [name for name, end in printed.items() if end < bound]
    outcome = same_times(
        list(printed.values()), [ends[name] for name in printed], [name in below for name in printed]
    )
    order = same_order([ends[name] for name in ("ISSA", "SSA", "PSO")])
    return Shown(
        [descent_figure(data)],
        [
            f"{outcome}. Printed ends: " + ", ".join(f"{n} {e} s" for n, e in printed.items())
            + f". Below the {bound:.3f} s that are proved for joint 1 under the limits of Table 3: "
            f"{listed(below)}. Reproduced ends: " + ", ".join(f"{n} {e:.3f} s" for n, e in ends.items()) + ".",
            f"First iteration within 1 % of the optimum (median run): {fast}. The printed order, ISSA before "
            f"SSA before PSO, is {order.inside} at the end.",
        ],
        [
            ItemVerdict("the ends of the curves", outcome),
            ItemVerdict("the order at the end: ISSA, SSA, PSO", order),
        ],
    )  # fmt: skip


# --- Fig. 7 ---------------------------------------------------------------------------------------


def show_curves(data: dict[str, Any]) -> Shown:
    """Show the curves of both motions, with the jerk."""
    problem, printed, reproduced = load("ur5-corrected"), data["printed"], data["reproduced"]
    titles = {
        "printed": f"Table 6 as printed, {data['total']} s",
        "reproduced": f"ISSA again, {reproduced['seconds']:.3f} s",
    }
    columns = [
        all_joints(f"{title}:\n{verdict_told(data[name])}", problem, data[name]["durations"])
        for name, title in titles.items()
    ]
    rule = "keeps" if reproduced["keeps"] else "does not keep"
    calm = smooth(*spline(problem, printed["durations"]).jumps.ravel())
    low, high = _swing(printed, 0)
    least_angle, most_angle = _waypoints(0)
    return Shown(
        [panels(columns, (0, 1, 2, 3))],
        [
            f"The printed motion is {'smooth' if calm else 'not smooth'}, and it "
            + (
                "keeps the limits that it was planned for, as claimed"
                if printed["keeps"]
                else "breaks the limits that it was planned for, against what is claimed"
            )
            + f": it uses most of the {printed['most']}.",
            f"Joint 1 swings from {low:.0f} to {high:.0f} deg; its waypoints lie between {least_angle:.0f} and "
            f"{most_angle:.0f} deg."
            + (
                " A 3-5-3 spline whose first and last segments are too short overshoots between its waypoints."
                if low < least_angle - _OVERSHOOT or high > most_angle + _OVERSHOOT
                else ""
            ),
            _first_plan(data["before"]),
            f"The rule of the longest time per segment {rule} the limits of all joints here: the reproduced "
            f"plan uses most of the {reproduced['most']}.",
        ],
        [
            ItemVerdict("that the motion is smooth", held(calm)),
            ItemVerdict("that it keeps the limits it was planned for", held(printed["keeps"])),
        ],
    )


def _first_plan(before: dict[str, Any]) -> str:
    """Whether the plan of sec. 5.2, from which the paper counts, keeps the limits."""
    return f"The plan before, {before['seconds']:.0f} s in equal segments (sec. 5.2), " + (
        "keeps the limits."
        if before["keeps"]
        else f"breaks the limits until all times are stretched by {before['stretch']:.3f}, to "
        f"{before['seconds'] * before['stretch']:.2f} s."
    )


def _swing(motion: dict[str, Any], joint: int) -> tuple[float, float]:
    """Least and greatest position of one joint on a motion [deg]."""
    reached = spline(load("ur5-corrected"), motion["durations"]).extremes(0)
    low, high = np.rad2deg([reached.low[:, joint].min(), reached.high[:, joint].max()])
    return float(low), float(high)


def _waypoints(joint: int) -> tuple[float, float]:
    """Least and greatest waypoint of one joint [deg]."""
    angles = np.rad2deg(load("ur5-corrected").waypoints[:, joint])
    return float(angles.min()), float(angles.max())


FIGURE_5 = Item(
    "Fig 5",
    "path of the tool",
    make_path,
    show_path,
    "The paper does not say which motion it draws. Here it is the motion of Table 6, printed and reproduced.",
    cost=8.0,
)
FIGURE_6 = Item(
    "Fig 6",
    "convergence for joint 1",
    make_descents,
    show_descents,
    "The paper prints one run of each. Here stand the median of several runs and the quartiles; an iteration "
    "is as many evaluations as there are individuals, scouts included.",
    cost=4.0,
)
FIGURE_7 = Item(
    "Fig 7",
    "position, velocity and acceleration of the joints",
    make_plans,
    show_curves,
    "The motion of Table 6. The jerk, which Table 3 limits and the paper does not draw, is added.",
    cost=8.0,
)
