"""A store of an older version is brought up to date when it is opened: one step per version.

A step is written once and never changed: it knows the columns of its own two versions, not those of today.
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Callable

from compare.benchmark.records.database.codec import unpacked
from compare.benchmark.records.database.schema import APPLICATION, VERSION, tables

_VIEW_2 = """
CREATE VIEW rows AS SELECT m."case", m."family", m."coding", m."swarm", m."library", m."parameters",
m."code", r."seed", r."status", r."claimed", r."keeps_limits", r."stretch", r."seconds", r."bound",
r."proof", r."gap", r."claimed_gap", m."budget", m."population", m."track", m."coordinates",
r."evaluations", r."durations", r."worst", r."note", m."isolated", m."time_limit",
r."seconds_algorithm", r."seconds_objective", m."problem", m."versions", c."machine"
FROM runs r JOIN makers m ON m.id = r.maker JOIN machines c ON c.id = r.machine
"""
_MAKERS_2 = """
CREATE TABLE makers_2 (
  id INTEGER PRIMARY KEY, digest TEXT NOT NULL UNIQUE,
  "case" TEXT NOT NULL, "family" TEXT NOT NULL, "coding" TEXT NOT NULL, "swarm" TEXT NOT NULL,
  "library" TEXT NOT NULL, "parameters" TEXT NOT NULL, "code" TEXT NOT NULL, "budget" INTEGER NOT NULL,
  "population" INTEGER NOT NULL, "track" TEXT NOT NULL, "coordinates" TEXT NOT NULL,
  "isolated" INTEGER NOT NULL, "time_limit" REAL, "problem" TEXT NOT NULL, "versions" TEXT NOT NULL
) STRICT
"""


_PROOFS_2 = """
CREATE TABLE proofs (
  problem TEXT NOT NULL, versions TEXT NOT NULL, code TEXT NOT NULL, asked TEXT NOT NULL,
  data TEXT NOT NULL, PRIMARY KEY (problem, versions, code, asked)
) STRICT
"""


def _tracks_and_coordinates(connection: sqlite3.Connection) -> None:
    """1 -> 2: track and coordinates; a budget counts the evaluations of the whole motion.

    Version 1 gave each joint of the published coding the whole budget, as the papers do. Its proofs were
    made by the code of its time, which no present code asks for.
    """
    joints = {
        maker: len(unpacked(data))
        for maker, data in connection.execute(
            "SELECT r.maker, t.data FROM runs r JOIN traces t ON t.run = r.id GROUP BY r.maker"
        )
    }
    lines = connection.execute(
        'SELECT id, digest, "case", family, coding, swarm, library, parameters, code, budget,'
        " population, isolated, time_limit, problem, versions FROM makers"
    ).fetchall()
    connection.execute("DROP VIEW rows")
    connection.execute(_MAKERS_2)
    for number, old, *first, budget, population, isolated, time_limit, problem, versions in lines:
        papers = first[2] == "published"
        values = [
            *first,
            budget * joints.get(number, 1) if papers else budget,
            population,
            "paper" if papers else "equal",
            "printed",
            isolated,
            time_limit,
            problem,
            versions,
        ]
        salt = "" if first[-1] else old  # code that cannot be read is the same as no other
        digest = hashlib.sha256(json.dumps([*values, salt]).encode()).hexdigest()[:24]
        marks = ", ".join("?" * (2 + len(values)))
        connection.execute(f"INSERT INTO makers_2 VALUES ({marks})", (number, digest, *values))
    connection.execute("DROP TABLE proofs")
    connection.execute(_PROOFS_2)
    connection.execute("DROP TABLE makers")
    connection.execute("ALTER TABLE makers_2 RENAME TO makers")
    connection.execute(_VIEW_2)


# version -> what makes the next version of it
STEPS: dict[int, Callable[[sqlite3.Connection], None]] = {1: _tracks_and_coordinates}


def bring_up_to_date(connection: sqlite3.Connection) -> None:
    """Make the tables of an empty file, or migrate those of an older version, all or nothing.

    Parameters
    ----------
    connection : sqlite3.Connection
        Without a transaction, and without checks of foreign keys.

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
