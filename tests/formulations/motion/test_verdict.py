"""The check: motions that are right, and planted faults that it must find and name."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from conftest import Array, durations, problems
from hypothesis import given
from hypothesis import strategies as st
from planted_motions import (
    HERMITE_PEAKS,
    THIRD,
    TIMES,
    WAYPOINTS,
    bumped,
    judged_infeasible,
    kick,
    one_piece,
    problem_of,
    rest_to_rest,
    spline,
)

from formulations import FAMILIES, InputError, Limits, Problem, Trajectory, check
from formulations.motion.peaks import Peak

# --- a motion that is right -----------------------------------------------------------------------


@given(problem=problems(segments=st.integers(1, 5), reach=(-4.0, 2.0)), data=st.data())
def test_a_motion_stretched_by_its_verdict_is_feasible_and_no_slower_than_needed(
    problem: Problem, data: st.DataObject
) -> None:
    times = data.draw(durations(problem.n_segments, -2.0, 2.0))
    motion = rest_to_rest(problem.waypoints, times)
    verdict = check(problem, motion)
    d = np.abs(problem.displacements)
    ratios = [
        (HERMITE_PEAKS[order - 1] * d / times[:, None] ** order / limit) ** (1.0 / order)
        for order, limit in enumerate(problem.limits.derivatives, 1)
    ]
    assert verdict.stretch == pytest.approx(np.max(ratios), rel=1e-9)
    if not problem.moving_joints:
        assert verdict.stretch == 0.0
        assert verdict.feasible
        return
    fitted = check(problem, motion.stretched(verdict.stretch))
    assert fitted.faults == ()
    assert fitted.feasible
    assert fitted.stretch == pytest.approx(1.0, rel=1e-12)
    assert fitted.worst is not None
    assert fitted.worst.factor == pytest.approx(1.0, rel=1e-11)
    assert fitted.seconds == pytest.approx(times.sum() * verdict.stretch, rel=1e-13)
    faster = check(problem, motion.stretched(verdict.stretch * (1.0 - 1e-7)))
    assert not faster.feasible
    assert all("over the limit" in fault for fault in faster.faults)


@pytest.mark.parametrize("family", list(FAMILIES))
@given(data=st.data())
def test_the_check_and_the_families_agree_on_the_stretch(family: str, data: st.DataObject) -> None:
    """Two ways to the same number that share no code."""
    segments = 3 if family == "3-5-3" else data.draw(st.integers(2, 6))
    problem = data.draw(problems(segments=segments, family=family, reach=(-4.0, 2.0)))
    # between durations far apart a B-spline swings out to 1e7 times its waypoints, which it then
    # passes to within the rounding of the swing, not of the waypoints
    wide = 1.0 if family.startswith("b-spline") else 2.0
    times = data.draw(durations(segments, -wide, wide))
    chosen = FAMILIES[family]
    stretch = float(chosen.stretch(problem, times[None])[0])
    assert check(problem, chosen.trajectory(problem, times)).stretch == pytest.approx(stretch, rel=1e-9)
    if stretch > 0.0:
        verdict = check(problem, chosen.trajectory(problem, times * stretch))
        assert verdict.feasible, verdict.faults


def test_peaks_are_sorted_worst_first() -> None:
    problem = Problem.of([[0.0], [1.0]], Limits.of(10.0, 1.0, 1e5, dof=1))
    verdict = check(problem, rest_to_rest(problem.waypoints, np.array([1.0])))
    assert [peak.quantity for peak in verdict.peaks] == ["acceleration", "velocity", "jerk"]
    assert verdict.worst is verdict.peaks[0]
    assert verdict.peaks[0].stretch == pytest.approx(math.sqrt(10.0 / math.sqrt(3.0)))


def test_a_motion_without_any_limit_in_force_has_no_worst_peak_but_passes() -> None:
    problem = Problem.of([[1.0], [1.0]], Limits.of(1.0, dof=1))
    verdict = check(problem, rest_to_rest(problem.waypoints, np.array([1.0])))
    assert verdict.feasible
    assert verdict.stretch == 0.0


def test_the_motion_without_a_fault_passes() -> None:
    for jerk in (np.inf, 1e4):
        verdict = check(problem_of(jerk), spline())
        assert verdict.faults == ()
        assert verdict.feasible


@pytest.mark.parametrize("row", range(4))
@pytest.mark.parametrize("joint", range(2))
def test_a_missed_waypoint_is_named(row: int, joint: int) -> None:
    moved = WAYPOINTS.copy()
    moved[row, joint] += 1e-6
    verdict = check(problem_of(waypoints=moved), spline())
    assert not verdict.feasible
    assert verdict.faults == (f"misses waypoint {row + 1}, joint {joint + 1} by 1e-06 rad",)


def test_a_waypoint_count_that_differs_is_a_fault() -> None:
    problem = problem_of(waypoints=WAYPOINTS[:3])
    verdict = check(problem, spline())
    assert not verdict.feasible
    assert "4 passage times for 3 waypoints" in verdict.faults[0]


def test_a_jump_of_position_is_found() -> None:
    verdict = check(problem_of(), bumped(spline(), 1, 1, kick(0, 1e-5, TIMES[1])))
    assert not verdict.feasible
    assert any("position of joint 2 jumps by 1e-05" in fault for fault in verdict.faults)


@pytest.mark.parametrize("piece", [1, 2])
@pytest.mark.parametrize("joint", [0, 1])
def test_a_jump_of_velocity_at_a_knot_is_found(piece: int, joint: int) -> None:
    motion = bumped(spline(), piece, joint, kick(1, 1e-5, TIMES[piece]))
    verdict = check(problem_of(), motion)
    assert not verdict.feasible
    assert verdict.faults == (f"velocity of joint {joint + 1} jumps by 1e-05",)


@pytest.mark.parametrize("piece", [1, 2])
def test_a_jump_of_acceleration_is_found_where_jerk_is_limited_and_accepted_where_not(
    piece: int,
) -> None:
    motion = bumped(spline(), piece, 1, kick(2, 1e-3, TIMES[piece]))
    verdict = check(problem_of(jerk=1e4), motion)
    assert not verdict.feasible
    assert verdict.faults == ("acceleration of joint 2 jumps by 0.001",)
    assert check(problem_of(), motion).feasible


def test_a_jump_of_acceleration_is_found_where_jerk_alone_is_limited() -> None:
    """Full throttle, full brake: feasible without a jerk limit, infinitely jerky with one."""
    motion = Trajectory(np.array([1.0, 1.0]), np.array([[[0.0, 0.0, 0.5]], [[0.5, 1.0, -0.5]]]))
    motion = replace(motion, passages=np.array([0.0, 2.0]))
    for limits, feasible in (
        (Limits.of(2.0, 2.0, dof=1), True),
        (Limits.of(2.0, 2.0, 1e3, dof=1), False),
        (Limits.of(2.0, np.inf, 1e3, dof=1), False),
    ):
        verdict = check(Problem.of([[0.0], [1.0]], limits), motion)
        assert verdict.feasible is feasible
        if not feasible:
            assert "acceleration of joint 1 jumps by 2" in verdict.faults
            assert "acceleration of joint 1 is 1 at an end" in verdict.faults


def test_a_jump_is_blamed_on_the_joint_it_is_forbidden_to() -> None:
    """Joint 1 has no jerk limit and may jump by more."""
    motion = bumped(spline(), 1, 0, kick(2, 5e-3, TIMES[1]))
    motion = bumped(motion, 1, 1, kick(2, 1e-3, TIMES[1]))
    limits = Limits.of(50.0, 500.0, [np.inf, 1e4], dof=2)
    verdict = check(Problem.of(WAYPOINTS, limits), motion)
    assert verdict.faults == ("acceleration of joint 2 jumps by 0.001",)


def test_a_jump_of_velocity_is_found_without_a_velocity_limit() -> None:
    try:
        limits = Limits.of(np.inf, 5.0, dof=1)
    except InputError:
        return  # then nothing can be unlimited in velocity
    assert judged_infeasible(Problem.of([[0.0], [1.0]], limits), one_piece(0.0, 1.0))


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize("joint", [0, 1])
def test_a_motion_that_does_not_rest_at_an_end_is_found(end: str, joint: int) -> None:
    for order, jerk in ((1, np.inf), (2, 1e4)):
        piece = 0 if end == "start" else 2
        bump = kick(order, 1e-3, TIMES[piece])
        if end == "end":
            bump = bump(np.polynomial.Polynomial([TIMES[piece], -1.0]))
        motion = bumped(spline(), piece, joint, bump)
        verdict = check(problem_of(jerk), motion)
        name = ("", "velocity", "acceleration")[order]
        assert not verdict.feasible
        assert verdict.faults == (f"{name} of joint {joint + 1} is 0.001 at an end",)
        if order == 2:  # without a jerk limit the acceleration is free to jump from rest
            assert check(problem_of(), motion).feasible


def three_joints(joint: int, segment: int) -> tuple[Array, Array, Trajectory]:
    """A motion whose chosen joint moves most, and most in the chosen segment."""
    times = np.array([0.8, 1.0, 1.3, 0.9])
    steps = np.full((4, 3), 0.2)
    steps[segment, joint] = -1.0
    steps *= times[:, None] ** 3  # no segment is quicker than another but by its step
    waypoints = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    return times, waypoints, rest_to_rest(waypoints, times)


@pytest.mark.parametrize("segment", range(4))
@pytest.mark.parametrize("joint", range(3))
@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_limit_broken_by_a_millionth_is_named_with_joint_segment_time_and_factor(
    order: int, joint: int, segment: int
) -> None:
    times, waypoints, motion = three_joints(joint, segment)
    step, time = abs(waypoints[segment + 1, joint] - waypoints[segment, joint]), times[segment]
    limits = [np.full(3, 1e4) for _ in range(3)]
    peak = HERMITE_PEAKS[order - 1] * step / time**order
    for factor, feasible in ((1.0 + 1e-6, False), (1.0 + 1e-12, True), (1.0 - 1e-6, True)):
        limits[order - 1][joint] = peak / factor
        problem = Problem.of(waypoints, Limits.of(*limits, dof=3))
        verdict = check(problem, motion)
        assert verdict.stretch == pytest.approx(factor ** (1.0 / order), rel=1e-12)
        assert verdict.feasible is feasible, verdict.faults
        worst = verdict.worst
        assert worst is not None
        assert worst.quantity == ("velocity", "acceleration", "jerk")[order - 1]
        assert (worst.joint, worst.segment) == (joint, segment)
        assert worst.factor == pytest.approx(factor, rel=1e-12)
        assert abs(worst.value) == pytest.approx(peak, rel=1e-12)
        assert worst.limit == peak / factor
        places = {1: [0.5], 2: [THIRD, 1.0 - THIRD], 3: [0.0, 1.0]}[order]
        local = (worst.time - times[:segment].sum()) / time
        assert min(abs(local - place) for place in places) < 1e-6
        if not feasible:
            assert len(verdict.faults) == 1
            assert f"joint {joint + 1} in segment {segment + 1}" in verdict.faults[0]
            assert "over the limit" in verdict.faults[0]


@pytest.mark.parametrize(
    ("quantity", "said"),
    [
        ("velocity", "90 deg/s, limit 180 deg/s"),
        ("torque", "1.5708 N m, limit 3.14159 N m"),
    ],
)
def test_a_peak_is_said_in_its_own_unit(quantity: str, said: str) -> None:
    """Degrees are a unit of angles; a torque has none in it."""
    peak = Peak(quantity, 0, 0, 0.5, math.pi / 2.0, math.pi, 0.5, 0.5, angle="deg")
    assert f"at 0.5000 s: {said}, factor 0.5" in str(peak)
