"""A motion made under conditions, judged under them: stops, times, velocities at the ends, other limits."""

from __future__ import annotations

import numpy as np
import pytest
from planted_motions import HERMITE, HERMITE_PEAKS, one_piece, rest_to_rest

from formulations import Conditions, InputError, Limits, Problem, plan
from formulations.assessment import assess
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.judgement import judge

WAYPOINTS = np.array([[0.0], [1.0], [3.0]])
TIMES = np.array([1.0, 2.0])
WIDE = Limits.of(50.0, 500.0, 5000.0, dof=1)
PROBLEM = Problem(WAYPOINTS, WIDE)
RESTING = rest_to_rest(WAYPOINTS, TIMES)  # rests at waypoint 1, at 1 s, and ends at 3 s


def through() -> Problem:
    """One quintic from 0 to 2 in 1 s passes 1 at 0.5 s without a stop."""
    return Problem([[0.0], [1.0], [2.0]], WIDE)


THROUGH = one_piece(*(2.0 * HERMITE))


def test_what_is_kept_is_said_to_be_kept() -> None:
    for asked in (
        Conditions(stops=frozenset({1})),
        Conditions(passage={1: 1.0}),
        Conditions(total=3.0),
        Conditions(passage={1: 1.0, 2: 3.0}, stops=frozenset({0, 1, 2}), total=3.0),
    ):
        found = judge(PROBLEM, RESTING, conditions=asked)
        assert found.feasible, found
        assert found.conditions == asked


def test_a_waypoint_passed_at_another_time_is_missed_by_what_is_left_at_the_time_asked_for() -> None:
    found = judge(PROBLEM, RESTING, conditions=Conditions(passage={1: 1.5}))
    # a quarter of the second quintic is over: 2 (10/64 - 15/256 + 6/1024)
    past = 2.0 * (10.0 / 64.0 - 15.0 / 256.0 + 6.0 / 1024.0)
    (miss,) = found.missed
    assert (miss.waypoint, miss.joint, miss.time) == (1, 0, 1.5)
    assert miss.distance == pytest.approx(past, abs=1e-12)
    assert found.stretch == np.inf  # the time is asked for: no stretch is allowed
    assert judge(PROBLEM, RESTING).feasible


def test_a_stop_that_is_none_is_found_with_its_velocity() -> None:
    asked = Conditions(stops=frozenset({1}))
    found = judge(through(), THROUGH, conditions=asked)
    moving = [jump for jump in found.not_at_rest if jump.quantity == "velocity"]
    assert [(jump.waypoint, jump.joint) for jump in moving] == [(1, 0)]
    assert moving[0].size == pytest.approx(2.0 * HERMITE_PEAKS[0])
    assert moving[0].time == pytest.approx(0.5, abs=1e-6)
    assert not found.feasible
    assert judge(through(), THROUGH).feasible
    # it rests at waypoint 1, but not when it is asked to
    late = Conditions(stops=frozenset({1}), passage={1: 1.5})
    assert {jump.quantity for jump in judge(PROBLEM, RESTING, conditions=late).not_at_rest} >= {
        "velocity"
    }


@pytest.mark.parametrize("asked", [Conditions(total=2.9), Conditions(passage={2: 3.1})])
def test_another_total_time_is_a_fault(asked: Conditions) -> None:
    found = judge(PROBLEM, RESTING, conditions=asked)
    assert found.missed_total == (asked.total or asked.passage[2])
    assert not found.feasible
    assert found.stretch == np.inf
    assert not found.missed


def test_velocities_at_the_ends_take_the_place_of_rest() -> None:
    ramp = one_piece(0.0, 1.5, duration=2.0)  # 1.5 rad/s throughout
    problem = Problem([[0.0], [3.0]], WIDE)
    speed = np.array([1.5])
    both = Conditions(start_velocity=speed, end_velocity=speed)
    assert judge(problem, ramp, conditions=both).feasible
    one = judge(problem, ramp, conditions=Conditions(start_velocity=speed))
    (rest,) = one.not_at_rest
    assert (rest.time, rest.size, rest.waypoint) == (2.0, 1.5, None)
    wrong = judge(problem, ramp, conditions=Conditions(start_velocity=speed, end_velocity=-speed))
    assert [jump.size for jump in wrong.not_at_rest] == [3.0]


def test_limits_of_one_segment_count_there_alone() -> None:
    slow = Limits.of(1.0, 500.0, 5000.0, dof=1)
    # each quintic reaches 15/8 of its mean speed, which is 1 rad/s in both
    for segment in (0, 1):
        found = judge(PROBLEM, RESTING, conditions=Conditions(segment_limits={segment: slow}))
        (peak,) = found.violations
        assert (peak.quantity, peak.segment) == ("velocity", segment)
        assert peak.factor == pytest.approx(HERMITE_PEAKS[0])


def test_a_planned_motion_is_judged_and_bounded_under_its_own_conditions() -> None:
    problem = Problem([[0.0], [1.0], [3.0]], {"velocity": 1.0, "acceleration": 2.0, "jerk": 10.0})
    asked = Conditions(stops=frozenset({1}))
    motion = plan(problem, conditions=asked)
    t = np.unique(np.concatenate([motion.trajectory.breaks, motion.trajectory.passage_times]))
    t = t[np.append(True, np.diff(t) > 1e-9)]
    points = MotionPoints(
        *(motion.trajectory.at(t, order) if order >= 0 else t for order in (-1, 0, 1, 2))
    )
    found = assess(problem, points, conditions=asked)
    assert found.judgement.feasible, found.judgement
    # closed form of a move with a top speed, from rest to rest: d/v + v/a + a/j
    truth = sum(d / 1.0 + 1.0 / 2.0 + 2.0 / 10.0 for d in (1.0, 2.0))
    assert motion.seconds == pytest.approx(truth, rel=1e-6)
    assert found.bound is not None
    assert found.bound.seconds <= truth
    assert found.bound.seconds == pytest.approx(truth, rel=1e-3)
    assert found.gap is not None
    assert found.gap < 1e-3
    # without the stop a faster one could be had, so the gap is larger
    free = assess(problem, points).gap
    assert free is not None
    assert free > 0.1


def test_conditions_that_do_not_fit_are_refused() -> None:
    with pytest.raises(InputError, match=r"conditions\.stops: waypoint 3 is not there"):
        judge(PROBLEM, RESTING, conditions=Conditions(stops=frozenset({3})))
