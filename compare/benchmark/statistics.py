"""Rows -> what they say per case, coding and swarm. Medians over seeds; nothing is left out."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.benchmark.grade import Trace
from formulations.problem.arrays import Array


@dataclass(frozen=True)
class Summary:
    """All seeds of one swarm in one coding on one case.

    gap: verified time over the family's optimum, minus 1, median over the seeds that ended in a
    verified motion. breaking: seeds whose motion, as claimed, breaks the limits; stretch: the worst
    factor those need. unsolved: seeds without a verified motion.
    """

    case: str
    coding: str
    swarm: str
    seeds: int
    unsolved: int
    breaking: int
    gap: float | None
    least: float | None
    most: float | None
    claimed_gap: float | None
    stretch: float | None


def summaries(rows: Iterable[dict[str, Any]]) -> dict[tuple[str, str, str], Summary]:
    """Summaries by (case, coding, swarm), in the order of the rows."""
    groups: dict[tuple[str, str, str], list[dict[str, Any]]] = {}
    for row in rows:
        groups.setdefault((row["case"], row["coding"], row["swarm"]), []).append(row)
    return {key: _summary(key, group) for key, group in groups.items()}


def _summary(key: tuple[str, str, str], group: list[dict[str, Any]]) -> Summary:
    gaps = [row["gap"] for row in group if row["gap"] is not None]
    claims = [row["claimed_gap"] for row in group if row["claimed_gap"] is not None]
    breaking = [row for row in group if row["keeps_limits"] is False]
    return Summary(
        *key,
        seeds=len(group),
        unsolved=sum(row["seconds"] is None for row in group),
        breaking=len(breaking),
        gap=float(np.median(gaps)) if gaps else None,
        least=min(gaps, default=None),
        most=max(gaps, default=None),
        claimed_gap=float(np.median(claims)) if claims else None,
        stretch=max((row["stretch"] for row in breaking), default=None),
    )


def convergence(
    runs: list[list[Trace]], optima: dict[int, float], budget: int, points: int = 60
) -> tuple[Array, Array]:
    """Gap against evaluations: grid (m,), and quartiles over the runs (3, m): 25, 50, 75 %.

    optima: reference time [s] by joint (-1: all joints at once). With several joints a run's gap is
    the mean over its joints, each against its own optimum. Infinite until something is feasible.
    """
    grid = np.unique(np.geomspace(1, budget, points).round())
    gaps = []
    for traces in runs:
        each = [best_after(trace, grid) / optima[trace.joint] - 1.0 for trace in traces]
        gaps.append(np.mean(each, axis=0))
    # the median of runs is infinite while fewer than half of them have found a feasible point
    quartiles = np.quantile(np.array(gaps), [0.25, 0.5, 0.75], axis=0, method="nearest")
    return grid, quartiles


def best_after(trace: Trace, grid: Array) -> Array:
    """Best fitness after each number of evaluations (m,): (m,); infinite before the first entry."""
    index = np.searchsorted(trace.evaluations, grid, side="right") - 1
    best = np.array(trace.best)
    return np.where(index >= 0, best[np.maximum(index, 0)], np.inf)


def bound_of(ladder: dict[str, Any]) -> tuple[float | None, str]:
    """What gaps are measured against [s], and its proof: "certified", "local optimum" or "none"."""
    rungs = ladder["ladder"]
    lower, optimum = rungs["family_lower"], rungs["family"]
    # a certified bound that is not tight says more of the proof than of a swarm
    if lower["seconds"] and optimum["seconds"] and optimum["seconds"] <= lower["seconds"] * _TIGHT:
        return lower["seconds"], "certified"
    if optimum["seconds"] is not None:
        return optimum["seconds"], "local optimum"
    return None, "none"


_TIGHT = 1.0 + 1e-3


def best_row(rows: Iterable[dict[str, Any]], **which: Any) -> dict[str, Any] | None:
    """The shortest verified row among those whose columns equal ``which``; None if there is none."""
    fitting = [
        row
        for row in rows
        if row["seconds"] is not None and all(row[name] == value for name, value in which.items())
    ]
    return min(fitting, key=lambda row: row["seconds"], default=None)


def best_claim(rows: Iterable[dict[str, Any]]) -> dict[str, Any] | None:
    """The shortest time claimed in the papers' coding: what a paper would print; None if none."""
    claims = [r for r in rows if r["coding"] == "published" and r["seconds"] is not None]
    return min(claims, key=lambda row: row["claimed"], default=None)
