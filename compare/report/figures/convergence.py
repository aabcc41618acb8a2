"""The median gap of every swarm against evaluations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from compare.benchmark.grade import Trace
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row, RunKey
from compare.benchmark.summaries import convergence
from compare.report.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    SMALLEST_GAP,
    VERMILION,
    styled,
)
from formulations import Problem
from formulations.problem.arrays import Array
from metaheuristics import ALGORITHMS, GROUPS

SWARM_STYLE = [  # within one group of swarms
    (BLUE, "-"), (VERMILION, "-"), (GREEN, "-"), (BLACK, "-"), (ORANGE, "-"),
    (PURPLE, "-"), (SKY, "-"), (BLUE, "--"), (VERMILION, "--"), (BLACK, "--"),
]  # fmt: skip


@styled
def convergence_figure(
    problem: Problem,
    ladder: LadderRecord,
    rows: Sequence[Row],
    traces: Mapping[RunKey, list[Trace]],
) -> Figure:
    """Draw the median gap against evaluations: a row per group of swarms, a column per variant of a coding.

    Parameters
    ----------
    problem : Problem
    ladder : LadderRecord
        Its bounds, with the optimum of each joint alone.
    rows : sequence of Row
        Its rows.
    traces : mapping of RunKey to list of Trace
        The traces of their runs.

    Returns
    -------
    Figure
    """
    swarms = list(dict.fromkeys(row.swarm for row in rows))
    variants = list(dict.fromkeys(row.variant for row in rows))
    groups: dict[str, list[str]] = {}
    for swarm in swarms:
        group = ALGORITHMS[swarm].group if swarm in ALGORITHMS else "rivals"
        groups.setdefault(group, []).append(swarm)
    optimum = ladder["ladder"]["family"]["seconds"]
    optima = {j: s for j, s in enumerate(ladder["alone"]) if s is not None}
    if optimum is not None:
        optima[-1] = optimum
    figure, grid = plt.subplots(
        len(groups), len(variants), figsize=(10.5, 0.9 + 2.1 * len(groups)),
        sharex="col", sharey=True, squeeze=False, layout="none",
    )  # fmt: skip
    curves = {}
    for variant in variants:
        for swarm in swarms:
            mine = [r for r in rows if r.swarm == swarm and r.variant == variant]
            found = [traces[r.key] for r in mine if r.key in traces]
            if found and optimum is not None:
                curves[variant, swarm] = convergence(found, optima, mine[0].budget)
    for panels, (group, members) in zip(grid, groups.items(), strict=True):
        for axes, variant in zip(panels, variants, strict=True):
            others = []
            for (where, swarm), (at, quartiles) in curves.items():
                if where != variant:
                    continue
                if swarm in members:
                    style = SWARM_STYLE[members.index(swarm) % len(SWARM_STYLE)]
                    _converging(axes, at, quartiles, style, swarm)
                else:
                    shown = np.isfinite(quartiles[1])
                    others.append(np.column_stack([at, np.maximum(quartiles[1], SMALLEST_GAP)])[shown])
            axes.add_collection(LineCollection(others, colors=GREY, lw=0.5, alpha=0.35))
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.minorticks_off()  # there would be as many as all other marks together
            axes.grid(alpha=0.25, lw=0.5)
        panels[0].set_ylabel(f"{GROUPS[group]}\ngap of the best so far [1]", fontsize=8)
        handles, labels = panels[-1].get_legend_handles_labels()
        panels[-1].legend(handles, labels, loc="center left", bbox_to_anchor=(1.0, 0.5),
                          frameon=False, fontsize=7.5)  # fmt: skip
    for column, variant in enumerate(variants):
        grid[0][column].set_title(variant, loc="left")
        grid[-1][column].set_xlabel("evaluations, whole motion")
    # margins in inches: computing the layout of so many panels takes seconds
    high = figure.get_figheight()
    figure.subplots_adjust(left=0.085, right=0.84, bottom=0.5 / high, top=1 - 0.55 / high,
                           wspace=0.06, hspace=0.08)  # fmt: skip
    figure.suptitle(
        f"{problem.name}: median over seeds, band: quartiles; grey: all other swarms. published: mean"
        " over the joints, each against its own optimum",
        fontsize=9,
    )
    return figure


def _converging(axes: Axes, grid: Array, quartiles: Array, style: tuple[str, str], label: str) -> None:
    """One swarm's median and its band."""
    low, middle, high = quartiles
    colour, line = style
    shown = np.isfinite(middle)
    axes.plot(grid[shown], np.maximum(middle[shown], SMALLEST_GAP), line,
              color=colour, lw=1.4, label=label)  # fmt: skip
    band = shown & np.isfinite(high)
    axes.fill_between(grid[band], np.maximum(low[band], SMALLEST_GAP), np.maximum(high[band], SMALLEST_GAP),
                      color=colour, alpha=0.08, lw=0)  # fmt: skip
