"""The results of one comparison on disk: ``DIR/results.sqlite``, and ``DIR/rows.csv`` made from it.

A run is one transaction, committed as the run ends: its row and its traces are there together or not at
all, whatever kills the program. Rows of other code, versions or budgets stay in the file; what is read
back are the rows of the plan alone. `compare.benchmark.records.database` holds the tables.
"""

from __future__ import annotations

import secrets
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from compare.benchmark.grade import Graded, Run, Trace
from compare.benchmark.records.database import documents, makers, runs
from compare.benchmark.records.database.schema import MAKER_COLUMNS
from compare.benchmark.records.exports.csv_ import write_rows
from compare.benchmark.records.facts import StoredFacts
from compare.benchmark.records.rows import BoundProof, Row, RunKey
from compare.benchmark.records.settings import Settings
from formulations import InputError, Problem

__all__ = ["Settings", "Store"]

T = TypeVar("T")


class Store(StoredFacts):
    """The results of one comparison in one folder.

    Parameters
    ----------
    folder : Path
    """

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        self.rows_file = folder / "rows.csv"
        self._salt = secrets.token_hex(8)  # see `makers.maker_id`
        self._plan: int | None = None

    def clear(self) -> None:
        """Start afresh: nothing of an earlier comparison, but the bounds that were proved."""
        self._plan = None
        self.rows_file.unlink(missing_ok=True)
        with self.database.writing() as connection:
            for table in ("planned", "plans", "traces", "runs", "makers", "instances", "documents"):
                connection.execute(f"DELETE FROM {table}")

    # --- runs -------------------------------------------------------------------------------------

    def write_plan(self, planned: Sequence[Run], problems: Mapping[str, Problem]) -> None:
        """Keep which runs are asked for; from now on only their rows are read.

        Parameters
        ----------
        planned : sequence of Run
            In the order of the rows.
        problems : mapping of str to Problem
            By case.
        """
        with self.database.writing() as connection:
            self._plan = makers.write_plan(connection, planned, problems, self._salt)

    def left(self) -> list[int]:
        """Return the places in the plan of the runs that are not stored.

        Returns
        -------
        list of int
        """
        return self._read(lambda c, plan: [] if plan is None else runs.left_of_plan(c, plan), [])

    def outside(self) -> list[tuple[dict[str, Any], int]]:
        """Return what is stored and not in the plan: what made it, and how many runs.

        Returns
        -------
        list of (dict, int)
            Columns that all seeds of a swarm share, by name, and the number of runs.
        """

        def read(connection: sqlite3.Connection, plan: int | None) -> list[tuple[dict[str, Any], int]]:
            if plan is None:
                return []
            known = makers.makers(connection)
            return [(known[m], n) for m, n in runs.outside_of_plan(connection, plan).items()]

        return self._read(read, [])

    def other_machines(self, machine: str) -> list[str]:
        """Return the machines that made part of a cell of which runs are left.

        Parameters
        ----------
        machine : str
            The one that would make the rest.

        Returns
        -------
        list of str
        """
        return self._read(lambda c, plan: runs.other_machines(c, plan, machine), [])

    def add(self, graded: Graded) -> None:
        """Store one finished run, row and traces, before this returns.

        Parameters
        ----------
        graded : Graded

        Raises
        ------
        InputError
            If the disk is full, or if another result of the same run by the same code is stored.
        """
        self.add_all([(graded.row, graded.traces)])

    def add_all(self, results: Iterable[tuple[Row, Sequence[Trace]]]) -> None:
        """Store runs in one transaction: all of them, or none.

        Parameters
        ----------
        results : iterable of (Row, sequence of Trace)
        """
        with self.database.writing() as connection:
            for row, traces in results:
                shared = {name: getattr(row, name) for name in MAKER_COLUMNS}
                maker = makers.maker_id(connection, shared, self._salt)
                try:
                    runs.write_run(connection, maker, row, traces)
                except ValueError as error:
                    raise InputError(f"{self.file}: {error}") from None

    def measure(self, bounds: Mapping[str, tuple[float | None, BoundProof]]) -> None:
        """Measure the gaps of the plan's rows against these times.

        Parameters
        ----------
        bounds : mapping of str to (float or None [s], BoundProof)
            By case.
        """
        with self.database.writing() as connection:
            runs.measure(connection, self._plan_of(connection), bounds)

    def rows(self, *, every: bool = False) -> list[Row]:
        """Return the rows of the plan, in its order; traces are not read.

        Parameters
        ----------
        every : bool
            All rows instead, those of other plans, code and versions too, in the order of writing. A
            store without a plan gives these in any case.

        Returns
        -------
        list of Row
        """
        return list(self.iterate_rows(every=every))

    def iterate_rows(self, *, every: bool = False) -> Iterator[Row]:
        """Read the same rows one by one.

        Parameters
        ----------
        every : bool
            As for ``rows``.

        Yields
        ------
        Row
        """
        if self.database.exists():
            with self._reading() as connection:
                plan = None if every else self._plan_of(connection)
                yield from runs.read_rows(connection, plan)

    def traces(self, case: str | None = None) -> Iterator[tuple[RunKey, list[Trace]]]:
        """Read the traces of the same runs, one run after the other.

        Parameters
        ----------
        case : str, optional
            Only those of this case.

        Yields
        ------
        key : RunKey
        traces : list of Trace
        """
        if self.database.exists():
            with self._reading() as connection:
                yield from runs.read_traces(connection, self._plan_of(connection), case)

    def write_csv(self) -> None:
        """Write ``rows.csv``: the rows of the plan, in its order."""
        write_rows(self.iterate_rows(), self.rows_file)

    # --- what goes with the runs ------------------------------------------------------------------

    def problems(self) -> dict[str, Problem]:
        """Return the problems of the plan by case, as they were when it was run."""
        return self._read(documents.problems_of_plan, {})

    def problem_digests(self) -> dict[str, str]:
        """Digests of the problems of the plan, by case."""
        return self._read(documents.digests_of_plan, {})

    # --- the database -----------------------------------------------------------------------------

    def _read(self, function: Callable[[sqlite3.Connection, int | None], T], nothing: T) -> T:
        """What a function of connection and plan reads; ``nothing`` if there is no file."""
        if not self.database.exists():
            return nothing
        with self._reading() as connection:
            return function(connection, self._plan_of(connection))

    def _plan_of(self, connection: sqlite3.Connection) -> int | None:
        """The plan of this object, else the one that was used last."""
        return makers.last_plan(connection) if self._plan is None else self._plan
