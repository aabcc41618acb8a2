"""The store: what is written comes back to the last bit, once, and what does not fit is named in one line."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands_run import ROOT
from graded_runs import graded, stored, without_times
from hypothesis import given
from hypothesis import strategies as st

from compare.benchmark.grade import Graded, Run, Trace, grade
from compare.benchmark.records.database import runs
from compare.benchmark.records.database.codec import packed, unpacked
from compare.benchmark.records.database.makers import maker_of
from compare.benchmark.records.database.schema import MAKER_COLUMNS, RUN_COLUMNS
from compare.benchmark.records.instances import plain_problem, problem_of
from compare.benchmark.records.rows import COLUMNS, RowStatus, RunKey
from compare.benchmark.records.settings import Settings
from compare.benchmark.records.store import Store
from formulations import CASES, InputError, Problem, load

numbers = st.floats(allow_nan=False)
traces = st.builds(
    lambda joint, points: Trace(joint, [n for n, _ in points], [b for _, b in points]),
    st.integers(-1, 6),
    st.lists(st.tuples(st.integers(0, 2**31 - 1), numbers)),
)


def one(seed: int = 1) -> Graded:
    return graded(load("sr4c"), 4.7, "shared", "random", seed, 30)


def test_rows_and_traces_come_back_as_they_were_written(tmp_path: Path) -> None:
    store = stored(tmp_path, 2)
    rows = store.rows()
    assert [row.seed for row in rows] == [0, 1]
    assert without_times(rows[1]) == without_times(one().row)
    assert dict(store.traces())[one().run.key] == one().traces
    assert [key for key, _ in Store(tmp_path).traces("sr4c")] == [row.key for row in rows]
    assert list(store.traces("ur5")) == []


@given(written=st.lists(traces, max_size=4))
def test_any_traces_come_back(written: list[Trace]) -> None:
    assert unpacked(packed(written)) == written


def test_every_column_of_a_row_has_one_place() -> None:
    assert sorted((*MAKER_COLUMNS, *RUN_COLUMNS, "seed", "machine")) == sorted(COLUMNS)
    assert set(RunKey._fields) <= {*MAKER_COLUMNS, "seed"}


def test_what_a_plan_asks_for_is_what_a_run_writes() -> None:
    problem = load("cobot")
    runs = [Run("cobot", coding, "pso", 3, 60, 20) for coding in ("published", "stretched")]
    for run in (*runs, replace(runs[0], constants=(("w", 0.5),)), replace(runs[0], time_limit=9.0)):
        row = grade(run, problem, 3.3).row
        assert maker_of(run, problem) == {name: getattr(row, name) for name in MAKER_COLUMNS}


@pytest.mark.parametrize("case", CASES)
def test_a_problem_comes_back_from_plain_data(case: str) -> None:
    problem = load(case)
    again = problem_of(plain_problem(problem))
    assert again == problem
    assert again.display_unit == problem.display_unit
    assert (again.limits.position == problem.limits.position).all()


def test_a_problem_without_some_limits_comes_back() -> None:
    limits = {
        "velocity": [1.0, 2.0],
        "acceleration": [np.inf, 3.0],
        "position": [[-np.inf, 2], [-1, np.inf]],
    }
    problem = Problem([[0, 0], [1, 0.1], [0.2, 0.3]], limits, names=["a", "b"], units=["m", "rad"])
    assert problem_of(plain_problem(problem)) == problem


# --- one run, one result --------------------------------------------------------------------------


def test_the_same_result_twice_is_one_row_and_measured_times_do_not_count(tmp_path: Path) -> None:
    store = stored(tmp_path, 2)
    before = store.rows()
    again = one()
    store.add(replace(again, row=replace(again.row, seconds_algorithm=9.0, machine="another")))
    assert store.rows() == before


@pytest.mark.parametrize(
    "change",
    [{"seconds": 5.0}, {"evaluations": 7}, {"durations": (1.0,)}, {"status": RowStatus.raised}],
)
def test_two_results_of_one_run_are_a_contradiction(tmp_path: Path, change: dict[str, object]) -> None:
    store = stored(tmp_path, 2)
    before = store.rows()
    other = replace(one(), row=replace(one().row, **change))
    with pytest.raises(
        InputError, match=rf"two results of one run: sr4c, .*, 1, .*: {next(iter(change))}"
    ):
        store.add(other)
    assert store.rows() == before


def test_two_traces_of_one_run_are_a_contradiction(tmp_path: Path) -> None:
    store = stored(tmp_path, 2)
    with pytest.raises(InputError, match="trace differ"):
        store.add(replace(one(), traces=[Trace(-1, [1], [5.0])]))


def test_how_far_a_swarm_came_in_its_time_is_no_contradiction(tmp_path: Path) -> None:
    store = stored(tmp_path, 2)
    store.add(replace(one(), row=replace(one().row, status=RowStatus.timed_out, evaluations=3)))
    assert store.rows()[1].status is RowStatus.ok


def test_rows_of_code_that_cannot_be_read_are_of_their_own_session(tmp_path: Path) -> None:
    store = stored(tmp_path, 0)
    unread = replace(one(), row=replace(one().row, code=""))
    store.add(unread)
    store.add(unread)
    assert len(store.rows()) == 1
    other = Store(tmp_path)
    other.add(replace(unread, row=replace(unread.row, seconds=5.0)))
    assert len(store.rows()) == 2


# --- files that are no store ----------------------------------------------------------------------


def test_reading_makes_no_file(tmp_path: Path) -> None:
    store = Store(tmp_path)
    assert (store.rows(), dict(store.traces()), store.ladders(), store.audits()) == ([], {}, {}, {})
    with pytest.raises(InputError, match="holds no comparison"):
        store.settings()
    assert list(tmp_path.iterdir()) == []


def test_a_file_of_something_else_is_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "results.sqlite").write_text("a,b\n1,2\n" * 99)
    with pytest.raises(InputError, match=r"results\.sqlite: cannot be read: file is not a database$"):
        Store(tmp_path).rows()
    (tmp_path / "results.sqlite").unlink()
    with sqlite3.connect(tmp_path / "results.sqlite") as other:
        other.execute("CREATE TABLE songs (name TEXT)")
    other.close()
    with pytest.raises(InputError, match=r"is a file of another program$"):
        Store(tmp_path).rows()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("UPDATE runs SET status = 'good'", "random, 0, 30, 20, equal, printed: status: 'good' is not"),
        ("UPDATE runs SET keeps_limits = 7", "keeps_limits: 7 is neither 0 nor 1"),
        ("UPDATE runs SET durations = x'00'", "durations: buffer size"),
        ("UPDATE makers SET track = 'fast'", "track: 'fast' is not"),
    ],
)
def test_a_value_that_does_not_fit_is_named(tmp_path: Path, change: str, words: str) -> None:
    stored(tmp_path, 1).close()
    with sqlite3.connect(tmp_path / "results.sqlite") as other:
        other.execute(change)
    other.close()
    with pytest.raises(InputError, match=words):
        Store(tmp_path).rows()


def test_the_view_shows_every_column_to_other_programs(tmp_path: Path) -> None:
    (row,) = stored(tmp_path, 1).rows()
    with sqlite3.connect(tmp_path / "results.sqlite") as other:
        found = other.execute("SELECT * FROM rows")
        assert tuple(column[0] for column in found.description) == COLUMNS
        shown = dict(zip(COLUMNS, found.fetchone(), strict=True))
    other.close()
    assert (shown["seconds"], shown["machine"]) == (row.seconds, row.machine)


def test_clearing_keeps_what_was_proved_and_nothing_else(tmp_path: Path) -> None:
    store = stored(tmp_path, 2)
    store.write_settings(Settings("quick", ("sr4c",), (0, 1), "30"))
    store.write_csv()
    store.clear()
    assert (store.rows(every=True), store.audits(), store.rows_file.exists()) == ([], {}, False)


# --- two processes --------------------------------------------------------------------------------

_WRITER = """
import sys
from pathlib import Path
from graded_runs import graded
from compare.benchmark.records.store import Store
from formulations import load
store, problem = Store(Path(sys.argv[1])), load("sr4c")
runs = [graded(problem, 4.7, "shared", "random", seed, 30) for seed in range(*map(int, sys.argv[2:]))]
print("ready", flush=True)
sys.stdin.readline()
for one in runs:
    store.add(one)
"""


@pytest.mark.slow
def test_two_processes_write_one_store_at_once(tmp_path: Path) -> None:
    spans = [(0, 60), (40, 100)]
    writers = [
        subprocess.Popen(
            [sys.executable, "-c", _WRITER, str(tmp_path), *map(str, span)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT,
            env={"PYTHONPATH": f"{ROOT}:{ROOT / 'tests'}"},
        )
        for span in spans
    ]  # fmt: skip
    for writer in writers:
        assert writer.stdout is not None
        assert writer.stdout.readline() == "ready\n"
    for writer in writers:  # neither file nor tables are there yet
        assert writer.stdin is not None
        writer.stdin.write("go\n")
        writer.stdin.flush()
    for writer in writers:
        writer.communicate(timeout=120)
        assert writer.returncode == 0
    rows = Store(tmp_path).rows()
    assert sorted(row.seed for row in rows) == list(range(100))
    assert len(dict(Store(tmp_path).traces())) == 100


def test_rows_that_another_process_writes_meanwhile_are_not_half_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A row of a new maker, written while the makers are read, is seen with its maker or not at all."""
    store = stored(tmp_path, 2)
    read = runs.makers

    def and_then_another_writes(connection: sqlite3.Connection) -> dict[int, dict[str, Any]]:
        found = read(connection)
        monkeypatch.setattr(runs, "makers", read)
        with closing(Store(tmp_path)) as other:
            other.add(graded(load("sr4c"), 4.7, "shared", "pso", 0, 30))
        return found

    monkeypatch.setattr(runs, "makers", and_then_another_writes)
    assert len(store.rows(every=True)) == 2
    assert len(store.rows(every=True)) == 3
