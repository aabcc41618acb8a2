"""TOPP-RA where the answer is known; elsewhere it is right or a visible failure."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from closed_forms_by_hand import SIZE, legs, trapezoid
from conftest import SOLVED, Array, climbed, problems
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import Limits, Problem, Trajectory, family_optimum, load
from formulations.proofs.displacement import displacement_durations
from formulations.references import Outcome, toppra_on
from formulations.references.toppra_ import toppra_cubic

GRID = 5e-4  # relative: twice the grid error TOPP-RA results are refined to, and some


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
    path = family_optimum(problem, starts=3).trajectory
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
    path = family_optimum(problem, starts=5).trajectory
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
    path = family_optimum(problem, starts=3).trajectory
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        outcome = toppra_on(problem, path)
    assert visible(outcome) or outcome.status == "ok"


def test_about_a_vertical_axis_a_torque_limit_is_an_acceleration_limit() -> None:
    pytest.importorskip("pinocchio", reason="pin is not installed (extra dynamics)")
    from small_arms import VERTICAL, pendulum

    from formulations import Conditions
    from formulations.problem.torque import TorqueLimits
    from formulations.references.toppra_torque_ import toppra_torque

    inertia = 0.1 + 2.0 * 0.5**2
    torque = TorqueLimits(pendulum(VERTICAL), ("hinge",), (2.4,))
    points, names = [[0.0], [0.5], [1.2]], ["hinge"]
    plain = Problem(points, {"velocity": 3.0, "acceleration": 2.4 / inertia}, names=names)
    limited = Problem(
        points,
        {"velocity": 3.0, "acceleration": 99.0},
        names=names,
        conditions=Conditions(torque=torque),
    )
    found, expected = toppra_torque(limited), toppra_cubic(plain)
    assert found.seconds == pytest.approx(expected.seconds, rel=1e-3)
    assert toppra_torque(plain).status == "not-applicable"
