"""Whatever cuts the writing short, a store that is opened again holds whole runs, and all that were committed.

The files are copied as they lie on the disk after each commit, and then every state is made that a cut in
between could leave: the log cut off at any byte, its end overwritten, the pages of a checkpoint half written.
"""

from __future__ import annotations

import contextlib
import shutil
import sqlite3
import struct
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from graded_runs import graded, stored

from compare.benchmark.grade import Graded
from compare.benchmark.records.database import connection as connection_module
from compare.benchmark.records.store import Store
from formulations import InputError, load

COUNT = 12


@cache
def one(seed: int) -> Graded:
    return graded(load("sr4c"), 4.7, "shared", "random", seed, 30)


def runs(count: int, first: int = 0) -> list[Graded]:
    return [one(seed) for seed in range(first, first + count)]


@pytest.fixture(scope="module")
def history(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes, list[int]]:
    """Database and log after the last commit, nothing checkpointed; length of the log at each commit."""
    folder = tmp_path_factory.mktemp("history")
    store = stored(folder, 0)
    store.close()  # the tables are in the database itself, the log is empty
    # a second connection keeps the log: the last one that closes empties it
    with contextlib.closing(sqlite3.connect(folder / "results.sqlite")) as other:
        other.execute("SELECT count(*) FROM runs").fetchone()
        lengths = []
        for run in runs(COUNT):
            store.add(run)
            lengths.append((folder / "results.sqlite-wal").stat().st_size)
        database, log = (folder / f"results.sqlite{end}" for end in ("", "-wal"))
        found = database.read_bytes(), log.read_bytes(), lengths
    store.close()
    return found


def opened(folder: Path, database: bytes, log: bytes) -> int:
    """How many runs are read from these files, once all that must hold of them is checked."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    (folder / "results.sqlite").write_bytes(database)
    (folder / "results.sqlite-wal").write_bytes(log)
    with contextlib.closing(sqlite3.connect(folder / "results.sqlite")) as other:
        assert other.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert other.execute("PRAGMA foreign_key_check").fetchall() == []
    store = Store(folder)
    rows, traces = store.rows(), dict(store.traces())
    assert [row.seed for row in rows] == list(range(len(rows)))
    expected = runs(len(rows))
    assert [row.durations for row in rows] == [one.row.durations for one in expected]
    assert traces == {one.run.key: one.traces for one in expected}
    store.close()
    return len(rows)


def cuts(log: bytes) -> Iterator[int]:
    """Every end of a frame, and places within the frames."""
    (page,) = struct.unpack(">I", log[8:12])
    frame = page + 24
    for start in range(32, len(log) + 1, frame):
        yield from {start, max(start - 1, 0), min(start + 13, len(log)), min(start + 700, len(log))}


def test_a_log_that_ends_anywhere_holds_the_runs_committed_until_there(
    history: tuple[bytes, bytes, list[int]], tmp_path: Path
) -> None:
    database, log, lengths = history
    found = {}
    for cut in sorted({0, *cuts(log)}):
        found[cut] = opened(tmp_path / "cut", database, log[:cut])
        assert found[cut] == sum(length <= cut for length in lengths), cut
    assert len(found) > 100
    assert set(found.values()) == set(range(COUNT + 1))


def test_a_log_with_a_damaged_end_holds_the_runs_before_it(
    history: tuple[bytes, bytes, list[int]], tmp_path: Path
) -> None:
    """The disk may have kept the length of a file and not yet its last sectors."""
    database, log, lengths = history
    rng = np.random.default_rng(1)
    for place in rng.integers(32, len(log), 40):
        for rest in (bytes(len(log) - place), rng.bytes(len(log) - place)):
            count = opened(tmp_path / "damaged", database, log[:place] + rest)
            assert count == sum(length <= place for length in lengths)


def test_a_checkpoint_cut_short_loses_nothing(
    history: tuple[bytes, bytes, list[int]], tmp_path: Path
) -> None:
    """A checkpoint copies pages from the log; any of them may be there, and the log is whole."""
    database, log, _ = history
    after = tmp_path / "after"
    assert opened(after, database, log) == COUNT  # closed: checkpointed
    whole = (after / "results.sqlite").read_bytes()
    (page,) = struct.unpack(">I", log[8:12])
    before = database.ljust(len(whole), b"\0")
    rng = np.random.default_rng(2)
    for _ in range(25):
        written = rng.random(len(whole) // page) < rng.random()
        mixed = b"".join(
            (whole if new else before)[k * page : (k + 1) * page] for k, new in enumerate(written)
        )
        assert opened(tmp_path / "mixed", mixed, log) == COUNT


def test_the_log_is_on_the_disk_before_a_run_counts_as_stored(tmp_path: Path) -> None:
    store = stored(tmp_path, 1)
    with store.database.reading() as connection:
        assert connection.execute("PRAGMA journal_mode").fetchone() == ("wal",)
        assert connection.execute("PRAGMA synchronous").fetchone() == (2,)  # FULL


# --- a run that does not come to its end ----------------------------------------------------------


class Killed(BaseException):
    """Stands for a kill: nothing in the program catches it."""


@pytest.mark.parametrize("table", ["makers", "machines", "runs", "traces"])
def test_a_run_cut_short_between_its_tables_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, table: str
) -> None:
    store = stored(tmp_path, 3)
    (new,) = runs(1, first=3)
    new = replace(new, row=replace(new.row, machine="new", parameters="{}"))

    def killed(action: int, name: str | None, *_: Any) -> int:
        if action == sqlite3.SQLITE_INSERT and name == table:
            raise Killed
        return sqlite3.SQLITE_OK

    with store.database.reading() as connection:
        before = list(connection.iterdump())
        connection.set_authorizer(killed)
        with pytest.raises(InputError):
            store.add(new)
        connection.set_authorizer(None)
        assert list(connection.iterdump()) == before
    store.add(new)
    assert [row.seed for row in store.rows()] == [0, 1, 2, 3]


def test_a_full_disk_is_one_line_and_loses_nothing(tmp_path: Path) -> None:
    store = stored(tmp_path, 5)
    with store.database.reading() as connection:
        (pages,) = connection.execute("PRAGMA page_count").fetchone()
        connection.execute(f"PRAGMA max_page_count = {pages + 2}")
        added = 5
        with contextlib.suppress(InputError):
            for run in runs(60, first=5):
                store.add(run)
                added += 1
        assert added < 65
        with pytest.raises(InputError, match=r"^[^\n]*results\.sqlite: cannot be written: .*full$"):
            store.add(one(added))
        assert [row.seed for row in store.rows()] == list(range(added))
        assert len(dict(store.traces())) == added
        connection.execute("PRAGMA max_page_count = 1000000")  # space again
    store.add(runs(1, first=added)[0])
    assert [row.seed for row in store.rows()] == list(range(added + 1))
    store.close()
    assert opened_count(tmp_path) == added + 1


def opened_count(folder: Path) -> int:
    with contextlib.closing(sqlite3.connect(folder / "results.sqlite")) as other:
        assert other.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        return int(other.execute("SELECT count(*) FROM runs").fetchone()[0])


def test_a_table_on_a_full_disk_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = stored(tmp_path, 2)
    store.write_csv()
    before = store.rows_file.read_bytes()
    monkeypatch.setattr(
        "os.fsync", lambda descriptor: (_ for _ in ()).throw(OSError(28, "No space left"))
    )
    with pytest.raises(InputError, match=r"rows\.csv: cannot be written: No space left"):
        store.write_csv()
    assert store.rows_file.read_bytes() == before
    assert not [path for path in tmp_path.iterdir() if path.suffix == ".part"]


def test_a_writer_waits_for_another_one_but_not_for_ever(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection_module, "PATIENCE", 0.2)
    store = stored(tmp_path, 1)
    with contextlib.closing(sqlite3.connect(store.file, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(InputError, match="cannot be written: database is locked"):
            store.add(runs(1, first=1)[0])
        assert len(store.rows()) == 1  # a reader does not wait
        other.execute("COMMIT")
    store.add(runs(1, first=1)[0])
    assert len(store.rows()) == 2
