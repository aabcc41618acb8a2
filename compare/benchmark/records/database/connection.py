"""One connection to ``results.sqlite``: whole transactions, and errors in one line.

Write-ahead log, and the log on the disk before a transaction counts as done: a run that was committed
outlives a kill and a loss of power, and a run that was not leaves nothing. Readers and one writer work at
the same time; a second writer waits.
"""

from __future__ import annotations

import sqlite3
import time
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from compare.benchmark.records.database.migrations import bring_up_to_date
from formulations import InputError

PATIENCE = 120.0  # s that a writer waits for another one


class Database:
    """The database of one store; it is opened when it is first used.

    Parameters
    ----------
    file : Path
        It is made by the first transaction if it is not there.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        self._connection: sqlite3.Connection | None = None

    def exists(self) -> bool:
        """Whether there is anything to read."""
        return self._connection is not None or self.file.exists()

    def close(self) -> None:
        """Close the file; the next use opens it again."""
        if self._connection is not None:
            self._finaliser()
            self._connection = None

    @contextmanager
    def reading(self) -> Iterator[sqlite3.Connection]:
        """Give the connection; what goes wrong becomes one line.

        Yields
        ------
        sqlite3.Connection
        """
        try:
            yield self._opened()
        except sqlite3.Error as error:
            raise InputError(f"{self.file}: cannot be read: {error}") from None

    @contextmanager
    def writing(self) -> Iterator[sqlite3.Connection]:
        """One transaction: all of it, or nothing if it is left by an exception.

        Yields
        ------
        sqlite3.Connection
        """
        try:
            connection = self._opened()
            connection.execute("BEGIN IMMEDIATE")
            try:
                yield connection
                connection.execute("COMMIT")
            except BaseException:
                if connection.in_transaction:  # a full disk has rolled back already
                    connection.execute("ROLLBACK")
                raise
        except sqlite3.Error as error:
            raise InputError(f"{self.file}: cannot be written: {error}") from None

    def _opened(self) -> sqlite3.Connection:
        if self._connection is None:
            # one thread uses it at a time; the garbage collector may close it in another one
            made = sqlite3.connect(
                self.file, timeout=PATIENCE, isolation_level=None, check_same_thread=False
            )
            try:
                _prepare(made)
            except ValueError as error:
                made.close()
                raise InputError(f"{self.file}: {error}") from None
            except BaseException:
                made.close()
                raise
            self._connection = made
            self._finaliser = weakref.finalize(self, made.close)
        return self._connection


def _prepare(connection: sqlite3.Connection) -> None:
    until = time.monotonic() + PATIENCE
    while True:
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            break
        except sqlite3.OperationalError as error:  # two processes at once: this pragma does not wait
            if "locked" not in str(error) or time.monotonic() > until:
                raise
            time.sleep(0.01)
    connection.execute("PRAGMA synchronous = FULL")
    bring_up_to_date(connection)  # replaces tables that others refer to
    connection.execute("PRAGMA foreign_keys = ON")
