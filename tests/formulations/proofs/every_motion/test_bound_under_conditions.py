"""The bound under conditions: closed forms of one joint, and no motion that keeps them is faster."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.check_certificate.verify import verify
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


def at(waypoint: int, distance: float) -> dict[int, np.ndarray]:
    return {waypoint: np.array([distance])}


FAR = Problem.of([[0.0], [1.0]], ONE.limits)
THERE_AND_BACK = Problem.of([[0.0], [1.0], [0.0]], ONE.limits)
UNEVEN = Limits.of(velocity=100.0, acceleration=[[-4.0, 2.0]], dof=1)
EXACT = {
    "a zone at the end": (FAR, Conditions(tolerance=at(1, 0.2)), rest_to_rest(0.8)),
    "zones at both ends": (FAR, Conditions(tolerance={**at(0, 0.1), **at(1, 0.2)}), rest_to_rest(0.7)),
    "a zone on the way": (ONE, Conditions(tolerance=at(1, 0.1)), rest_to_rest(1.0)),
    "a zone where it turns": (THERE_AND_BACK, Conditions(tolerance=at(1, 0.3)), 2 * rest_to_rest(0.7)),
    "a wait": (ONE, Conditions(waits={1: 0.5}), rest_to_rest(0.25) + 0.5 + rest_to_rest(0.75)),
    "a late window": (FAR, Conditions(windows={1: (3.0, 9.0)}), 3.0),
    "a least time": (FAR, Conditions(segment_times={0: (3.0, math.inf)}), 3.0),
    "a free end": (FAR, Conditions(end_velocity="free"), math.sqrt(2.0 * 1.0 / A)),
    "free at both ends": (FAR, Conditions(start_velocity="free", end_velocity="free"), 1.0 / 100.0),
    "a cycle": (THERE_AND_BACK, Conditions(cyclic=True), 4.0 * math.sqrt(2.0 * 0.5 / A)),
    "two directions": (
        Problem.of([[0.0], [1.0]], UNEVEN),
        Conditions(),
        math.sqrt(2.0 * (1.0 / 2.0 + 1.0 / 4.0)),
    ),
}


@pytest.mark.parametrize("name", EXACT)
def test_one_joint_in_closed_form(name: str) -> None:
    """The bound is the least time itself, and the checker proves it again."""
    problem, asked, truth = EXACT[name]
    bound = free_form_bound(problem, conditions=asked, gap=1e-7, upper=truth, record=True)
    assert bound.seconds <= truth * (1.0 + 1e-12)
    assert bound.seconds == pytest.approx(truth, rel=1e-6)
    assert float.fromhex(bound.certificate["seconds"]) == pytest.approx(truth, rel=1e-6)
    assert "takes" in verify(bound.certificate)


def test_a_problem_carries_its_conditions() -> None:
    asked = Conditions(waits={1: 0.5})
    carried = free_form_bound(replace(ONE, conditions=asked), gap=1e-6)
    assert carried.seconds == free_form_bound(ONE, conditions=asked, gap=1e-6).seconds
    assert (
        carried.seconds
        > free_form_bound(replace(ONE, conditions=asked), conditions=Conditions()).seconds
    )


@pytest.mark.long  # searches and proofs
@given(
    seed=st.integers(0, 10**6),
    key=st.sampled_from(["tolerance", "windows", "segment_times", "waits", "limits"]),
)
@settings(max_examples=12, deadline=None)
def test_a_motion_that_keeps_more_is_no_faster_than_the_bound_of_less(seed: int, key: str) -> None:
    rng = np.random.default_rng(seed)
    limits = Limits.of(velocity=2.0, acceleration=5.0, jerk=30.0, dof=2)
    problem = Problem.of(rng.uniform(-1.0, 1.0, (3, 2)), limits)
    size = float(rng.uniform(0.05, 0.6))
    strict, loose = {
        "tolerance": [Conditions(tolerance={1: np.full(2, x)}) for x in (size / 2, size)],
        "windows": [Conditions(windows={1: (x, math.inf)}) for x in (3 * size, 2 * size)],
        "segment_times": [Conditions(segment_times={1: (x, math.inf)}) for x in (3 * size, 2 * size)],
        "waits": [Conditions(waits={1: x}) for x in (size, size / 2)],
        "limits": [Conditions(segment_limits={0: slower(limits, x)}) for x in (size, (1 + size) / 2)],
    }[key]
    motion = free_form(problem, conditions=strict)
    bound = free_form_bound(problem, conditions=loose, upper=motion.seconds, time_limit=2.0)
    assert bound.least_verified <= motion.seconds
    assert free_form(problem, conditions=loose).seconds <= motion.seconds * (1.0 + 1e-3)


def slower(limits: Limits, factor: float) -> Limits:
    return replace(limits, velocity=factor * limits.velocity)


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
