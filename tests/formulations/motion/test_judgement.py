"""Motions of other planners and planted faults: the judge against dense samples made here."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import ruckig
import toppra
from conftest import Array
from hypothesis import given, settings
from hypothesis import strategies as st
from planted_motions import HERMITE_PEAKS, rest_to_rest
from scipy.interpolate import BPoly, CubicHermiteSpline

from formulations import InputError, Limits, Problem, Trajectory, free_form, load
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.judgement import Judgement, judge

NAMES = ("velocity", "acceleration", "jerk")


def dense(points: MotionPoints) -> list[Array]:
    """Largest |velocity|, |acceleration|, |jerk| per joint, from 1000 samples of each Hermite piece."""
    t = points.times - points.times[0]
    at = np.concatenate([np.linspace(a, b, 1000, endpoint=False) for a, b in pairwise(t)])
    if points.accelerations is not None:
        stated = np.stack([points.positions, points.velocities, points.accelerations], axis=1)
        curve = BPoly.from_derivatives(t, stated)
    else:
        curve = CubicHermiteSpline(t, points.positions, points.velocities)
    return [np.abs(curve.derivative(k)(at)).max(axis=0) for k in (1, 2, 3)]


def agrees(found: Judgement, points: MotionPoints, limits: Limits) -> None:
    """Each broken limit is one that the samples break, by as much."""
    broken = {(peak.quantity, peak.joint): peak for peak in found.violations}
    for order, reached in enumerate(dense(points)):
        for joint, value in enumerate(reached):
            limit = limits.derivatives[order, joint]
            peak = broken.get((NAMES[order], joint))
            if value > limit * (1.0 + 1e-6):
                assert peak is not None, (NAMES[order], joint, value, limit)
            if peak is not None:
                assert peak.factor >= value / limit * (1.0 - 1e-9)
                assert peak.factor <= value / limit * (1.0 + 1e-2)
                assert abs(peak.value) == pytest.approx(peak.factor * limit)


# --- motions of other planners ----------------------------------------------------------------------


def test_toppras_motion_breaks_its_limits_between_its_grid_points_and_jerk_altogether() -> None:
    problem = load("ur5")
    limits = problem.limits
    knots = np.linspace(0.0, 1.0, len(problem.waypoints))
    path = toppra.SplineInterpolator(knots, problem.waypoints)
    both = [
        toppra.constraint.JointVelocityConstraint(np.stack([-limits.velocity, limits.velocity], 1)),
        toppra.constraint.JointAccelerationConstraint(
            np.stack([-limits.acceleration, limits.acceleration], 1)
        ),
    ]
    planned = toppra.algorithm.TOPPRA(both, path, solver_wrapper="seidel").compute_trajectory()
    t = np.linspace(0.0, planned.duration, 200)
    points = MotionPoints(t, planned(t), planned(t, 1))
    found = judge(problem, points)
    assert found.interpolation == "cubic"
    assert not found.missed
    agrees(found, points, limits)
    assert ("jerk" in {peak.quantity for peak in found.violations}) == bool(
        (dense(points)[2] > limits.jerk).any()
    )
    if limits.has_jerk:
        # cubics: the acceleration jumps, and no stretch takes that away
        assert {jump.quantity for jump in found.jumps} == {"acceleration"}
        assert found.stretch == np.inf


def stop_and_go(problem: Problem, step: float | None) -> MotionPoints:
    """Ruckig from stop to stop: points where a phase of any joint ends, or every ``step`` seconds."""
    rows, start = [], 0.0
    for a, b in pairwise(problem.waypoints):
        task = ruckig.InputParameter(problem.dof)
        task.current_position, task.target_position = a.tolist(), b.tolist()
        task.max_velocity, task.max_acceleration, task.max_jerk = problem.limits.derivatives.tolist()
        answer = ruckig.Trajectory(problem.dof)
        ruckig.Ruckig(problem.dof).calculate(task, answer)
        ends = np.cumsum([profile.t for profile in answer.profiles[0]], axis=1).ravel()
        if step is not None:
            ends = np.arange(0.0, answer.duration, step)
        times = np.unique(np.concatenate([[0.0], ends[ends < answer.duration], [answer.duration]]))
        times = times[np.append(np.diff(times) > 1e-6, True)]
        rows += [(start + t, *answer.at_time(t)) for t in times[bool(rows) :]]
        start += answer.duration
    t, x, v, a = (np.array(column) for column in zip(*rows, strict=True))
    return MotionPoints(t, x, v, a)


JERKY = Problem.of(
    [[0.0, 1.0], [0.7, 0.2], [1.5, 0.9]],
    Limits.of([1.0, 1.5], [3.0, 4.0], [20.0, 30.0], (-1.0, 2.0), dof=2),
)


def test_ruckigs_stop_and_go_is_right_where_its_phases_end_and_spoiled_by_10_hz() -> None:
    found = judge(JERKY, stop_and_go(JERKY, None))
    assert found.feasible, found
    assert found.stretch == pytest.approx(1.0, abs=1e-6)
    coarse = stop_and_go(JERKY, 0.1)
    spoiled = judge(JERKY, coarse)
    assert not spoiled.feasible
    assert not spoiled.missed
    agrees(spoiled, coarse, JERKY.limits)


@pytest.mark.parametrize("case", ["sr4c", "ur5"])
@pytest.mark.parametrize("degree", ["cubic", "quintic"])
def test_a_fastest_motion_sampled_at_10_hz_is_spoiled_by_the_controller(case: str, degree: str) -> None:
    problem = load(case)
    motion = free_form(problem).trajectory
    assert motion is not None
    t = np.append(np.arange(0.0, motion.seconds, 0.1), motion.seconds)
    points = MotionPoints(
        t, motion.at(t), motion.at(t, 1), motion.at(t, 2) if degree == "quintic" else None
    )
    found = judge(problem, points)
    assert not found.feasible
    assert found.violations
    agrees(found, points, problem.limits)
    # and the motion itself is good: what is wrong is the sampling
    itself = judge(problem, motion)
    assert itself.feasible
    assert itself.interpolation == "pieces"


# --- planted faults ---------------------------------------------------------------------------------


def two_joints(**limits: object) -> tuple[Problem, MotionPoints]:
    """Two joints from rest to rest in 2 s, by one quintic each: every peak lies between the points."""
    ends = np.array([[0.0, 0.0], [1.0, -2.0]])
    problem = Problem.of(ends, Limits.of(dof=2, **limits))  # type: ignore[arg-type]
    return problem, MotionPoints(np.array([0.0, 2.0]), ends, 0.0 * ends, 0.0 * ends)


def test_one_per_cent_over_the_limit_of_one_joint_between_the_samples() -> None:
    peak = 2.0 * HERMITE_PEAKS[0] / 2.0
    problem, points = two_joints(velocity=[10.0, peak / 1.01], acceleration=50.0)
    found = judge(problem, points)
    (broken,) = found.violations
    assert (broken.quantity, broken.joint) == ("velocity", 1)
    assert broken.time == pytest.approx(1.0, abs=1e-6)
    assert broken.value == pytest.approx(-peak)
    assert broken.factor == pytest.approx(1.01)
    assert found.stretch == pytest.approx(1.01)
    # at the limit itself nothing is wrong
    problem, points = two_joints(velocity=[10.0, peak], acceleration=50.0)
    assert judge(problem, points).feasible


def test_a_waypoint_missed_by_a_thousandth() -> None:
    limits = Limits.of(10.0, 100.0, dof=2)
    problem = Problem.of([[0.0, 0.0], [0.5, 1e-3], [1.0, 0.0]], limits)
    motion = rest_to_rest(np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([2.0]))
    found = judge(problem, motion)
    (miss,) = found.missed
    assert (miss.waypoint, miss.joint) == (1, 1)
    assert miss.distance == pytest.approx(-1e-3)
    assert miss.time == pytest.approx(1.0, abs=1e-4)
    assert found.stretch == np.inf
    assert judge(problem, motion, tolerance=2e-3).feasible


@pytest.mark.parametrize(("order", "quantity"), [(0, "position"), (1, "velocity")])
def test_a_jump_is_found_where_it_is(order: int, quantity: str) -> None:
    motion = rest_to_rest(np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 3.0]]), np.array([1.0, 2.0]))
    coefficients = motion.coefficients.copy()
    coefficients[1, 1, order] += 0.01
    problem = Problem.of([[0.0, 0.0], [2.0, 3.0]], Limits.of(50.0, 500.0, dof=2))
    found = judge(problem, Trajectory(motion.durations, coefficients), tolerance=0.1)
    (jump,) = found.jumps
    assert (jump.quantity, jump.joint, jump.count) == (quantity, 1, 1)
    assert jump.time == pytest.approx(1.0)
    assert jump.size == pytest.approx(0.01)
    assert found.stretch == np.inf


def test_straight_lines_jump_in_velocity_at_every_point_and_at_the_ends() -> None:
    t = np.array([0.0, 1.0, 2.0, 3.0])
    points = MotionPoints(t, np.array([[0.0], [1.0], [3.0], [4.0]]))
    found = judge(Problem.of([[0.0], [4.0]], Limits.of(5.0, 10.0, dof=1)), points)
    assert found.interpolation == "linear"
    (jump,) = found.jumps
    assert (jump.quantity, jump.count) == ("velocity", 2)
    (end,) = found.not_at_rest
    assert end.size == pytest.approx(1.0)
    assert not found.violations
    assert found.stretch == np.inf


def test_a_position_limit_is_mended_by_no_stretch() -> None:
    t = np.array([0.0, 1.0, 2.0])
    points = MotionPoints(t, np.array([[0.0], [1.2], [1.0]]), np.zeros((3, 1)), np.zeros((3, 1)))
    found = judge(Problem.of([[0.0], [1.0]], Limits.of(9.0, 99.0, np.inf, (-1.0, 1.0), dof=1)), points)
    (broken,) = found.violations
    assert (broken.quantity, broken.value, broken.limit) == ("position", pytest.approx(1.2), 1.0)
    assert found.stretch == np.inf


def test_what_does_not_fit_is_refused() -> None:
    problem, points = two_joints(velocity=9.0)
    other = Problem.of([[0.0], [1.0]], Limits.of(1.0, dof=1))
    with pytest.raises(InputError, match="motion: 2 joints, the problem has 1"):
        judge(other, points)
    with pytest.raises(InputError, match="tolerance: 0"):
        judge(problem, points, tolerance=0.0)
    with pytest.raises(InputError, match="interpolation: quintic needs"):
        judge(problem, MotionPoints(points.times, points.positions), interpolation="quintic")


# --- laws -------------------------------------------------------------------------------------------


@given(
    seed=st.integers(0, 10**6),
    dof=st.integers(1, 3),
    count=st.integers(2, 6),
    pace=st.floats(0.05, 5.0),
)
@settings(max_examples=60, deadline=None)
def test_the_stretch_mends_every_limit_and_a_thousandth_less_does_not(
    seed: int, dof: int, count: int, pace: float
) -> None:
    rng = np.random.default_rng(seed)
    waypoints = rng.uniform(-2.0, 2.0, (count, dof))
    limits = Limits.of(*rng.uniform(0.5, 5.0, (3, dof)), dof=dof)
    problem = Problem.of(waypoints, limits)
    found = judge(problem, rest_to_rest(waypoints, rng.uniform(0.5, 2.0, count - 1) * pace))
    assert not found.missed
    derivatives = {(p.quantity, p.joint) for p in found.violations}
    assert bool(derivatives) == (found.stretch_for_limits > 1.0)
    factor = found.stretch_for_limits
    assert not judge(problem, found.motion.stretched(factor)).violations
    assert judge(problem, found.motion.stretched(0.999 * factor)).violations


@given(digits=st.integers(9, 15), rate=st.sampled_from([100.0, 1000.0, 4000.0]))
@settings(max_examples=10, deadline=None)
def test_points_of_a_good_motion_are_not_broken_by_the_rounding_of_doubles(
    digits: int, rate: float
) -> None:
    """A smooth motion well inside its limits, at 1 kHz and more: no jump, no limit, no waypoint."""
    waypoints = np.array([[3.0, -2.0], [2.0, 1.0]])
    motion = rest_to_rest(waypoints, np.array([2.0]))
    problem = Problem.of(waypoints, Limits.of(9.0, 30.0, 500.0, dof=2))
    t, values = motion.sample(rate)
    points = MotionPoints(t, *(np.round(value, digits) for value in values[:3]))
    if digits == 15:
        assert judge(problem, points).feasible
    assert not judge(problem, points).jumps
