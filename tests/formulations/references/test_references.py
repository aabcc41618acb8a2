"""References: Ruckig against closed forms, TOPP-RA where the answer is known, displacement."""

from __future__ import annotations

import inspect
import math
import warnings
from itertools import pairwise

import numpy as np
import pytest
import ruckig
from conftest import SOLVED, Array, climbed, powers_of_ten, problems
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import REFERENCES, Limits, Problem, Trajectory, check, family_optimum, load
from formulations.proofs.displacement import displacement_durations
from formulations.proofs.rest_to_rest import rest_to_rest
from formulations.references import Outcome, toppra_on
from formulations.references.toppra_ import toppra_cubic

SIZE = powers_of_ten(-1.5, 1.5)
GRID = 5e-4  # relative: twice the grid error TOPP-RA results are refined to, and some


def trapezoid(distance: float, velocity: float, acceleration: float) -> float:
    """Least time of one joint from rest to rest without a jerk limit."""
    if distance >= velocity**2 / acceleration:
        return distance / velocity + velocity / acceleration
    return 2.0 * math.sqrt(distance / acceleration)


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


def legs(problem: Problem, points: Array) -> list[float]:
    """Closed form of each leg: the slowest joint."""
    limits = problem.limits.derivatives
    return [
        max(rest_to_rest(abs(d), *limits[:, j]) for j, d in enumerate(b - a))
        for a, b in pairwise(points)
    ]


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


# --- displacement ---------------------------------------------------------------------------------


@given(problem=problems(segments=st.integers(1, 6)))
def test_displacement_is_the_sum_of_the_slowest_joints_at_top_speed(problem: Problem) -> None:
    total = 0.0
    for a, b in pairwise(problem.waypoints):
        total += max(abs(y - x) / v for x, y, v in zip(a, b, problem.limits.velocity, strict=True))
    outcome = REFERENCES["displacement"](problem)
    assert outcome.status == "ok"
    assert outcome.seconds == pytest.approx(total, rel=1e-12, abs=0.0)
    assert outcome.durations is not None
    # sum and terms are each rounded down from exact numbers (test_certified.py), so they may differ
    # by the rounding of the sum
    assert outcome.durations.sum() == pytest.approx(outcome.seconds, rel=2e-15, abs=0.0)
    np.testing.assert_array_equal(outcome.durations, displacement_durations(problem))


def test_displacement_of_the_cobot_by_hand() -> None:
    """100 deg/s: segments move 30, 45 (joint 5) and 45 degrees (joint 2)."""
    outcome = REFERENCES["displacement"](load("cobot"))
    assert outcome.seconds == pytest.approx(1.2, rel=1e-14)
    assert outcome.durations is not None
    np.testing.assert_allclose(outcome.durations, [0.3, 0.45, 0.45], rtol=1e-14)


# --- TOPP-RA --------------------------------------------------------------------------------------


def grid_error(outcome: Outcome) -> float:
    """The error the note states."""
    return float(outcome.note.split("grid error ")[1].split(";")[0])


def seconds_of(outcome: Outcome) -> float:
    assert outcome.status == "ok", outcome.note
    assert outcome.seconds is not None
    assert "grid intervals per piece" in outcome.note
    assert "no jerk limit" in outcome.note
    return outcome.seconds


@given(
    steps=st.lists(st.floats(-3.0, 3.0).filter(lambda x: abs(x) > 1e-3), min_size=1, max_size=3),
    velocity=st.lists(SIZE, min_size=3, max_size=3),
    acceleration=st.lists(SIZE, min_size=3, max_size=3),
)
@settings(max_examples=15)
def test_a_straight_line_takes_the_time_of_the_trapezoid(
    steps: list[float], velocity: list[float], acceleration: list[float]
) -> None:
    dof = len(steps)
    limits = Limits.of(velocity[:dof], acceleration[:dof], dof=dof)
    problem = Problem.of([np.zeros(dof), steps], limits)
    # along the line, s from 0 to 1, the tightest joint of each kind limits
    v = min(limits.velocity / np.abs(steps))
    a = min(limits.acceleration / np.abs(steps))
    found = toppra_cubic(problem)
    assert seconds_of(found) == pytest.approx(trapezoid(1.0, v, a), rel=GRID)
    assert grid_error(found) < 2e-4


@given(steps=st.lists(st.floats(0.05, 2.0), min_size=2, max_size=4))
@settings(max_examples=10)
def test_one_joint_that_never_turns_takes_the_time_of_the_trapezoid(steps: list[float]) -> None:
    """On a line it does not matter where the waypoints lie."""
    points = np.concatenate([[0.0], np.cumsum(steps)])[:, None]
    # a path of straight pieces, each a cube: rests in its parameter at every waypoint
    times = np.ones(len(steps))
    c = np.zeros((len(steps), 1, 4))
    c[:, 0, 0] = points[:-1, 0]
    c[:, 0, 1] = steps
    problem = Problem.of(points, Limits.of(1.0, 2.0, dof=1))
    found = toppra_on(problem, Trajectory(times, c))
    assert seconds_of(found) == pytest.approx(trapezoid(float(points[-1, 0]), 1.0, 2.0), rel=GRID)


@pytest.mark.parametrize("case", ["cobot", "bagging"])
def test_with_velocity_alone_the_time_is_the_integral_of_the_slowest_joint(case: str) -> None:
    """T = integral of max |q_j'| / V_j over the path parameter, by a fine midpoint rule."""
    problem = load(case)
    path = family_optimum(problem, random_starts=0).trajectory
    edges = np.linspace(0.0, path.seconds, 400_001)
    middles = 0.5 * (edges[1:] + edges[:-1])
    rate = (np.abs(path.at(middles, 1)) / problem.limits.velocity).max(axis=1)
    exact = float(rate.sum() * (edges[1] - edges[0]))
    assert seconds_of(toppra_on(problem, path)) == pytest.approx(exact, rel=GRID)


@pytest.mark.parametrize("case", SOLVED)
def test_toppra_on_shipped_cases_is_ok_and_no_slower_than_the_family(case: str) -> None:
    problem = load(case)
    optimum = climbed(case).optimum
    assert optimum is not None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        on_path, cubic = toppra_on(problem, optimum.trajectory), toppra_cubic(problem)
    assert seconds_of(on_path) <= optimum.seconds * (1.0 + 1e-3)
    # a path costs at least its displacements at top speed
    least = float(displacement_durations(problem).sum())
    for outcome in (on_path, cubic):
        assert seconds_of(outcome) >= least * (1.0 - GRID)
        assert grid_error(outcome) < 2e-4


@given(problem=problems(segments=3, limited=("va",), reach=(-1.0, 1.0), max_dof=3))
@settings(max_examples=8)
def test_toppra_on_made_up_problems_is_ok_or_says_why(problem: Problem) -> None:
    outcome = toppra_cubic(problem)
    if outcome.status == "ok":
        assert outcome.seconds is not None
        least = float(displacement_durations(problem).sum())
        assert outcome.seconds >= least * (1.0 - 1e-3)
    else:
        assert outcome.status == "failed"
        assert outcome.seconds is None
        assert outcome.note.startswith("TOPP-RA: ")


def test_nothing_that_moves_takes_no_time() -> None:
    still = Problem.of(np.full((4, 2), 0.5), Limits.of(1.0, 1.0, 1.0, dof=2))
    for reference in REFERENCES.values():
        outcome = reference(still)
        assert outcome.status == "ok"
        assert outcome.seconds == 0.0
    assert toppra_on(still, family_optimum(still).trajectory).seconds == 0.0


def test_equal_waypoints_do_not_stop_the_cubic() -> None:
    limits = Limits.of(1.0, 1.0, dof=2)
    points = np.array([[0.0, 0.0], [1.0, 2.0], [2.0, 1.0]])
    once = toppra_cubic(Problem.of(points, limits))
    for rows in ([0, 0, 1, 2], [0, 1, 1, 2], [0, 1, 2, 2], [0, 0, 1, 1, 1, 2]):
        again = toppra_cubic(Problem.of(points[rows], limits))
        assert seconds_of(again) == pytest.approx(seconds_of(once), rel=1e-12)


def visible(outcome: Outcome) -> bool:
    """A result that failed and says why, in one line."""
    return (
        outcome.status == "failed"
        and outcome.seconds is None
        and len(outcome.note) > 10
        and len(outcome.note.splitlines()) == 1
    )


@pytest.mark.parametrize(
    "points", [[[0], [1], [0]], [[0, 0], [1, 2], [0, 0]], [[1], [0], [1], [0]], [[0], [1], [0.5], [2]]]
)
def test_a_cubic_that_reverses_through_standstill_is_a_visible_failure_or_right(
    points: list[list[float]],
) -> None:
    """There and back on one line: the motion must stop where it turns."""
    problem = Problem.of(points, Limits.of(1.0, 1.0, dof=len(points[0])))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        outcome = toppra_cubic(problem)
    if not visible(outcome):
        least = sum(legs(problem, problem.waypoints))
        assert seconds_of(outcome) >= least * (1.0 - 2e-3)


def line_with_turns(path: Trajectory) -> Array:
    """Start, turning points and end of a one-joint path."""
    t = np.linspace(0.0, path.seconds, 200_001)
    x = path.at(t)[:, 0]
    turns = np.flatnonzero(np.diff(np.sign(np.diff(x))) != 0) + 1
    return np.concatenate([x[:1], x[turns], x[-1:]])


@pytest.mark.parametrize(
    "points",
    [[0.0, 1.0, 0.0], [0.0, 1.0, 0.5, 2.0], [0.0, 2.0, 1.0, 3.0, 0.0], [0.0, 1.0, 1.0, 2.0]],
)
def test_a_one_joint_path_that_turns_must_stop_there_or_fail_visibly(points: list[float]) -> None:
    """Between waypoints, where no grid point need fall. Closed form: trapezoids between the turns."""
    problem = Problem.of(np.array(points)[:, None], Limits.of(1.0, 1.0, dof=1))
    path = family_optimum(problem, random_starts=2).trajectory
    ends = line_with_turns(path)
    assert len(ends) > 2
    least = sum(trapezoid(abs(d), 1.0, 1.0) for d in np.diff(ends))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        outcome = toppra_on(problem, path)
    if not visible(outcome):
        assert seconds_of(outcome) >= least * (1.0 - 2e-3)


def test_a_path_that_stands_still_for_a_while_is_a_visible_failure() -> None:
    """Nothing moves in the first third: no direction to start in."""
    points = np.array([[0.0, 0.0], [0.0, 0.0], [1.0, 2.0], [2.0, 1.0]])
    problem = Problem.of(points, Limits.of(1.0, 1.0, dof=2))
    path = family_optimum(problem, random_starts=0).trajectory
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        outcome = toppra_on(problem, path)
    assert visible(outcome) or outcome.status == "ok"


# --- one signature --------------------------------------------------------------------------------


@pytest.mark.parametrize("key", list(REFERENCES))
def test_every_reference_has_the_one_signature(key: str) -> None:
    assert list(inspect.signature(REFERENCES[key]).parameters) == ["problem"]
    outcome = REFERENCES[key](load("sr4c"))
    assert isinstance(outcome, Outcome)
    assert outcome.status == "ok"
    assert outcome.seconds is not None
    assert outcome.seconds > 0.0
    if outcome.trajectory is not None:
        assert outcome.trajectory.seconds == pytest.approx(outcome.seconds, rel=1e-9)
