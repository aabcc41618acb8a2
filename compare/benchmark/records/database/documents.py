"""The table ``documents``: JSON by kind and name, and the bounds that were proved once."""

from __future__ import annotations

import json
import sqlite3
from typing import Any

from compare.benchmark.records.instances import problem_of
from compare.benchmark.records.proof_cache import ProofKey
from formulations import Problem


def write_document(connection: sqlite3.Connection, kind: str, name: str, data: Any) -> None:
    """Store plain data in place of what is stored under this kind and name.

    Parameters
    ----------
    connection : sqlite3.Connection
        In a transaction.
    kind, name : str
    data : Any
        Ready for strict JSON.
    """
    connection.execute(
        "INSERT OR REPLACE INTO documents (kind, name, data) VALUES (?, ?, ?)",
        (kind, name, json.dumps(data, allow_nan=False)),
    )


def documents(connection: sqlite3.Connection, kind: str) -> dict[str, Any]:
    """Return all plain data of one kind.

    Parameters
    ----------
    connection : sqlite3.Connection
    kind : str

    Returns
    -------
    dict of str to Any
        By name, in alphabetical order.
    """
    lines = connection.execute("SELECT name, data FROM documents WHERE kind = ? ORDER BY name", (kind,))
    return {name: json.loads(data) for name, data in lines}


def problems_of_plan(connection: sqlite3.Connection, plan: int | None) -> dict[str, Problem]:
    """Return the problems that a plan runs on.

    Parameters
    ----------
    connection : sqlite3.Connection
    plan : int or None

    Returns
    -------
    dict of str to Problem
        By case, in the order of the plan.
    """
    lines = connection.execute(
        'SELECT i.name, i.data FROM instances i JOIN makers m ON m.problem = i.problem AND m."case" = i.name'
        " JOIN planned p ON p.maker = m.id WHERE p.plan = ? GROUP BY i.name ORDER BY min(p.place)",
        (plan,),
    )
    return {name: problem_of(json.loads(data)) for name, data in lines}


def digests_of_plan(connection: sqlite3.Connection, plan: int | None) -> dict[str, str]:
    """Return the digests of the problems that a plan runs on.

    Parameters
    ----------
    connection : sqlite3.Connection
    plan : int or None

    Returns
    -------
    dict of str to str
        By case.
    """
    lines = connection.execute(
        'SELECT DISTINCT m."case", m.problem FROM makers m JOIN planned p ON p.maker = m.id WHERE p.plan = ?',
        (plan,),
    )
    return dict(lines.fetchall())


def copy_table(source: sqlite3.Connection, target: sqlite3.Connection, table: str) -> None:
    """Copy the lines of a table that another store does not have.

    Parameters
    ----------
    source, target : sqlite3.Connection
        The target is in a transaction.
    table : str
    """
    lines = source.execute(f"SELECT * FROM {table}")
    marks = ", ".join("?" * len(lines.description))
    target.executemany(f"INSERT OR IGNORE INTO {table} VALUES ({marks})", lines)


def write_proof(connection: sqlite3.Connection, key: ProofKey, data: Any) -> None:
    """Store proved bounds, unless there are some of the same key.

    Parameters
    ----------
    connection : sqlite3.Connection
        In a transaction.
    key : ProofKey
    data : Any
        Ready for strict JSON.
    """
    connection.execute(
        "INSERT OR IGNORE INTO proofs (problem, versions, code, asked, data) VALUES (?, ?, ?, ?, ?)",
        (*key, json.dumps(data, allow_nan=False)),
    )


def proof(connection: sqlite3.Connection, key: ProofKey) -> Any:
    """Return the bounds that were proved under a key.

    Parameters
    ----------
    connection : sqlite3.Connection
    key : ProofKey

    Returns
    -------
    Any
        None if there are none.
    """
    found = connection.execute(
        "SELECT data FROM proofs WHERE problem = ? AND versions = ? AND code = ? AND asked = ?", key
    ).fetchone()
    return None if found is None else json.loads(found[0])
