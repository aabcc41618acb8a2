"""What all seeds of a swarm on a case share, each combination stored once; and the plans made of them."""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

from compare.benchmark.grade import Run
from compare.benchmark.records.database.codec import decoded, encoded
from compare.benchmark.records.database.schema import MAKER_COLUMNS
from compare.benchmark.records.instances import plain_problem
from compare.benchmark.records.provenance import problem_digest, provenance_of
from formulations import Problem

_MARKS = ", ".join("?" * (1 + len(MAKER_COLUMNS)))
_NAMES = ", ".join(f'"{name}"' for name in MAKER_COLUMNS)


def maker_of(run: Run, problem: Problem) -> dict[str, Any]:
    """Return what a run here and now would share with all other seeds of its swarm.

    Parameters
    ----------
    run : Run
    problem : Problem
        The problem of ``run.case``.

    Returns
    -------
    dict
        The columns ``MAKER_COLUMNS`` of the row that ``grade`` would give.
    """
    made_by = provenance_of(run.swarm, problem, run.population, run.time_limit, run.constants)
    known = asdict(run) | asdict(made_by) | {"family": problem.family}
    return {name: known[name] for name in MAKER_COLUMNS}


def maker_id(connection: sqlite3.Connection, maker: Mapping[str, Any], salt: str) -> int:
    """Return the number of a maker, which is stored if it is new.

    Parameters
    ----------
    connection : sqlite3.Connection
        In a transaction.
    maker : mapping
        Its columns.
    salt : str
        Of this session: code that cannot be read may be another one in every session.

    Returns
    -------
    int
    """
    values = [encoded(maker[name]) for name in MAKER_COLUMNS]
    text = json.dumps([*values, "" if maker["code"] else salt])
    digest = hashlib.sha256(text.encode()).hexdigest()[:24]
    connection.execute(
        f"INSERT OR IGNORE INTO makers (digest, {_NAMES}) VALUES ({_MARKS})", (digest, *values)
    )
    return int(connection.execute("SELECT id FROM makers WHERE digest = ?", (digest,)).fetchone()[0])


def makers(connection: sqlite3.Connection) -> dict[int, dict[str, Any]]:
    """Return every maker by its number.

    Parameters
    ----------
    connection : sqlite3.Connection

    Returns
    -------
    dict of int to dict
    """
    lines = connection.execute(f"SELECT id, {_NAMES} FROM makers")
    return {line[0]: decoded(MAKER_COLUMNS, line[1:]) for line in lines}


def digests(connection: sqlite3.Connection) -> dict[int, str]:
    """Return the digest of every maker by its number.

    Parameters
    ----------
    connection : sqlite3.Connection

    Returns
    -------
    dict of int to str
    """
    return dict(connection.execute("SELECT id, digest FROM makers").fetchall())


def entries_of(connection: sqlite3.Connection, plan: int | None) -> list[tuple[int, int]]:
    """Return the runs of a plan in their order.

    Parameters
    ----------
    connection : sqlite3.Connection
    plan : int or None

    Returns
    -------
    list of (int, int)
        Number of the maker and seed.
    """
    lines = connection.execute("SELECT maker, seed FROM planned WHERE plan = ? ORDER BY place", (plan,))
    return lines.fetchall()


def write_plan(
    connection: sqlite3.Connection,
    runs: Sequence[Run],
    problems: Mapping[str, Problem],
    salt: str,
) -> int:
    """Store which runs are asked for, and make this plan the last one used.

    Parameters
    ----------
    connection : sqlite3.Connection
        In a transaction.
    runs : sequence of Run
        In their order; none twice.
    problems : mapping of str to Problem
        By case.
    salt : str
        Of this session.

    Returns
    -------
    int
        The number of the plan.
    """
    write_problems(connection, problems)
    ids: dict[Run, int] = {}
    entries = []
    for run in runs:
        cell = replace(run, seed=0)
        if cell not in ids:
            ids[cell] = maker_id(connection, maker_of(cell, problems[run.case]), salt)
        entries.append((ids[cell], run.seed))
    return enter_plan(connection, entries)


def enter_plan(connection: sqlite3.Connection, entries: Sequence[tuple[int, int]]) -> int:
    """Store a plan of makers and seeds, and make it the last one used.

    Parameters
    ----------
    connection : sqlite3.Connection
        In a transaction.
    entries : sequence of (int, int)
        Number of the maker and seed of each run, in order.

    Returns
    -------
    int
        The number of the plan; that of an equal one if there is one.
    """
    digest = hashlib.sha256(json.dumps(entries).encode()).hexdigest()[:24]
    connection.execute("INSERT OR IGNORE INTO plans (digest, used) VALUES (?, 0)", (digest,))
    plan = int(connection.execute("SELECT id FROM plans WHERE digest = ?", (digest,)).fetchone()[0])
    connection.executemany(
        "INSERT OR IGNORE INTO planned (plan, place, maker, seed) VALUES (?, ?, ?, ?)",
        ((plan, place, maker, seed) for place, (maker, seed) in enumerate(entries)),
    )
    connection.execute(
        "UPDATE plans SET used = (SELECT max(used) + 1 FROM plans) WHERE id = ?", (plan,)
    )
    return plan


def write_problems(connection: sqlite3.Connection, problems: Mapping[str, Problem]) -> None:
    """Store problems as plain data.

    Parameters
    ----------
    connection : sqlite3.Connection
        In a transaction.
    problems : mapping of str to Problem
        By case.
    """
    connection.executemany(
        "INSERT OR REPLACE INTO instances (problem, name, data) VALUES (?, ?, ?)",
        (
            (problem_digest(problem), case, json.dumps(plain_problem(problem), allow_nan=False))
            for case, problem in problems.items()
        ),
    )


def last_plan(connection: sqlite3.Connection) -> int | None:
    """Return the number of the plan that was used last, None if there is none.

    Parameters
    ----------
    connection : sqlite3.Connection

    Returns
    -------
    int or None
    """
    found = connection.execute("SELECT id FROM plans ORDER BY used DESC LIMIT 1").fetchone()
    return None if found is None else int(found[0])
