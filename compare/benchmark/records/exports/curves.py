"""What a search has reached after how many evaluations, as a gap to the optimum of its task.

The task of a search is a case or, in the published coding, one joint of it; its gap is measured against the
certified bound of the case where that is tight, else against the best optimum known, and against the optimum
of the joint alone.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.pooled import CELL, require_pooled
from compare.benchmark.records.rows import Row
from compare.benchmark.records.store import Store
from compare.benchmark.summaries import bound_of
from formulations.problem.arrays import Array


@dataclass(frozen=True)
class SearchTask:
    """What is searched: a case, or one of its joints alone.

    number: from 1, in the order of the cases; joint: from 0, -1 for all at once; dimension: number of
    segments; optimum: what gaps are measured against [s].
    """

    number: int
    case: str
    joint: int
    dimension: int
    optimum: float

    @property
    def name(self) -> str:
        """The case, with the number of the joint from 1."""
        return self.case if self.joint < 0 else f"{self.case} joint {self.joint + 1}"


@dataclass(frozen=True)
class SearchCurve:
    """One search: its row, evaluations from 1 on, and the best gap after each of them.

    Gaps are infinite while nothing feasible is found. The last entry is that of the last evaluation.
    """

    row: Row
    evaluations: Array
    gaps: Array


def tasks(store: Store) -> dict[tuple[str, int], SearchTask]:
    """Return every task of a comparison whose optimum is known.

    Parameters
    ----------
    store : Store

    Returns
    -------
    dict of (case, joint) to SearchTask
    """
    found: dict[tuple[str, int], SearchTask] = {}
    ladders = store.ladders()
    for case, problem in store.problems().items():
        for joint, optimum in _optima(ladders.get(case)):
            if optimum is not None:
                found[case, joint] = SearchTask(
                    len(found) + 1, case, joint, problem.n_segments, optimum
                )
    return found


def _optima(ladder: LadderRecord | None) -> Iterator[tuple[int, float | None]]:
    if ladder is not None:
        yield -1, bound_of(ladder)[0]
        yield from enumerate(ladder.get("alone", []))


def cells(store: Store) -> Iterator[tuple[str, SearchTask, list[SearchCurve]]]:
    """Give the searches of cell after cell of the plan; memory holds one cell at a time.

    Parameters
    ----------
    store : Store

    Yields
    ------
    name : str
        The swarm and the variant of its coding.
    task : SearchTask
    curves : list of SearchCurve
        One for each seed.

    Raises
    ------
    InputError
        If a cell holds rows that cannot be pooled.
    """
    known = tasks(store)
    rows = require_pooled(store.iterate_rows(), allow=store.settings().allow)
    results = zip(rows, store.traces(), strict=True)
    for _, group in groupby(results, lambda one: [getattr(one[0], name) for name in CELL]):
        by_task: dict[SearchTask, list[SearchCurve]] = {}
        for row, (_, traces) in group:
            for trace in traces:
                task = known.get((row.case, trace.joint))
                if task is not None and trace.evaluations:
                    by_task.setdefault(task, []).append(
                        _curve(row, task, trace.evaluations, trace.best)
                    )
        for task, curves in by_task.items():
            row = curves[0].row
            yield f"{row.swarm} {row.variant}", task, curves


def _curve(row: Row, task: SearchTask, evaluations: list[int], best: list[float]) -> SearchCurve:
    gaps = np.maximum(np.array(best) / task.optimum - 1.0, 0.0)  # below is rounding
    at = np.array(evaluations)
    if at[0] > 1:  # readers tell where a run begins by its first evaluation
        at, gaps = np.insert(at, 0, 1), np.insert(gaps, 0, np.inf)
    return SearchCurve(row, at, gaps)


def file_name(text: str) -> str:
    """Return text as part of the name of a file.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
        Letters, digits, points, hyphens and underscores.
    """
    return re.sub(r"[^\w.-]+", "-", text, flags=re.ASCII).strip("-")


def made_by(row: Row) -> str:
    """Return in one line what made the runs of a cell.

    Parameters
    ----------
    row : Row
        One of them.

    Returns
    -------
    str
    """
    facts = (row.swarm, row.library, row.parameters, f"code {row.code}", row.versions)
    line = io.StringIO()
    csv.writer(line, delimiter=";", lineterminator="").writerow([fact for fact in facts if fact])
    return line.getvalue().replace("'", "")
