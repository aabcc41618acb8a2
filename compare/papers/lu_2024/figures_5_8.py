"""Lu 2024, Figs 5 to 8: convergence and curves, on made waypoints since the paper prints none."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.audit.paper import load_papers, settings
from compare.benchmark.grade import Run, grade
from compare.papers.item import Item, Shown, Table
from compare.papers.lu_2024.plan import drawn_waypoints, plan, task
from compare.papers.measure import spline
from compare.papers.pictures.descent import draw_descent
from compare.papers.pictures.panels import all_joints, panels, verdict_told
from compare.papers.verdicts import BEST, agrees, same_gain, smooth
from compare.papers.words import percent
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, styled
from formulations import family_bound, family_optimum

RUNS = {False: 5, True: 30}
SETS = {False: 10, True: 50}  # further sets of waypoints

# --- Fig. 5 ---------------------------------------------------------------------------------------

SWARMS = {
    "whale-lu-2024": ("whales with inertia and chaotic start, resolved", (BLUE, "-")),
    "whale-lu-2024-printed": ("the same, equations as printed", (ORANGE, "-")),
    "whale": ("whales as published in 2016", (GREEN, "-")),
}


def make_descent(full: bool) -> dict[str, Any]:
    """Follow the best total time over the iterations on the B-spline of degree 5."""
    problem = task("b-spline-5")
    found = {swarm: plan(problem, swarm, RUNS[full]) for swarm in SWARMS}
    optimum = family_optimum(problem)
    bound = family_bound(problem, optimum=optimum)
    return {"found": found, "optimum": optimum.seconds, "bound": bound.seconds}


@styled
def descent_figure(data: dict[str, Any]) -> Figure:
    """Draw the reproduced descents, the best known optimum, the certified bound and the printed end."""
    figure, axes = plt.subplots(figsize=(9.5, 4.0))
    for swarm, found in data["found"].items():
        name, style = SWARMS[swarm]
        draw_descent(axes, found["descent"], f"{name}", style)
    printed = _printed("B-spline with WOA")
    for value, colour, line, label in (
        (data["optimum"], BLACK, "--", f"best known B-spline: {data['optimum']:.3f} s"),
        (data["bound"], GREY, "--", f"certified: no motion below {data['bound']:.3f} s"),
        (float(printed), VERMILION, ":", f"printed end: {printed} s, on other waypoints"),
    ):
        axes.axhline(value, color=colour, ls=line, lw=1.1, label=label)
    axes.set_ylim(None, 1.7 * data["optimum"])
    axes.set_xlabel("iteration")
    axes.set_ylabel("total time [s]; bands: quartiles")
    figure.legend(loc="outside right center", fontsize=8, frameon=False)
    return figure


def show_descent(data: dict[str, Any]) -> Shown:
    """Show the picture, and the paper's two observations."""
    says = settings("z1")["descent"]
    remarks = [
        "The seconds cannot be compared, since the paper prints no waypoints. These were drawn at random and "
        "stand in the case file z1."
    ]
    for swarm, found in data["found"].items():
        curve = np.array(found["descent"]["quartiles"][1], dtype=float)
        at = np.array(found["descent"]["iterations"])
        end, name = curve[-1], SWARMS[swarm][0].capitalize()
        solved = (
            f"{name}: {len(found['seconds'])} of {found['runs']} runs find a motion within the limits"
        )
        if not np.isfinite(end):
            remarks.append(f"{solved}.")
            continue
        steady = int(at[np.flatnonzero(curve <= 1.01 * end)[0]])
        left = curve[np.searchsorted(at, says["left_local_optimum"])]
        remarks.append(
            f"{solved}. The median ends at {end:.3f} s, {percent(end / data['optimum'] - 1.0)} above the best "
            f"known, and is within 1 % of its end from iteration {steady} on (printed: steady after "
            f"{says['steady_after']}). After iteration {says['left_local_optimum']}, where the paper sees the "
            f"swarm leave a local optimum, it falls by {percent(1.0 - end / left)}."
        )
    ends = [found["descent"]["quartiles"][1][-1] for found in data["found"].values()]
    arrived = sum(end is not None and end <= data["optimum"] * (1.0 + BEST) for end in ends)
    remarks.append(
        f"{arrived} of {len(ends)} medians end at the best known B-spline, {data['optimum']:.3f} s: a "
        "curve that "
        "has become flat need not have found the optimum. The best known one comes from local solves; it is "
        f"proved that no motion at all takes less than {data['bound']:.3f} s."
    )
    return Shown([descent_figure(data)], remarks)


def _printed(by: str) -> str:
    """Total time as the paper prints it [s]."""
    return str(next(t.value for t in load_papers("z1")[0].totals if t.by == by))


# --- Figs 6 to 8 ----------------------------------------------------------------------------------


def make_curves(full: bool) -> dict[str, Any]:
    """Run the paper's method and its rival; compare the families alone on these and on other waypoints."""
    found = {
        "b-spline-5": plan(task("b-spline-5"), "whale-lu-2024", RUNS[full]),
        "quintic": plan(task("quintic"), "whale", RUNS[full]),
        "b-spline-3": plan(task("b-spline-3"), "whale-lu-2024", RUNS[full]),
        "quintic with the paper's whales": plan(task("quintic"), "whale-lu-2024", RUNS[full]),
    }
    for entry in found.values():
        del entry["descent"]
    ends = {}
    for family in ("b-spline-5", "quintic"):
        median = found[family]["median"]
        if median is not None:
            motion = spline(task(family), median["durations"])
            edge = np.abs([motion.at([0.0, motion.seconds], order) for order in (1, 2)]).max()
            ends[family] = {"jump": float(motion.jumps[1:].max()), "edge": float(edge)}
    others = []
    for seed in range(SETS[full]):
        waypoints = drawn_waypoints(seed)
        pair = {}
        for family in ("b-spline-5", "quintic"):
            problem = replace(task(family), waypoints=waypoints)
            run = Run(f"z1 drawn from {seed}", "stretched", "pso", 0, 5000, 50)
            pair[family] = grade(run, problem, None, "none").row.seconds
        others.append({"seed": seed, **pair})
    optima = {family: family_optimum(task(family)).seconds for family in ("b-spline-5", "quintic")}
    return {"found": found, "ends": ends, "optima": optima, "others": others}


METHODS = {
    "b-spline-5": ("B-spline of degree 5, whales of Lu 2024", "B-spline with WOA"),
    "quintic": ("quintic spline, whales of 2016", "quintic with WOA"),
    "b-spline-3": ("B-spline of degree 3, whales of Lu 2024", ""),
    "quintic with the paper's whales": ("quintic spline, whales of Lu 2024", ""),
}


def show_curves(data: dict[str, Any]) -> Shown:
    """Show the times of both methods, then the curves of both."""
    found, optima = data["found"], data["optima"]
    rows = []
    for key, (name, printed) in METHODS.items():
        seconds, median = found[key]["seconds"], found[key]["median"]
        rows.append(
            [
                name,
                _printed(printed) if printed else "",
                "none" if median is None else f"{median['seconds']:.3f}",
                f"{min(seconds):.3f} to {max(seconds):.3f}" if seconds else "",
                f"{len(seconds)} of {found[key]['runs']}",
                f"{optima[key]:.3f}" if key in optima else "",
            ]
        )
    header = ["method", "printed, other waypoints [s]", "reproduced, median [s]", "all runs [s]",
              "solved", "best known of the family [s]"]  # fmt: skip
    caption = (
        "Total times: as printed in sec. 3.2, and on the waypoints of the case z1, budget as printed."
    )
    columns = []
    for key in ("b-spline-5", "quintic"):
        median = found[key]["median"]
        if median is not None:
            title = f"{METHODS[key][0]}, {median['seconds']:.2f} s:\n{verdict_told(median)}"
            columns.append(all_joints(title, task(key), median["durations"]))
    parts: list[Table | Figure] = [Table(header, rows, caption, (1, 2, 3, 4, 5))]
    if columns:
        parts.append(panels(columns))
    return Shown(parts, _remarks(data))


def _remarks(data: dict[str, Any]) -> list[str]:
    found, optima = data["found"], data["optima"]
    medians = {key: entry["median"] for key, entry in found.items()}
    printed = [float(_printed(METHODS[key][1])) for key in ("b-spline-5", "quintic")]
    remarks = [
        f"The waypoints are our own: the printed {printed[0]:.2f} s and {printed[1]:.2f} s cannot be "
        "reproduced, "
        "only which method is the shorter one."
    ]
    bspline, quintic, cubic, same = medians.values()
    apart, gain = 1.0 - optima["b-spline-5"] / optima["quintic"], 0.0
    if bspline and quintic:
        claimed, gain = 1.0 - printed[0] / printed[1], 1.0 - bspline["seconds"] / quintic["seconds"]
        remarks.append(
            f"{same_gain(claimed, gain)}: the B-spline is {_shorter(gain)} than the quintic (printed: "
            f"{_shorter(claimed)})"
            + (
                f"; with the same whales for both it is {_shorter(1.0 - bspline['seconds'] / same['seconds'])}."
                if same
                else "."
            )
        )
    left = {key: m["seconds"] / optima[key] - 1.0 for key in optima if (m := medians[key]) is not None}
    remarks.append(
        f"The best known motions of both families take {optima['b-spline-5']:.3f} s and "
        f"{optima['quintic']:.3f} s: without any swarm the B-spline is {_shorter(apart)}"
        + (f", {100 * apart / gain:.0f} % of the difference above" if gain else "")
        + ". The whales end above the optimum of their own family by "
        + " and ".join(percent(gap) for gap in left.values())
        + "."
    )
    pairs = [
        (o["b-spline-5"], o["quintic"]) for o in data["others"] if o["b-spline-5"] and o["quintic"]
    ]
    if pairs:
        shorter = [1.0 - a / b for a, b in pairs]
        remarks.append(
            f"On {len(pairs)} of {len(data['others'])} further sets of waypoints, drawn alike, a PSO with the "
            f"exact stretch finds a motion of both families. The B-spline is the shorter one on "
            f"{sum(s > 0.0 for s in shorter)}; in the median it is {_shorter(float(np.median(shorter)))}."
        )
    if bspline and cubic:
        remarks.append(
            f"The other reading of the degree, 3, takes {cubic['seconds']:.3f} s; degree 5 takes "
            f"{bspline['seconds']:.3f} s."
        )
    if bspline:
        ends = data["ends"]["b-spline-5"]
        calm = smooth(ends["jump"], ends["edge"])
        remarks.append(
            f"The B-spline is {'continuous and at rest' if calm else 'not continuous or not at rest'} at its "
            f"ends, {agrees(calm)} (Figs 7 and 8): velocity and acceleration jump by {ends['jump']:.0e} at "
            "most "
            f"and are {ends['edge']:.0e} rad/s or rad/s² at the ends. The motion uses most of the "
            f"{bspline['most']}."
        )
    return remarks


def _shorter(gain: float) -> str:
    """By how much one motion is shorter or longer than another."""
    return f"{percent(abs(gain))} {'shorter' if gain > 0.0 else 'longer'}"


FIGURE_5 = Item(
    "Fig 5",
    "convergence",
    make_descent,
    show_descent,
    "Waypoints of our own (case z1). Budget and upper end of the box are as printed; the lower end, printed 0, "
    "is 1 ms. A candidate that breaks a limit is out. Position limits, which the paper names but does not "
    "print, hold too. The degree is not printed: 5 is taken.",
    cost=16.0,
)
FIGURES_6_8 = Item(
    "Figs 6-8",
    "position, velocity and acceleration of the joints, B-spline and quintic",
    make_curves,
    show_curves,
    "Waypoints of our own. The paper does not say which velocities the quintic has at inner waypoints: zero "
    "where a joint turns, else the mean of both sides. The limits are in degrees, printed as radians.",
    cost=25.0,
)
