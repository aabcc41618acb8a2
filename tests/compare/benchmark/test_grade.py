"""Grading: what a row says of a run, whatever the swarm found."""

from __future__ import annotations

import numpy as np
from graded_runs import graded, optimum, without_times

from compare.benchmark import suite
from compare.benchmark.objective import CODINGS
from formulations import Limits, Problem, load


def test_the_papers_rule_claims_less_than_the_optimum_and_is_found_out() -> None:
    row = graded(load("sr4c"), optimum("sr4c").seconds, "published", "mipso-printed", 0, 2550).row
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
    first = graded(problem, bound, "published", "mipso", 3, 300)
    again = graded(problem, bound, "published", "mipso", 3, 300)
    other = graded(problem, bound, "published", "mipso", 4, 300)
    repeatable = [without_times(g.row) for g in (first, again, other)]
    assert repeatable[0] == repeatable[1]
    assert first.traces == again.traces
    assert repeatable[0]["durations"] != repeatable[2]["durations"]


def test_the_full_comparison_uses_the_papers_own_budgets() -> None:
    full = {run.case: run for run in suite.runs(size="full", swarms=["pso"], codings=["shared"])}
    assert full["sr4c"].budget == 50 * 51
    assert full["ur5"].population == 1000
    assert full["cobot"].budget == full["bagging"].budget == 20 * 201
