"""Every swarm of a grading over the same instances and seeds: where the graded one stands among them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from compare.benchmark.protocol import Coordinates
from compare.grading.cells import Cell, CellKey
from compare.grading.contest import Contest, middle
from compare.statistics.cells import complete
from compare.statistics.instances import Ranks, ranks
from compare.statistics.pairs import holm
from compare.statistics.runtimes import (
    ExpectedTime,
    SuccessShare,
    expected_running_time,
    mean_running_time,
    success_rate,
)

TARGET = 1e-3
"""The target of success rate and expected running time: a gap of 0.1 %."""


@dataclass(frozen=True)
class RankedSwarm:
    """One swarm of the standing.

    Attributes
    ----------
    rank : float
        Mean rank over the instances by median loss; 1 is best.
    gap : float
        Median over the instances of the median gap.
    behind : float or None
        Geometric mean over the instances of its median gap over that of the best swarm; None where a
        median is a miss. Gaps below the last target count as that.
    success : SuccessShare
        Runs that reached `TARGET`, over all instances.
    expected : ExpectedTime
        Evaluations until `TARGET`, over all instances, each failure charged its own budget.
    area : float
        Mean area over the convergence curve.
    own, objective : float [s]
        Time per million evaluations in the swarm and in its objective, medians over the runs.
    isolated : bool
        Whether it ran in a process of its own, whose messages count as its own time.
    p : float or None
        Wilcoxon's test against the graded swarm over the instances, Holm-corrected over the standing.
    a12 : float or None
        Probability that a run of the graded swarm beats one of this one.
    """

    swarm: str
    rank: float
    gap: float
    behind: float | None
    success: SuccessShare
    expected: ExpectedTime
    area: float
    own: float
    objective: float
    isolated: bool
    p: float | None
    a12: float | None


@dataclass(frozen=True)
class Ranking:
    """All swarms, best mean rank first, and what the critical-difference diagram shows."""

    places: tuple[RankedSwarm, ...]
    swarms: tuple[str, ...]
    ranks: Ranks

    def place(self, swarm: str) -> RankedSwarm:
        """Return the place of a swarm.

        Parameters
        ----------
        swarm : str

        Returns
        -------
        RankedSwarm
        """
        return next(place for place in self.places if place.swarm == swarm)


def costs(cells: Mapping[CellKey, Cell], swarms: Sequence[str]) -> np.ndarray:
    """Return the expected running time of each swarm on each instance, until `TARGET`.

    Parameters
    ----------
    cells : mapping of (instance, swarm, coordinates) to Cell
    swarms : sequence of str

    Returns
    -------
    ndarray, shape (n_instances, n_swarms)
        Evaluations; infinite where no run reached the target.
    """
    by_swarm = [printed(cells, swarm) for swarm in swarms]
    return np.array([[_expected(mine[case]) for mine in by_swarm] for case in by_swarm[0]])


def _expected(cell: Cell) -> float:
    hits, spent = _to_target(cell), np.array([float(row.budget) for row in cell.rows])
    return mean_running_time(hits, spent)


def printed(cells: Mapping[CellKey, Cell], swarm: str) -> dict[str, Cell]:
    """Return the cells of a swarm in the printed coordinates, by instance.

    Parameters
    ----------
    cells : mapping of (instance, swarm, coordinates) to Cell
    swarm : str

    Returns
    -------
    dict of str to Cell
    """
    return {
        case: cell
        for (case, name, seen), cell in cells.items()
        if name == swarm and seen is Coordinates.printed
    }


def standing(
    cells: Mapping[CellKey, Cell], swarms: Sequence[str], contests: Mapping[str, Contest]
) -> Ranking:
    """Rank swarms over all instances.

    Parameters
    ----------
    cells : mapping of (instance, swarm, coordinates) to Cell
    swarms : sequence of str
    contests : mapping of str to Contest
        The graded swarm against each other one.

    Returns
    -------
    Ranking

    Raises
    ------
    MissingCellError
        If a swarm lacks runs on an instance; both are named.
    """
    by_swarm = {swarm: printed(cells, swarm) for swarm in swarms}
    instances = list(by_swarm[swarms[0]])
    named = {(case, s): cell.rows for s, mine in by_swarm.items() for case, cell in mine.items()}
    complete(named, instances, swarms, len(by_swarm[swarms[0]][instances[0]]))
    medians = np.array(
        [[middle(by_swarm[s][case].losses.tolist()) for s in swarms] for case in instances]
    )
    found = ranks(medians)
    together = dict(
        zip(contests, holm([one.effect.p for one in contests.values()]).tolist(), strict=True)
    )
    floors = np.array([[by_swarm[s][case].floor for s in swarms] for case in instances])
    gaps = np.maximum([[by_swarm[s][case].gap for s in swarms] for case in instances], floors)
    order = np.argsort(found.mean, kind="stable")
    places = [
        _place(
            swarms[k],
            by_swarm[swarms[k]],
            float(found.mean[k]),
            _behind(gaps[:, k], gaps[:, order[0]]),
            together.get(swarms[k]),
            contests.get(swarms[k]),
        )
        for k in order
    ]
    return Ranking(tuple(places), tuple(swarms), found)


def _behind(gaps: np.ndarray, best: np.ndarray) -> float | None:
    if not (np.isfinite(gaps).all() and np.isfinite(best).all()):
        return None
    return float(np.exp(np.log(gaps / best).mean()))


def _place(
    swarm: str,
    mine: Mapping[str, Cell],
    rank: float,
    behind: float | None,
    p: float | None,
    contest: Contest | None,
) -> RankedSwarm:
    rows = [row for cell in mine.values() for row in cell.rows]
    hits = np.concatenate([_to_target(cell) for cell in mine.values()])
    spent = np.array([row.budget for row in rows], dtype=np.float64)
    made = [row for row in rows if row.evaluations > 0]
    per_million = [
        float(np.median([getattr(row, name) / row.evaluations for row in made])) * 1e6 if made else 0.0
        for name in ("seconds_algorithm", "seconds_objective")
    ]
    return RankedSwarm(
        swarm,
        rank,
        middle([cell.gap for cell in mine.values()]),
        behind,
        success_rate(hits),
        expected_running_time(hits, spent, seed=0),
        float(np.mean([cell.areas.mean() for cell in mine.values()])),
        per_million[0],
        per_million[1],
        any(row.isolated for row in rows),
        p,
        None if contest is None else contest.effect.mean,
    )


def _to_target(cell: Cell) -> np.ndarray:
    """Evaluations of each run until `TARGET`, or until the last target that can be told from the optimum."""
    allowed = np.flatnonzero(cell.targets >= TARGET * (1 - 1e-9))
    return np.asarray(cell.hits[:, allowed[-1]])
