"""Rows and traces on disk: they come back as they were written, and a broken file is named."""

from __future__ import annotations

from pathlib import Path

import pytest
from graded_runs import graded, stored, without_times

from compare.benchmark.records.rows import COLUMNS
from compare.benchmark.records.store import Store
from formulations import InputError, load


def test_rows_come_back_as_they_were_written(tmp_path: Path) -> None:
    store = stored(tmp_path, 2)
    rows = store.rows()
    assert [row.seed for row in rows] == [0, 1]
    original = graded(load("sr4c"), 4.7, "shared", "random", 1, 30).row
    assert without_times(rows[1]) == without_times(original)
    assert set(store.traces()) == {row.key for row in rows}


def test_a_row_cut_short_by_a_crash_is_passed_over_and_the_rest_kept(tmp_path: Path) -> None:
    store = stored(tmp_path, 3)
    for path in (store.rows_file, store.traces_file):
        path.write_bytes(path.read_bytes()[:-20])
    assert len(store.rows()) == 2
    store.mend()
    assert len(store.rows()) == 2
    assert store.rows_file.read_text().endswith("\n")


def test_a_table_of_something_else_is_refused_in_one_line(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.rows_file.write_text("a,b\n1,2\n")
    with pytest.raises(InputError, match="not a table of this version"):
        store.rows()
    store.rows_file.write_text(",".join(COLUMNS) + "\n" + ",".join(["x"] * len(COLUMNS)) + "\n")
    with pytest.raises(InputError, match="line 2"):
        store.rows()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_a_full_disk_is_one_line(tmp_path: Path) -> None:
    store = stored(tmp_path, 1)
    store.rows_file.unlink()
    store.rows_file.symlink_to("/dev/full")
    with pytest.raises(InputError, match=r"rows\.csv: cannot be written: .*[Nn]o space"):
        store.add(graded(load("sr4c"), 4.7, "shared", "random", 9, 30))
