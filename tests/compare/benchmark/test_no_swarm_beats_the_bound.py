"""The law the project exists for: no verified result of a swarm lies below the certified bound."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import SOLVED
from graded_runs import graded, optimum, unbeatable
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.benchmark.grade import durations_of
from compare.benchmark.objective import CODINGS
from formulations import FAMILIES, Limits, Problem, check, load
from formulations.proofs.family import family_bound
from metaheuristics import ALGORITHMS


@pytest.mark.parametrize("case", SOLVED)
def test_no_verified_swarm_result_lies_below_the_bound(case: str) -> None:
    problem, bound = load(case), unbeatable(case)
    for coding in CODINGS:
        for swarm, entry in ALGORITHMS.items():
            # libraries: one point at a time, most of them; B-splines: slow
            budget = 200 if entry.libraries or problem.family.startswith("b-spline") else 1000
            row = graded(problem, bound, coding, swarm, 0, budget).row
            if row.seconds is not None:
                assert row.seconds >= bound, (coding, swarm)
                # judged again here, from the row's own durations
                verdict = check(
                    problem, FAMILIES[problem.family].trajectory(problem, durations_of(row))
                )
                assert verdict.feasible
                assert verdict.seconds == pytest.approx(row.seconds, rel=1e-12)


@pytest.mark.slow
@given(data=st.data())
@settings(max_examples=15, deadline=None, derandomize=True)
def test_no_swarm_beats_the_bound_of_a_made_up_problem(data: st.DataObject) -> None:
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    dof, waypoints = int(rng.integers(1, 4)), int(rng.integers(3, 6))
    points = rng.normal(size=(waypoints, dof)) * 10.0 ** rng.uniform(-2, 1)
    acceleration, jerk = [(np.inf, np.inf), (2.0, np.inf), (2.0, 5.0)][int(rng.integers(3))]
    problem = Problem.of(points, Limits.of(1.0, acceleration, jerk, dof=dof))
    proof = family_bound(problem, gap=1e-5, time_limit=10.0)
    assert proof.seconds > 0.0
    for coding in CODINGS:
        for swarm in ("pso", "mipso", "whale"):
            row = graded(problem, proof.seconds, coding, swarm, 1, 2000).row
            assert row.seconds is None or row.seconds >= proof.least_verified


def test_a_wrong_bound_would_be_noticed() -> None:
    """The law above can fail: an optimum 1 % too long is beaten."""
    row = graded(load("sr4c"), optimum("sr4c").seconds * 1.01, "stretched", "pso", 0, 2550).row
    assert row.gap < 0.0
