"""How fast swarms approach the optimum: median gaps, and shares of targets reached, against evaluations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from compare.benchmark.grade import Trace
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.protocol import targets
from compare.benchmark.records.rows import Row, RunKey
from compare.benchmark.summaries import by_variant_and_swarm, convergence, gaps_after
from formulations.problem.arrays import Array

_POINTS = 40  # of a curve


def progress_chart(
    ladder: LadderRecord, rows: Sequence[Row], traces: Mapping[RunKey, list[Trace]]
) -> dict[str, Any]:
    """Return a curve per swarm and variant of a coding.

    Parameters
    ----------
    ladder : LadderRecord
        With the optimum of each joint alone, against which searches of single joints are measured.
    rows : sequence of Row
        Of one problem.
    traces : mapping of RunKey to list of Trace

    Returns
    -------
    dict
        ``curves``: of each the evaluations ``at``, the quartiles ``gap`` [1] (None while too few runs have
        a feasible point) and the share ``reached`` of runs and targets [1].
    """
    optima = {j: s for j, s in enumerate(ladder.get("alone", [])) if s is not None}
    optimum = ladder["ladder"]["family"]["seconds"]
    lower = ladder["ladder"]["family_lower"]["seconds"]
    if optimum is not None:
        optima[-1] = optimum
    goals = np.array(targets(optimum / lower - 1.0 if optimum and lower else 0.0))
    curves: list[dict[str, Any]] = []
    for (variant, swarm), mine in by_variant_and_swarm(rows).items():
        runs = [traces[row.key] for row in mine if row.key in traces]
        if not runs or optimum is None:
            continue
        at, quartiles = convergence(runs, optima, mine[0].budget, _POINTS)
        reached = _reached(runs, len(mine), optima, at, goals)
        curves.append(
            {
                "variant": variant,
                "swarm": swarm,
                "at": [int(count) for count in at],
                "gap": [[_short(value) for value in line] for line in quartiles],
                "reached": [round(float(share), 4) for share in reached],
            }
        )
    best = max(curves, key=lambda curve: curve["reached"][-1], default=None)
    alt = "No run has a trace."
    if best is not None:
        alt = (
            f"At the end of its budget {best['swarm']} ({best['variant']} coding) has reached "
            f"{100.0 * best['reached'][-1]:.0f} % of all runs and targets, more than any other."
        )
    return {"curves": curves, "alt": alt}


def _reached(
    runs: Sequence[Sequence[Trace]], started: int, optima: Mapping[int, float], at: Array, goals: Array
) -> Array:
    """Share of (run, target) pairs that are reached after each number of evaluations, (m,)."""
    total = np.zeros(len(at))
    for traces in runs:
        total += (gaps_after(traces, at, optima)[:, None] <= goals).mean(axis=1)
    return total / started


def _short(value: float) -> float | None:
    """Three digits are what a curve shows."""
    return float(f"{value:.3g}") if np.isfinite(value) else None
