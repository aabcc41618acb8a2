"""All rivals on all tasks as a study: its calls, what its rows say together, and a summary per program."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from compare.rivals import RIVALS
from compare.rivals.rows import BREAKS, KEEPS, NOT_GIVEN, OURS, RivalRow, answered, version_of
from compare.rivals.shown import by_task
from compare.rivals.terminal import as_text
from compare.studies.study import Call, Study
from formulations import Problem


def with_zones(problem: Problem, zone: float) -> Problem:
    """Let a motion pass the inner waypoints within zones.

    Parameters
    ----------
    problem : Problem
    zone : float
        How far from an inner waypoint each joint may pass it [rad].

    Returns
    -------
    Problem
        With a name that says so.
    """
    boxes = {k: np.full(problem.dof, zone) for k in range(1, problem.n_segments)}
    asked = replace(problem.conditions, tolerance=boxes)
    return replace(problem, name=f"{problem.name}, zones of {zone:g} rad", conditions=asked)


def calls(
    problems: Sequence[Problem],
    rivals: Sequence[str],
    *,
    zone: float,
    seconds: float,
    memory: int,
) -> list[Call]:
    """List the calls of the study: each task with each program, ours first.

    Where a program that blends corners is among them, each task without conditions stands there once more, with
    zones: corners that it may cut, ours may cut as far. The motions of the others, which pass the points
    exactly, are valid there too. They are run once, and judged for both tasks.

    Parameters
    ----------
    problems : sequence of Problem
    rivals : sequence of str
        Keys of ``RIVALS``.
    zone : float
        Of these tasks, at each inner waypoint [rad].
    seconds : float
        Time limit of each program on each task [s].
    memory : int
        Bytes that each may hold.

    Returns
    -------
    list of tuples
        Arguments of ``answered``.
    """
    blending = any(RIVALS[key].zones for key in rivals)
    found: list[tuple[Problem, Problem | None, str]] = []
    for problem in problems:
        zoned = None
        if blending and problem.conditions.none and problem.n_segments > 1:
            zoned = with_zones(problem, zone)
        for key in (OURS, *rivals):
            if zoned is not None and (key == OURS or RIVALS[key].zones):
                found += [(problem, None, key), (zoned, None, key)]
            else:
                found.append((problem, zoned, key))
    version = {key: version_of(rival.package) for key, rival in RIVALS.items()} | {
        OURS: version_of(OURS)
    }
    return [(problem, zoned, key, version[key], seconds, memory) for problem, zoned, key in found]


def count_rows(listed: Sequence[Call]) -> int:
    """Count the rows that calls give.

    Parameters
    ----------
    listed : sequence of tuples
        As ``calls`` returns them.

    Returns
    -------
    int
    """
    return sum(1 if zoned is None else 2 for _, zoned, *_ in listed)


def beside(rows: list[RivalRow]) -> list[RivalRow]:
    """Set each motion beside the fastest one of its task that keeps all, and beside our bound.

    Parameters
    ----------
    rows : list of RivalRow
        Of all tasks.

    Returns
    -------
    list of RivalRow
        Task by task.
    """
    found = []
    for row in (row for mine in by_task(rows).values() for row in mine):
        mine = [other for other in rows if other.problem == row.problem]
        bound = next((other.bound for other in mine if other.rival == OURS), None)
        kept = [o.seconds for o in mine if o.status == KEEPS and o.seconds is not None]
        fastest = min(kept, default=None)
        found.append(
            replace(
                row,
                bound=bound,
                fastest=fastest,
                over_bound=_over(row.seconds, bound),
                over_fastest=_over(row.seconds, fastest),
            )
        )
    return found


def _over(seconds: float | None, least: float | None) -> float | None:
    return seconds / least if seconds is not None and least else None


@dataclass(frozen=True)
class RivalSummary:
    """What matters of one program.

    exact: whether it is about the tasks with zones whose points the program passes exactly, or about all
    others. tasks: those that it was given. kept, broken, none: motions that keep all, that break something,
    and tasks without a motion; tasks that it was not given are none of these. over: median and largest time
    over the fastest motion, of motions that keep all; mended: the same of those that break something, once
    they are slowed down; mendable: how many of them that mends. factor: largest value over a limit.
    work: median [s].
    """

    rival: str
    exact: bool
    tasks: int
    kept: int
    broken: int
    none: int
    over: tuple[float, float] | None
    mendable: int
    mended: tuple[float, float] | None
    factor: float | None
    work: float | None


def summarise(rows: list[RivalRow]) -> list[dict[str, Any]]:
    """Sum the rows of each program up.

    Parameters
    ----------
    rows : list of RivalRow
        As ``beside`` returns them.

    Returns
    -------
    list of dict
        A ``RivalSummary`` each.
    """
    found = []
    groups = dict.fromkeys((row.exact, row.rival) for row in rows)
    for exact, key in sorted(groups, key=lambda group: group[0]):
        mine = [
            row
            for row in rows
            if (row.exact, row.rival) == (exact, key) and row.status not in NOT_GIVEN
        ]
        kept = [r for r in mine if r.status == KEEPS]
        broken = [r for r in mine if r.status == BREAKS]
        mended = [r.mended / r.fastest for r in broken if r.mended is not None and r.fastest]
        work = [r.computation for r in mine if r.computation is not None]
        summary = RivalSummary(
            key,
            exact,
            len(mine),
            len(kept),
            len(broken),
            len(mine) - len(kept) - len(broken),
            _median_and_largest([r.over_fastest for r in kept if r.over_fastest is not None]),
            len(mended),
            _median_and_largest(mended),
            max((r.factor for r in mine if r.factor is not None), default=None),
            float(np.median(work)) if work else None,
        )
        found.append(asdict(summary))
    return found


def _median_and_largest(values: list[float]) -> tuple[float, float] | None:
    return (float(np.median(values)), max(values)) if values else None


STUDY = Study(
    name="rivals",
    row=RivalRow,
    compute=answered,
    complete=beside,
    summarise=summarise,
    text=as_text,
)
