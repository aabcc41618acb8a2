"""Lu 2024, Fig. 5: convergence, on made waypoints since the paper prints none."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.audit.paper import settings
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.lu_2024.plan import between, losses, plan, printed_total, shared, solved, task
from compare.papers.measure import every_motion
from compare.papers.pictures.descent import draw_descent
from compare.papers.verdicts import BEST, Reproduction, agrees, held
from compare.papers.words import percent
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, styled
from compare.statistics.medians import gain_over, median_of
from formulations import family_bound, family_optimum

OF_THE_PAPER = {"whale-lu-2024": "equations resolved", "whale-lu-2024-printed": "equations as printed"}
"""The paper's own swarm, in both readings."""
RUNS = {False: 11, True: 50}
STARTS = {False: 1, True: None}  # of the nonlinear program; all of them agree on z1
_GAPS = {False: 0.1, True: 1e-3}  # of the proof: 5 s, and some minutes
_PROOF = 300.0  # s, at most
_FEW = 5  # runs whose median shows what so few are worth

SWARMS = {
    "whale-lu-2024": ("whales with inertia and chaotic start, resolved", (BLUE, "-")),
    "whale-lu-2024-printed": ("the same, equations as printed", (ORANGE, "-")),
    "whale": ("whales as published in 2016", (GREEN, "-")),
}


def make_descent(full: bool) -> dict[str, Any]:
    """Follow the best total time over the iterations on the B-spline of degree 5."""
    problem = task("b-spline-5")
    found = {
        swarm: plan(shared("b-spline-5"), problem.n_segments, swarm, RUNS[full]) for swarm in SWARMS
    }
    optimum = family_optimum(problem, starts=STARTS[full])
    whole = every_motion(problem)
    own = family_bound(problem, optimum=optimum, gap=_GAPS[full], time_limit=_PROOF)
    return {
        "found": found,
        "optimum": min(optimum.seconds, own.upper),
        "bound": max(own.seconds, whole),  # a B-spline is a motion
        "every_motion": whole,
    }


@styled
def descent_figure(data: dict[str, Any]) -> Figure:
    """Draw the reproduced descents, the best known optimum, the certified bound and the printed end."""
    figure, axes = plt.subplots(figsize=(9.5, 4.0))
    for swarm, found in data["found"].items():
        name, style = SWARMS[swarm]
        draw_descent(axes, found["descent"], f"{name}", style)
    printed = printed_total("B-spline with WOA")
    lines = [
        (data["optimum"], BLACK, "--", f"best known B-spline: {data['optimum']:.3f} s"),
        (data["every_motion"], GREY, "--", f"certified: no motion below {data['every_motion']:.3f} s"),
        (float(printed), VERMILION, ":", f"printed end: {printed} s, on other waypoints"),
    ]
    if data["bound"] > data["every_motion"]:
        lines.append((data["bound"], GREY, "-.", f"certified: no B-spline below {data['bound']:.3f} s"))
    for value, colour, line, label in lines:
        axes.axhline(value, color=colour, ls=line, lw=1.1, label=label)
    axes.set_ylim(None, 1.7 * data["optimum"])
    axes.set_xlabel("iteration")
    axes.set_ylabel("total time [s]; bands: quartiles")
    figure.legend(loc="outside right center", fontsize=8, frameon=False)
    return figure


def show_descent(data: dict[str, Any]) -> Shown:
    """Show the ends, the picture, and the paper's two observations."""
    first = data["found"]["whale-lu-2024"]
    rows = []
    for swarm, found in data["found"].items():
        gain = gain_over(losses(found), losses(first), seed=0)
        few = median_of(losses(found)[:_FEW]).value
        rows.append(
            [
                SWARMS[swarm][0],
                solved(found),
                between(median_of(losses(found))),
                "none" if not np.isfinite(few) else f"{few:.2f}",
                "" if found is first else f"{percent(gain.low)} to {percent(gain.high)}",
            ]
        )
    caption = (
        "In brackets the 95 % interval of the median, between two of the runs. Last column: by how much the "
        "median is below that of the first row, 95 % interval (bootstrap over the runs)."
    )
    header = [
        "swarm",
        "solved",
        "median [s]",
        f"median of the first {_FEW} [s]",
        "gain over the first row",
    ]
    table = Table(header, rows, caption, range(1, 5))
    return Shown([table, descent_figure(data)], _remarks_5(data), _verdicts_5(data))


def _verdicts_5(data: dict[str, Any]) -> list[ItemVerdict]:
    after = settings("z1")["descent"]["steady_after"]
    return [
        ItemVerdict(
            f"a steady curve after iteration {after}, {words}", _calm_in_time(data["found"][swarm])
        )
        for swarm, words in OF_THE_PAPER.items()
    ]


def _steady(found: dict[str, Any]) -> int | None:
    """First iteration at which the median is within 1 % of its end; None if it ends without a motion."""
    curve = np.array(found["descent"]["quartiles"][1], dtype=float)
    if not np.isfinite(curve[-1]):
        return None
    return int(found["descent"]["iterations"][np.flatnonzero(curve <= 1.01 * curve[-1])[0]])


def _calm_in_time(found: dict[str, Any]) -> Reproduction:
    """Whether the median is steady where the paper says that its curve is."""
    steady = _steady(found)
    return held(steady is not None and steady <= settings("z1")["descent"]["steady_after"])


def _remarks_5(data: dict[str, Any]) -> list[str]:
    says = settings("z1")["descent"]
    remarks = [
        "The seconds cannot be compared, since the paper prints no waypoints. These were drawn at random and "
        "stand in the case file z1."
    ]
    for swarm, found in data["found"].items():
        curve = np.array(found["descent"]["quartiles"][1], dtype=float)
        at = np.array(found["descent"]["iterations"])
        end, name = curve[-1], SWARMS[swarm][0].capitalize()
        told = f"{name}: {solved(found)} runs find a motion within the limits"
        steady = _steady(found)
        if steady is None:
            remarks.append(f"{told}.")
            continue
        says_so = _calm_in_time(found) is Reproduction.REPRODUCED
        left = curve[np.searchsorted(at, says["left_local_optimum"])]
        remarks.append(
            f"{told}. The median ends at {end:.3f} s, {percent(end / data['optimum'] - 1.0)} above the best "
            f"known, and is within 1 % of its end from iteration {steady} on (printed: steady after "
            f"{says['steady_after']}"
            + (f"), {agrees(says_so)}. " if swarm in OF_THE_PAPER else "). ")
            + f"After iteration {says['left_local_optimum']}, where the paper sees the "
            f"swarm leave a local optimum, it falls by {percent(1.0 - end / left)}."
        )
    ends = [found["descent"]["quartiles"][1][-1] for found in data["found"].values()]
    arrived = sum(end is not None and end <= data["optimum"] * (1.0 + BEST) for end in ends)
    tighter = data["bound"] > data["every_motion"]
    remarks.append(
        f"{arrived} of {len(ends)} medians end at the best known B-spline, {data['optimum']:.3f} s: a curve "
        "that has become flat need not have found the optimum. It is proved that no motion at all takes less "
        f"than {data['every_motion']:.3f} s"
        + (f", and no B-spline less than {data['bound']:.3f} s." if tighter else ".")
        + f" The best known B-spline comes from local solves; {percent(data['optimum'] / data['bound'] - 1.0)} "
        "lie between it and what is proved."
    )
    return remarks


FIGURE_5 = Item(
    "Fig 5",
    "convergence",
    make_descent,
    show_descent,
    "Waypoints of our own (case z1). Budget and upper end of the box are as printed; the lower end, printed 0, "
    "is 1 ms. A candidate that breaks a limit is out. Position limits, which the paper names but does not "
    "print, hold too. The degree is not printed: 5 is taken. For s and b see Eqs 17, 22.",
    cost=20.0,
)
