"""Plug-ins are graded in a process of their own, which does not know where the results are stored."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from compare.benchmark.grade import Run, grade
from compare.benchmark.records.rows import RowStatus
from compare.benchmark.records.store import Store
from compare.benchmark.run import climb, swarm
from compare.engines import workers
from formulations import load
from metaheuristics.entry import TIME_LIMIT

SPY = """
import json, os, sys

def swarm(task, *, population=4):
    yield task.sample(population)
    seen = {"argv": sys.argv, "environment": dict(os.environ), "process": os.getpid()}
    raise RuntimeError(json.dumps(seen))
"""


@pytest.fixture
def spy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    (tmp_path / "plugged").mkdir()
    (tmp_path / "plugged" / "spying.py").write_text(SPY)
    monkeypatch.chdir(tmp_path / "plugged")
    return "spying:swarm"


def test_a_plug_in_runs_apart_unless_it_is_asked(spy: str) -> None:
    problem = load("cobot")
    row = grade(Run("cobot", "shared", spy, 0, 40, 4), problem, 3.3496).row
    assert (row.isolated, row.time_limit, row.status) == (True, TIME_LIMIT, RowStatus.raised)
    assert len(row.code) == 12
    assert json.loads(row.parameters) == {"population": 4}
    row = grade(Run("cobot", "shared", spy, 0, 40, 4, 7.0), problem, 3.3496).row
    assert (row.isolated, row.time_limit) == (True, 7.0)


def test_a_swarm_of_the_house_runs_here_unless_it_is_given_a_time_limit() -> None:
    problem = load("cobot")
    row = grade(Run("cobot", "shared", "pso", 0, 40, 4), problem, 3.3496).row
    assert (row.isolated, row.time_limit) == (False, None)


@pytest.mark.slow
def test_the_process_of_a_plug_in_has_no_path_to_the_store(
    spy: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "the-place-of-the-results"
    folder.mkdir()
    # as ``compare.all --out FOLDER`` would have it
    monkeypatch.setattr("sys.argv", ["compare.all", "--out", str(folder)])
    store = Store(folder)
    store.clear()
    problems = {"cobot": load("cobot")}
    with workers(1) as pool:
        climb(pool, problems, store, certify=False)
        swarm(pool, [Run("cobot", "shared", spy, 0, 40, 4)], problems, store)
    (row,) = store.rows()
    assert row.status is RowStatus.raised
    assert '"argv"' in row.note
    assert folder.name not in row.note
