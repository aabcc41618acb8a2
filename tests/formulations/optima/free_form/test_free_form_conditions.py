"""Conditions are kept, seen by the check, and refused in one clear line."""

from __future__ import annotations

import math

import numpy as np
import pytest
from free_form_helpers import DRIFT, SLOW, SR4C, UR5, motion, seconds_of

from formulations import (
    Conditions,
    InputError,
    Limits,
    NoFeasibleMotion,
    Problem,
    Trajectory,
    check,
    free_form,
)

ASKED = [
    Conditions(passage={1: 6.0}),
    Conditions(passage={1: 4.5, 2: 12.0}),
    Conditions(total=20.0),
    Conditions(total=20.0, passage={1: 5.0}),
    Conditions(stops=frozenset({1})),
    Conditions(start_velocity=DRIFT),
    Conditions(start_velocity=DRIFT, end_velocity=-DRIFT),
    Conditions(segment_limits={1: SLOW}),
    Conditions(segment_limits={0: SLOW}, stops=frozenset({2})),
]


@pytest.mark.parametrize("asked", ASKED, ids=range(len(ASKED)))
def test_conditions_are_kept(asked: Conditions) -> None:
    found = motion(free_form(UR5, conditions=asked))
    times = found.passage_times
    for waypoint, time in {**asked.passage, **({3: asked.total} if asked.total else {})}.items():
        assert times[waypoint] == pytest.approx(time, rel=1e-12)
    for stop in asked.stops:
        assert np.abs(found.at(times[stop], 1)).max() < 1e-9
        assert np.abs(found.at(times[stop], 2)).max() < 1e-9
    for at, velocity in ((0.0, asked.start_velocity), (found.seconds, asked.end_velocity)):
        expected = np.zeros(6) if velocity is None else velocity
        np.testing.assert_allclose(found.at(at, 1), expected, atol=1e-9)
    for segment in asked.segment_limits:
        inside = np.linspace(times[segment], times[segment + 1], 2000)[1:-1]
        assert (np.abs(found.at(inside, 1)) <= SLOW.velocity * (1.0 + 1e-9)).all()
    # the check says the same, and without the conditions it may not
    assert check(UR5, found, conditions=asked).feasible
    assert check(UR5, found).feasible == (asked.start_velocity is None)


@pytest.mark.parametrize(
    ("asked", "fault"),
    [
        (Conditions(passage={1: 3.0}), "passes waypoint 2 at"),
        (Conditions(total=15.0), "passes waypoint 4 at"),
        (Conditions(stops=frozenset({1})), "at waypoint 2, a stop"),
        (Conditions(start_velocity=DRIFT), "off by 0.3 at an end"),
        (Conditions(end_velocity=DRIFT), "off by 0.3 at an end"),
        (Conditions(segment_limits={1: SLOW}), "over the limit: velocity"),
    ],
)
def test_the_check_sees_what_was_not_kept(asked: Conditions, fault: str) -> None:
    verdict = check(UR5, motion(free_form(UR5)), conditions=asked)
    assert not verdict.feasible
    assert any(fault in line for line in verdict.faults), verdict.faults


def test_conditions_cost_time_in_order() -> None:
    fastest = free_form(UR5).seconds
    stopping = free_form(UR5, conditions=Conditions(stops=frozenset({1}))).seconds
    both = free_form(UR5, conditions=Conditions(stops=frozenset({1, 2}))).seconds
    assert fastest < stopping < both
    assert both == pytest.approx(seconds_of("ruckig_stop_and_go", UR5), rel=1e-9)
    rolling = free_form(UR5, conditions=Conditions(start_velocity=DRIFT)).seconds
    assert rolling < fastest


def test_the_smoothest_motion_is_smoother_than_the_fastest_slowed_down() -> None:
    def roughness(found: Trajectory) -> float:
        jerks = found.at(found.breaks[:-1] + 0.5 * found.durations, 3) / UR5.limits.jerk
        return float((jerks**2).sum(axis=1) @ found.durations)

    fastest = motion(free_form(UR5))
    smooth = motion(free_form(UR5, conditions=Conditions(total=20.0)))
    assert roughness(smooth) < 0.5 * roughness(fastest.stretched(20.0 / fastest.seconds))


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (Conditions(passage={1: 1.0}), "passes waypoint 2 at 3.96"),
        (Conditions(total=14.0), "passes waypoint 4 at 14.76"),
        (Conditions(total=14.0, stops=frozenset({1})), "conditions.total, conditions.stops"),
    ],
)
def test_what_cannot_be_done_is_one_clear_line(asked: Conditions, line: str) -> None:
    with pytest.raises(NoFeasibleMotion, match=line) as refusal:
        free_form(UR5, conditions=asked)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (Conditions(passage={9: 1.0}), "conditions.passage: waypoint 9 is not there: 0 to 3"),
        (Conditions(passage={1: -1.0}), "conditions.passage: waypoint 1: -1 s is no time"),
        (Conditions(passage={0: 1.0}), "conditions.passage: waypoint 0: 1 s, not the start"),
        (Conditions(passage={1: 3.0, 2: 2.0}), "waypoint 2: 2 s is not after waypoint 1 at 3 s"),
        (Conditions(total=math.nan), "conditions.total: nan s"),
        (Conditions(total=2.0, passage={3: 3.0}), "conditions.total: 2 s, but conditions.passage"),
        (Conditions(total=2.0, passage={1: 3.0}), "waypoint 1: 3 s is after conditions.total, 2 s"),
        (Conditions(stops=frozenset({7})), "conditions.stops: waypoint 7 is not there"),
        (Conditions(start_velocity=np.zeros(2)), r"start_velocity: expected 6 values, got \(2,\)"),
        (Conditions(end_velocity=np.full(6, 9.0)), "joint 1: 515.662 deg/s is over the limit 25 deg/s"),
        (Conditions(start_velocity=DRIFT, stops=frozenset({0})), "start_velocity: .* which is a stop"),
        (Conditions(segment_limits={5: SLOW}), "segment_limits: segment 5 is not there: 0 to 2"),
        (Conditions(segment_limits={0: SR4C.limits}), "segment 0: jerk of joint 1 is inf"),
        (Conditions(segment_limits={0: Limits.of(1, dof=2)}), "segment 0: limits.velocity: 2 values"),
    ],
)
def test_conditions_that_do_not_fit_are_one_clear_line(asked: Conditions, line: str) -> None:
    with pytest.raises(InputError, match=line):
        free_form(UR5, conditions=asked)


def test_equal_waypoints_with_different_times_wait() -> None:
    problem = Problem.of([[0.0], [1.0], [1.0], [2.0]], Limits.of(1.0, 2.0, 10.0, dof=1))
    asked = Conditions(passage={1: 3.0, 2: 5.0})
    found = motion(free_form(problem, conditions=asked))
    assert found.passage_times[1:3] == pytest.approx([3.0, 5.0], rel=1e-12)
    assert check(problem, found, conditions=asked).feasible


def ten(seed: int) -> Problem:
    points = np.cumsum(np.random.default_rng(seed).uniform(-0.6, 0.6, (10, 7)), axis=0)
    return Problem.of(points, Limits.of(2.0, 8.0, 60.0, dof=7))


@pytest.mark.parametrize(("seed", "share"), [(2, 0.985), (3, 0.97), (0, 0.995)])
def test_a_passage_may_be_earlier_than_that_of_the_fastest_motion(seed: int, share: float) -> None:
    problem = ten(seed)
    fastest = motion(free_form(problem))
    asked = Conditions(passage={5: share * fastest.passage_times[5]})
    found = free_form(problem, conditions=asked)
    assert check(problem, motion(found), conditions=asked).feasible
    assert found.status == "ok"
    assert fastest.seconds * (1.0 - 1e-6) <= found.seconds < 1.05 * fastest.seconds


def test_a_passage_a_little_later_than_that_of_the_fastest_motion_is_met() -> None:
    fastest = motion(free_form(UR5, tolerance=1e-6))
    # slowed down as a whole, the fastest motion meets the time: this is possible, and no worse is accepted
    late = 1.0 + 1e-5
    asked = Conditions(passage={2: late * fastest.passage_times[2]})
    found = free_form(UR5, conditions=asked)
    assert check(UR5, motion(found), conditions=asked).feasible
    assert found.seconds <= late * fastest.seconds * (1.0 + 1e-6)


@pytest.mark.long
def test_a_refusal_names_a_time_that_is_then_possible() -> None:
    problem = ten(1)
    with pytest.raises(NoFeasibleMotion, match="the nearest one found passes waypoint 6 at") as refusal:
        free_form(problem, conditions=Conditions(passage={5: 1.0}))
    least = float(str(refusal.value).split("passes waypoint 6 at ")[1].split(" s")[0])
    # an oracle: the first five segments, with a stop at their end, are a motion that takes longer
    prefix = Problem.of(problem.waypoints[:6], problem.limits)
    assert least < free_form(prefix).seconds
    asked = Conditions(passage={5: least * 1.001})
    assert check(problem, motion(free_form(problem, conditions=asked)), conditions=asked).feasible


@pytest.mark.parametrize("more", [1.0 + 1e-6, 1.0 + 1e-4, 1.01])
def test_the_status_is_that_of_the_answer(more: float) -> None:
    least = free_form(SR4C, tolerance=1e-6).seconds
    found = free_form(SR4C, conditions=Conditions(total=least * more))
    assert check(SR4C, motion(found), conditions=Conditions(total=least * more)).feasible
    assert "infeasible" not in found.ending
    assert (found.status == "ok") or found.notes
