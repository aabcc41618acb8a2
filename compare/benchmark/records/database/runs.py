"""The tables ``runs`` and ``traces``: a run is written once, and its rows are read as they are needed."""

from __future__ import annotations

import sqlite3
import zlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from compare.benchmark.grade import Trace
from compare.benchmark.records.database.codec import decoder, encoded, packed, unpacked
from compare.benchmark.records.database.makers import makers
from compare.benchmark.records.database.schema import RUN_COLUMNS
from compare.benchmark.records.rows import TIMING_COLUMNS, BoundProof, Row, RowStatus, RunKey

# what may differ between two results of one run: measured times, what depends on the bounds known at the
# time, and the reason in words, in which a foreign program may print an address
_MEASURED = ("bound", "proof", "gap", "claimed_gap")
_FREE = (*TIMING_COLUMNS, *_MEASURED, "note")
_SAME = tuple(name for name in RUN_COLUMNS if name not in _FREE)
_NAMES = ", ".join(f'"{name}"' for name in RUN_COLUMNS)
_INSERT = (
    f"INSERT OR IGNORE INTO runs (maker, seed, machine, {_NAMES})"
    f" VALUES (?, ?, ?, {', '.join('?' * len(RUN_COLUMNS))})"
)
_R_NAMES = ", ".join(f'r."{name}"' for name in RUN_COLUMNS)


def write_run(connection: sqlite3.Connection, maker: int, row: Row, traces: Sequence[Trace]) -> None:
    """Store a run, its row and its traces; the same result a second time is passed over.

    Parameters
    ----------
    connection : sqlite3.Connection
        In a transaction.
    maker : int
        The number of its maker.
    row : Row
    traces : sequence of Trace

    Raises
    ------
    ValueError
        If the store holds another result of the same run by the same code.
    """
    connection.execute("INSERT OR IGNORE INTO machines (machine) VALUES (?)", (row.machine,))
    (machine,) = connection.execute(
        "SELECT id FROM machines WHERE machine = ?", (row.machine,)
    ).fetchone()
    values = [encoded(getattr(row, name)) for name in RUN_COLUMNS]
    written = connection.execute(_INSERT, (maker, row.seed, machine, *values))
    data = packed(traces)
    if written.rowcount == 1:
        connection.execute("INSERT INTO traces (run, data) VALUES (?, ?)", (written.lastrowid, data))
    else:
        _require_equal(connection, maker, row, dict(zip(RUN_COLUMNS, values, strict=True)), data)


def _require_equal(
    connection: sqlite3.Connection, maker: int, row: Row, values: dict[str, Any], data: bytes
) -> None:
    stored = connection.execute(
        f"SELECT c.machine, t.data, {_R_NAMES} FROM runs r JOIN machines c ON c.id = r.machine"
        " JOIN traces t ON t.run = r.id WHERE r.maker = ? AND r.seed = ?",
        (maker, row.seed),
    ).fetchone()
    there = dict(zip(RUN_COLUMNS, stored[2:], strict=True))
    if RowStatus.timed_out in (row.status, there["status"]):
        return  # how far a swarm came before its time was over is no property of the swarm
    differing = [name for name in _SAME if there[name] != values[name]]
    if not differing and zlib.decompress(stored[1]) != zlib.decompress(data):
        differing = ["trace"]
    if differing:
        name = differing[0]
        shown = "" if name == "trace" else f": {there[name]!r} and {values[name]!r}"
        raise ValueError(
            f"two results of one run: {', '.join(map(str, row.key))}: {', '.join(differing)} differ"
            f"{shown} ({stored[0]}; {row.machine})"
        )


def measure(
    connection: sqlite3.Connection,
    plan: int | None,
    bounds: Mapping[str, tuple[float | None, BoundProof]],
) -> None:
    """Measure the gaps of rows against these times, where they are measured against others.

    Parameters
    ----------
    connection : sqlite3.Connection
        In a transaction.
    plan : int or None
        As in ``read_rows``.
    bounds : mapping of str to (float or None [s], BoundProof)
        By case.
    """
    in_use = connection.execute(
        'SELECT DISTINCT m."case", r.bound, r.proof'
        f" {_selected(plan, 'JOIN makers m ON m.id = r.maker', ordered=False)}",
        _arguments(plan),
    )
    stale = {case for case, *used in in_use if case in bounds and tuple(used) != bounds[case]}
    if not stale:
        return
    for maker, row in [one for one in numbered_rows(connection, plan) if one[1].case in stale]:
        again = row.measured_against(*bounds[row.case])
        connection.execute(
            f"UPDATE runs SET {', '.join(f'{name} = ?' for name in _MEASURED)}"
            " WHERE maker = ? AND seed = ?",
            (*(encoded(getattr(again, name)) for name in _MEASURED), maker, row.seed),
        )


def read_rows(connection: sqlite3.Connection, plan: int | None) -> Iterator[Row]:
    """Read rows one by one, without their traces.

    Parameters
    ----------
    connection : sqlite3.Connection
    plan : int or None
        Only what this plan asks for, in its order; None: every row, in the order of writing.

    Returns
    -------
    iterator of Row

    Raises
    ------
    ValueError
        If a value does not fit its column.
    """
    return (row for _, row in numbered_rows(connection, plan))


def numbered_rows(connection: sqlite3.Connection, plan: int | None) -> Iterator[tuple[int, Row]]:
    """Read the same rows with the numbers of their makers.

    Parameters
    ----------
    connection : sqlite3.Connection
    plan : int or None
        As in ``read_rows``.

    Yields
    ------
    maker : int
    row : Row
    """
    # the rows are asked for first: as long as they are read, no table shows what others write meanwhile
    rows = connection.execute(
        f"SELECT r.maker, r.seed, r.machine, {_R_NAMES} {_selected(plan)}", _arguments(plan)
    )
    shared = makers(connection)
    machines = dict(connection.execute("SELECT id, machine FROM machines"))
    reads = [(name, decoder(name)) for name in RUN_COLUMNS]
    for maker, seed, machine, *values in rows:
        found = {}
        for (name, read), value in zip(reads, values, strict=True):
            try:
                found[name] = read(value)
            except ValueError as error:
                key = _key(shared[maker], seed)
                raise ValueError(f"{', '.join(map(str, key))}: {name}: {error}") from None
        yield maker, Row(**shared[maker], **found, seed=seed, machine=machines[machine])


def read_traces(
    connection: sqlite3.Connection, plan: int | None, case: str | None = None
) -> Iterator[tuple[RunKey, list[Trace]]]:
    """Read the traces of run after run.

    Parameters
    ----------
    connection : sqlite3.Connection
    plan : int or None
        As in ``read_rows``.
    case : str, optional
        Only those of this case.

    Yields
    ------
    key : RunKey
    traces : list of Trace
    """
    shared = makers(connection)
    wanted = [number for number, maker in shared.items() if case in (None, maker["case"])]
    within = f" AND r.maker IN ({', '.join(map(str, wanted))})"
    for maker, seed, data in connection.execute(
        f"SELECT r.maker, r.seed, t.data {_selected(plan, 'JOIN traces t ON t.run = r.id', within)}",
        _arguments(plan),
    ):
        yield _key(shared[maker], seed), unpacked(data)


def left_of_plan(connection: sqlite3.Connection, plan: int) -> list[int]:
    """Return the places in a plan whose runs are not stored.

    Parameters
    ----------
    connection : sqlite3.Connection
    plan : int

    Returns
    -------
    list of int
        In order.
    """
    lines = connection.execute(
        "SELECT p.place FROM planned p LEFT JOIN runs r ON r.maker = p.maker AND r.seed = p.seed"
        " WHERE p.plan = ? AND r.id IS NULL ORDER BY p.place",
        (plan,),
    )
    return [place for (place,) in lines]


def other_machines(connection: sqlite3.Connection, plan: int | None, machine: str) -> list[str]:
    """Return the machines that made part of a cell of which runs are left.

    Parameters
    ----------
    connection : sqlite3.Connection
    plan : int or None
    machine : str
        The one that would make the rest.

    Returns
    -------
    list of str
    """
    lines = connection.execute(
        "WITH mine AS (SELECT p.maker, r.machine FROM planned p LEFT JOIN runs r"
        " ON r.maker = p.maker AND r.seed = p.seed WHERE p.plan = ?)"
        " SELECT DISTINCT c.machine FROM mine JOIN machines c ON c.id = mine.machine WHERE c.machine <> ?"
        " AND mine.maker IN (SELECT maker FROM mine WHERE machine IS NULL) ORDER BY c.machine",
        (plan, machine),
    )
    return [name for (name,) in lines]


def outside_of_plan(connection: sqlite3.Connection, plan: int) -> dict[int, int]:
    """Return how many stored runs a plan does not ask for.

    Parameters
    ----------
    connection : sqlite3.Connection
    plan : int

    Returns
    -------
    dict of int to int
        By the number of their maker.
    """
    lines = connection.execute(
        "SELECT maker, count(*) FROM (SELECT maker, seed FROM runs EXCEPT"
        " SELECT maker, seed FROM planned WHERE plan = ?) GROUP BY maker",
        (plan,),
    )
    return dict(lines.fetchall())


def _selected(plan: int | None, join: str = "", within: str = "", *, ordered: bool = True) -> str:
    """The clauses of SQL that choose runs: all of them, or those of a plan."""
    if plan is None:
        return f"FROM runs r {join} WHERE 1{within}" + " ORDER BY r.id" * ordered
    return (
        f"FROM planned p JOIN runs r ON r.maker = p.maker AND r.seed = p.seed {join}"
        f" WHERE p.plan = ?{within}" + " ORDER BY p.place" * ordered
    )


def _arguments(plan: int | None) -> tuple[int, ...]:
    return () if plan is None else (plan,)


def _key(maker: dict[str, Any], seed: int) -> RunKey:
    return RunKey._make(seed if name == "seed" else maker[name] for name in RunKey._fields)
