"""The tables of ``results.sqlite``, derived from the columns of a row.

makers     what all seeds of a swarm on a case share: what was run, and by which code and versions
machines   processors, cores and systems
runs       a row per run: seed, what was found and judged
traces     best fitness against evaluations of each run, compressed
instances  the problems, as plain data
plans, planned   which runs were asked for, in their order
proofs     bounds of problems, by problem, versions and code of the provers
documents  JSON by kind and name: settings, ladders, known times, audits
rows       a view that joins runs, makers and machines into one wide table, for other programs

The columns of ``makers`` and ``runs`` are those of `compare.benchmark.records.rows.Row`. A new column of
`Row` needs a new version of the schema: one line in `STEPS` of `migrations`.
"""

from __future__ import annotations

from enum import StrEnum
from typing import Any, get_type_hints

from compare.benchmark.records.rows import COLUMNS, Row

VERSION = 2
APPLICATION = 0x74696D65  # "time": tells the file from other SQLite files

_SHARED = (
    "case", "family", "coding", "swarm", "library", "parameters", "code", "budget", "population",
    "track", "coordinates", "isolated", "time_limit", "problem", "versions",
)  # fmt: skip
MAKER_COLUMNS: tuple[str, ...] = tuple(name for name in COLUMNS if name in _SHARED)
RUN_COLUMNS: tuple[str, ...] = tuple(
    name for name in COLUMNS if name not in (*_SHARED, "seed", "machine")
)
KINDS: dict[str, Any] = get_type_hints(Row)


def sql_type(kind: Any) -> str:
    """Return the declared type of a column.

    Parameters
    ----------
    kind : type
        Type of the field of `Row`.

    Returns
    -------
    str
        SQL, with ``NOT NULL`` unless None is a value.
    """
    if isinstance(kind, type) and issubclass(kind, StrEnum):
        return "TEXT NOT NULL"
    return {
        str: "TEXT NOT NULL",
        int: "INTEGER NOT NULL",
        bool: "INTEGER NOT NULL",
        bool | None: "INTEGER",
        float: "REAL NOT NULL",
        float | None: "REAL",
        tuple[float, ...]: "BLOB NOT NULL",
    }[kind]


def tables() -> str:
    """Return the statements that make an empty store.

    Returns
    -------
    str
        SQL.
    """
    maker = ",\n  ".join(f'"{name}" {sql_type(KINDS[name])}' for name in MAKER_COLUMNS)
    found = ",\n  ".join(f'"{name}" {sql_type(KINDS[name])}' for name in RUN_COLUMNS)
    return f"""
CREATE TABLE makers (
  id INTEGER PRIMARY KEY,
  digest TEXT NOT NULL UNIQUE,
  {maker}
) STRICT;
CREATE TABLE machines (id INTEGER PRIMARY KEY, machine TEXT NOT NULL UNIQUE) STRICT;
CREATE TABLE runs (
  id INTEGER PRIMARY KEY,
  maker INTEGER NOT NULL REFERENCES makers (id),
  seed INTEGER NOT NULL,
  machine INTEGER NOT NULL REFERENCES machines (id),
  {found},
  UNIQUE (maker, seed)
) STRICT;
CREATE TABLE traces (run INTEGER PRIMARY KEY REFERENCES runs (id), data BLOB NOT NULL) STRICT;
CREATE TABLE instances (
  problem TEXT NOT NULL, name TEXT NOT NULL, data TEXT NOT NULL, PRIMARY KEY (problem, name)
) STRICT;
CREATE TABLE plans (id INTEGER PRIMARY KEY, digest TEXT NOT NULL UNIQUE, used INTEGER NOT NULL) STRICT;
CREATE TABLE planned (
  plan INTEGER NOT NULL REFERENCES plans (id),
  place INTEGER NOT NULL,
  maker INTEGER NOT NULL REFERENCES makers (id),
  seed INTEGER NOT NULL,
  PRIMARY KEY (plan, place)
) STRICT, WITHOUT ROWID;
CREATE TABLE proofs (
  problem TEXT NOT NULL, versions TEXT NOT NULL, code TEXT NOT NULL, asked TEXT NOT NULL,
  data TEXT NOT NULL, PRIMARY KEY (problem, versions, code, asked)
) STRICT;
CREATE TABLE documents (
  kind TEXT NOT NULL, name TEXT NOT NULL, data TEXT NOT NULL, PRIMARY KEY (kind, name)
) STRICT;
{view()}
"""


def view() -> str:
    """Return the statement that makes the view ``rows``: the columns of a row in their order.

    Returns
    -------
    str
        SQL.
    """
    places = {"seed": "r", "machine": "c"} | dict.fromkeys(MAKER_COLUMNS, "m")
    columns = ", ".join(f'{places.get(name, "r")}."{name}"' for name in COLUMNS)
    return (
        f"CREATE VIEW rows AS SELECT {columns} FROM runs r"
        " JOIN makers m ON m.id = r.maker JOIN machines c ON c.id = r.machine;"
    )
