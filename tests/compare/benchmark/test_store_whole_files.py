"""Files of the store are written whole or not at all, whatever interrupts the writing."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Any

import pytest
from graded_runs import stored

from compare.benchmark import store as store_module


class Killed(BaseException):
    """Stands for a kill: nothing in the program catches it."""


@pytest.mark.parametrize("after", range(8))
def test_no_row_and_no_trace_is_lost_when_mend_is_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, after: int
) -> None:
    store = stored(tmp_path, 10)
    rows, traces = store.rows(), store.traces()
    left = [after]

    def dying(real: Any) -> Any:
        def call(*args: Any, **kwargs: Any) -> Any:
            if left[0] == 0:
                raise Killed
            left[0] -= 1
            return real(*args, **kwargs)

        return call

    # every call that changes a file on disk counts as one step
    monkeypatch.setattr(os, "write", dying(os.write))
    monkeypatch.setattr(os, "replace", dying(os.replace))
    monkeypatch.setattr(Path, "write_text", dying(Path.write_text))
    if hasattr(store_module, "_append"):
        monkeypatch.setattr(store_module, "_append", dying(store_module._append))
    with contextlib.suppress(Killed):
        store.mend()
    monkeypatch.undo()
    assert store.rows() == rows
    assert store.traces() == traces
