"""Ruckig, and the closed form of one joint from rest to rest, against each other and by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
import ruckig
from closed_forms_by_hand import SIZE, legs, trapezoid
from conftest import powers_of_ten, problems
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import REFERENCES, Limits, Problem, check, load
from formulations.proofs.rest_to_rest import rest_to_rest

# --- the closed form of one joint -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("distance", "limits", "seconds"),
    [
        # cruise reached, with constant acceleration: 10/2 + 2/1 + 1/2
        (10.0, (2.0, 1.0, 2.0), 7.5),
        # cruise reached, without constant acceleration: 10/1 + 2 sqrt(1/4)
        (10.0, (1.0, 100.0, 4.0), 11.0),
        # neither: jerk alone, 4 cbrt(d / 2 J)
        (2.0, (100.0, 100.0, 1.0), 4.0),
        # constant acceleration, no cruise: A/J + sqrt((A/J)^2 + 4 d/A) = 1 + sqrt(1 + 8)
        (2.0, (100.0, 1.0, 1.0), 4.0),
        # no jerk limit
        (10.0, (2.0, 1.0, math.inf), 7.0),
        (4.0, (100.0, 1.0, math.inf), 4.0),
        (0.0, (1.0, 1.0, 1.0), 0.0),
        (0.0, (1.0, 1.0, math.inf), 0.0),
    ],
)
def test_rest_to_rest_by_hand(
    distance: float, limits: tuple[float, float, float], seconds: float
) -> None:
    assert rest_to_rest(distance, *limits) == pytest.approx(seconds, rel=1e-14, abs=1e-300)


@given(distance=powers_of_ten(-3.0, 2.0), velocity=SIZE, acceleration=SIZE, jerk=SIZE)
@settings(max_examples=200)
def test_rest_to_rest_agrees_with_ruckig(
    distance: float, velocity: float, acceleration: float, jerk: float
) -> None:
    task = ruckig.InputParameter(1)
    task.current_position, task.target_position = [0.0], [distance]
    task.max_velocity, task.max_acceleration = [velocity], [acceleration]
    for limit in (jerk, math.inf):
        task.max_jerk = [limit]
        answer = ruckig.Trajectory(1)
        ruckig.Ruckig(1).calculate(task, answer)
        closed = rest_to_rest(distance, velocity, acceleration, limit)
        assert closed == pytest.approx(answer.duration, rel=1e-9)


@given(distance=powers_of_ten(-3.0, 2.0), velocity=SIZE, acceleration=SIZE)
def test_rest_to_rest_without_a_jerk_limit_is_the_trapezoid(
    distance: float, velocity: float, acceleration: float
) -> None:
    expected = trapezoid(distance, velocity, acceleration)
    assert rest_to_rest(distance, velocity, acceleration, math.inf) == pytest.approx(
        expected, rel=1e-12
    )
    # and the limit of ever larger jerk
    huge = 1e12 * (acceleration / velocity + acceleration**2 / distance)
    near = rest_to_rest(distance, velocity, acceleration, huge)
    assert near == pytest.approx(expected, rel=1e-5)
    assert near >= expected


# --- Ruckig: stop and go, end to end --------------------------------------------------------------


@given(
    problem=problems(
        segments=st.integers(1, 5), limited=("va", "vaj"), reach=(-3.0, 2.0), position=True
    )
)
@settings(max_examples=80)
def test_stop_and_go_is_the_sum_of_the_legs_and_passes_the_check(problem: Problem) -> None:
    outcome = REFERENCES["ruckig_stop_and_go"](problem)
    assert outcome.status == "ok", outcome.note
    expected = legs(problem, problem.waypoints)
    assert outcome.seconds == pytest.approx(sum(expected), rel=1e-8, abs=1e-12)
    assert outcome.durations is not None
    np.testing.assert_allclose(outcome.durations, expected, rtol=1e-8, atol=1e-12)
    if not problem.moving_joints:
        assert outcome.trajectory is None
        return
    assert outcome.trajectory is not None
    verdict = check(problem, outcome.trajectory)
    assert verdict.feasible, verdict.faults
    assert verdict.seconds == outcome.seconds
    for time, waypoint in zip(outcome.trajectory.passage_times, problem.waypoints, strict=True):
        for order, value in ((0, waypoint), (1, 0.0)):
            size = np.abs(outcome.trajectory.at(time, order) - value)
            assert (size <= 1e-8 * (1.0 + np.abs(problem.waypoints).max())).all()


@given(problem=problems(segments=st.integers(1, 5), limited=("va", "vaj"), reach=(-3.0, 2.0)))
def test_end_to_end_is_the_one_leg_and_never_slower_than_stop_and_go(problem: Problem) -> None:
    outcome = REFERENCES["ruckig_end_to_end"](problem)
    assert outcome.status == "ok", outcome.note
    ends = problem.waypoints[[0, -1]]
    assert outcome.seconds == pytest.approx(legs(problem, ends)[0], rel=1e-9, abs=1e-12)
    if outcome.trajectory is not None:
        assert check(problem, outcome.trajectory, through=False).feasible
    stop = REFERENCES["ruckig_stop_and_go"](problem)
    assert stop.seconds is not None
    assert outcome.seconds is not None
    assert outcome.seconds <= stop.seconds * (1.0 + 1e-9)


@given(problem=problems(segments=2, limited=("v", "vj"), reach=(-2.0, 1.0)))
@settings(max_examples=10)
def test_without_an_acceleration_limit_ruckig_is_not_applicable(problem: Problem) -> None:
    for key in ("ruckig_stop_and_go", "ruckig_end_to_end"):
        outcome = REFERENCES[key](problem)
        assert outcome.status == "not-applicable"
        assert outcome.seconds is None
        assert "acceleration limit" in outcome.note


def test_one_joint_without_an_acceleration_limit_is_enough_to_refuse() -> None:
    limits = Limits.of(1.0, [1.0, np.inf], dof=2)
    outcome = REFERENCES["ruckig_stop_and_go"](Problem.of([[0.0, 0.0], [1.0, 1.0]], limits))
    assert outcome.status == "not-applicable"


def test_a_jerk_limit_on_some_joints_only_is_kept_on_those() -> None:
    limits = Limits.of(1.0, 1.0, [np.inf, 2.0], dof=2)
    problem = Problem.of([[0.0, 0.0], [1.0, 1.0], [1.0, 3.0]], limits)
    outcome = REFERENCES["ruckig_stop_and_go"](problem)
    assert outcome.status == "ok"
    assert outcome.trajectory is not None
    assert check(problem, outcome.trajectory).feasible
    assert outcome.seconds == pytest.approx(rest_to_rest(1, 1, 1, 2) + rest_to_rest(2, 1, 1, 2))


@pytest.mark.parametrize("case", ["sr4c", "ur5", "ur5-corrected"])
def test_ruckig_on_shipped_cases_is_the_closed_form(case: str) -> None:
    problem = load(case)
    stop = REFERENCES["ruckig_stop_and_go"](problem)
    assert stop.seconds == pytest.approx(sum(legs(problem, problem.waypoints)), rel=1e-9)
    through = REFERENCES["ruckig_end_to_end"](problem)
    assert through.seconds == pytest.approx(legs(problem, problem.waypoints[[0, -1]])[0], rel=1e-9)
