"""Rows are judged again from their durations: whoever changes a row on disk is found out."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from conftest import climbed
from graded_runs import graded
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.benchmark.ladders import LadderRecord, ladder_record
from compare.benchmark.objective import CODINGS
from compare.benchmark.records.rejudge import exact_extent, judged_again
from compare.benchmark.records.rows import BoundProof, Row, RowStatus
from compare.benchmark.records.store import Store
from compare.benchmark.summaries import bound_of, summaries
from formulations import FAMILIES, Problem, check, load

CASES = ("sr4c", "ur5", "cobot", "bagging")
SWARMS = ("pso", "whale", "random")


@pytest.fixture(scope="module")
def problems() -> dict[str, Problem]:
    return {case: load(case) for case in CASES}


@pytest.fixture(scope="module")
def ladders() -> dict[str, LadderRecord]:
    return {case: ladder_record(climbed(case)) for case in CASES}


@pytest.fixture(scope="module")
def rows(problems: Mapping[str, Problem], ladders: Mapping[str, LadderRecord]) -> list[Row]:
    """Honest rows of every coding: claims that hold, claims that do not, searches that found nothing."""
    found = []
    for case, problem in problems.items():
        bound, proof = bound_of(ladders[case])
        for coding in CODINGS:
            for swarm in SWARMS:
                budget = 300 * (len(problem.moving_joints) if coding == "published" else 1)
                row = graded(problem, bound or 0.0, coding, swarm, 0, budget).row
                found.append(row.measured_against(bound, proof))
    return found


def reason(row: Row) -> str:
    assert row.status is RowStatus.contradicted
    assert row.seconds is row.gap is row.claimed is row.claimed_gap is row.keeps_limits is None
    return row.note


def test_honest_rows_hold(rows: list[Row], problems: Any, ladders: Any) -> None:
    assert judged_again(rows, problems, ladders) == rows
    # the sample has what the laws speak of
    assert {row.keeps_limits for row in rows} >= {True, False}
    assert any(row.stretch is not None and row.stretch > 1.01 for row in rows)


def test_a_planted_line_is_shown_as_a_fault_with_its_reason(
    rows: list[Row], problems: Any, ladders: Any, tmp_path: Any
) -> None:
    store = Store(tmp_path)
    store.add_all((row, []) for row in rows)
    planted = replace(
        rows[0], swarm="evil:swarm", seed=7, seconds=1.0, gap=-0.7, status=RowStatus.ok, claimed=1.0
    )
    store.add_all([(planted, [])])
    found = judged_again(store.rows(), problems, ladders)
    assert found[:-1] == rows
    assert reason(found[-1]).startswith("it states 1 s, its durations add up to ")
    (summary,) = [s for s in summaries(found).values() if s.swarm == "evil:swarm"]
    assert (summary.seeds, summary.unsolved, summary.gap) == (1, 1, None)


def verified(rows: list[Row], coding: str = "stretched") -> Row:
    return next(row for row in rows if row.seconds is not None and row.coding == coding)


def faster(row: Row, factor: float) -> Row:
    """The row as if its motion were so much shorter, every number of it consistent with that."""
    assert row.seconds is not None
    durations = tuple(t * factor for t in row.durations)
    seconds = float(np.cumsum(durations)[-1])
    changed = replace(row, durations=durations, seconds=seconds, claimed=seconds)
    return changed.measured_against(row.bound, row.proof)


def test_a_consistent_lie_breaks_a_limit(rows: list[Row], problems: Any, ladders: Any) -> None:
    for factor in (0.3, 0.99, 1.0 - 1e-8):
        (found,) = judged_again([faster(verified(rows), factor)], problems, ladders)
        assert "its motion does not hold: over the limit" in reason(found)


def test_a_motion_below_a_certified_bound_is_a_fault(
    rows: list[Row], problems: Any, ladders: Any
) -> None:
    row = verified(rows)
    key = "family_lower"
    wrong = {**ladders[row.case]["ladder"]}
    wrong[key] = {**wrong[key], "seconds": row.seconds * 1.01, "certified": True}
    judged = {**ladders, row.case: {**ladders[row.case], "ladder": wrong}}
    bound, proof = bound_of(judged[row.case])
    (found,) = judged_again([row.measured_against(bound, proof)], problems, judged)
    assert "the certified bound (family_lower)" in reason(found)


CHANGES: dict[str, tuple[dict[str, Any], str]] = {
    "a bound of one's own": ({"bound": 40.0, "gap": None}, "its gap is measured against 40.0 s"),
    "a proof of one's own": ({"proof": BoundProof.none}, "its gap is measured against"),
    "another problem": ({"problem": "0" * 12}, "another problem"),
    "another family": ({"family": "quintic"}, "another problem"),
    "no durations": ({"durations": ()}, "no durations"),
    "too few durations": ({"durations": (1.0,)}, "are not 3 positive times"),
    "a negative duration": ({"durations": (1.0, -1.0, 5.0)}, "are not 3 positive times"),
    "durations beyond all numbers": ({"durations": (1e-300, 1e-300, 1e300)}, "it states"),
    "an unknown case": ({"case": "sr4d"}, "has no case sr4d"),
    "a claim": ({"claimed": 1.0}, "claimed gap"),
    "a kept limit": ({"keeps_limits": False}, "against what it states"),
    "a stretch": ({"stretch": 0.5}, "it states the stretch 0.5"),
    "a hidden time": ({"seconds": None, "gap": None}, "its status is ok"),
    "a hidden motion": (
        {"seconds": None, "gap": None, "status": RowStatus.check_failed}, "keep the limits",
    ),
    "its own verdict": ({"status": RowStatus.contradicted}, "stored as contradicted"),
}  # fmt: skip


@pytest.mark.parametrize("change", CHANGES)
def test_a_changed_row_is_named(rows: list[Row], problems: Any, ladders: Any, change: str) -> None:
    columns, words = CHANGES[change]
    honest = verified(rows)
    (found,) = judged_again([replace(honest, **columns)], problems, ladders)
    assert words in reason(found)


def test_the_second_row_of_a_run_is_a_fault(rows: list[Row], problems: Any, ladders: Any) -> None:
    found = judged_again([*rows, rows[3]], problems, ladders)
    assert found[:-1] == rows
    assert "an earlier row of the same run" in reason(found[-1])


@given(data=st.data())
@settings(max_examples=150)
def test_any_change_of_a_number_is_found(
    rows: list[Row], problems: Any, ladders: Any, data: st.DataObject
) -> None:
    """Seconds, gaps, claims, stretch and durations: none can be changed by more than rounding."""
    index = data.draw(st.integers(0, len(rows) - 1))
    row = rows[index]
    names = [n for n in ("seconds", "gap", "claimed_gap", "claimed", "stretch") if getattr(row, n)]
    names += ["durations"] * bool(row.durations)
    if not names:
        return
    factor = data.draw(st.floats(1e-3, 1e3).filter(lambda f: abs(f - 1.0) > 1e-7))
    name = data.draw(st.sampled_from(names))
    changed: Any = getattr(row, name)
    if name == "durations":
        k = data.draw(st.integers(0, len(changed) - 1))
        changed = tuple(t * factor if i == k else t for i, t in enumerate(changed))
    else:
        changed *= factor
    found = judged_again([*rows[:index], replace(row, **{name: changed}), *rows[index + 1 :]],
                         problems, ladders)  # fmt: skip
    assert reason(found[index])
    assert [row for i, row in enumerate(found) if i != index] == rows[:index] + rows[index + 1 :]


@pytest.mark.parametrize("case", ["sr4c", "ur5", "bagging", "z1"])
def test_the_population_is_judged_like_each_motion_alone(case: str) -> None:
    problem = load(case)
    rng = np.random.default_rng(1)
    durations = rng.uniform(0.3, 6.0, (30, problem.n_segments))
    total, stretch, excess = exact_extent(problem, durations)
    for k, row in enumerate(durations):
        verdict = check(problem, FAMILIES[problem.family].trajectory(problem, row))
        assert verdict.seconds == pytest.approx(total[k], rel=1e-14)
        assert verdict.stretch == pytest.approx(stretch[k], rel=1e-10)
        assert verdict.position_kept == (excess[k] <= 0.0)


def test_five_thousand_rows_are_judged_in_a_moment(
    rows: list[Row], problems: Any, ladders: Any
) -> None:
    """A report of so many rows takes minutes to draw."""
    many = [replace(row, seed=seed) for seed in range(140) for row in rows][:5000]
    started = time.perf_counter()
    assert judged_again(many, problems, ladders) == many
    assert time.perf_counter() - started < 20.0  # it takes 1 s
