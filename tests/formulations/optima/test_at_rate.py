"""Motions for a controller with a fixed rate: the file itself is judged, by samples of its own."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from conftest import Array
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import Conditions, InputError, Limits, Problem, check, free_form, load
from formulations.motion.interpolation import joined
from formulations.motion.trajectory import Trajectory
from formulations.optima.at_rate.motion import AtPoints, at_rate


@functools.cache
def panda(seed: int = 1, count: int = 5) -> tuple[Problem, Trajectory]:
    """Random waypoints under the limits of Franka's data sheet, and the fastest motion."""
    limits = Limits.of(
        [2.175] * 4 + [2.61] * 3,
        [15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0],
        [7500.0, 3750.0, 5000.0, 6250.0, 7500.0, 10000.0, 10000.0],
        dof=7,
    )
    rng = np.random.default_rng(seed)
    problem = Problem.of(rng.uniform(-1.5, 1.5, (count, 7)), limits)
    found = free_form(problem).trajectory
    assert found is not None
    return problem, found


def points_of(motion: AtPoints) -> tuple[Array, Array]:
    """Times and position, velocity, acceleration of the points of a file, (3, n_points, dof)."""
    return motion.times, np.stack([motion.trajectory.at(motion.times, order) for order in range(3)])


def factors(times: Array, states: Array, problem: Problem) -> Array:
    """Largest velocity, acceleration and jerk over their limits, (3,), by dense samples of Hermite quintics.

    Written out with the textbook's basis, so that it shares nothing with the code under test.
    """
    h = np.diff(times)[:, None, None]
    p, v, a = (states[k][:, None] for k in range(3))
    s = np.linspace(0.0, 1.0, 41)[:, None]
    b3 = (
        10.0 * (p[1:] - p[:-1]) - h * (6.0 * v[:-1] + 4.0 * v[1:]) - h**2 * (1.5 * a[:-1] - 0.5 * a[1:])
    )
    b4 = -15.0 * (p[1:] - p[:-1]) + h * (8.0 * v[:-1] + 7.0 * v[1:]) + h**2 * (1.5 * a[:-1] - a[1:])
    b5 = 6.0 * (p[1:] - p[:-1]) - 3.0 * h * (v[:-1] + v[1:]) - h**2 * 0.5 * (a[:-1] - a[1:])
    velocity = v[:-1] + (h * a[:-1] * s) + (3 * b3 * s**2 + 4 * b4 * s**3 + 5 * b5 * s**4) / h
    acceleration = a[:-1] + (6 * b3 * s + 12 * b4 * s**2 + 20 * b5 * s**3) / h**2
    jerk = (6 * b3 + 24 * b4 * s + 60 * b5 * s**2) / h**3
    return np.array(
        [
            (np.abs(x) / limit).max()
            for x, limit in zip((velocity, acceleration, jerk), problem.limits.derivatives, strict=True)
        ]
    )


@pytest.mark.parametrize("rate", [50.0, 125.0, 1000.0])
def test_sampling_the_fastest_motion_breaks_limits_and_the_file_does_not(rate: float) -> None:
    problem, fastest = panda()
    times = np.append(np.arange(int(fastest.seconds * rate)) / rate, fastest.seconds)
    states = np.stack([fastest.at(times, order) for order in range(3)])
    assert factors(times, states, problem)[2] > 1.02

    motion = at_rate(problem, fastest, rate)
    times, states = points_of(motion)
    assert (factors(times, states, problem) <= 1.0 + 1e-9).all()
    assert check(problem, joined(times, *states, passages=motion.trajectory.passage_times)).feasible
    # every waypoint is a point of the file, and each segment is rounded up to a period
    at = np.searchsorted(times, motion.trajectory.passage_times)
    assert np.array_equal(times[at], motion.trajectory.passage_times)
    assert np.abs(states[0][at] - problem.waypoints).max() <= 1e-9
    assert fastest.seconds <= motion.trajectory.seconds
    assert motion.trajectory.seconds <= fastest.seconds + 2.0 * problem.n_segments / rate
    assert np.allclose(np.diff(times), 1.0 / rate, rtol=0.0, atol=1.1e-9)


def test_without_a_rate_no_two_points_are_too_close_for_their_digits() -> None:
    problem, fastest = panda()
    assert np.diff(fastest.breaks).min() < 1e-6  # what spoiled files that held every switch
    motion = at_rate(problem, fastest, None)
    times, states = points_of(motion)
    assert np.diff(times).min() > 1e-5
    assert (factors(times, states, problem) <= 1.0 + 1e-9).all()
    assert motion.trajectory.seconds <= 1.011 * fastest.seconds


@given(seed=st.integers(0, 10**6), rate=st.sampled_from([40.0, 125.0, 300.0, 1024.0]))
@settings(max_examples=12)
def test_files_of_random_problems_keep_their_limits(seed: int, rate: float) -> None:
    rng = np.random.default_rng(seed)
    dof, count = int(rng.integers(1, 4)), int(rng.integers(2, 6))
    limits = Limits.of(
        rng.uniform(0.5, 3.0, dof),
        rng.uniform(2.0, 20.0, dof),
        np.where(rng.random(dof) < 0.3, np.inf, rng.uniform(50.0, 5000.0, dof)),
        dof=dof,
    )
    problem = Problem.of(rng.uniform(-2.0, 2.0, (count, dof)), limits)
    fastest = free_form(problem).trajectory
    assert fastest is not None
    motion = at_rate(problem, fastest, rate)
    times, states = points_of(motion)
    assert (factors(times, states, problem) <= 1.0 + 1e-9).all()
    assert check(problem, joined(times, *states, passages=motion.trajectory.passage_times)).feasible


def test_stops_and_times_that_were_asked_for_are_kept() -> None:
    problem, _ = panda()
    asked = Conditions(stops=frozenset([1]), passage={3: 6.0})
    fastest = free_form(problem, conditions=asked).trajectory
    assert fastest is not None
    motion = at_rate(problem, fastest, 125.0, conditions=asked)
    verdict = check(problem, motion.trajectory, conditions=asked)
    assert verdict.feasible, verdict.faults
    assert motion.trajectory.passage_times[3] == pytest.approx(6.0, abs=1e-12)
    with pytest.raises(InputError, match=r"waypoint 4 is asked for at 6 s, between two points"):
        at_rate(problem, fastest, 0.99, conditions=asked)


def test_what_no_controller_can_run_is_refused() -> None:
    free = Problem.of([[0.0], [1.0]], Limits.of(1.0, dof=1))
    motion = free_form(free).trajectory
    assert motion is not None
    with pytest.raises(InputError, match=r"limits\.acceleration: joint 1 has none"):
        at_rate(free, motion, 125.0)
    problem, fastest = panda()
    with pytest.raises(InputError, match="rate: 1e\\+09 points per second"):
        at_rate(problem, fastest, 1e9)
    with pytest.raises(InputError, match="rounding of positions"):
        at_rate(problem, fastest, 1e5)
    for rate in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(InputError, match="rate"):
            at_rate(problem, fastest, rate)


@pytest.mark.parametrize("case", ["sr4c", "ur5"])
def test_shipped_cases_cost_at_most_a_period_per_segment(case: str) -> None:
    problem = load(case)
    fastest = free_form(problem).trajectory
    assert fastest is not None
    motion = at_rate(problem, fastest, 125.0)
    times, states = points_of(motion)
    assert (factors(times, states, problem)[:2] <= 1.0 + 1e-9).all()
    assert motion.trajectory.seconds <= fastest.seconds + 2.0 * problem.n_segments / 125.0


@pytest.mark.parametrize("rate", [None, 100.0])
@pytest.mark.parametrize(
    "asked",
    [
        Conditions(tolerance={1: np.array([0.2, 0.1])}),
        Conditions(end_velocity="free", end_acceleration="free"),
        Conditions(windows={1: (2.0, 9.0)}, segment_times={1: (2.5, np.inf)}),
        Conditions(start_velocity=np.array([0.3, -0.2]), start_acceleration=np.array([0.5, 1.0])),
    ],
    ids=["zone", "free end", "times", "moving start"],
)
def test_demands_are_kept_by_points(asked: Conditions, rate: float | None) -> None:
    limits = Limits.of([[-1.0, 2.0], [-1.5, 1.5]], [[-4.0, 3.0], [-5.0, 5.0]], 20.0, dof=2)
    problem = Problem.of([[0.0, 0.0], [1.0, 0.5], [0.2, 1.0]], limits, conditions=asked)
    fastest = free_form(problem).trajectory
    assert fastest is not None
    found = at_rate(problem, fastest, rate)
    assert check(problem, found.trajectory).feasible
    assert fastest.seconds * (1.0 - 1e-9) <= found.trajectory.seconds < 1.1 * fastest.seconds


def test_points_refuse_a_wait() -> None:
    asked = Conditions(waits={1: 0.5})
    limits = Limits.of(2.0, 4.0, 20.0, dof=1)
    problem = Problem.of([[0.0], [1.0], [0.2]], limits, conditions=asked)
    waiting = free_form(problem).trajectory
    assert waiting is not None
    with pytest.raises(InputError, match=r"conditions\.waits: .* wait at waypoint 2;"):
        at_rate(problem, waiting, 100.0)
