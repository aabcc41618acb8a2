"""The gap of every run of one case: a lane per swarm and variant of a coding."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from compare.benchmark.records.rows import Row
from compare.benchmark.summaries import gaps_of, median
from compare.report.style import BLACK, GREY, SMALLEST_GAP, styled, variant_style
from formulations import Problem


@styled
def gap_figure(problem: Problem, rows: Sequence[Row]) -> Figure:
    """Draw the gap of every seed of every swarm in every coding.

    Hollow marks: the claimed motion breaks its limits, and the gap is that of the slowed-down one.

    Parameters
    ----------
    problem : Problem
    rows : sequence of Row
        Its rows.

    Returns
    -------
    Figure
    """
    swarms = list(dict.fromkeys(row.swarm for row in rows))
    variants = list(dict.fromkeys(row.variant for row in rows))
    figure, axes = plt.subplots(figsize=(9.0, 1.2 + 0.34 * len(swarms)))
    for row_index, swarm in enumerate(swarms):
        if row_index % 2:
            axes.axhspan(row_index - 0.5, row_index + 0.5, color="#000000", alpha=0.035, lw=0)
        for lane, variant in enumerate(variants):
            colour, marker = variant_style(variant)
            y = row_index + (lane - (len(variants) - 1) / 2) * 0.75 / len(variants)
            group = [r for r in rows if r.swarm == swarm and r.variant == variant]
            middle = median(gaps_of(group))
            unsolved = sum(r.gap is None for r in group)
            for kept, face in ((True, colour), (False, "white")):
                marks = gaps_of(r for r in group if r.keeps_limits is kept)
                x = [max(gap, SMALLEST_GAP) for gap in marks]
                axes.plot(x, [y] * len(x), marker, ls="", ms=4, mec=colour, mfc=face,
                          alpha=0.75, mew=0.9)  # fmt: skip
            if middle is not None:
                axes.plot(max(middle, SMALLEST_GAP), y, "|", color=BLACK, ms=9, mew=1.6)
            if unsolved:
                text = f"{unsolved} of {len(group)} without a verified motion"
                axes.text(0.995, y, text, color=colour, fontsize=7, va="center", ha="right",
                          transform=axes.get_yaxis_transform())  # fmt: skip
    for variant in variants:
        colour, marker = variant_style(variant)
        axes.plot([], [], marker, color=colour, ls="", label=variant)
    axes.plot([], [], "o", mec=GREY, mfc="white", ls="", label="claimed motion breaks limits")
    axes.plot([], [], "|", color=BLACK, ls="", ms=9, mew=1.6, label="median")
    axes.set_xscale("log")
    axes.set_xlim(SMALLEST_GAP * 0.5, max([10.0, *[(r.gap or 0.0) * 2 for r in rows]]))
    axes.set_ylim(len(swarms) - 0.5, -0.5)
    axes.set_yticks(range(len(swarms)), swarms)
    ticks = [1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1.0]
    axes.set_xticks(ticks, ["rounding", *(f"{100 * t:.4g} %" for t in ticks[1:])])
    axes.set_xlabel("gap of the verified motion to the family's optimum [%], every seed a mark")
    axes.set_title(f"{problem.name}: how far each swarm is from the best in its family", loc="left")
    axes.legend(
        ncols=6,
        fontsize=7.5,
        loc="upper center",
        bbox_to_anchor=(0.5, -0.5 / (1.0 + 0.34 * len(swarms))),
        frameon=False,
    )
    return figure
