"""``kill -9`` at random moments of a comparison, resumed each time: the rows are those of an unbroken one.

Nine kills by default: three with one worker, with two, and with the workers of a Dask cluster, one of which is
killed now and then too. ``TIMEBOUND_KILLS=100 pytest tests/compare/benchmark/test_kills.py`` makes a hundred.
"""

from __future__ import annotations

import contextlib
import csv
import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

import pytest
from commands_run import ROOT
from dask_processes import Processes
from graded_runs import without_times

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.plan import runs
from compare.benchmark.records.rows import COLUMNS, TIMING_COLUMNS
from compare.benchmark.records.store import Store
from compare.benchmark.run import swarm
from compare.engines import Engine, ThisProcess, on_cluster, workers
from formulations import load

KILLS = int(os.environ.get("TIMEBOUND_KILLS", "9"))
PROBLEMS = {"cobot": load("cobot")}
PLAN = runs(PROBLEMS, swarms=["pso", "whale"], seeds=60, evaluations=1500)


def compared(folder: Path, engine: str) -> None:
    """The comparison, as ``timebound all --resume`` makes it, but for bounds and pictures."""
    store = Store(folder)
    rung = {
        "seconds": 3.3,
        "kind": "upper",
        "status": "ok",
        "certified": False,
        "runtime": 0.1,
        "note": "",
    }
    rungs = {"family": rung, "family_lower": {**rung, "seconds": None}}
    ladder: Any = {"problem": "cobot", "durations": {}, "versions": {}, "ladder": rungs}
    known: LadderRecord = ladder
    store.write_ladder("cobot", known)
    with engine_of(engine) as pool:
        swarm(pool, PLAN, PROBLEMS, store)
    store.close()


def engine_of(text: str) -> AbstractContextManager[Engine]:
    """Nothing: this process; a number of workers; or the address of a cluster."""
    if not text:
        return nullcontext(ThisProcess())
    return workers(int(text)) if text.isdigit() else on_cluster(text)


@pytest.fixture(scope="module")
def unbroken(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    folder = tmp_path_factory.mktemp("unbroken")
    compared(folder, "")
    return contents(folder)


def contents(folder: Path) -> list[dict[str, Any]]:
    """Rows with their traces, measured times aside; the table beside the store holds the same rows."""
    store = Store(folder)
    rows, traces = store.rows(), dict(store.traces())
    with store.rows_file.open(encoding="utf-8", newline="") as lines:
        table = list(csv.DictReader(lines))
    assert [tuple(line[name] for name in COLUMNS) for line in table] == [
        tuple(row.to_cells()) for row in rows
    ]
    store.close()
    return [without_times(row) | {"traces": traces.pop(row.key)} for row in rows]


def holds(folder: Path, unbroken: list[dict[str, Any]]) -> int:
    """How many runs a killed comparison has left; each is whole, and as it must be."""
    if not (folder / "results.sqlite").exists():
        return 0
    with contextlib.closing(sqlite3.connect(folder / "results.sqlite")) as made:
        assert made.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
    store = Store(folder)
    rows, traces = store.rows(), dict(store.traces())
    store.close()
    expected = {(row["coding"], row["track"], row["swarm"], row["seed"]): row for row in unbroken}
    for row in rows:
        known = expected[row.coding, row.track, row.swarm, row.seed]
        assert without_times(row) | {"traces": traces[row.key]} == known
    assert len(traces) == len(rows)
    return len(rows)


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="kills a group of processes")
@pytest.mark.parametrize("engine", ["1", "2", "cluster"])
def test_killed_at_random_moments_and_resumed(
    engine: str, unbroken: list[dict[str, Any]], tmp_path: Path
) -> None:
    with nullcontext() if engine != "cluster" else Processes(tmp_path) as cluster:
        killed_and_resumed(engine, unbroken, tmp_path, cluster)


def killed_and_resumed(
    engine: str, unbroken: list[dict[str, Any]], tmp_path: Path, cluster: Processes | None
) -> None:
    assert len(unbroken) == len(PLAN) == 480
    assert "traces" not in TIMING_COLUMNS
    chance = random.Random(engine)
    where = engine if cluster is None else cluster.address
    kills, finished, moments = 0, 0, []
    while kills < KILLS // 3:
        folder = tmp_path / f"results-{finished}"
        folder.mkdir(exist_ok=True)
        before = holds(folder, unbroken)
        process = start(folder, where)
        if chance.random() < 0.8:  # while runs are written; else wherever it is
            wait_for_a_run(process, folder, before)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(chance.uniform(0.0, 2.0))
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            kills += 1
            moments.append(holds(folder, unbroken) - before)
            if cluster is not None and chance.random() < 0.5:
                cluster.replace_worker()
        else:
            assert process.returncode == 0
            assert contents(folder) == unbroken
            finished += 1
    process = start(folder, where)
    assert process.wait(300) == 0
    assert contents(folder) == unbroken
    print(
        f"{kills} kills, engine {engine}: runs written before each: {moments}; {finished + 1} finished"
    )


def wait_for_a_run(process: subprocess.Popen[bytes], folder: Path, before: int) -> None:
    """Wait until the comparison has written a run, or has ended."""
    while process.poll() is None:
        with (
            contextlib.suppress(sqlite3.OperationalError),  # no file yet, or no table
            contextlib.closing(
                sqlite3.connect(f"file:{folder}/results.sqlite?mode=ro", uri=True)
            ) as made,
        ):
            if made.execute("SELECT count(*) FROM runs").fetchone()[0] > before:
                return
        time.sleep(0.02)


def start(folder: Path, engine: str) -> subprocess.Popen[bytes]:
    """The comparison in a group of processes of its own."""
    paths = os.pathsep.join(map(str, (ROOT, ROOT / "tests", Path(__file__).parent)))
    return subprocess.Popen(
        [sys.executable, __file__, str(folder), engine],
        cwd=ROOT, env={**os.environ, "PYTHONPATH": paths}, start_new_session=True,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip


if __name__ == "__main__":
    compared(Path(sys.argv[1]), sys.argv[2])
