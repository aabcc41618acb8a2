"""Folders merged: what one comparison would have given, and a refusal of what none could give."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from graded_runs import without_times
from hypothesis import given
from hypothesis import strategies as st

from compare.__main__ import main
from compare.benchmark import run as run_module
from compare.benchmark.plan import runs
from compare.benchmark.records.merge import merge
from compare.benchmark.records.settings import Settings, budget_words
from compare.benchmark.records.store import Store
from compare.benchmark.run import climb, swarm, tabulate_known_times
from compare.commands.benchmark.seeds import listed_seeds
from formulations import InputError, Problem, load


@pytest.fixture
def pool() -> Iterator[Executor]:
    with ThreadPoolExecutor(1) as threads:
        yield threads


@pytest.fixture(autouse=True)
def quick_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Bounds that need no solver: as each folder would find them, but for the runtimes."""
    seconds = {"cobot": 3.3, "sr4c": 4.7}

    def record(case: str, problem: Problem, certify: bool) -> tuple[str, Any]:
        rung = {"seconds": seconds[case], "kind": "upper", "status": "ok", "certified": False,
                "runtime": 0.1, "note": ""}  # fmt: skip
        rungs = {"family": rung, "family_lower": {**rung, "seconds": None}}
        return case, {"problem": case, "durations": {}, "versions": {}, "ladder": rungs}

    monkeypatch.setattr(run_module, "_ladder", record)


def compared(
    pool: Executor,
    folder: Path,
    *,
    cases: Sequence[str] = ("cobot", "sr4c"),
    swarms: Sequence[str] = ("random", "pso"),
    seeds: Sequence[int] = range(4),
    budget: int = 60,
) -> Store:
    """A small comparison, as ``timebound all`` makes it."""
    folder.mkdir()
    store = Store(folder)
    store.clear()
    problems = {case: load(case) for case in cases}
    planned = runs(problems, swarms=swarms, seeds=seeds, evaluations=budget)
    budgets = sorted({run.budget for run in planned})
    store.write_settings(Settings("default", tuple(cases), tuple(seeds), budget_words(budgets)))
    climb(pool, problems, store)
    swarm(pool, planned, problems, store)
    tabulate_known_times(pool, problems, store)
    store.close()
    return store


def contents(store: Store) -> tuple[Any, ...]:
    """All that a report is made of, measured times aside."""
    return (
        [without_times(row) for row in store.rows()],
        list(store.traces()),
        store.settings(),
        store.ladders(),
        store.known_times(),
        store.problems(),
        list(store.problems()),
    )


SPLITS: dict[str, list[dict[str, Any]]] = {
    "seeds": [{"seeds": [0, 1]}, {"seeds": [2, 3]}],
    "interleaved seeds": [{"seeds": [1, 3]}, {"seeds": [0, 2]}],
    "seeds that overlap": [{"seeds": [0, 1, 2]}, {"seeds": [1, 2, 3]}],
    "swarms": [{"swarms": ["random"]}, {"swarms": ["pso"]}],
    "cases": [{"cases": ["cobot"]}, {"cases": ["sr4c"]}],
    "three folders": [{"seeds": [0]}, {"seeds": [1]}, {"seeds": [2, 3]}],
}


@pytest.mark.parametrize("split", SPLITS)
def test_folders_merge_into_what_one_run_would_have_given(
    pool: Executor, tmp_path: Path, split: str, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = compared(pool, tmp_path / "whole")
    parts = [compared(pool, tmp_path / str(k), **part).folder for k, part in enumerate(SPLITS[split])]
    target = tmp_path / "merged"
    capsys.readouterr()
    assert main(["merge", *map(str, parts), "--out", str(target)]) == 0
    assert capsys.readouterr().out == f"merged: {target / 'results.sqlite'} (64 rows)\n"
    merged = Store(target)
    assert contents(merged) == contents(whole)
    times = [(row.key, row.seconds) for row in whole.rows()]
    assert [(row.key, row.seconds) for row in merged.rows()] == times
    # all that is there is there: nothing is computed again
    merged.write_plan(
        runs(
            {c: load(c) for c in ("cobot", "sr4c")}, swarms=["random", "pso"], seeds=4, evaluations=60
        ),
        {c: load(c) for c in ("cobot", "sr4c")},
    )
    assert merged.left() == []
    assert len((target / "rows.csv").read_text().splitlines()) == 65


def test_a_folder_can_take_in_another_one(pool: Executor, tmp_path: Path) -> None:
    whole = compared(pool, tmp_path / "whole")
    first = compared(pool, tmp_path / "first", seeds=[0, 1])
    second = compared(pool, tmp_path / "second", seeds=[2, 3])
    for _ in range(2):  # a second time changes nothing
        assert main(["merge", str(first.folder), str(second.folder)]) == 0
        assert contents(Store(first.folder)) == contents(whole)
    assert len(second.rows()) == 32


def test_proofs_come_along(pool: Executor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = compared(pool, tmp_path / "a", cases=["cobot"], seeds=[0])
    second = compared(pool, tmp_path / "b", cases=["sr4c"], seeds=[0])
    merged = merge([first.folder, second.folder], tmp_path / "a")
    monkeypatch.setattr(run_module, "_ladder", None)
    merged.clear()
    climb(pool, {case: load(case) for case in ("cobot", "sr4c")}, merged)
    assert set(merged.ladders()) == {"cobot", "sr4c"}


def tampered(store: Store, change: str) -> None:
    store.close()
    with closing(sqlite3.connect(store.file)) as other, other:
        other.execute(change)


PLANTED = {
    "two results": ("UPDATE runs SET evaluations = 1", [0], "two results of one run: cobot"),
    "two codes": ("UPDATE makers SET code = 'abc'", [1], "two versions of the swarm's code cannot be pooled"),
    "two budgets": ("UPDATE makers SET budget = 61", [1], "two budgets cannot be pooled: .* and 61"),
    "two versions": ("UPDATE makers SET versions = 'python=2'", [1], "two versions of the programs"),
    "two parameters": ("UPDATE makers SET parameters = '{}'", [1], "two sets of parameters"),
    "two problems": ("UPDATE makers SET problem = 'abc'", [1], "results of two problems"),
    "two machines": ("UPDATE machines SET machine = 'other'", [1], "two machines cannot .* and other"),
}  # fmt: skip


@pytest.mark.parametrize("plant", PLANTED)
def test_what_no_single_run_could_give_is_refused_and_nothing_is_changed(
    pool: Executor, tmp_path: Path, plant: str, capsys: pytest.CaptureFixture[str]
) -> None:
    change, seeds, words = PLANTED[plant]
    first = compared(pool, tmp_path / "a", cases=["cobot"], swarms=["pso"], seeds=[0])
    second = compared(pool, tmp_path / "b", cases=["cobot"], swarms=["pso"], seeds=seeds)
    tampered(second, change)
    before = contents(first)
    for target in ("a", "new"):
        with pytest.raises(InputError, match=words):
            merge([tmp_path / "a", tmp_path / "b"], tmp_path / target)
        (tmp_path / "new").mkdir(exist_ok=True)
    assert contents(Store(tmp_path / "a")) == before
    assert list((tmp_path / "new").iterdir()) == []
    capsys.readouterr()
    assert main(["merge", str(tmp_path / "a"), str(tmp_path / "b")]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_machines_are_pooled_where_that_is_allowed_by_name(pool: Executor, tmp_path: Path) -> None:
    first = compared(pool, tmp_path / "a", cases=["cobot"], swarms=["pso"], seeds=[0])
    second = compared(pool, tmp_path / "b", cases=["cobot"], swarms=["pso"], seeds=[1])
    tampered(second, "UPDATE machines SET machine = 'other'")
    assert main(["merge", str(first.folder), str(second.folder), "--machines"]) == 0
    merged = Store(first.folder)
    assert {row.machine for row in merged.rows()} > {"other"}
    assert merged.settings().allow == ("machine",)  # the report says so, and is drawn


def test_folders_without_results_are_named(tmp_path: Path, pool: Executor) -> None:
    first = compared(pool, tmp_path / "a", cases=["cobot"], swarms=["pso"], seeds=[0])
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="empty: holds no comparison"):
        merge([first.folder, tmp_path / "empty"], tmp_path / "new")
    other = compared(pool, tmp_path / "b", cases=["cobot"], swarms=["pso"], seeds=[1])
    with pytest.raises(InputError, match="is there already"):
        merge([first.folder], other.folder)


# --- seeds ----------------------------------------------------------------------------------------


@given(seeds=st.sets(st.integers(0, 40), min_size=1))
def test_seeds_are_told_and_read(seeds: set[int]) -> None:
    settings = Settings("default", (), tuple(sorted(seeds)), "")
    text = settings.seeds_text.replace(" to ", "-")
    assert listed_seeds(text + ",") == settings.seeds


@pytest.mark.parametrize(
    ("text", "seeds"),
    [
        ("3", (0, 1, 2)),
        ("10-12", (10, 11, 12)),
        ("3,5,8", (3, 5, 8)),
        ("8, 0-2 ,1", (0, 1, 2, 8)),
        ("7,", (7,)),
    ],
)
def test_choices_of_seeds(text: str, seeds: tuple[int, ...]) -> None:
    assert listed_seeds(text) == seeds


@pytest.mark.parametrize("text", ["0", "-3", "5-3", "a", "1-", "-", ",", "1.5", "1-2-3", ""])
def test_no_choice_of_seeds(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["all", f"--seeds={text}"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: --seeds: ")
