"""What a swarm in a process of its own can see and do: ask for points, and nothing else."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import hostile
import intruders
import numpy as np
import pytest
from loops import HI, LO, Recorder, bowl

from metaheuristics import (
    ALGORITHMS,
    Result,
    Status,
    TaskError,
    UnknownAlgorithmError,
    algorithm,
    apart,
    minimise,
)
from metaheuristics.driver.task import Moves, Search, Task

pytestmark = pytest.mark.filterwarnings("error")


@pytest.fixture(autouse=True)
def _no_mark() -> Iterator[None]:
    intruders.MARK.unlink(missing_ok=True)
    yield
    intruders.MARK.unlink(missing_ok=True)


def run(
    search: Search, f: Any = bowl, *, budget: int = 20, seconds: float = 30.0, **parameters: Any
) -> Result:
    return minimise(apart(search, seconds=seconds), f, LO, HI, budget=budget, seed=1, **parameters)


def test_in_this_process_a_swarm_can_steal_the_objective_and_apart_it_cannot() -> None:
    f = Recorder(bowl)
    here = minimise(intruders.thief, f, LO, HI, budget=20, seed=1)
    assert (here.status, here.evaluations, here.isolated) == (Status.ok, 20, False)
    assert len(f.values) > 1000, "the thief of the test steals nothing"

    for many, status in ((1000, Status.bad_message), (5, Status.over_budget)):
        g = Recorder(bowl)
        there = run(intruders.thief, g, many=many)
        assert (there.status, there.isolated) == (status, True)
        assert there.evaluations == len(g.values) <= 20
        assert there.fitness == min(g.values, default=np.inf)


def test_it_sees_nothing_of_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SECRET", "of the user")
    monkeypatch.setattr(sys, "argv", ["compare.all", "--out", "report"])
    result = run(intruders.spy)
    assert (result.status, result.note) == (Status.ok, "")


def test_its_folder_goes_with_it() -> None:
    result = run(intruders.litterer)
    assert result.status is Status.raised
    folder = Path(result.note.removeprefix("RuntimeError: "))
    assert folder.name.startswith("timebound-")
    assert not folder.exists()


def test_its_prints_reach_nobody(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(intruders.printer).status is Status.ok
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("what", intruders.WORDS)
def test_what_is_no_message_is_a_status(what: str) -> None:
    f = Recorder(bowl)
    result = run(intruders.forger, f, what=what)
    assert result.status is Status.bad_message
    assert "its process sent" in result.note
    assert result.evaluations == len(f.values) == 4
    assert not intruders.MARK.exists(), "something was unpickled"


def test_points_are_checked_on_this_side_too() -> None:
    f = Recorder(bowl)
    result = run(intruders.drifter, f)
    assert (result.status, result.evaluations) == (Status.out_of_box, 4)
    assert len(f.values) == 4


def test_evaluations_past_the_count_of_its_process_are_counted_here() -> None:
    for budget, evaluations, status in (
        (20, 4, Status.bad_message),  # a hundred points are more than its budget
        (500, 500, Status.over_budget),
        (5000, 1004, Status.stopped_early),
    ):
        f = Recorder(bowl)
        result = run(intruders.honeyed, f, budget=budget)
        assert result.status is status
        assert result.evaluations == len(f.values) == evaluations


@pytest.mark.parametrize("search", [intruders.hesitant, intruders.runaway, intruders.parent])
def test_the_time_limit_holds_whatever_holds_the_channel(search: Search) -> None:
    started = time.monotonic()
    result = run(search, seconds=0.5)
    assert result.status is Status.timed_out
    assert time.monotonic() - started < 20.0
    if search is intruders.parent:
        time.sleep(2.5)
        assert not intruders.MARK.exists(), "a process that it started goes on"


def test_a_closed_channel_is_an_exit() -> None:
    result = run(intruders.hanger_up)
    assert (result.status, result.note) == (Status.exited, "its process closed its channel")


def test_a_process_that_was_ended_says_by_what() -> None:
    result = run(hostile.aborter)
    assert (result.status, result.note) == (Status.exited, "its process was ended by SIGABRT")


def test_what_is_not_found_there_is_a_status(tmp_path: Path) -> None:
    """A script's own functions are found; what exists in this process alone is not."""
    script = tmp_path / "script.py"
    script.write_text(
        "from metaheuristics import apart, minimise\n"
        "def swarm(task, *, population=3):\n"
        "    while True:\n"
        "        yield task.sample(population)\n"
        "if __name__ == '__main__':\n"
        "    f = lambda x: (x**2).sum(1)\n"
        "    found = minimise(apart(swarm, seconds=30.0), f, [-1], [1], budget=9, seed=0)\n"
        "    swarm.__qualname__ = swarm.__name__ = 'nothing'\n"
        "    globals()['nothing'] = swarm\n"
        "    lost = minimise(apart(swarm, seconds=30.0), f, [-1], [1], budget=9, seed=0)\n"
        "    print(found.status, found.evaluations, lost.status, lost.note)\n"
    )
    root = Path(__file__).resolve().parents[3]
    done = subprocess.run(
        [sys.executable, script],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": str(root)},
    )
    assert done.stdout == "ok 9 raised cannot be loaded: KeyError: 'nothing'\n"


def test_a_time_limit_is_positive() -> None:
    for seconds in (0.0, -1.0, np.nan):
        with pytest.raises(TaskError, match="positive"):
            apart(hostile.honest, seconds=seconds)


# ---------------------------------------------------------------------------------------- by default


def plug_in(folder: Path, text: str) -> None:
    (folder / "mine.py").write_text("from pathlib import Path\n" + text)


SWARM = """
def swarm(task, *, population=7, name="x", strange=Path()):
    while True:
        yield task.sample(population)
"""


def test_a_plug_in_is_described_and_run_without_being_imported_here(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    plug_in(tmp_path, SWARM)
    entry = algorithm("mine:swarm")
    assert not entry.trusted
    assert entry.parameters == {"population": 7, "name": "x"}
    f = Recorder(bowl)
    result = minimise(entry.search(), f, LO, HI, budget=20, seed=0, **entry.parameters)
    assert (result.status, result.isolated) == (Status.ok, True)
    assert [len(x) for x in f.batches] == [7, 7, 6]
    assert "mine" not in sys.modules
    with pytest.raises(TypeError, match="wings"):
        minimise(entry.search(), bowl, LO, HI, budget=20, seed=0, wings=2)


def test_a_time_limit_of_the_callers_own_goes_first() -> None:
    entry = algorithm("hostile:sleeper")
    result = minimise(entry.search(0.3), bowl, LO, HI, budget=20, seed=0)
    assert (result.status, result.isolated) == (Status.timed_out, True)
    assert "0.3 s" in result.note


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("raise SystemExit(3)", "SystemExit: 3"),
        ("raise KeyboardInterrupt", "KeyboardInterrupt"),
        ("raise ValueError('\\ud800')", "ValueError"),
        ("import os; os._exit(3)", "exit code 3"),
        ("swarm = 3", "cannot be called"),
        ("class swarm:\n  def __getattr__(self, name): 1 / 0\nswarm = swarm()", "cannot be called"),
    ],
)
def test_a_module_that_misbehaves_as_it_loads_is_not_known(
    text: str, word: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    plug_in(tmp_path, text)
    with pytest.raises(UnknownAlgorithmError) as caught:
        algorithm("mine:swarm")
    assert word in str(caught.value)
    assert str(caught.value).isprintable()


def test_what_is_trusted_runs_here_unless_a_limit_is_given() -> None:
    for entry in ALGORITHMS.values():
        assert entry.trusted
        assert entry.search() is entry.function
    result = minimise(ALGORITHMS["pso"].search(30.0), bowl, LO, HI, budget=20, seed=0)
    assert (result.status, result.isolated) == (Status.ok, True)


def test_a_swarm_cannot_call_itself_isolated() -> None:
    class Posing:
        isolated = True

        def __call__(self, task: Task) -> Moves:
            yield from hostile.honest(task)

    result = minimise(Posing(), bowl, LO, HI, budget=20, seed=0)
    assert (result.status, result.isolated) == (Status.ok, False)


def test_the_words_of_a_status_are_plain() -> None:
    assert json.loads(json.dumps(list(Status))) == [status.value for status in Status]
