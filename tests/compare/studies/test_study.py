"""The runner of studies: rows in order, files that hold them all, and a resume that mixes nothing."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure

from compare.engines import workers
from compare.studies import study as module
from compare.studies.study import Study, run
from formulations import InputError, Limits, Problem


@dataclass(frozen=True)
class Measured:
    name: str
    value: float
    other: float | None
    count: int
    good: bool


MADE: list[tuple[Any, ...]] = []  # calls that were computed in this process


def measure(name: str, count: int) -> Iterator[Measured]:
    MADE.append((name, count))
    for k in range(count):
        value = np.float64(np.inf) if k == 2 else np.float64(1.0 / 3.0 + k)
        yield Measured(name, value, None if k == 1 else 0.1 * k, k, bool(k % 2))


def summarise(rows: list[Measured]) -> dict[str, int]:
    return {"rows": len(rows)}


def text(rows: list[Measured], summary: dict[str, int]) -> str:
    return f"{summary['rows']} rows"


def figure(rows: list[Measured], summary: dict[str, int]) -> Figure:
    drawn, axes = plt.subplots()
    axes.plot([row.count for row in rows])
    return drawn


STUDY = Study("planted", Measured, measure, summarise, text, figure)
CALLS: list[tuple[Any, ...]] = [("a", 3), ("b", 1), ("c", 2)]


@pytest.fixture(autouse=True)
def _nothing_made() -> None:
    MADE.clear()
    return


def test_rows_stand_in_the_order_of_the_calls_whoever_makes_them(tmp_path: Path) -> None:
    alone = run(STUDY, CALLS)
    with workers(2) as pool:
        shared = run(STUDY, CALLS, folder=tmp_path, pool=pool)
    assert alone.rows == shared.rows == [row for call in CALLS for row in measure(*call)]
    assert alone.summary == {"rows": 6}
    with (tmp_path / "planted.csv").open() as lines:
        written = list(csv.DictReader(lines))
    assert [row["name"] for row in written] == ["a", "a", "a", "b", "c", "c"]
    assert float(written[2]["value"]) == np.inf
    facts = json.loads((tmp_path / "planted.json").read_text())
    assert facts["summary"] == {"rows": 6}
    assert {"machine", "versions"} < set(facts)
    assert (tmp_path / "figures" / "planted.svg").stat().st_size > 1000


def test_without_a_folder_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    found = run(STUDY, CALLS)
    assert not list(tmp_path.iterdir())
    data = json.dumps(found.to_json(), allow_nan=False)
    assert json.loads(data)["rows"][2]["value"] is None
    assert found.as_text().startswith("6 rows\n")


def test_a_resumed_study_makes_what_is_missing_and_ends_like_an_unbroken_one(tmp_path: Path) -> None:
    whole = run(STUDY, CALLS, folder=tmp_path)
    store = tmp_path / "studies" / "planted.jsonl"
    first, second, _ = store.read_text().splitlines(keepends=True)
    store.write_text(first + second[:-9])  # as a kill leaves it
    MADE.clear()
    again = run(STUDY, CALLS, folder=tmp_path, resume=True)
    assert MADE == [("b", 1), ("c", 2)]
    assert again.rows == whole.rows
    assert [type(row.value) for row in again.rows] == [float] * 3 + [np.float64] * 3  # stored or made
    MADE.clear()
    assert run(STUDY, CALLS, folder=tmp_path, resume=True).rows == whole.rows
    assert MADE == []


def test_without_resume_everything_is_made_again(tmp_path: Path) -> None:
    run(STUDY, CALLS, folder=tmp_path)
    MADE.clear()
    run(STUDY, CALLS, folder=tmp_path)
    assert MADE == CALLS


def test_rows_of_other_arguments_versions_or_code_are_not_mixed_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run(STUDY, CALLS, folder=tmp_path)
    MADE.clear()
    found = run(STUDY, [("a", 2), ("b", 1)], folder=tmp_path, resume=True)
    assert MADE == [("a", 2)]
    assert found.summary == {"rows": 3}
    for what in ("versions_text", "source_digest"):
        with monkeypatch.context() as other:
            other.setattr(module, what, lambda: "another")
            MADE.clear()
            run(STUDY, [("b", 1)], folder=tmp_path, resume=True)
            assert MADE == [("b", 1)], what


def test_a_problem_in_a_call_is_told_by_its_name_and_what_it_is() -> None:
    def problem(name: str, last: float) -> Problem:
        return Problem.of([[0.0], [last]], Limits.of(1.0, dof=1), name=name)

    keys = {module._key(STUDY, (problem(name, last), 1)) for name in ("x", "y") for last in (1.0, 2.0)}
    assert len(keys) == 4
    assert module._key(STUDY, (problem("x", 1.0), 1)) in keys


def test_an_interrupted_study_keeps_the_finished_calls(tmp_path: Path) -> None:
    def breaks(name: str, count: int) -> Iterator[Measured]:
        if name == "c":
            raise KeyboardInterrupt
        return measure(name, count)

    # a stand-in of the same name, so that its calls have the same keys
    breaks.__qualname__ = measure.__qualname__
    broken = Study("planted", Measured, breaks, summarise, text, figure)
    with pytest.raises(KeyboardInterrupt):
        run(broken, CALLS, folder=tmp_path)
    assert not (tmp_path / "planted.csv").exists()
    MADE.clear()
    run(STUDY, CALLS, folder=tmp_path, resume=True)
    assert MADE == [("c", 2)]


def test_a_file_of_something_else_is_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "studies").mkdir()
    (tmp_path / "studies" / "planted.jsonl").write_text("{}\n")
    with pytest.raises(InputError, match=r"planted\.jsonl: line 1: holds no rows of planted"):
        run(STUDY, CALLS, folder=tmp_path, resume=True)
