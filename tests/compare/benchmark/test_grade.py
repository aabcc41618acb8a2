"""Grading: what a row says of a run, whatever the swarm found."""

from __future__ import annotations

import numpy as np
import pytest
from graded_runs import graded, optimum, without_times
from hypothesis import assume, given
from hypothesis import strategies as st

from compare.benchmark.grade import Run, grade
from compare.benchmark.objective import CODINGS
from compare.benchmark.plan import runs
from compare.benchmark.protocol import (
    PAPER_BUDGETS,
    TARGETS,
    Coordinates,
    Track,
    shares,
    targets,
)
from formulations import CASES, InputError, Limits, Problem, load


def test_the_papers_rule_claims_less_than_the_optimum_and_is_found_out() -> None:
    row = graded(load("sr4c"), optimum("sr4c").seconds, "published", "mipso-printed", 0, 6 * 2550).row
    assert row.claimed_gap < -0.01
    assert row.keeps_limits is False
    assert row.stretch > 1.05
    assert "acceleration of joint" in row.worst
    assert row.gap > 0.0


def test_a_search_that_finds_nothing_feasible_stays_a_visible_row() -> None:
    # the first cube arrives at 1 rad still moving, so every 3-5-3 spline overshoots its limit there
    turning = Problem.of([[0.0], [1.0], [-1.0], [0.0]], Limits.of(1.0, position=(-1.0, 1.0), dof=1))
    for coding in CODINGS:
        row = graded(turning, 1.0, coding, "random", 0, 60).row
        assert row.status == "no-feasible-point"
        assert row.note
        assert row.seconds is row.gap is None


def test_a_problem_in_which_nothing_moves_is_a_row_too() -> None:
    still = Problem.of(np.ones((4, 2)), Limits.of(1.0, dof=2))
    row = graded(still, 1.0, "published", "pso", 0, 40).row
    assert row.status == "nothing-moves"


def test_random_numbers_depend_on_the_run_alone() -> None:
    problem, bound = load("cobot"), optimum("cobot").seconds
    first = graded(problem, bound, "published", "mipso", 3, 1800)
    again = graded(problem, bound, "published", "mipso", 3, 1800)
    other = graded(problem, bound, "published", "mipso", 4, 1800)
    repeatable = [without_times(g.row) for g in (first, again, other)]
    assert repeatable[0] == repeatable[1]
    assert first.traces == again.traces
    assert repeatable[0]["durations"] != repeatable[2]["durations"]


def test_the_full_comparison_uses_the_papers_own_budgets() -> None:
    problems = {case: load(case) for case in CASES}
    full = {run.case: run for run in runs(problems, size="full", swarms=["pso"], codings=["shared"])}
    assert full["sr4c"].budget == 50 * 51
    assert full["ur5"].population == 1000
    assert full["cobot"].budget == full["bagging"].budget == 20 * 201


def test_every_coding_spends_the_budget_of_the_whole_motion_and_no_more() -> None:
    problem = load("cobot")
    joints = len(problem.moving_joints)
    for coding in CODINGS:
        found = graded(problem, optimum("cobot").seconds, coding, "random", 0, 1000)
        spent = [trace.evaluations[-1] for trace in found.traces]
        assert sum(spent) == found.row.evaluations == found.row.budget == 1000
        assert len(spent) == (joints if coding == "published" else 1)
        assert max(spent) - min(spent) <= 1


def test_the_papers_track_gives_each_joint_what_the_others_have_for_all() -> None:
    problems = {case: load(case) for case in ("sr4c", "bagging")}
    planned = runs(problems, size="full", swarms=["pso"], seeds=1)
    for case, problem in problems.items():
        by = {(run.coding, run.track): run.budget for run in planned if run.case == case}
        paper = by.pop(("published", Track.paper))
        assert set(by) == {(coding, Track.equal) for coding in CODINGS}
        assert set(by.values()) == {PAPER_BUDGETS[case].evaluations}
        assert paper == len(problem.moving_joints) * PAPER_BUDGETS[case].evaluations


def test_a_budget_that_leaves_a_joint_without_evaluations_is_refused() -> None:
    with pytest.raises(InputError, match="budget: 5 evaluations are fewer than 6"):
        runs({"sr4c": load("sr4c")}, evaluations=5)


@given(budget=st.integers(0, 10**9), searches=st.integers(1, 12))
def test_shares_are_fair_and_complete(budget: int, searches: int) -> None:
    assume(budget >= searches)
    found = shares(budget, searches)
    assert sum(found) == budget
    assert len(found) == searches
    assert max(found) - min(found) <= 1
    assert found == sorted(found, reverse=True)


def test_coordinates_change_what_the_swarm_sees_and_nothing_of_the_motion() -> None:
    """PSO does not know where zero is: the same motion, but for rounding; whales are drawn to it."""
    problem, bound = load("cobot"), optimum("cobot").seconds
    found = {}
    for name in ("pso", "whale"):
        for seen in Coordinates:
            run = Run("cobot", "stretched", name, 0, 400, 20, coordinates=seen)
            found[name, seen] = grade(run, problem, bound).row
            assert found[name, seen].coordinates is seen
            assert found[name, seen].gap >= -1e-9
    near = {seen: np.array(found["pso", seen].durations) for seen in Coordinates}
    np.testing.assert_allclose(near[Coordinates.offset], near[Coordinates.printed], rtol=1e-6)
    far = found["whale", Coordinates.offset].gap
    assert far > 2.0 * found["whale", Coordinates.printed].gap


def test_the_targets_are_those_of_the_protocol() -> None:
    assert len(TARGETS) == 41
    assert (TARGETS[0], TARGETS[5], TARGETS[-1]) == (10.0, 1.0, 1e-7)
    np.testing.assert_allclose(np.diff(np.log10(TARGETS)), -0.2, atol=1e-4)
    assert targets(1e-3)[-1] == 1e-3
