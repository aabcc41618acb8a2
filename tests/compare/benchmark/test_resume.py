"""Resuming: a stored row counts only if the present plan would make the same one."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest
from graded_runs import without_times

from compare.benchmark.grade import Run
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.plan import runs
from compare.benchmark.records import provenance
from compare.benchmark.records.provenance import code_digest
from compare.benchmark.records.rows import csv_text
from compare.benchmark.records.store import Store
from compare.benchmark.run import swarm
from compare.benchmark.statistics import summaries
from formulations import load

PROBLEMS = {"cobot": load("cobot")}


def ladder_record(family: float) -> LadderRecord:
    def rung(seconds: float | None) -> dict[str, object]:
        return {"seconds": seconds, "kind": "upper", "status": "ok", "certified": False,
                "runtime": 0.0, "note": ""}  # fmt: skip

    return {  # type: ignore[typeddict-item]
        "problem": "cobot", "durations": {}, "versions": {},
        "ladder": {"family": rung(family), "family_lower": rung(None)},
    }  # fmt: skip


@pytest.fixture
def pool() -> Iterator[Executor]:
    with ThreadPoolExecutor(1) as threads:
        yield threads


@pytest.fixture
def store(tmp_path: Path) -> Store:
    made = Store(tmp_path)
    made.clear()
    made.write_ladder("cobot", ladder_record(3.3496))
    return made


def plan(swarms: tuple[str, ...] = ("pso",), seeds: int = 4, evaluations: int = 60) -> list[Run]:
    return runs(PROBLEMS, swarms=list(swarms), codings=["shared"], seeds=seeds, evaluations=evaluations)


def fresh(pool: Executor, folder: Path, runs: list[Run]) -> list[dict[str, object]]:
    """The rows of these runs in a folder of their own."""
    folder.mkdir()
    clean = Store(folder)
    clean.clear()
    clean.write_ladder("cobot", ladder_record(3.3496))
    swarm(pool, runs, PROBLEMS, clean)
    return [without_times(row) for row in clean.rows()]


def test_another_budget_does_not_enter_the_medians(
    pool: Executor, store: Store, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    swarm(pool, plan(evaluations=600), PROBLEMS, store)
    capsys.readouterr()
    swarm(pool, plan(evaluations=60), PROBLEMS, store)
    rows = store.rows()
    assert [row.budget for row in rows] == [60] * 4
    assert [without_times(row) for row in rows] == fresh(pool, tmp_path / "fresh", plan())
    told = [line for line in capsys.readouterr().err.splitlines() if line.startswith("resume:")]
    assert told == [
        "resume: 0 of 4 stored rows fit the plan; 4 do not and are set aside in rows-set-aside.csv"
        " (4 with another budget)"
    ]
    assert [row.budget for row in store.set_aside()] == [600] * 4
    assert set(store.traces()) == {row.key for row in rows}


def test_fewer_seeds_and_swarms_leave_the_others_out(
    pool: Executor, store: Store, capsys: pytest.CaptureFixture[str]
) -> None:
    swarm(pool, plan(("pso", "random")), PROBLEMS, store)
    capsys.readouterr()
    swarm(pool, plan(seeds=3), PROBLEMS, store)
    rows = store.rows()
    assert [(row.swarm, row.seed) for row in rows] == [("pso", 0), ("pso", 1), ("pso", 2)]
    assert summaries(rows)["cobot", "shared", "pso"].seeds == 3
    told = capsys.readouterr().err
    assert "3 of 8 stored rows fit the plan" in told
    assert "4 with a case, coding or swarm that is not asked for" in told
    assert "1 with a seed that is not asked for" in told


@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("code", "0" * 12, "other code of the swarm"),
        ("code", "", "other code of the swarm"),
        ("parameters", '{"population": 50, "w": 0.5}', "other parameters of the swarm"),
        ("library", "cmaes=0.0", "another version of the swarm's library"),
        ("versions", "python=3.0", "other versions of the programs"),
        ("problem", "0" * 12, "another problem"),
        ("isolated", True, "other isolation of the swarm"),
        ("time_limit", 5.0, "another time limit"),
    ],
)
def test_a_row_made_by_something_else_is_made_again(
    pool: Executor, store: Store, capsys: pytest.CaptureFixture[str],
    column: str, value: object, words: str,
) -> None:  # fmt: skip
    swarm(pool, plan(), PROBLEMS, store)
    before = store.rows()
    changed = [replace(before[0], **{column: value}), *before[1:]]
    store.rows_file.write_text(csv_text(changed))
    capsys.readouterr()
    swarm(pool, plan(), PROBLEMS, store)
    assert [without_times(row) for row in store.rows()] == [without_times(row) for row in before]
    assert (
        f"1 do not and are set aside in rows-set-aside.csv (1 with {words})" in capsys.readouterr().err
    )


def test_rows_of_the_same_plan_are_kept_and_nothing_is_said(
    pool: Executor, store: Store, capsys: pytest.CaptureFixture[str]
) -> None:
    swarm(pool, plan(), PROBLEMS, store)
    before = store.rows()
    capsys.readouterr()
    swarm(pool, plan(), PROBLEMS, store)
    assert store.rows() == before  # the measured times too: nothing ran again
    assert "resume" not in capsys.readouterr().err
    assert store.set_aside() == []


def test_kept_rows_are_measured_against_the_bound_that_the_store_has_now(
    pool: Executor, store: Store
) -> None:
    swarm(pool, plan(), PROBLEMS, store)
    store.write_ladder("cobot", ladder_record(3.0))
    swarm(pool, plan(), PROBLEMS, store)
    for row in store.rows():
        assert row.bound == 3.0
        assert row.seconds is None or row.gap == row.seconds / 3.0 - 1.0


def test_a_second_row_of_one_run_is_set_aside(pool: Executor, store: Store) -> None:
    swarm(pool, plan(), PROBLEMS, store)
    rows = store.rows()
    store.rows_file.write_text(csv_text([*rows, replace(rows[0], seconds=1.0, gap=-0.7)]))
    swarm(pool, plan(), PROBLEMS, store)
    assert store.rows() == rows
    assert [row.seconds for row in store.set_aside()] == [1.0]


# --- the digest of the code -----------------------------------------------------------------------


def test_the_digest_covers_swarm_driver_coding_and_what_the_swarm_imports(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    read: list[str] = []
    source = provenance._source_file

    def noting(module: str, beside: Path | None) -> Path | None:
        path = source(module, beside)
        if path is not None:
            read.append(module)
        return path

    monkeypatch.setattr(provenance, "_source_file", noting)
    code_digest.cache_clear()
    assert len(code_digest("mipso")) == 12
    assert {
        "metaheuristics.swarms.mipso", "metaheuristics.driver.judge", "metaheuristics.driver.task",
        "metaheuristics.driver.archive", "compare.benchmark.objective",
    } <= set(read)  # fmt: skip
    assert not any(name.startswith("numpy") for name in read)
    assert "metaheuristics.swarms.whale" not in read
    code_digest.cache_clear()


def test_swarms_of_one_module_share_a_digest_and_others_do_not() -> None:
    assert code_digest("mipso") == code_digest("mipso-printed")
    assert code_digest("mipso") != code_digest("whale")
    assert code_digest("nelder-mead") != code_digest("cma-es")


def test_a_changed_line_of_a_plug_in_or_of_a_module_beside_it_changes_its_digest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    mine, beside, other = (tmp_path / f"{name}.py" for name in ("digested", "digested_too", "unused"))
    mine.write_text(
        "import numpy as np\nfrom digested_too import COUNT\n"
        "def swarm(task, *, population=COUNT):\n    while True:\n        yield task.sample(population)\n"
    )
    beside.write_text("COUNT = 4\n")
    other.write_text("")

    def digest() -> str:
        code_digest.cache_clear()
        return code_digest("digested:swarm")

    first = digest()
    assert len(first) == 12
    other.write_text("A = 1\n")
    assert digest() == first
    beside.write_text("COUNT = 4  # the same, but another text\n")
    second = digest()
    assert second != first
    mine.write_text(mine.read_text() + "\n")
    assert digest() != second
    code_digest.cache_clear()
