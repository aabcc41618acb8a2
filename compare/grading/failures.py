"""Runs that failed: said on the console as they happen, and counted for the page."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass

from compare.benchmark.grade import Graded
from compare.benchmark.records.rows import Row
from compare.grading.cells import COUNTED


@dataclass(frozen=True)
class Failure:
    """All runs of one swarm that failed in one way, with the message of the first."""

    swarm: str
    status: str
    count: int
    first: str
    note: str


class Console:
    """Says on stderr that runs fail: the first one of each swarm, status and instance in full."""

    def __init__(self) -> None:
        self._said: set[tuple[str, str, str]] = set()

    def __call__(self, graded: Graded) -> None:
        """Look at one finished run.

        Parameters
        ----------
        graded : Graded
        """
        row = graded.row
        kind = (row.swarm, row.status.value, row.case)
        if failed(row) and kind not in self._said:
            self._said.add(kind)
            note = f": {row.note}" if row.note else ""
            where = f"{row.case}, seed {row.seed}"
            print(f"failed: {row.swarm} on {where}: {row.status}{note}", file=sys.stderr, flush=True)


def failed(row: Row) -> bool:
    """Whether a run counts as a miss.

    Parameters
    ----------
    row : Row

    Returns
    -------
    bool
    """
    return row.status not in COUNTED or row.gap is None


def failures(rows: Iterable[Row]) -> list[Failure]:
    """Count the runs that failed, by swarm and status.

    Parameters
    ----------
    rows : iterable of Row

    Returns
    -------
    list of Failure
        In the order in which they are first met.
    """
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        if failed(row):
            groups.setdefault((row.swarm, row.status.value), []).append(row)
    return [
        Failure(swarm, status, len(group), f"{group[0].case}, seed {group[0].seed}", group[0].note)
        for (swarm, status), group in groups.items()
    ]
