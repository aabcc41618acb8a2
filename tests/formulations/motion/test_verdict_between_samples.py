"""The check finds what samples miss, and judges positions and motions that are no motions."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from planted_motions import (
    TIMES,
    at,
    bumped,
    judged_infeasible,
    one_piece,
    problem_of,
    rest_to_rest,
    spline,
)

from formulations import FAMILIES, InputError, Limits, Problem, Trajectory, check, load

# --- violations between samples -------------------------------------------------------------------


def sampled_velocity(motion: Trajectory, per_segment: int = 100) -> float:
    """What a check by samples sees, as the papers make it."""
    times = motion.passage_times
    grid = [np.linspace(a, b, per_segment) for a, b in pairwise(times)]
    return float(np.abs(motion.at(np.concatenate(grid), 1)).max())


def test_a_peak_between_samples_is_found() -> None:
    """The quintic's 15/8 lies at the middle of a segment, where no sample of a hundred falls."""
    motion = rest_to_rest(np.array([[0.0], [1.0]]), np.array([1.0]))
    limit = 15.0 / 8.0 * (1.0 - 1e-4)
    assert sampled_velocity(motion) < limit
    verdict = check(Problem.of([[0.0], [1.0]], Limits.of(limit, dof=1)), motion)
    assert not verdict.feasible
    assert verdict.worst is not None
    assert verdict.worst.time == pytest.approx(0.5, abs=1e-7)
    assert verdict.worst.factor == pytest.approx(1.0 / (1.0 - 1e-4), rel=1e-12)


def test_a_narrow_spike_of_velocity_between_samples_is_found() -> None:
    """Cruise at 1 rad/s with a hat of 0.3 rad/s and 2 ms, between the samples 1/99 s apart."""
    width = 1e-3
    before = 49.5 / 99.0 - width  # the middle of a gap in a segment of one second
    durations = np.array([1.0, before, width, width, 1.0 - before - 2.0 * width, 1.0])
    pieces = [
        [0.0, 0.0, 1.5, -2.0 / 3.0],  # velocity 3 t - 2 t^2: 0 to 1
        [0.0, 1.0],
        [0.0, 1.0, 0.15 / width],
        [0.0, 1.3, -0.15 / width],
        [0.0, 1.0],
        [0.0, 1.0, 0.5, -2.0 / 3.0],  # velocity 1 + t - 2 t^2: 1 to 0
    ]
    c = np.zeros((6, 1, 4))
    position = 0.0
    for k, (piece, h) in enumerate(zip(pieces, durations, strict=True)):
        c[k, 0, : len(piece)] = piece
        c[k, 0, 0] = position
        position = float(np.polynomial.polynomial.polyval(h, c[k, 0]))
    breaks = np.concatenate([[0.0], np.cumsum(durations)])
    motion = Trajectory(durations, c, breaks[[0, 1, 5, 6]])
    waypoints = motion.at(motion.passage_times)
    limit = 1.2
    assert sampled_velocity(motion) < limit
    verdict = check(Problem.of(waypoints, Limits.of(limit, dof=1)), motion)
    assert not verdict.feasible
    worst = verdict.worst
    assert worst is not None
    assert (worst.quantity, worst.joint, worst.segment) == ("velocity", 0, 1)
    assert worst.time == pytest.approx(1.5, abs=1e-9)
    assert worst.value == pytest.approx(1.3, rel=1e-12)
    assert len(verdict.faults) == 1
    # it is the spike alone that is wrong
    assert check(Problem.of(waypoints, Limits.of(1.3001, dof=1)), motion).feasible


# --- position limits ------------------------------------------------------------------------------


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_swing_beyond_the_position_limits_between_waypoints_is_found(side: float) -> None:
    """0 to 1 to 1 to 0 overshoots: x = 1 + 3 s (1 - s) + ... between the middle waypoints."""
    points = side * np.array([[0.0], [1.0], [1.0], [0.0]])
    times = np.ones(3)
    free = Problem.of(points, Limits.of(100.0, dof=1))
    motion = FAMILIES["3-5-3"].trajectory(free, times)
    top = float(np.abs(at(motion.coefficients[1, 0], 0)).max())
    assert top > 1.5
    for room, feasible in ((top - 1e-6, False), (top + 1e-6, True)):
        bounds = sorted([-side, side * room])
        problem = Problem.of(points, Limits.of(100.0, position=[bounds], dof=1))
        verdict = check(problem, motion)
        assert verdict.feasible is feasible
        assert verdict.position_kept is feasible
        assert verdict.stretch < 1.0  # the derivatives are kept either way
        assert not check(problem, motion.stretched(10.0)).feasible or feasible
        if not feasible:
            assert len(verdict.faults) == 1
            assert "position of joint 1 in segment 2" in verdict.faults[0]
            peak = next(peak for peak in verdict.peaks if peak.quantity == "position")
            assert peak.time == pytest.approx(1.5, abs=1e-6)
            assert peak.value == pytest.approx(side * top, rel=1e-7)
            assert peak.limit == pytest.approx(side * room, rel=1e-12)
            assert peak.factor > 1.0
            assert peak.stretch == math.inf


def test_a_joint_that_sits_on_its_limit_within_rounding_is_accepted() -> None:
    problem = load("sr4c")
    family = FAMILIES["3-5-3"]
    for times in ([1.5, 2.0, 1.2], [4.0, 4.0, 4.0], [0.3, 0.4, 0.2]):
        stretch = family.stretch(problem, np.array([times]))[0]
        verdict = check(problem, family.trajectory(problem, np.array(times) * stretch))
        assert verdict.faults == ()
        assert verdict.position_kept


def test_a_joint_that_dips_below_its_starting_limit_is_not_accepted() -> None:
    problem = load("sr4c")
    motion = FAMILIES["3-5-3"].trajectory(problem, [4.0, 4.0, 4.0])
    t = np.polynomial.Polynomial([0.0, 1.0])
    rise = problem.waypoints[1, 4] - problem.waypoints[0, 4]
    for size, kept in ((0.5, True), (2.0, False)):  # it starts as (rise - size) times a cube
        dip = -size * rise * (t / 4.0) ** 3 * (1.0 - t / 4.0) ** 2
        verdict = check(problem, bumped(motion, 0, 4, dip))
        assert verdict.position_kept is kept
        fault = any("position of joint 5 in segment 1" in fault for fault in verdict.faults)
        assert fault is not kept


def test_position_limits_on_one_side_alone_are_judged_on_that_side() -> None:
    points = np.array([[0.0], [1.0], [1.0], [0.0]])
    motion = FAMILIES["3-5-3"].trajectory(Problem.of(points, Limits.of(100.0, dof=1)), np.ones(3))
    for bounds, feasible in (([-np.inf, 1.0], False), ([0.0, np.inf], True), ([-1.0, np.inf], True)):
        problem = Problem.of(points, Limits.of(100.0, position=[bounds], dof=1))
        assert check(problem, motion).feasible is feasible


# --- motions that are no motions ------------------------------------------------------------------


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("power", range(6))
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_coefficient_that_is_no_number_is_never_feasible(value: float, power: int) -> None:
    for piece in range(3):
        c = spline().coefficients.copy()
        c[piece, 1, power] = value
        try:
            motion = Trajectory(TIMES, c)
        except InputError:
            continue
        assert judged_infeasible(problem_of(), motion)
        assert judged_infeasible(problem_of(1e4), motion)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_passage_time_that_is_no_number_is_never_feasible() -> None:
    for value in (np.nan, np.inf):
        try:
            motion = replace(spline(), passages=np.array([0.0, 1.0, value, TIMES.sum()]))
        except InputError:
            continue
        assert judged_infeasible(problem_of(), motion)


def test_a_motion_that_goes_on_after_the_last_waypoint_is_never_feasible() -> None:
    """There and back again: it passes the last waypoint and ends elsewhere."""
    motion = rest_to_rest(np.array([[0.0], [1.0], [0.0]]), np.array([1.0, 1.0]))
    problem = Problem.of([[0.0], [1.0]], Limits.of(10.0, dof=1))
    assert judged_infeasible(problem, replace(motion, passages=np.array([0.0, 1.0])))
    assert judged_infeasible(
        Problem.of([[1.0], [0.0]], problem.limits), replace(motion, passages=np.array([1.0, 2.0]))
    )


def test_waypoints_passed_in_another_order_are_never_feasible() -> None:
    motion = rest_to_rest(np.array([[0.0], [1.0], [0.0]]), np.array([1.0, 1.0]))
    problem = Problem.of([[0.0], [1.0], [0.5], [0.0]], Limits.of(10.0, dof=1))
    assert check(problem, replace(motion, passages=np.array([0.0, 1.0, 1.5, 2.0]))).feasible
    assert judged_infeasible(problem, replace(motion, passages=np.array([0.0, 1.0, 0.5, 2.0])))


def test_waypoints_beyond_the_end_of_the_motion_are_never_passed() -> None:
    """t^3/2 - 3/4 t^2 rests at 0 and at 1 s, at -1/4; only at 2 s, were it to go on, is it 1."""
    motion = one_piece(0.0, 0.0, -0.75, 0.5)
    limits = Limits.of(10.0, dof=1)
    assert check(Problem.of([[0.0], [-0.25]], limits), motion).feasible
    beyond = replace(motion, passages=np.array([0.0, 2.0]))
    assert judged_infeasible(Problem.of([[0.0], [1.0]], limits), beyond)
    before = replace(motion, passages=np.array([-1.0, 1.0]))
    assert judged_infeasible(Problem.of([[-1.25], [-0.25]], limits), before)
