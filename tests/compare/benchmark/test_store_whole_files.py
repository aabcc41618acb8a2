"""Files of the store are written whole or not at all, whatever interrupts the writing."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Any

import pytest
from graded_runs import stored

from compare.benchmark.records import store as store_module


class Killed(BaseException):
    """Stands for a kill: nothing in the program catches it."""


class Steps:
    """Kills the program after so many calls that change a file on disk."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, left: int) -> None:
        self.left = left
        monkeypatch.setattr(os, "write", self.dying(os.write))
        monkeypatch.setattr(os, "replace", self.dying(os.replace))
        monkeypatch.setattr(Path, "write_text", self.dying(Path.write_text))
        monkeypatch.setattr(store_module, "_append", self.dying(store_module._append))

    def dying(self, real: Any) -> Any:
        def call(*args: Any, **kwargs: Any) -> Any:
            if self.left == 0:
                raise Killed
            self.left -= 1
            return real(*args, **kwargs)

        return call


@pytest.mark.parametrize("after", range(8))
def test_no_row_and_no_trace_is_lost_when_mend_is_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, after: int
) -> None:
    store = stored(tmp_path, 10)
    rows, traces = store.rows(), store.traces()
    Steps(monkeypatch, after)
    with contextlib.suppress(Killed):
        store.mend()
    monkeypatch.undo()
    assert store.rows() == rows
    assert store.traces() == traces


@pytest.mark.parametrize("after", range(4))
def test_no_row_is_lost_when_rows_are_set_aside_and_that_is_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, after: int
) -> None:
    store = stored(tmp_path, 6)
    rows = store.rows()
    Steps(monkeypatch, after)
    with contextlib.suppress(Killed):
        store.keep(rows[:4])
    monkeypatch.undo()
    found = store.rows()
    assert found in (rows, rows[:4])
    assert {row.key for row in [*found, *store.set_aside()]} == {row.key for row in rows}
    assert set(store.traces()) >= {row.key for row in found}
    store.keep(rows[:4])  # once more, to the end
    assert store.rows() == rows[:4]
    assert store.set_aside() == rows[4:]
    assert set(store.traces()) == {row.key for row in rows[:4]}


def test_what_was_written_is_on_the_disk_before_it_has_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = stored(tmp_path, 1)
    order: list[str] = []
    for name in ("fsync", "replace"):
        real = getattr(os, name)
        monkeypatch.setattr(
            os, name, lambda *a, name=name, real=real: (order.append(name), real(*a))[1]
        )
    store.mend()
    assert order == ["fsync", "replace"] * 2
