"""How long a comparison will take, from a small part of it that is measured first."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from compare.benchmark.grade import Run
from compare.benchmark.records.rows import Row

_EACH = 2  # runs of each swarm and variant that are measured


def part(runs: Sequence[Run]) -> list[Run]:
    """Choose the runs to measure: a few of each swarm in each variant, on cases as different as possible.

    Parameters
    ----------
    runs : sequence of Run
        The whole plan.

    Returns
    -------
    list of Run
    """
    groups: dict[tuple[str, ...], list[Run]] = {}
    for run in runs:
        groups.setdefault(_group(run), []).append(run)
    return [
        group[(place * 7 + k * len(group) // _EACH) % len(group)]
        for place, group in enumerate(groups.values())
        for k in range(min(_EACH, len(group)))
    ]


def estimate(measured: Iterable[Row], runs: Iterable[Run], jobs: int) -> float:
    """Estimate the time of a plan.

    Parameters
    ----------
    measured : iterable of Row
        Rows of its part.
    runs : iterable of Run
        What is to be run.
    jobs : int
        Worker processes.

    Returns
    -------
    float [s]
        Of a swarm in a variant, the time of an evaluation is taken to be the same on all cases.
    """
    seconds: dict[tuple[str, ...], float] = {}
    evaluations: dict[tuple[str, ...], int] = {}
    for row in measured:
        key = _group(row)
        seconds[key] = seconds.get(key, 0.0) + row.seconds_algorithm + row.seconds_objective
        evaluations[key] = evaluations.get(key, 0) + max(row.evaluations, 1)
    costs = {key: seconds[key] / evaluations[key] for key in seconds}
    usual = max(costs.values(), default=0.0)  # of a swarm that was not measured
    return sum(costs.get(_group(run), usual) * run.budget for run in runs) / jobs


def _group(one: Run | Row) -> tuple[str, ...]:
    return one.swarm, one.coding, one.track, one.coordinates
