"""Motions under each linear demand: closed forms, and laws of loosening."""

from __future__ import annotations

import math

import numpy as np
import pytest
from free_form_helpers import motion
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import Conditions, InputError, Limits, NoFeasibleMotion, Problem, check, free_form
from formulations.problem.arrays import Array

FREE = Conditions(end_velocity="free", end_acceleration="free")
TIGHT = 1e-6


def one(points: list[float], velocity: object, acceleration: object, jerk: float = math.inf) -> Problem:
    limits = Limits.of(velocity, acceleration, jerk, dof=1)  # type: ignore[arg-type]
    return Problem.of(np.array(points)[:, None], limits)


def seconds(problem: Problem, asked: Conditions | None = None) -> float:
    """The time of a motion that passes the check."""
    found = free_form(problem, conditions=asked, tolerance=TIGHT)
    verdict = check(problem, motion(found), conditions=asked)
    assert verdict.feasible, verdict.faults
    return found.seconds


@given(d=st.floats(0.01, 3.0), v=st.floats(0.2, 3.0), a=st.floats(0.5, 8.0), forth=st.booleans())
@settings(max_examples=10)
def test_a_free_end_is_reached_at_top_speed(d: float, v: float, a: float, forth: bool) -> None:
    # from rest: sqrt(2 d / a) while v is not reached, else a ramp of v / a and the rest at v
    truth = math.sqrt(2.0 * d / a) if d <= v**2 / (2.0 * a) else v / a + (d - v**2 / (2.0 * a)) / v
    problem = one([0.0, d if forth else -d], v, a)
    assert seconds(problem, Conditions(end_velocity="free")) == pytest.approx(truth, rel=1e-6)
    both = Conditions(start_velocity="free", end_velocity="free")
    assert seconds(problem, both) == pytest.approx(d / v, rel=1e-6)


def test_a_free_acceleration_is_faster_than_none_with_a_jerk_limit() -> None:
    problem = one([0.0, 1.0], 100.0, 100.0, 6.0)
    # the jerk limit all the way: x = j t^3 / 6
    assert seconds(problem, FREE) == pytest.approx(1.0, rel=1e-6)
    assert seconds(problem, Conditions(end_velocity="free")) > 1.1


@given(start=st.floats(0.0, 0.4), end=st.floats(0.0, 0.4), a=st.floats(0.5, 8.0))
@settings(max_examples=8)
def test_zones_at_both_ends_shorten_the_way(start: float, end: float, a: float) -> None:
    asked = Conditions(tolerance={0: np.array([start]), 1: np.array([end])})
    truth = 2.0 * math.sqrt((1.0 - start - end) / a)
    problem = one([0.0, 1.0], 100.0, a)
    assert seconds(problem, asked) == pytest.approx(truth, rel=1e-6)


def test_a_zone_reaches_no_farther_than_the_position_limit() -> None:
    limits = Limits.of(100.0, 4.0, position=[-1.0, 0.9], dof=1)
    problem = Problem.of([[0.0], [0.8], [0.0]], limits)
    asked = Conditions(tolerance={1: np.array([0.5])})
    # turned at 0.3, not at 1.3: there and back, each from rest to rest with acceleration 4
    assert seconds(problem, asked) == pytest.approx(4.0 * math.sqrt(0.3 / 4.0), rel=1e-6)
    up = Problem.of([[0.0], [0.8]], limits)
    assert seconds(up, Conditions(tolerance={1: np.array([0.5])})) == pytest.approx(
        2.0 * math.sqrt(0.3 / 4.0), rel=1e-6
    )


@pytest.mark.parametrize("order", [1, 2, 3])
def test_overlapping_zones_are_passed_at_once(order: int) -> None:
    limits = Limits.of(1.0, 4.0 if order > 1 else math.inf, 30.0 if order > 2 else math.inf, dof=2)
    dense = Problem.of([[0.0, 0.0], [0.5, 0.1], [0.55, 0.12], [0.6, 0.1], [1.0, 0.0]], limits)
    wide = {k: np.array([0.2, 0.2]) for k in (1, 2, 3)}
    ends = Problem.of([[0.0, 0.0], [1.0, 0.0]], limits)
    # the straight way passes all zones
    assert seconds(dense, Conditions(tolerance=wide)) == pytest.approx(seconds(ends), rel=2e-5)


@given(wait=st.floats(0.01, 2.0), jerk=st.sampled_from([20.0, math.inf]))
@settings(max_examples=6)
def test_a_wait_adds_its_time_to_a_stop(wait: float, jerk: float) -> None:
    problem = one([0.0, 1.0, 0.2], 2.0, 4.0, jerk)
    stopped = seconds(problem, Conditions(stops=frozenset({1})))
    found = free_form(problem, conditions=Conditions(waits={1: wait}), tolerance=TIGHT)
    assert found.seconds == pytest.approx(stopped + wait, rel=1e-6)
    arrival = motion(found).passage_times[1]
    still = motion(found).at(np.linspace(arrival, arrival + wait, 50))
    np.testing.assert_allclose(still, 1.0, atol=1e-12)


def test_a_wait_counts_before_the_times_of_later_waypoints() -> None:
    problem = one([0.0, 1.0, 2.0], 2.0, 4.0)
    asked = Conditions(waits={1: 1.0}, passage={2: 5.0}, segment_times={0: (0.0, 1.5)})
    found = motion(free_form(problem, conditions=asked))
    assert check(problem, found, conditions=asked).feasible
    assert found.seconds == pytest.approx(5.0, rel=1e-9)


def test_a_least_time_of_a_segment_binds_where_it_is_longer() -> None:
    problem = one([0.0, 1.0], 2.0, 4.0)
    assert seconds(problem, Conditions(segment_times={0: (3.0, math.inf)})) == pytest.approx(3.0)
    assert seconds(problem, Conditions(segment_times={0: (0.5, math.inf)})) == pytest.approx(1.0)
    assert seconds(problem, Conditions(windows={1: (2.5, math.inf)})) == pytest.approx(2.5)


def test_windows_and_greatest_times_that_are_too_short_name_the_nearest() -> None:
    problem = one([0.0, 1.0], 10.0, 4.0)
    with pytest.raises(
        NoFeasibleMotion, match=r"waypoint 2 at (1|0\.9999)\S* s, \[0, 0.5\] s asked for"
    ):
        free_form(problem, conditions=Conditions(windows={1: (0.0, 0.5)}))
    with pytest.raises(NoFeasibleMotion, match=r"takes (1|0\.9999)\S* s for segment 1, at most 0.7 s"):
        free_form(problem, conditions=Conditions(segment_times={0: (0.0, 0.7)}))


def test_a_cycle_of_one_joint_turns_at_the_jerk_limit() -> None:
    # v = 0 and a = a0 at 0, v = 0 and a = -a0 at d, jerk -j between: a0 = j h / 2, d = j h^3 / 12
    d, j = 0.7, 9.0
    problem = one([0.0, d, 0.0], 100.0, 100.0, j)
    truth = 2.0 * (12.0 * d / j) ** (1.0 / 3.0)
    assert seconds(problem, Conditions(cyclic=True)) == pytest.approx(truth, rel=1e-6)
    # without a jerk limit it gains nothing: 4 sqrt(d / a)
    bang = one([0.0, d, 0.0], 100.0, 4.0)
    assert seconds(bang, Conditions(cyclic=True)) == pytest.approx(4.0 * math.sqrt(d / 4.0), rel=1e-6)


def test_a_cycle_shares_one_place_in_the_zone_of_its_ends() -> None:
    problem = one([0.0, 1.0, 0.0], 100.0, 4.0)
    zone = np.array([0.1])
    asked = Conditions(cyclic=True, tolerance={0: zone, 2: zone})
    assert seconds(problem, asked) == pytest.approx(4.0 * math.sqrt(0.9 / 4.0), rel=1e-6)


@given(up=st.floats(0.5, 8.0), down=st.floats(0.5, 8.0), d=st.floats(0.05, 3.0))
@settings(max_examples=8)
def test_acceleration_limits_that_differ(up: float, down: float, d: float) -> None:
    problem = one([0.0, d], 100.0, [[-down, up]])
    assert seconds(problem) == pytest.approx(math.sqrt(2.0 * d * (1.0 / up + 1.0 / down)), rel=1e-6)
    back = one([d, 0.0], 100.0, [[-up, down]])
    assert seconds(back) == pytest.approx(seconds(problem), rel=1e-6)


def test_velocity_limits_that_differ() -> None:
    problem = one([0.0, 1.0, 0.0], [[-0.5, 2.0]], 1000.0)
    stop = Conditions(stops=frozenset({1}))
    # d / v + v / a forth and back
    assert seconds(problem, stop) == pytest.approx(0.5 + 2.0 + 2.0 / 1000.0 + 0.5 / 1000.0, rel=1e-6)
    only = one([0.0, 1.0, 0.0], [[-0.5, 2.0]], math.inf)
    assert seconds(only) == pytest.approx(2.5, rel=1e-5)


def drawn(seed: int) -> Problem:
    rng = np.random.default_rng(seed)
    dof = int(rng.integers(1, 4))
    jerk = math.inf if rng.random() < 0.3 else float(rng.uniform(5.0, 50.0))
    limits = Limits.of(rng.uniform(0.5, 3.0, dof), rng.uniform(1.0, 9.0, dof), jerk, dof=dof)
    return Problem.of(rng.uniform(-1.5, 1.5, (int(rng.integers(3, 6)), dof)), limits)


def pairs(problem: Problem, rng: np.random.Generator) -> dict[str, tuple[Conditions, Conditions]]:
    """A demand of each kind, and a looser one."""
    n, dof, limits = problem.n_segments, problem.dof, problem.limits
    k = int(rng.integers(1, n))
    passed = motion(free_form(problem)).passage_times

    def state(scale: float) -> Array:
        return np.asarray(scale * limits.velocity * np.sign(rng.uniform(-1.0, 1.0, dof)))

    zones = {w: rng.uniform(0.0, 0.3, dof) for w in range(n + 1)}
    slow = Limits.of(0.5 * limits.velocity, 0.5 * limits.acceleration, 0.5 * limits.jerk, dof=dof)
    return {
        "zones": (
            Conditions(tolerance={w: 0.5 * zone for w, zone in zones.items()}),
            Conditions(tolerance=zones),
        ),
        "windows": (
            Conditions(windows={k: (1.2 * passed[k], 1.3 * passed[k])}),
            Conditions(windows={k: (1.1 * passed[k], 1.5 * passed[k])}),
        ),
        "segment times": (
            Conditions(segment_times={k: (1.4 * np.diff(passed)[k], math.inf)}),
            Conditions(segment_times={k: (1.2 * np.diff(passed)[k], math.inf)}),
        ),
        "waits": (Conditions(waits={k: 0.5}), Conditions(waits={k: 0.2})),
        "a wait is a stop": (Conditions(waits={k: 0.1}), Conditions(stops=frozenset({k}))),
        "ends": (Conditions(end_velocity=state(0.3)), FREE if limits.has_jerk else _FREE_SPEED),
        "rest": (Conditions(), FREE if limits.has_jerk else _FREE_SPEED),
        "limits": (Conditions(segment_limits={k: slow}), Conditions()),
    }


_FREE_SPEED = Conditions(end_velocity="free")


@pytest.mark.long  # searches and proofs
@given(seed=st.integers(0, 10_000))
@settings(max_examples=4, deadline=None)
def test_loosening_a_demand_never_makes_the_motion_slower(seed: int) -> None:
    problem = drawn(seed)
    for name, (tight, loose) in pairs(problem, np.random.default_rng(seed)).items():
        assert seconds(problem, loose) <= seconds(problem, tight) * (1.0 + 2e-6), name


@given(seed=st.integers(0, 10_000))
@settings(max_examples=3, deadline=None)
def test_a_cycle_is_no_slower_than_from_rest_to_rest(seed: int) -> None:
    drawn_ = drawn(seed)
    points = np.vstack([drawn_.waypoints, drawn_.waypoints[:1]])
    problem = Problem.of(points, drawn_.limits)
    assert seconds(problem, Conditions(cyclic=True)) <= seconds(problem) * (1.0 + 1e-6)


def test_the_conditions_of_the_problem_hold_where_no_others_are_given() -> None:
    asked = Conditions(waits={1: 0.5})
    limits = Limits.of(2.0, 4.0, dof=1)
    problem = Problem.of([[0.0], [1.0], [0.2]], limits, conditions=asked)
    bare = Problem.of([[0.0], [1.0], [0.2]], limits)
    own = free_form(problem)
    assert own.conditions == asked
    assert own.seconds == free_form(bare, conditions=asked).seconds
    assert free_form(problem, conditions=Conditions()).seconds == free_form(bare).seconds
    assert not check(problem, motion(free_form(bare))).feasible


def test_a_joint_that_rests_in_a_segment_keeps_its_zone() -> None:
    limits = Limits.of([2.0, 2.0], [4.0, 4.0], [30.0, 30.0], dof=2)
    problem = Problem.of([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0, 0.5]], limits)
    asked = Conditions(tolerance={1: np.array([0.1, 0.2]), 3: np.array([0.0, 0.2])})
    assert seconds(problem, asked) < seconds(problem)


def test_a_smoothest_motion_waits_too() -> None:
    problem = one([0.0, 1.0, 0.2], 2.0, 4.0, 20.0)
    asked = Conditions(waits={1: 0.5}, total=6.0)
    assert seconds(problem, asked) == pytest.approx(6.0, rel=1e-9)


def test_highs_keeps_demands_as_well() -> None:
    problem = one([0.0, 1.0, 0.2], 2.0, [[-4.0, 6.0]], 20.0)
    asked = Conditions(tolerance={1: np.array([0.1])}, end_velocity="free", windows={1: (1.0, 1.2)})
    slp = free_form(problem, conditions=asked, solver="highs")
    assert check(problem, motion(slp), conditions=asked).feasible
    assert slp.seconds == pytest.approx(seconds(problem, asked), rel=1e-4)


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(InputError, match=r"conditions\.tolerance: waypoint 9 is not there"):
        free_form(one([0.0, 1.0], 1.0, 1.0), conditions=Conditions(tolerance={9: np.array([0.1])}))
