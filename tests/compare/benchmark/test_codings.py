"""Codings: what a swarm's vector stands for, and what the swarm is told about it."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from conftest import SOLVED
from graded_runs import optimum

from compare.benchmark.objective import Objective, search_box
from formulations import FAMILIES, check, load


@pytest.mark.parametrize("case", SOLVED)
def test_the_search_box_holds_the_optimum(case: str) -> None:
    problem = load(case)
    lo, hi = search_box(problem)
    best = optimum(case).durations
    assert (lo <= best).all()
    assert (best <= hi).all()


def test_penalty_codings_call_infeasible_exactly_what_the_check_calls_infeasible() -> None:
    problem = load("sr4c")
    family = FAMILIES[problem.family]
    durations = np.random.default_rng(0).uniform(0.5, 4.0, (200, 3))
    fitness = Objective(problem, stretch=False)(durations)
    assert 0 < np.isfinite(fitness).sum() < 200
    for value, row in zip(fitness, durations, strict=True):
        feasible = check(problem, family.trajectory(problem, row)).feasible
        assert feasible == np.isfinite(value)
        assert not feasible or value == pytest.approx(row.sum(), rel=1e-15)


def test_the_stretched_coding_makes_every_shape_feasible_but_for_position() -> None:
    problem = load("ur5")
    durations = np.random.default_rng(1).uniform(0.5, 30.0, (100, 3))
    objective = Objective(problem, stretch=True)
    fitness = objective(durations)
    for value, row in zip(fitness, durations, strict=True):
        verdict = check(problem, FAMILIES["3-5-3"].trajectory(problem, objective.durations(row)))
        if np.isfinite(value):
            assert verdict.feasible
            assert verdict.seconds == pytest.approx(value, rel=1e-12)
        else:
            assert not verdict.position_kept
    assert np.isinf(fitness).any()
    assert np.isfinite(fitness).any()


def test_an_objective_that_has_worked_can_be_sent_to_another_process() -> None:
    problem = load("ur5")
    durations = np.random.default_rng(2).uniform(0.5, 30.0, (20, 3))
    for stretch in (False, True):
        objective = Objective(problem, stretch)
        before = objective(durations)
        again = pickle.loads(pickle.dumps(objective))
        assert again == objective
        np.testing.assert_array_equal(again(durations), before)
