"""Every bound of one case and its best swarm results on one time axis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import BoundProof, Row
from compare.benchmark.summaries import best_claim, best_row, bound_of
from compare.report.style import BLUE, GREEN, ORANGE, PURPLE, VERMILION, styled
from formulations import RUNGS, Problem

KIND_STYLE: dict[Any, Any] = {"lower": (BLUE, ">"), "upper": (GREEN, "o"), "reference": (PURPLE, "D")}


@styled
def ladder_figure(problem: Problem, ladder: LadderRecord, rows: Sequence[Row]) -> Figure:
    """Draw every bound and the best swarm results on one time axis.

    Parameters
    ----------
    problem : Problem
    ladder : LadderRecord
        Its bounds.
    rows : sequence of Row
        Its rows.

    Returns
    -------
    Figure
    """
    entries = [
        (RUNGS[key].name, rung["seconds"], *KIND_STYLE[rung["kind"]])
        for key, rung in ladder["ladder"].items()
        if rung["seconds"] is not None and key not in ("free_form_lower", "family_lower")
    ]
    claim = best_claim(rows)
    if claim is not None and claim.claimed is not None and claim.seconds is not None:
        name = f"best claim in the papers' coding ({claim.swarm})"
        if claim.keeps_limits:
            entries.append((name, claim.claimed, ORANGE, "o"))
        else:
            entries.append((f"{name}: BREAKS LIMITS", claim.claimed, VERMILION, "X"))
            name = f"that claim, slowed by {claim.stretch:.4f} until it keeps them"
            entries.append((name, claim.seconds, ORANGE, "o"))
    stretched = best_row(rows, variant="stretched")
    if stretched is not None and stretched.seconds is not None:
        name = f"best swarm, stretched coding ({stretched.swarm})"
        entries.append((name, stretched.seconds, ORANGE, "o"))
    entries.sort(key=lambda entry: entry[1])
    optimum, proof = bound_of(ladder)
    figure, axes = plt.subplots(figsize=(9.0, 0.8 + 0.3 * len(entries)))
    barrier = ladder["ladder"]["free_form_lower"]["seconds"] or 0.0
    axes.axvspan(0.0, barrier, color=BLUE, alpha=0.10, lw=0)
    axes.text(barrier / 2, -0.75, "no motion can be here", ha="center", color=BLUE, fontsize=8)
    if optimum is not None:
        axes.axvline(optimum, color=GREEN, lw=0.8, ls="--")
        words = "nothing in the family" if proof is BoundProof.certified else "best known of the family"
        axes.text(optimum, -0.75, f"{words} ", ha="right", color=GREEN, fontsize=8)
    for y, (name, seconds, colour, marker) in enumerate(entries):
        axes.plot([0.0, seconds], [y, y], color=colour, lw=1.0, alpha=0.35)
        axes.plot(seconds, y, marker, color=colour, ms=7)
        relative = ""
        if optimum and name != RUNGS["family"].name:
            gap = seconds / optimum - 1.0
            relative = "  (the optimum)" if abs(gap) < 5e-7 else f"  ({gap:+.2%})"
        axes.text(seconds, y, f"   {seconds:.4f} s{relative}", va="center", fontsize=8)
    axes.set_yticks(range(len(entries)), [entry[0] for entry in entries])
    axes.set_ylim(len(entries) - 0.4, -1.1)
    axes.set_xlim(0.0, max(entry[1] for entry in entries) * 1.28)
    axes.set_xlabel("total time [s]; in brackets: against the optimum of the family")
    axes.set_title(f"{problem.name}: {problem.title}, family {problem.family}", loc="left")
    return figure
