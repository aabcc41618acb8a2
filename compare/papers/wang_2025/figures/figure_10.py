"""Wang 2025, Fig. 10: the best time of joint 1 over the iterations, by swarm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.benchmark.grade import Graded
from compare.benchmark.protocol import Budget
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.measure import trials
from compare.papers.pictures.descent import descent, draw_descent
from compare.papers.verdicts import Reproduction, same_order, same_times
from compare.papers.wang_2025.joint_1 import IN_FORCE, LIMITS, PRINTED, TABLE_6, bounds, joint_1
from compare.papers.wang_2025.paper import ALONE, PRINTED_TIMES, SWARM, boxes, budget, in_words
from compare.papers.words import above, seconds
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, styled

_SWARMS: dict[str, tuple[str, tuple[Any, Any]]] = {
    "pso": ("PSO, constriction", (BLACK, "-")),
    "pso-1995": ("PSO, 1995", (GREY, "-")),
    "mipso": ("MIPSO", (BLUE, "-")),
    "mipso-pso1": ("PSO1, no tent map", (SKY, "--")),
    "mipso-pso2": ("PSO2, nothing dynamic", (ORANGE, "--")),
    "mipso-pso3": ("PSO3, no mutation", (GREEN, "--")),
    "mipso-printed": ("MIPSO as printed", (PURPLE, "-.")),
}


def make_fig_10(full: bool) -> dict[str, Any]:
    """Run every swarm under the limit in force; quartiles of the best time found."""
    runs, more = 300 if full else 60, Budget(budget().population, round(1.2 * budget().iterations))
    problem, stated = joint_1(IN_FORCE), joint_1(TABLE_6)
    found = {swarm: trials(problem, swarm, budget(), runs) for swarm in _SWARMS}
    return {
        "runs": runs,
        "accelerations": [LIMITS[name][1] for name in (IN_FORCE, TABLE_6)],
        "bound": bounds(IN_FORCE)[0],
        "descents": {swarm: descent([g.traces[0] for g in group], *astuple(budget()))
                     for swarm, group in found.items()},
        "free_mutants": _end(trials(problem, SWARM, more, runs), more),
        "boxed": {
            swarm: _end(trials(problem, swarm, budget(), runs, boxes()[PRINTED_TIMES]), budget())
            for swarm in (SWARM, "pso")
        },
        "box": list(boxes()[PRINTED_TIMES]),
        "table_6": _end(trials(stated, SWARM, budget(), runs), budget()),
    }  # fmt: skip


def _end(found: Sequence[Graded], spent: Budget) -> float | None:
    """Median best time after all iterations [s]."""
    quartiles = descent([g.traces[0] for g in found], *astuple(spent))["quartiles"]
    return quartiles[1][-1]  # type: ignore[no-any-return]


def show_fig_10(data: dict[str, Any]) -> Shown:
    """Show the picture and the medians as a table."""
    at = data["descents"][SWARM]["iterations"]
    median = {swarm: d["quartiles"][1][-1] for swarm, d in data["descents"].items()}
    shown = [at.index(k) for k in (5.0, 10.0, 20.0, 30.0, 50.0)]
    header = ["swarm", *(f"iteration {at[i]:g}" for i in shown), "above the bound"]
    lines = []
    for swarm, (title, _) in _SWARMS.items():
        medians = data["descents"][swarm]["quartiles"][1]
        cells = [seconds(medians[i]) for i in shown]
        lines.append([title, *cells, above(median[swarm], data["bound"])])
    caption = f"Median best time of joint 1 [s] of {data['runs']} runs after so many iterations."
    force, stated = data["accelerations"]
    order = sorted(median, key=lambda swarm: np.inf if median[swarm] is None else float(median[swarm]))
    outcome = same_order([np.inf if median[s] is None else median[s] for s in (SWARM, "pso")])
    means = {name: float(np.mean(column)) for name, column in PRINTED.items()}
    remarks = [
        f"That MIPSO ends below PSO is {outcome.inside}. The paper prints the order MIPSO, IPSO, PSO; the "
        f"reproduced medians end in the order {'; '.join(_SWARMS[s][0] for s in order)}.",
        f"If mutants were not counted, at most 20 % more evaluations, the median of MIPSO would end at "
        f"{seconds(data['free_mutants'])} s instead of {seconds(median[SWARM])} s.",
        f"In the other reading of the search box, {in_words(*data['box'])}, the medians end "
        f"at {seconds(data['boxed'][SWARM])} s (MIPSO) and {seconds(data['boxed']['pso'])} s (PSO, "
        "constriction).",
    ]
    if median[SWARM] is not None and data["table_6"] is not None:
        meant = any(
            same_times([mean], [data["table_6"]]) is Reproduction.REPRODUCED for mean in means.values()
        )
        remarks.append(
            f"Under the {stated:.0f} deg/s² of Table 6 the same runs end at {data['table_6']:.4f} s. The times "
            f"are divided by {median[SWARM] / data['table_6']:.4f}; where acceleration is the only active "
            "limit "
            f"the factor is sqrt({stated:.0f}/{force:.0f}) = {np.sqrt(stated / force):.4f}. "
            f"{'One' if meant else 'None'} of the printed means "
            f"({', '.join(f'{name} {mean:.4f} s' for name, mean in means.items())}) lies within 1 % of it."
        )
    table = Table(header, lines, caption, range(1, len(header)))
    return Shown([fig_10(data), table], remarks, [ItemVerdict("that MIPSO ends below PSO", outcome)])


@styled
def fig_10(data: dict[str, Any]) -> Figure:
    """Draw medians and quartiles against iterations: times beside the printed means, and gaps."""
    figure, (times, gaps) = plt.subplots(1, 2, figsize=(10.4, 3.9))
    bound = data["bound"]
    for swarm, (title, style) in _SWARMS.items():
        found = data["descents"][swarm]
        draw_descent(times, found, title, style)
        middle = np.array(found["quartiles"][1], dtype=float)
        gaps.plot(
            found["iterations"], 100.0 * (middle / bound - 1.0), color=style[0], ls=style[1], lw=1.4
        )
    times.axhline(bound, color=BLACK, lw=0.9, ls=":")
    times.text(1, bound, "certified: none below", va="top", fontsize=7.5)
    times.set_ylim(bound - 0.1, bound + 1.2)
    for name, column in PRINTED.items():
        mean = float(np.mean(column))
        times.annotate(f"{name}, printed", (1.0, mean), (1.03, mean), va="center", fontsize=7.5,
                       color=VERMILION, xycoords=("axes fraction", "data"),
                       arrowprops={"arrowstyle": "-", "color": VERMILION, "lw": 1.6})  # fmt: skip
    times.set_ylabel("best time of joint 1 [s]")
    times.set_title(f"{data['accelerations'][0]:.0f} deg/s²; band: quartiles", loc="left")
    gaps.set_yscale("log")
    gaps.set_yticks([0.1, 1.0, 10.0, 100.0], ["0.1", "1", "10", "100"])
    gaps.set_ylabel("above the certified bound [%]")
    gaps.set_title("the same medians", loc="left")
    for axes in (times, gaps):
        axes.set_xlabel("iteration [1]")
        axes.set_xlim(0, data["descents"][SWARM]["iterations"][-1])
    handles, labels = times.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=8)
    return figure


FIGURE_10 = Item(
    "Fig 10",
    "fitness over the iterations",
    make_fig_10,
    show_fig_10,
    ALONE
    + "Iterations are counted by evaluations, 50 each; mutants count. The band shows the quartiles. "
    "Added: MIPSO without one strategy at a time, and with eq. 15 and 16 as they are printed.",
    cost=15.0,
)
