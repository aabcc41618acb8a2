"""Passage times of motions from elsewhere, against motions whose passages are known."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import Limits, Problem, Trajectory, free_form, load
from formulations.motion.interpolation import joined
from formulations.motion.passages import passages


@pytest.mark.parametrize("case", ["sr4c", "ur5"])
def test_the_fastest_motion_passes_where_its_solver_says(case: str) -> None:
    problem = load(case)
    motion = free_form(problem).trajectory
    assert motion is not None
    # a reader of the file knows the points alone
    bare = Trajectory(motion.durations, motion.coefficients)
    found = passages(bare, problem.waypoints)
    assert np.abs(found.misses).max() <= 1e-9
    assert np.allclose(found.times, motion.passage_times, rtol=0.0, atol=1e-6)


@given(seed=st.integers(0, 10**6), dof=st.integers(1, 3), count=st.integers(2, 7))
@settings(max_examples=60)
def test_points_of_the_motion_itself_are_found_in_their_order(seed: int, dof: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.1, 1.0, 9))
    motion = joined(times, rng.normal(size=(9, dof)), rng.normal(size=(9, dof)))
    wanted = np.sort(rng.uniform(0.0, motion.seconds, count))
    wanted[0], wanted[-1] = 0.0, motion.seconds
    found = passages(motion, motion.at(wanted))
    assert (np.diff(found.times) >= 0.0).all()
    assert np.abs(found.misses).max() <= 1e-8


def test_a_waypoint_passed_twice_is_taken_where_the_order_allows_it() -> None:
    # there and back and there again: 0, 1, 0, 1
    motion = joined(np.arange(4.0), np.array([[0.0], [1.0], [0.0], [1.0]]))
    found = passages(motion, np.array([[0.0], [0.5], [0.0], [0.5], [1.0]]))
    assert np.allclose(found.times, [0.0, found.times[1], 2.0, 2.5, 3.0])
    assert np.isclose(found.times[1] % 1.0, 0.5)
    assert found.times[1] < 2.0


def test_a_missed_waypoint_gets_its_nearest_approach() -> None:
    motion = joined(np.array([0.0, 1.0, 2.0]), np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]))
    found = passages(motion, np.array([[0.0, 0.0], [1.0, 1.2], [2.0, 0.0]]))
    assert found.times[1] == pytest.approx(1.0, abs=0.2)
    assert np.abs(found.misses[1]).max() == pytest.approx(0.2, abs=1e-3)
    assert np.abs(found.misses[[0, 2]]).max() == 0.0


def test_standing_still_for_a_long_time_costs_no_time() -> None:
    times = np.arange(300_001) / 1000.0
    positions = np.clip(times - 100.0, 0.0, 1.0)[:, None] * np.ones(7)
    motion = joined(times, positions)
    start = time.perf_counter()
    found = passages(motion, np.array([[0.0] * 7, [0.25] * 7, [1.0] * 7]))
    assert time.perf_counter() - start < 20.0
    assert found.times[1] == pytest.approx(100.25)


def test_the_problem_of_two_waypoints_needs_no_search() -> None:
    problem = Problem.of([[0.0], [1.0]], Limits.of(1.0, 2.0, dof=1))
    motion = free_form(problem).trajectory
    assert motion is not None
    assert passages(motion, problem.waypoints).times.tolist() == [0.0, motion.seconds]
