"""Running a comparison: bounds as they were asked for, workers with one thread each."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from compare.benchmark.records.rows import BoundProof
from compare.benchmark.records.store import Store
from compare.benchmark.run import climb, workers
from compare.benchmark.statistics import bound_of
from formulations import load


def test_a_bound_that_is_not_asked_for_is_not_proved(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.clear()
    with ThreadPoolExecutor(1) as pool:
        climb(pool, {"cobot": load("cobot")}, store, certify=False)
    ladder = store.ladders()["cobot"]
    assert ladder["ladder"]["family_lower"]["status"] == "not-applicable"
    assert ladder["ladder"]["family_lower"]["note"] == "not asked for"
    assert bound_of(ladder)[1] is BoundProof.local_optimum


def test_workers_are_the_only_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")  # somebody's own choice
    with workers(1) as pool:
        found = list(pool.map(os.getenv, ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")))
    assert found == ["1", "3"]
    assert "OMP_NUM_THREADS" not in os.environ
