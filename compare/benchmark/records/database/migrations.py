"""A store of an older version is brought up to date when it is opened: one step per version."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable

from compare.benchmark.records.database.schema import APPLICATION, VERSION, tables

Step = Callable[[sqlite3.Connection], None]

# version -> what makes the next version of it
STEPS: dict[int, Step] = {}


def bring_up_to_date(connection: sqlite3.Connection) -> None:
    """Make the tables of an empty file, or migrate those of an older version, all or nothing.

    Parameters
    ----------
    connection : sqlite3.Connection
        Without a transaction.

    Raises
    ------
    ValueError
        If the file is of a newer version, or of another program.
    """
    if _state(connection) == (APPLICATION, VERSION):
        return
    connection.execute("BEGIN IMMEDIATE")  # another process may be at the same
    try:
        application, version = _state(connection)
        if (application, version) == (0, 0) and not _names(connection):
            for statement in tables().split(";\n"):
                connection.execute(statement)
            version = VERSION
        elif application != APPLICATION:
            raise ValueError("is a file of another program")
        elif version > VERSION:
            raise ValueError(
                f"was written by a newer version of timebound (schema {version}; this one knows {VERSION})"
            )
        while version < VERSION:
            STEPS[version](connection)
            version += 1
        connection.execute(f"PRAGMA application_id = {APPLICATION}")
        connection.execute(f"PRAGMA user_version = {version}")
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


def _state(connection: sqlite3.Connection) -> tuple[int, int]:
    """Which program wrote the file, and in which version of its schema."""
    return (
        connection.execute("PRAGMA application_id").fetchone()[0],
        connection.execute("PRAGMA user_version").fetchone()[0],
    )


def _names(connection: sqlite3.Connection) -> list[str]:
    return [name for (name,) in connection.execute("SELECT name FROM sqlite_schema")]
