"""Resuming: a stored row counts only if the present plan would make the same one."""

from __future__ import annotations

import csv
import sqlite3
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from graded_runs import without_times

from compare.benchmark import run as run_module
from compare.benchmark.grade import Graded, Run, grade
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.plan import runs
from compare.benchmark.records import proof_cache, provenance
from compare.benchmark.records.database.schema import MAKER_COLUMNS
from compare.benchmark.records.provenance import code_digest
from compare.benchmark.records.store import Store
from compare.benchmark.run import climb, swarm
from compare.benchmark.summaries import summaries
from compare.engines import Engine, ThisProcess
from formulations import InputError, Problem, load

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
def pool() -> Engine:
    return ThisProcess()


@pytest.fixture
def store(tmp_path: Path) -> Store:
    made = Store(tmp_path)
    made.clear()
    made.write_ladder("cobot", ladder_record(3.3496))
    return made


def plan(swarms: tuple[str, ...] = ("pso",), seeds: int = 4, evaluations: int = 60) -> list[Run]:
    return runs(PROBLEMS, swarms=list(swarms), codings=["shared"], seeds=seeds, evaluations=evaluations)


def fresh(pool: Engine, folder: Path, runs: list[Run]) -> list[dict[str, object]]:
    """The rows of these runs in a folder of their own."""
    folder.mkdir()
    clean = Store(folder)
    clean.clear()
    clean.write_ladder("cobot", ladder_record(3.3496))
    swarm(pool, runs, PROBLEMS, clean)
    return [without_times(row) for row in clean.rows()]


def test_another_budget_does_not_enter_the_medians(
    pool: Engine, store: Store, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    swarm(pool, plan(evaluations=600), PROBLEMS, store)
    capsys.readouterr()
    swarm(pool, plan(evaluations=60), PROBLEMS, store)
    rows = store.rows()
    assert [row.budget for row in rows] == [60] * 4
    assert [without_times(row) for row in rows] == fresh(pool, tmp_path / "fresh", plan())
    told = [line for line in capsys.readouterr().err.splitlines() if line.startswith("resume:")]
    assert told == [
        "resume: 0 of 4 stored rows fit the plan; 4 do not and are left out (4 with another budget)"
    ]
    assert [row.budget for row in store.rows(every=True)] == [600] * 4 + [60] * 4
    assert {key for key, _ in store.traces()} == {row.key for row in rows}
    capsys.readouterr()
    swarm(pool, plan(evaluations=600), PROBLEMS, store)  # they are still there, and not run again
    assert [row.budget for row in store.rows()] == [600] * 4
    assert "4 of 8 stored rows fit the plan" in capsys.readouterr().err


def test_fewer_seeds_and_swarms_leave_the_others_out(
    pool: Engine, store: Store, capsys: pytest.CaptureFixture[str]
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
    pool: Engine, store: Store, capsys: pytest.CaptureFixture[str],
    column: str, value: object, words: str,
) -> None:  # fmt: skip
    swarm(pool, plan(), PROBLEMS, store)
    before = store.rows()
    store.close()
    with sqlite3.connect(store.file) as other:
        other.execute(
            "INSERT INTO makers SELECT 99, 'another', "
            + ", ".join(f'"{name}"' for name in MAKER_COLUMNS)
            + " FROM makers"
        )
        other.execute("UPDATE runs SET maker = 99 WHERE seed = 0")
        other.execute(f"UPDATE makers SET {column} = ? WHERE id = 99", (value,))
    other.close()
    capsys.readouterr()
    swarm(pool, plan(), PROBLEMS, store)
    assert [without_times(row) for row in store.rows()] == [without_times(row) for row in before]
    assert store.rows()[1:] == before[1:]  # the measured times too: these did not run again
    assert f"1 do not and are left out (1 with {words})" in capsys.readouterr().err


def test_rows_of_the_same_plan_are_kept_and_nothing_is_said(
    pool: Engine, store: Store, capsys: pytest.CaptureFixture[str]
) -> None:
    swarm(pool, plan(), PROBLEMS, store)
    before = store.rows()
    capsys.readouterr()
    swarm(pool, plan(), PROBLEMS, store)
    assert store.rows() == before  # the measured times too: nothing ran again
    assert "resume" not in capsys.readouterr().err


def test_kept_rows_are_measured_against_the_bound_that_the_store_has_now(
    pool: Engine, store: Store
) -> None:
    swarm(pool, plan(), PROBLEMS, store)
    store.write_ladder("cobot", ladder_record(3.0))
    swarm(pool, plan(), PROBLEMS, store)
    for row in store.rows():
        assert row.bound == 3.0
        assert row.seconds is None or row.gap == row.seconds / 3.0 - 1.0


def test_an_interrupt_leaves_the_table_of_what_was_finished(
    pool: Engine, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*args: object, **more: object) -> Iterator[list[Graded]]:
        yield [grade(run, PROBLEMS["cobot"], 3.3496) for run in plan()[1:3]]
        raise KeyboardInterrupt

    monkeypatch.setattr(run_module, "each", interrupted)
    with pytest.raises(KeyboardInterrupt):
        swarm(pool, plan(), PROBLEMS, store)
    with store.rows_file.open(encoding="utf-8", newline="") as lines:
        assert [line["seed"] for line in csv.DictReader(lines)] == ["1", "2"]
    monkeypatch.undo()
    swarm(pool, plan(), PROBLEMS, store)  # the rest; the table has the order of the plan
    with store.rows_file.open(encoding="utf-8", newline="") as lines:
        assert [line["seed"] for line in csv.DictReader(lines)] == ["0", "1", "2", "3"]


def test_a_cell_that_another_machine_began_is_not_pooled_unless_that_is_allowed(
    pool: Engine, store: Store
) -> None:
    swarm(pool, plan(seeds=2), PROBLEMS, store)
    store.close()
    with sqlite3.connect(store.file) as other:
        other.execute("UPDATE machines SET machine = 'a cluster'")
    other.close()
    swarm(pool, plan(seeds=2), PROBLEMS, store)  # nothing is left to be run here
    with pytest.raises(InputError, match=r"another machine \(a cluster; this is .*--machines"):
        swarm(pool, plan(seeds=3), PROBLEMS, store)
    assert len(store.rows()) == 2
    swarm(pool, plan(seeds=3), PROBLEMS, store, allow=("machine",))
    assert [row.machine == "a cluster" for row in store.rows()] == [True, True, False]
    with pytest.raises(InputError, match="two machines cannot be pooled"):
        summaries(store.rows())


def test_what_was_proved_once_is_not_proved_again(
    pool: Engine, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    climb(pool, PROBLEMS, store, certify=False)
    proved = store.ladders()
    store.clear()
    monkeypatch.setattr(run_module, "ladder", None)  # nothing can be proved from now on
    climb(pool, PROBLEMS, store, certify=False)
    assert store.ladders() == proved
    for change in ({"certify": True}, {"renamed": True}, {"code": "0" * 16}):
        problems = PROBLEMS
        if "renamed" in change:
            problems = {"cobot": replace_name(PROBLEMS["cobot"])}
        if "code" in change:
            monkeypatch.setattr(proof_cache, "_prover_digest", lambda: "0" * 16)
        with pytest.raises(TypeError):
            climb(pool, problems, store, certify=bool(change.get("certify")))


def replace_name(problem: Problem) -> Problem:
    return Problem(problem.waypoints, problem.limits, name="another", family=problem.family)


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


def test_rows_of_a_worker_with_other_code_are_refused(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    def foreign(batch: list[tuple[Run, object, float, str]]) -> list[Graded]:
        found = [grade(*one) for one in batch]  # type: ignore[arg-type]
        return [replace(one, row=replace(one.row, code="0123456789ab")) for one in found]

    monkeypatch.setattr(run_module, "_grades", foreign)
    with pytest.raises(InputError, match=r"^4 of 4 runs were made by workers with other code"):
        swarm(ThisProcess(), plan(), PROBLEMS, store)
    assert store.rows() == []
    assert len(store.rows(every=True)) == 4
