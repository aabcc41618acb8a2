"""Running a comparison: bounds as they were asked for."""

from __future__ import annotations

from pathlib import Path

from compare.benchmark.records.rows import BoundProof
from compare.benchmark.records.store import Store
from compare.benchmark.run import climb
from compare.benchmark.summaries import bound_of
from compare.engines import workers
from formulations import load


def test_a_bound_that_is_not_asked_for_is_not_proved(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.clear()
    with workers(1) as engine:
        climb(engine, {"cobot": load("cobot")}, store, certify=False)
    ladder = store.ladders()["cobot"]
    assert ladder["ladder"]["family_lower"]["status"] == "not-applicable"
    assert ladder["ladder"]["family_lower"]["note"] == "not asked for"
    assert bound_of(ladder)[1] is BoundProof.local_optimum
