"""The runs of one swarm on one instance, as numbers that can be compared.

A run counts if its status is ``ok`` or ``stopped-early`` and its motion was verified; any other run is a
miss. Of two runs the better one ends closer to the optimum. Two runs that both reach the last target,
below which no proof tells gaps apart, are ordered by the evaluations that they needed for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from compare.benchmark.grade import Trace
from compare.benchmark.protocol import TARGETS, Coordinates, targets
from compare.benchmark.records.pooled import pooled
from compare.benchmark.records.rows import Row, RowStatus, RunKey
from compare.statistics.runtimes import area_over_curve, hitting_times
from formulations import InputError
from formulations.problem.arrays import Array

COUNTED = (RowStatus.ok, RowStatus.stopped_early)
"""Statuses of a run whose verified motion counts; a run of any other status is a miss."""
CellKey = tuple[str, str, Coordinates]  # instance, swarm, coordinates


@dataclass(frozen=True, eq=False)
class Cell:
    """All runs of one swarm on one instance in one kind of coordinates, in the order of their seeds.

    Attributes
    ----------
    losses : Array, shape (n,)
        What runs are ordered by, infinite for a miss: the decimal logarithm of the gap; below the last
        target that of the target, minus the share of the budget that was left when it was reached.
    gaps : Array, shape (n,)
        Gap to the certified optimum, infinite for a miss.
    hits : Array, shape (n, m)
        Evaluations until each target that can be told from the optimum; infinite: not reached.
    areas : Array, shape (n,)
        Area over the convergence curve: 1 is best.
    targets : Array, shape (m,)
        The targets of ``hits``.
    rows : tuple of Row
        The rows.
    """

    losses: Array
    gaps: Array
    hits: Array
    areas: Array
    targets: Array
    rows: tuple[Row, ...]

    def __len__(self) -> int:
        return len(self.rows)

    def first(self, runs: int) -> Cell:
        """Return the cell with its first runs alone.

        Parameters
        ----------
        runs : int
            How many.

        Returns
        -------
        Cell
        """
        kept = slice(0, runs)
        return Cell(
            self.losses[kept], self.gaps[kept], self.hits[kept], self.areas[kept],
            self.targets, self.rows[kept],
        )  # fmt: skip

    @property
    def gap(self) -> float:
        """Median gap; infinite if half of the runs are misses."""
        return float(np.quantile(self.gaps, 0.5, method="higher"))

    @property
    def floor(self) -> float:
        """The last target: closer to the optimum than that, gaps are not told apart."""
        return float(self.targets[-1])


def cells_of(
    rows: Iterable[Row], traces: Mapping[RunKey, list[Trace]], proved: Mapping[str, float]
) -> dict[CellKey, Cell]:
    """Arrange rows by instance, swarm and coordinates.

    Parameters
    ----------
    rows : iterable of Row
        Of one coding in which one vector holds the durations of all joints.
    traces : mapping of RunKey to list of Trace
        The trace of each.
    proved : mapping of str to float
        By instance, the relative gap between its certified bound and its verified optimum.

    Returns
    -------
    dict of (instance, swarm, coordinates) to Cell
    """
    groups: dict[CellKey, list[Row]] = {}
    for row in pooled(rows):
        groups.setdefault((row.case, row.swarm, row.coordinates), []).append(row)
    return {
        key: _cell(sorted(group, key=lambda row: row.seed), traces, proved[key[0]])
        for key, group in groups.items()
    }


def _cell(rows: list[Row], traces: Mapping[RunKey, list[Trace]], proved: float) -> Cell:
    wanted = np.array(targets(proved) or TARGETS[:1])
    losses, gaps, hits, areas = [], [], [], []
    for row in rows:
        if row.bound is None:
            raise InputError(f"{row.case}: no optimum is known, so that no gap can be told")
        counts = row.status in COUNTED and row.gap is not None
        (trace,) = traces[row.key]
        best = trace.best if counts else [np.inf] * len(trace.best)
        hit = hitting_times(trace.evaluations, best, row.bound, wanted)
        gap = row.gap if counts and row.gap is not None else np.inf
        reached = np.isfinite(hit[-1])
        left = 1.0 - hit[-1] / row.budget if reached else 0.0
        losses.append(float(np.log10(max(gap, wanted[-1]))) - left)
        gaps.append(gap)
        hits.append(hit)
        areas.append(area_over_curve(trace.evaluations, best, row.bound, row.budget))
    return Cell(np.array(losses), np.array(gaps), np.array(hits), np.array(areas), wanted, tuple(rows))
