"""What rows say per case, variant and swarm. Statistics are over seeds, and every seed is counted."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from compare.benchmark.grade import Trace
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.protocol import Track
from compare.benchmark.records.pooled import pooled
from compare.benchmark.records.rows import BoundProof, Row
from formulations.problem.arrays import Array

# a certified bound of the family is used where it lies within this factor of the optimum
_TIGHT = 1.0 + 1e-3


@dataclass(frozen=True)
class Summary:
    """All seeds of one swarm in one variant of a coding on one case.

    Attributes
    ----------
    seeds : int
        Number of runs.
    unsolved : int
        Runs without a verified motion.
    breaking : int
        Runs whose motion, as claimed, breaks its limits; ``stretch`` is the worst factor these need.
    gap : float or None
        Median gap of the verified motions to the family's optimum; ``least`` and ``most`` of them.
    claimed_gap : float or None
        Median gap of the claimed motions.
    """

    case: str
    variant: str
    swarm: str
    seeds: int
    unsolved: int
    breaking: int
    gap: float | None
    least: float | None
    most: float | None
    claimed_gap: float | None
    stretch: float | None

    @property
    def gap_of_most(self) -> float | None:
        """The median gap; None where half of the runs or more have no verified motion, and so no median."""
        return self.gap if 2 * self.unsolved < self.seeds else None


def by_variant_and_swarm(rows: Iterable[Row]) -> dict[tuple[str, str], list[Row]]:
    """Group rows of one case.

    Parameters
    ----------
    rows : iterable of Row

    Returns
    -------
    dict of (variant, swarm) to list of Row
        In the order in which the rows name them first.
    """
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((row.variant, row.swarm), []).append(row)
    return groups


def summaries(
    rows: Iterable[Row], *, allow: Collection[str] = ()
) -> dict[tuple[str, str, str], Summary]:
    """Summarise rows by case, variant and swarm.

    Parameters
    ----------
    rows : iterable of Row
        They pass the gate `compare.benchmark.records.pooled.pooled`.
    allow : collection of str
        Columns in which the rows of one cell may differ, as the gate takes them.

    Returns
    -------
    dict of (case, variant, swarm) to Summary
        In the order in which the rows name them first.
    """
    groups: dict[tuple[str, str, str], list[Row]] = {}
    for row in pooled(rows, allow=allow):
        groups.setdefault((row.case, row.variant, row.swarm), []).append(row)
    return {key: _summary(key, group) for key, group in groups.items()}


def _summary(key: tuple[str, str, str], group: list[Row]) -> Summary:
    gaps = gaps_of(group)
    breaking = [row for row in group if row.keeps_limits is False]
    return Summary(
        *key,
        seeds=len(group),
        unsolved=sum(row.seconds is None for row in group),
        breaking=len(breaking),
        gap=median(gaps),
        least=min(gaps, default=None),
        most=max(gaps, default=None),
        claimed_gap=median([row.claimed_gap for row in group if row.claimed_gap is not None]),
        stretch=max((row.stretch for row in breaking if row.stretch is not None), default=None),
    )


def median(values: Sequence[float]) -> float | None:
    """Return the median, the mean of the middle two of an even number; None of no values.

    Parameters
    ----------
    values : sequence of float

    Returns
    -------
    float or None
    """
    return float(np.median(values)) if len(values) else None


def gaps_of(rows: Iterable[Row]) -> list[float]:
    """Return the gaps of the rows that have one.

    Parameters
    ----------
    rows : iterable of Row

    Returns
    -------
    list of float
    """
    return [row.gap for row in rows if row.gap is not None]


def times_of(rows: Iterable[Row]) -> list[float]:
    """Return the times of the rows that have a verified motion.

    Parameters
    ----------
    rows : iterable of Row

    Returns
    -------
    list of float [s]
    """
    return [row.seconds for row in rows if row.seconds is not None]


def convergence(
    runs: Sequence[Sequence[Trace]], optima: dict[int, float], budget: int, points: int = 60
) -> tuple[Array, Array]:
    """Return quartiles over runs of the gap of the best so far, against evaluations.

    Parameters
    ----------
    runs : sequence of traces
        The traces of each run. With several joints the gap of a run is the mean over its joints, each
        against its own optimum, after equal shares of the evaluations.
    optima : dict of int to float [s]
        Reference time by joint; -1: all joints at once.
    budget : int
        Evaluations up to which the curves go.
    points : int
        Most points of a curve.

    Returns
    -------
    grid : Array, shape (m,)
        Numbers of evaluations over the whole motion.
    quartiles : Array, shape (3, m)
        25, 50 and 75 %; infinite while too few runs have found a feasible point.
    """
    grid = np.unique(np.geomspace(1, budget, points).round())
    gaps = [gaps_after(traces, grid, optima) for traces in runs]
    quartiles = np.quantile(np.array(gaps), [0.25, 0.5, 0.75], axis=0, method="nearest")
    return grid, quartiles


def gaps_after(traces: Sequence[Trace], grid: Array, optima: Mapping[int, float]) -> Array:
    """Return the gap of one run after given numbers of evaluations.

    Parameters
    ----------
    traces : sequence of Trace
        Those of the run; of several joints the mean counts.
    grid : Array, shape (m,)
        Numbers of evaluations over the whole motion.
    optima : mapping of int to float [s]
        As in ``convergence``.

    Returns
    -------
    Array, shape (m,)
        Infinite while a joint has no feasible point.
    """
    share = np.ceil(grid / len(traces))  # of each joint; they search side by side
    each = [best_after(trace, share) / optima[trace.joint] - 1.0 for trace in traces]
    return np.array(np.mean(each, axis=0))


def best_after(trace: Trace, grid: Array) -> Array:
    """Return the best fitness after given numbers of evaluations.

    Parameters
    ----------
    trace : Trace
    grid : Array, shape (m,)

    Returns
    -------
    Array, shape (m,) [s]
        Infinite before the first entry of the trace.
    """
    index = np.searchsorted(trace.evaluations, grid, side="right") - 1
    best = np.array(trace.best)
    return np.where(index >= 0, best[np.maximum(index, 0)], np.inf)


def bound_of(ladder: LadderRecord) -> tuple[float | None, BoundProof]:
    """Return the time that gaps of a case are measured against, and what stands behind it.

    Parameters
    ----------
    ladder : LadderRecord

    Returns
    -------
    seconds : float or None [s]
        The certified bound of the family where it is tight, else the best optimum known.
    proof : BoundProof
    """
    rungs = ladder["ladder"]
    lower, optimum = rungs["family_lower"]["seconds"], rungs["family"]["seconds"]
    # the gap to a loose bound would say more of the proof than of a swarm
    if lower and optimum and optimum <= lower * _TIGHT:
        return lower, BoundProof.certified
    if optimum is not None:
        return optimum, BoundProof.local_optimum
    return None, BoundProof.none


def best_row(rows: Iterable[Row], *, variant: str | None = None) -> Row | None:
    """Return the row with the shortest verified motion.

    Parameters
    ----------
    rows : iterable of Row
    variant : str, optional
        Among the rows of this variant of a coding.

    Returns
    -------
    Row or None
        None if no row has a verified motion.
    """
    found: Row | None = None
    for row in rows:
        if row.seconds is None or variant not in (None, row.variant):
            continue
        if found is None or found.seconds is None or row.seconds < found.seconds:
            found = row
    return found


def best_claim(rows: Iterable[Row]) -> Row | None:
    """Return the row with the shortest time claimed by the papers' rule: what a paper would print.

    Parameters
    ----------
    rows : iterable of Row

    Returns
    -------
    Row or None
        None if no such row has a motion that keeps its limits once it is slowed down.
    """
    claims = [
        (row.claimed, index, row)
        for index, row in enumerate(as_papers_run(rows))
        if row.seconds is not None and row.claimed is not None
    ]
    return min(claims, key=lambda claim: claim[:2])[2] if claims else None


def as_papers_run(rows: Iterable[Row]) -> list[Row]:
    """Return the rows that follow the papers' own protocol.

    Parameters
    ----------
    rows : iterable of Row

    Returns
    -------
    list of Row
        Those of the published coding in the track ``paper``; where there are none, those of that coding.
    """
    published = [row for row in rows if row.coding == "published"]
    return [row for row in published if row.track is Track.paper] or published
