"""Paper 002 (UR5, ISSA): Figs 5 to 7, the tool's path, convergence and the joints' curves."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.audit.paper_file import load_papers
from compare.audit.printed import values
from compare.benchmark.suite import PAPER_BUDGETS
from compare.papers.curves import all_joints, verdict_told
from compare.papers.descent import descent, draw_descent
from compare.papers.item import Item, Shown
from compare.papers.measure import judged, least, listed, summary, trials
from compare.papers.panels import panels
from compare.papers.paths import length, path_views, tool_path
from compare.papers.printed import tables
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, styled
from formulations import FAMILIES, load, longest_segment
from formulations.arms import load_arm
from formulations.problem.arrays import Array

_BUDGET = PAPER_BUDGETS["ur5"]
_RUNS = {False: 5, True: 30}


def planned(full: bool) -> dict[str, Any]:
    """Table 6 and ISSA's plan: each joint alone, then the longest time per segment; both judged."""
    paper = next(p for p in load_papers("ur5") if p.name == "ur5-corrected")
    row = next(r for r in paper.rows if r.joint is None and r.by == "ISSA")
    problem = load("ur5-corrected")
    alone = [
        summary(trials(problem.joint(j), "issa", _BUDGET, _RUNS[full])) for j in range(problem.dof)
    ]
    rule = longest_segment(problem, [np.array(found["durations"]) for found in alone])
    return {
        "total": str(row.total),
        "printed": judged(problem, values(row.times)),
        "reproduced": judged(problem, rule.claimed),
    }


# --- Fig. 5 ---------------------------------------------------------------------------------------


def make_path(full: bool) -> dict[str, Any]:
    """Both motions, and how far they stay away from the printed points [m]."""
    problem, arm = load("ur5-corrected"), load_arm("ur5")
    tool = arm.chain.forward(problem.waypoints)[:, :3, 3]
    return {**planned(full), "miss": np.linalg.norm(tool - _points(), axis=1).tolist()}


def _points() -> Array:
    """The points of sec. 5.1, (4, 3) [m]."""
    return np.array([values(p.position) * p.metre for p in load_papers("ur5")[0].points])


def show_path(data: dict[str, Any]) -> Shown:
    """Paths in three views, and where they do not go."""
    problem, arm = load("ur5-corrected"), load_arm("ur5")
    motions = []
    for name, style in (("printed", (VERMILION, "-")), ("reproduced", (BLUE, "--"))):
        motion = FAMILIES[problem.family].trajectory(problem, data[name]["durations"])
        motions.append((f"{name} times, {motion.seconds:.3f} s", style, motion))
    long = [length(tool_path(arm, motion)) for _, _, motion in motions]
    miss = [f"{1e3 * m:.0f}" for m in data["miss"]]
    return Shown(
        [path_views(arm, motions, _points(), [f"P{i + 1}" for i in range(4)])],
        [
            f"Not reproduced: the path passes P1 to P4 at {listed(miss)} mm, as the points are out of reach "
            "(Table 2).",
            f"Times shape the path, too, not the speed along it alone: with the printed ones the tool goes "
            f"{long[0]:.2f} m, with the reproduced ones {long[1]:.2f} m.",
        ],
    )


# --- Fig. 6 ---------------------------------------------------------------------------------------


def make_descents(full: bool) -> dict[str, Any]:
    """Best time of joint 1 against iterations, by algorithm."""
    joint = load("ur5-corrected").joint(0)
    found = {}
    for name, swarm in (("PSO", "pso"), ("SSA", "sparrow"), ("ISSA", "issa")):
        runs = trials(joint, swarm, _BUDGET, _RUNS[full])
        traces = [graded.traces[0] for graded in runs]
        found[name] = descent(traces, _BUDGET.population, _BUDGET.iterations)
    return {"descents": found, "bound": least(joint)["bound"], "runs": _RUNS[full]}


STYLE = {"PSO": (GREEN, "-"), "SSA": (ORANGE, "-"), "ISSA": (BLUE, "-")}


@styled
def descent_figure(data: dict[str, Any]) -> Figure:
    """Gaps of the reproduced curves to the certified bound; printed and reproduced ends in seconds."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.9), width_ratios=(2, 1))
    bound, printed = data["bound"], tables("ur5")["descents"]["ends"]
    for row, (name, found) in enumerate(data["descents"].items()):
        draw_descent(left, found, f"{name}: median, quartiles", STYLE[name], above=bound)
        ends = float(printed[name]), found["quartiles"][1][-1]
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
    """The picture and how it compares."""
    ends = {name: found["quartiles"][1][-1] for name, found in data["descents"].items()}
    within = {}
    for name, found in data["descents"].items():
        middle = np.array(found["quartiles"][1], dtype=float)
        near = np.flatnonzero(middle <= data["bound"] * 1.01)
        within[name] = found["iterations"][near[0]] if len(near) else None
    printed = tables("ur5")["descents"]["ends"]
    fast = ", ".join(f"{n} {'never' if i is None else int(i)}" for n, i in within.items())
    return Shown(
        [descent_figure(data)],
        [
            "Not reproduced: printed ends "
            + ", ".join(f"{n} {e} s" for n, e in printed.items())
            + f" lie below the {data['bound']:.3f} s that are proved for joint 1 under the limits of Table "
            "3; reproduced ends are " + ", ".join(f"{n} {e:.3f} s" for n, e in ends.items()) + ".",
            f"First iteration within 1 % of the optimum (median run): {fast}. The printed order, ISSA before "
            f"SSA before PSO, is {'' if ends['ISSA'] < ends['SSA'] < ends['PSO'] else 'not '}what comes out "
            "in the end.",
        ],
    )


# --- Fig. 7 ---------------------------------------------------------------------------------------


def show_curves(data: dict[str, Any]) -> Shown:
    """Curves of both motions; the paper draws all but the jerk, which it limits too."""
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
    return Shown(
        [panels(columns, (0, 1, 2, 3))],
        [
            "Not as claimed: the printed motion is smooth, but breaks the limits it was planned for; it asks "
            f"most of the {printed['most']}.",
            f"Joint 1 swings from {_swing(printed, 0)} deg where its waypoints lie within "
            f"{_waypoints(0)} deg: a 3-5-3 spline that is too fast at both ends overshoots between them.",
            f"The rule of the longest time per segment {rule} the limits of all joints here: the reproduced "
            f"plan uses most of the {reproduced['most']}.",
        ],
    )


def _swing(judged: dict[str, Any], joint: int) -> str:
    """Least and greatest position of one joint on a motion [deg]."""
    problem = load("ur5-corrected")
    reached = FAMILIES[problem.family].trajectory(problem, judged["durations"]).extremes(0)
    low, high = np.rad2deg([reached.low[:, joint].min(), reached.high[:, joint].max()])
    return f"{low:.0f} to {high:.0f}"


def _waypoints(joint: int) -> str:
    angles = np.rad2deg(load("ur5-corrected").waypoints[:, joint])
    return f"{angles.min():.0f} to {angles.max():.0f}"


ITEMS: tuple[Item, ...] = (
    Item(
        "Fig 5",
        "path of the tool",
        make_path,
        show_path,
        "The paper does not say which motion it draws: here the one of Table 6, as printed and reproduced.",
        cost=8.0,
    ),
    Item(
        "Fig 6",
        "convergence for joint 1",
        make_descents,
        show_descents,
        "One run of each is printed, here the median of several and the quartiles; an iteration is as many "
        "evaluations as there are individuals, scouts counted.",
        cost=4.0,
    ),
    Item(
        "Fig 7",
        "position, velocity and acceleration of the joints",
        planned,
        show_curves,
        "The motion of Table 6; the jerk, limited in Table 3 but not drawn in the paper, is added.",
        cost=8.0,
    ),
)
