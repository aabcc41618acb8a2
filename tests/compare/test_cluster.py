"""A real Dask cluster on this machine: same answers, nothing lost with a worker, other code refused."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from dask_processes import Processes
from graded_runs import without_times

from compare.benchmark.plan import runs
from compare.benchmark.records.store import Store
from compare.benchmark.run import climb, swarm
from compare.engines import Engine, each, on_cluster, workers
from compare.engines import cluster as module
from formulations import InputError, load

distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def processes(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Processes]:
    with Processes(tmp_path_factory.mktemp("cluster")) as found:
        yield found


def slow_square(x: int) -> int:
    time.sleep(0.2)
    return x * x


def rows_of(engine: Engine, folder: Path) -> list[dict[str, object]]:
    store = Store(folder)
    store.clear()
    problems = {"cobot": load("cobot")}
    climb(engine, problems, store, certify=False)
    planned = runs(problems, swarms=["pso", "whale"], codings=["stretched"], seeds=3, evaluations=200)
    swarm(engine, planned, problems, store)
    return [without_times(row) for row in store.rows()]


def test_rows_are_those_of_one_machine(processes: Processes, tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    (tmp_path / "there").mkdir()
    with workers(2) as engine:
        here = rows_of(engine, tmp_path / "here")
    with on_cluster(processes.address) as engine:
        there = rows_of(engine, tmp_path / "there")
    assert len(here) == 6
    assert there == here


def test_a_worker_with_other_code_is_refused(
    processes: Processes, monkeypatch: pytest.MonkeyPatch
) -> None:
    there = module.environment()
    monkeypatch.setattr(module, "environment", lambda: {**there, "source": "of another day"})
    with pytest.raises(InputError, match=r"has source .*, not of another day"):
        module._same_everywhere({"tcp://127.0.0.1:1": there}, "tcp://127.0.0.1:0")


def test_no_scheduler_is_said_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_PATIENCE", 1.0)
    with (
        pytest.raises(
            InputError, match=r"^--cluster tcp://127\.0\.0\.1:9: no scheduler answers"
        ) as error,
        on_cluster("tcp://127.0.0.1:9"),
    ):
        pass
    assert "\n" not in str(error.value)


def test_nothing_is_lost_with_a_worker(processes: Processes) -> None:
    found = []
    with on_cluster(processes.address) as engine:
        for answer in each(engine, "squares", slow_square, [(x,) for x in range(60)]):
            found.append(answer)
            if len(found) == 15:
                processes.kill(processes.workers[0])
    assert sorted(found) == [x * x for x in range(60)]
