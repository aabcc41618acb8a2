"""The bound under conditions: closed forms of one joint, and no motion that keeps them is faster."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from formulations import Conditions, InputError, Limits, Problem, free_form, free_form_bound, load

UR5 = load("ur5")
A = 2.0  # rad/s^2; the velocity limit is out of reach in the closed forms
ONE = Problem.of([[0.0], [0.25], [1.0]], Limits.of(velocity=100.0, acceleration=A, dof=1))
SLOW = replace(UR5.limits, velocity=0.5 * UR5.limits.velocity)
FAST = replace(UR5.limits, velocity=2.0 * UR5.limits.velocity, jerk=4.0 * UR5.limits.jerk)
DRIFT = np.array([0.3, 0.0, 0.0, 0.0, 0.0, 0.0])


def rest_to_rest(distance: float, acceleration: float = A) -> float:
    """Half of the way at full acceleration, half at full deceleration."""
    return 2.0 * math.sqrt(distance / acceleration)


def test_a_stop_cuts_the_motion_in_two() -> None:
    bound = free_form_bound(ONE, conditions=Conditions(stops=frozenset({1})), gap=1e-6)
    truth = rest_to_rest(0.25) + rest_to_rest(0.75)
    assert bound.seconds <= truth
    assert bound.seconds == pytest.approx(truth, rel=1e-6)
    assert truth > free_form_bound(ONE).seconds


def test_a_late_passage_and_what_comes_after_it() -> None:
    """The joint swings back so far that it passes the waypoint at the speed from which it can just stop."""
    bound = free_form_bound(ONE, conditions=Conditions(passage={1: 7.0}), gap=1e-6)
    truth = 7.0 + math.sqrt(2.0 * 0.75 / A)
    assert bound.seconds <= truth
    assert bound.seconds == pytest.approx(truth, rel=1e-6)
    assert free_form_bound(ONE, conditions=Conditions(total=9.0)).seconds == 9.0


def test_looser_limits_of_a_segment_make_the_bound_less() -> None:
    """With acceleration 4 on both segments the motion is faster than the problem's own bound."""
    limits = Limits.of(velocity=100.0, acceleration=2.0 * A, dof=1)
    asked = Conditions(segment_limits={0: limits, 1: limits})
    bound = free_form_bound(ONE, conditions=asked, gap=1e-6)
    assert bound.seconds <= rest_to_rest(1.0, 2.0 * A) < free_form_bound(ONE).seconds
    assert bound.seconds == pytest.approx(rest_to_rest(1.0, 2.0 * A), rel=1e-6)


def test_a_running_start_and_a_running_end() -> None:
    """At 10 rad/s at both ends the joint crosses 1 rad faster than from rest to rest."""
    rolling = Conditions(start_velocity=np.array([10.0]), end_velocity=np.array([10.0]))
    bound = free_form_bound(ONE, conditions=rolling, gap=1e-6)
    truth = 2.0 * (math.sqrt(100.0 + A) - 10.0) / A  # speeds up for half of the way, then slows down
    assert bound.seconds <= truth < free_form_bound(ONE).seconds
    assert bound.seconds == pytest.approx(truth, rel=1e-6)


@pytest.mark.parametrize(
    "asked",
    [
        Conditions(stops=frozenset({1})),
        Conditions(stops=frozenset({1, 2}), passage={2: 15.0}),
        Conditions(passage={1: 6.0}),
        Conditions(segment_limits={1: SLOW}),
        Conditions(segment_limits={0: FAST, 1: FAST, 2: FAST}),
        Conditions(segment_limits={1: FAST}, stops=frozenset({1})),
        Conditions(start_velocity=DRIFT),
        Conditions(start_velocity=DRIFT, stops=frozenset({1})),
        Conditions(total=20.0),
    ],
    ids=range(9),
)
def test_no_motion_that_keeps_the_conditions_is_faster(asked: Conditions) -> None:
    found = free_form(UR5, conditions=asked)
    bound = free_form_bound(UR5, conditions=asked, upper=found.seconds, time_limit=10.0)
    assert 0.0 < bound.least_verified <= found.seconds
    # planted fault: the bound without conditions is no bound where the limits are looser
    if set(asked.segment_limits) == {0, 1, 2}:
        assert free_form_bound(UR5).seconds > found.seconds


def test_conditions_that_do_not_fit_are_refused() -> None:
    with pytest.raises(InputError, match="waypoint 9"):
        free_form_bound(UR5, conditions=Conditions(stops=frozenset({9})))
