"""Every linear demand: a motion in closed form that keeps it, and one fault planted in each."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from planted_motions import rest_to_rest

from formulations import Conditions, Limits, Problem, Trajectory, check
from formulations.motion.judgement import judge

WIDE = Limits.of(50.0, 500.0, 5000.0, dof=1)
PROBLEM = Problem([[0.0], [1.0], [3.0]], WIDE)
RESTING = rest_to_rest(PROBLEM.waypoints, np.array([1.0, 2.0]))  # rests at waypoint 1, at 1 s


def pieces(*parts: tuple[float, ...], passages: list[float]) -> Trajectory:
    """One joint: each part is a duration and the coefficients of its cubic."""
    coefficients = np.zeros((len(parts), 1, 6))
    for k, (_, *values) in enumerate(parts):
        coefficients[k, 0, : len(values)] = values
    return Trajectory(np.array([part[0] for part in parts]), coefficients, np.array(passages))


def waiting(seconds: float, drift: float = 0.0) -> Trajectory:
    """RESTING with a wait at waypoint 1, during which it goes away by ``drift`` and comes back."""
    first, last = RESTING.coefficients[:1], RESTING.coefficients[1:]
    # 64 drift s^3 (1 - s)^3 has zero velocity and acceleration at both ends; degree 6
    wide = np.zeros((3, 1, 7))
    wide[0, :, :6], wide[2, :, :6] = first[0], last[0]
    wide[1, 0, 0] = 1.0
    for power, factor in zip((3, 4, 5, 6), (1.0, -3.0, 3.0, -1.0), strict=True):
        wide[1, 0, power] = 64.0 * drift * factor / seconds**power
    return Trajectory(np.array([1.0, seconds, 2.0]), wide, np.array([0.0, 1.0, 3.0 + seconds]))


def lines(problem: Problem, motion: Trajectory, asked: Conditions) -> tuple[str, ...]:
    return check(problem, motion, conditions=asked).faults


KEPT = [
    Conditions(windows={1: (0.9, 1.1), 2: (0.0, 3.0)}),
    Conditions(segment_times={0: (1.0, 1.0), 1: (0.5, math.inf)}),
    Conditions(tolerance={1: np.array([0.5])}),
    Conditions(end_velocity="free", start_acceleration="free"),
]
BROKEN = [
    (Conditions(windows={1: (1.2, 2.0)}), "passes waypoint 2 at 1 s, before the earliest time, 1.2 s"),
    (Conditions(windows={1: (0.0, 0.9)}), "passes waypoint 2 at 1 s, after the latest time, 0.9 s"),
    (Conditions(segment_times={1: (2.5, 9.0)}), "segment 2 takes 2 s, the least time is 2.5 s"),
    (Conditions(segment_times={0: (0.0, 0.9)}), "segment 1 takes 1 s, the greatest time is 0.9 s"),
    (Conditions(start_velocity=np.array([0.5])), "velocity of joint 1 is off by 0.5 at an end"),
    (
        Conditions(end_velocity="free", end_acceleration=np.array([2.0])),
        "acceleration of joint 1 is off by 2 at an end",
    ),
]


@pytest.mark.parametrize("asked", KEPT, ids=range(len(KEPT)))
def test_what_is_kept_is_said_to_be_kept(asked: Conditions) -> None:
    assert lines(PROBLEM, RESTING, asked) == ()
    assert lines(replace(PROBLEM, conditions=asked), RESTING, Conditions()) == ()
    assert judge(PROBLEM, RESTING, conditions=asked).feasible


@pytest.mark.parametrize(("asked", "line"), BROKEN, ids=range(len(BROKEN)))
def test_a_planted_fault_is_one_plain_line(asked: Conditions, line: str) -> None:
    assert lines(PROBLEM, RESTING, asked) == (line,)
    assert not judge(PROBLEM, RESTING, conditions=asked).feasible
    # the conditions of the problem hold where no others are given
    posed = replace(PROBLEM, conditions=asked)
    assert check(posed, RESTING).faults == (line,)
    assert not judge(posed, RESTING).feasible


@pytest.mark.parametrize("off", [0.0, 0.3, -0.3])
def test_a_zone_is_a_box_around_the_waypoint(off: float) -> None:
    moved = Problem([[0.0], [1.0 + off], [3.0]], WIDE)
    for width, feasible in ((0.29, off == 0.0), (0.31, True)):
        asked = Conditions(tolerance={1: np.array([width])})
        found = lines(moved, RESTING, asked)
        assert (found == ()) == feasible
        if not feasible:
            assert found[0].startswith("misses the zone of waypoint 2, joint 1 by 0.01 rad")


def test_a_zone_widens_what_a_motion_from_elsewhere_passes() -> None:
    moved = Problem([[0.0], [3.2], [3.0]], WIDE)  # never reached: the motion ends at 3
    narrow, wide = (Conditions(tolerance={1: np.array([width])}) for width in (0.1, 0.25))
    assert [miss.waypoint for miss in judge(moved, RESTING, conditions=narrow).missed] == [1]
    assert judge(moved, RESTING, conditions=wide).feasible


def test_a_wait_is_a_standstill_from_the_arrival_on() -> None:
    asked = Conditions(waits={1: 0.5})
    assert lines(PROBLEM, waiting(0.5), asked) == ()
    assert judge(PROBLEM, waiting(0.5), conditions=asked).feasible
    (short,) = lines(PROBLEM, waiting(0.4), asked)
    assert short.startswith("joint 1 moves by")
    assert "at waypoint 2, where it waits 0.5 s" in short
    assert judge(PROBLEM, waiting(0.2), conditions=asked).unkept
    # between its ends, where no sample at a break sees it
    (moves,) = lines(PROBLEM, waiting(0.5, drift=1e-3), asked)
    assert moves.startswith("joint 1 moves by 0.001 rad")
    assert judge(PROBLEM, waiting(0.5, drift=1e-3), conditions=asked).unkept


def test_a_wait_is_no_part_of_the_segment_after_it() -> None:
    asked = Conditions(waits={1: 0.5}, segment_times={1: (2.0, 2.0)})
    assert lines(PROBLEM, waiting(0.5), asked) == ()
    asked = Conditions(waits={1: 0.5}, segment_times={1: (2.2, 9.0)})
    assert lines(PROBLEM, waiting(0.5), asked) == ("segment 2 takes 2 s, the least time is 2.2 s",)


def cycle(end: float) -> Trajectory:
    """From 0 to 1 and back with the accelerations 6, -6, 6 at the turns; the last piece is bent by ``end``."""
    forth = (1.0, 0.0, 0.0, 3.0, -2.0)
    back = (1.0, 1.0, 0.0, -3.0, 2.0)
    bent = (1.0, 1.0, 0.0, -3.0 + end, 2.0 - end)
    return pieces(forth, back if end == 0.0 else bent, passages=[0.0, 1.0, 2.0])


def test_both_ends_of_a_cycle_are_one_state() -> None:
    problem = Problem([[0.0], [1.0], [0.0]], WIDE)
    asked = Conditions(cyclic=True)
    assert lines(problem, cycle(0.0), asked) == ()
    assert judge(problem, cycle(0.0), conditions=asked).feasible
    # without the cycle it should rest, and has an acceleration
    assert lines(problem, cycle(0.0), Conditions()) == ("acceleration of joint 1 is 6 at an end",)
    faults = lines(problem, cycle(0.5), asked)
    # derivatives of the bent piece at its end: -6 + 1 + 6 - 1.5 and -6 + 1 + 12 - 3
    assert "velocity of joint 1 differs by 0.5 between both ends of the cycle" in faults
    assert "acceleration of joint 1 differs by 2 between both ends of the cycle" in faults
    assert judge(problem, cycle(0.5), conditions=asked).unkept


def test_limits_of_the_two_directions_count_on_their_own_side() -> None:
    # 15/8 d / t and 10 / sqrt(3) d / t^2 are the peaks of the quintic from rest to rest
    up = Problem([[0.0], [1.0]], Limits.of([[-1.0, 2.0]], [[-6.0, 5.0]], dof=1))
    down = Problem([[1.0], [0.0]], Limits.of([[-1.0, 2.0]], [[-6.0, 5.0]], dof=1))
    forth, back = (rest_to_rest(p.waypoints, np.array([1.0])) for p in (up, down))
    steepest = 10.0 / math.sqrt(3.0)
    peaks = {peak.quantity: peak for peak in check(up, forth).peaks}
    assert peaks["velocity"].factor == pytest.approx(15.0 / 8.0 / 2.0)
    assert peaks["acceleration"].factor == pytest.approx(steepest / 5.0)
    assert peaks["acceleration"].value > 0.0
    peaks = {peak.quantity: peak for peak in check(down, back).peaks}
    assert peaks["velocity"].factor == pytest.approx(15.0 / 8.0)
    assert peaks["velocity"].value < 0.0


@pytest.mark.parametrize("segment", [0, 1])
def test_a_piece_across_a_waypoint_is_cut_there(segment: int) -> None:
    # one quintic through 0.5 of 1 at half its time; its velocity is largest there
    problem = Problem([[0.0], [0.1], [1.0]], WIDE)
    whole = rest_to_rest(np.array([[0.0], [1.0]]), np.array([1.0]))
    roots = np.roots([6.0, -15.0, 10.0, 0.0, 0.0, -0.1])
    s = next(float(r.real) for r in roots if abs(r.imag) < 1e-12 and 0.0 < r.real < 1.0)
    passed = Trajectory(whole.durations, whole.coefficients, np.array([0.0, s, 1.0]))
    slow = Limits.of(1.0, 500.0, 5000.0, dof=1)
    found = check(problem, passed, conditions=Conditions(segment_limits={segment: slow}))
    speed = 30.0 * s**2 * (1.0 - s) ** 2 if segment == 0 else 15.0 / 8.0
    (peak,) = [peak for peak in found.peaks if peak.quantity == "velocity"]
    assert peak.segment == segment
    assert peak.factor == pytest.approx(speed)


def test_a_window_is_met_where_a_waypoint_is_passed_twice() -> None:
    # 0 to 1 and back, then on: 0.5 is passed at 0.5 s, 1.5 s and 2.5 s
    turns = rest_to_rest(np.array([[0.0], [1.0], [0.0], [1.0]]), np.ones(3))
    problem = Problem([[0.0], [0.5], [1.0]], WIDE)
    for window, time in (((0.4, 0.6), 0.5), ((1.2, 1.6), 1.5), ((2.4, 9.0), 2.5)):
        found = judge(problem, turns, conditions=Conditions(windows={1: window}))
        assert found.feasible
        assert found.motion.passage_times[1] == pytest.approx(time, abs=1e-6)
    late = judge(problem, turns, conditions=Conditions(windows={1: (0.7, 1.2)}))
    assert [miss.waypoint for miss in late.missed] == [1]
