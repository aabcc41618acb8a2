"""Stores of older and newer versions: one is migrated as it is opened, the other refused."""

from __future__ import annotations

import re
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from graded_runs import graded, stored

from compare.benchmark.grade import Trace
from compare.benchmark.protocol import Coordinates, Track
from compare.benchmark.records.database import migrations
from compare.benchmark.records.database.codec import packed
from compare.benchmark.records.database.schema import APPLICATION, VERSION, tables
from compare.benchmark.records.store import Store
from formulations import InputError, load

FIRST = Path(__file__).with_name("schema_1.sql").read_text("utf-8")


def of_version_1(folder: Path) -> None:
    """A store of version 1 with four runs: two codings, and code that cannot be read."""
    file = folder / "results.sqlite"
    with closing(sqlite3.connect(file)) as made, made:
        made.executescript(FIRST)
        made.execute(f"PRAGMA application_id = {APPLICATION}")
        made.execute("PRAGMA user_version = 1")
        made.execute("INSERT INTO machines VALUES (1, 'a machine')")
        for maker, (coding, code) in enumerate(
            [("published", "c1"), ("stretched", "c1"), ("stretched", ""), ("stretched", "")], 1
        ):
            made.execute(
                "INSERT INTO makers VALUES (?, ?, 'sr4c', '3-5-3', ?, 'pso', '', '{}', ?, 100, 20, 0, NULL,"
                " 'p', 'v')",
                (maker, f"digest {maker}", coding, code),
            )
            made.execute(
                "INSERT INTO runs VALUES (?, ?, 7, 1, 'ok', 5.0, 1, 1.0, 5.0, 4.7, 'certified', 0.06, 0.06,"
                " 600, x'', '', '', 0.1, 0.2)",
                (maker, maker),
            )
            joints = range(6) if coding == "published" else [-1]
            made.execute(
                "INSERT INTO traces VALUES (?, ?)",
                (maker, packed([Trace(j, [1], [5.0]) for j in joints])),
            )
            made.execute("INSERT INTO plans VALUES (?, ?, ?)", (maker, f"plan {maker}", maker))
        made.execute("INSERT INTO planned VALUES (2, 0, 1, 7), (2, 1, 2, 7)")
        made.execute("UPDATE plans SET used = 9 WHERE id = 2")


def schema_of(folder: Path) -> set[str]:
    with closing(sqlite3.connect(folder / "results.sqlite")) as made:
        assert made.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert made.execute("PRAGMA foreign_key_check").fetchall() == []
        lines = made.execute("SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL").fetchall()
    return {re.sub(r'[\s";]', "", sql) for (sql,) in lines}


def test_the_first_version_is_migrated_as_it_is_opened(tmp_path: Path) -> None:
    of_version_1(tmp_path)
    store = Store(tmp_path)
    papers, equal = store.rows()  # those of the plan
    # each of the six joints had 100 evaluations
    assert (papers.track, papers.budget, papers.coding) == (Track.paper, 600, "published")
    assert (equal.track, equal.budget, equal.coding) == (Track.equal, 100, "stretched")
    assert {row.coordinates for row in store.rows(every=True)} == {Coordinates.printed}
    assert [len(traces) for _, traces in store.traces()] == [6, 1]
    assert len(store.rows(every=True)) == 4
    # what is stored now finds the makers that were migrated
    store.add(graded(load("sr4c"), 4.7, "shared", "random", 0, 30))
    store.close()
    assert Store(tmp_path).rows() == [papers, equal]
    fresh = tmp_path / "fresh"
    fresh.mkdir()
    stored(fresh, 0).close()
    assert schema_of(tmp_path) == schema_of(fresh)


def test_a_migrated_row_is_the_same_run_as_a_new_one(tmp_path: Path) -> None:
    of_version_1(tmp_path)
    store = Store(tmp_path)
    (first, *_) = store.rows()
    store.add_all([(first, dict(store.traces())[first.key])])
    assert len(store.rows(every=True)) == 4


def test_a_migration_that_fails_leaves_the_old_store(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    of_version_1(tmp_path)
    before = schema_of(tmp_path)
    step = migrations.STEPS[1]

    def failing(connection: sqlite3.Connection) -> None:
        step(connection)
        connection.execute("SELECT * FROM missing")

    monkeypatch.setitem(migrations.STEPS, 1, failing)
    with pytest.raises(InputError, match="no such table: missing"):
        Store(tmp_path).rows()
    assert schema_of(tmp_path) == before
    monkeypatch.undo()
    assert len(Store(tmp_path).rows()) == 2


def test_a_newer_store_is_refused_in_one_line(tmp_path: Path) -> None:
    stored(tmp_path, 1).close()
    with closing(sqlite3.connect(tmp_path / "results.sqlite")) as made:
        made.execute(f"PRAGMA user_version = {VERSION + 1}")
    before = (tmp_path / "results.sqlite").read_bytes()
    words = (
        rf"^[^\n]*results\.sqlite: was written by a newer version .*schema {VERSION + 1}.*{VERSION}\)$"
    )
    for _ in range(2):
        with pytest.raises(InputError, match=words):
            Store(tmp_path).rows()
    assert (tmp_path / "results.sqlite").read_bytes() == before


def test_every_version_has_a_step_and_a_changed_table_a_new_version() -> None:
    """A new column of `Row` changes the tables: write a step, raise VERSION, and this text with it."""
    assert sorted(migrations.STEPS) == list(range(1, VERSION))
    columns = len(re.findall(r"^  \"\w+\" ", tables(), re.MULTILINE))
    assert (VERSION, columns) == (2, 30)
