"""Laws of the family optimum: scaling, still joints, equal waypoints and position limits."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import powers_of_ten, problems
from family_oracle import (
    MOVING,
    NO_SHRINKING,
    judged,
    optimum,
    quick,
    searched,
)
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from formulations import (
    FAMILIES,
    Limits,
    NoFeasibleMotion,
    Problem,
    UnsupportedProblem,
    each_joint_alone,
    family_optimum,
    load,
)


def scaled(problem: Problem, *, waypoints: float = 1.0, time: float = 1.0) -> Problem:
    """The same task in another unit of angle and another unit of time."""
    limits = problem.limits
    orders = (limits.velocity, limits.acceleration, limits.jerk)
    factors = [waypoints / time**order for order in (1, 2, 3)]
    return Problem.of(
        problem.waypoints * waypoints,
        Limits.of(*(x * f for x, f in zip(orders, factors, strict=True)), dof=problem.dof),
        family=problem.family,
    )


@given(problem=MOVING, factor=powers_of_ten(-2.0, 2.0))
@settings(max_examples=4, phases=NO_SHRINKING)
def test_a_change_of_units_changes_nothing_but_units(problem: Problem, factor: float) -> None:
    seconds = quick(problem).seconds
    assert quick(scaled(problem, waypoints=factor)).seconds == pytest.approx(seconds, rel=1e-8)
    assert quick(scaled(problem, time=factor)).seconds == pytest.approx(seconds * factor, rel=1e-8)


@given(problem=problems(reach=(-2.0, 1.0), limited=("v",)), factor=powers_of_ten(-1.0, 1.0))
@settings(max_examples=4, phases=NO_SHRINKING)
def test_with_velocity_alone_time_is_divided_by_the_factor_on_the_limits(
    problem: Problem, factor: float
) -> None:
    assume(problem.moving_joints)
    faster = Problem.of(problem.waypoints, Limits.of(problem.limits.velocity * factor, dof=problem.dof))
    assert quick(faster).seconds == pytest.approx(quick(problem).seconds / factor, rel=1e-8)


@pytest.mark.slow
@given(problem=MOVING, shift=st.floats(-2.0, 2.0))
@settings(max_examples=3, phases=NO_SHRINKING)
def test_neither_an_offset_nor_a_sign_nor_the_direction_of_time_matters(
    problem: Problem, shift: float
) -> None:
    seconds = quick(problem).seconds
    for points in (problem.waypoints + shift, -problem.waypoints, problem.waypoints[::-1]):
        other = Problem.of(points, problem.limits, family=problem.family)
        assert quick(other).seconds == pytest.approx(seconds, rel=1e-8)


@given(problem=MOVING)
@settings(max_examples=4, phases=NO_SHRINKING)
def test_a_further_limit_or_joint_never_makes_it_faster(problem: Problem) -> None:
    whole = quick(problem).seconds
    for alone in each_joint_alone(problem, starts=4):
        assert alone is None or alone.seconds <= whole * (1.0 + 1e-9)
    freer = Problem.of(problem.waypoints, Limits.of(problem.limits.velocity, dof=problem.dof))
    assert quick(freer).seconds <= whole * (1.0 + 1e-9)


@pytest.mark.parametrize("case", ["sr4c", "bagging"])
def test_the_same_seed_gives_the_same_answer_to_the_bit(case: str) -> None:
    first, again = (family_optimum(load(case), starts=4, seed=5) for _ in range(2))
    np.testing.assert_array_equal(first.durations, again.durations)
    assert [s.seconds for s in first.starts] == [s.seconds for s in again.starts]
    assert optimum(case).seconds == pytest.approx(first.seconds, rel=1e-9)


def test_progress_rises_to_one() -> None:
    seen: list[float] = []
    family_optimum(load("cobot"), starts=5, progress=seen.append)
    assert len(seen) >= 4
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_another_family_can_be_asked_for() -> None:
    problem = load("sr4c")
    other = family_optimum(problem, family="4-3-4")
    assert other.family == "4-3-4"
    judged(other)
    assert optimum("sr4c").family == "3-5-3"
    with pytest.raises(UnsupportedProblem, match="3 segments"):
        family_optimum(load("bagging"), family="3-5-3")


@pytest.mark.parametrize("family", list(FAMILIES))
def test_nothing_moves_and_that_is_an_answer(family: str) -> None:
    problem = Problem.of(np.full((4, 2), 0.7), Limits.of(1.0, 1.0, 1.0, dof=2), family=family)
    found = family_optimum(problem)
    assert found.verdict.feasible
    assert 0.0 < found.seconds < 1e-6
    assert each_joint_alone(problem) == (None, None)


@pytest.mark.parametrize("row", range(3))
@pytest.mark.parametrize("family", list(FAMILIES))
def test_equal_consecutive_waypoints_are_solved(family: str, row: int) -> None:
    points = np.array([[0.0, 1.0], [1.0, 0.5], [1.5, 2.0], [0.2, 1.7]])
    points[row + 1] = points[row]
    problem = Problem.of(points, Limits.of(1.0, 2.0, 5.0, dof=2), family=family)
    found = family_optimum(problem)
    judged(found)
    oracle, _ = searched(problem)
    assert found.seconds <= oracle * (1.0 + 1e-9)


@pytest.mark.parametrize(
    "points", [[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 1.0, 1.0]], ids=["before the move", "after it"]
)
def test_segments_without_displacement_cost_nothing(points: list[float]) -> None:
    """One cube of 1 rad at V = 1 takes 3 s; the still segments beside it may vanish."""
    problem = Problem.of(np.array(points)[:, None], Limits.of(1.0, dof=1))
    found = family_optimum(problem)
    judged(found)
    assert found.seconds == pytest.approx(3.0, rel=1e-9)


def test_a_start_converges_where_the_last_segment_vanishes() -> None:
    points = [[0.0], [1.0], [1.0078125], [1.0078125]]
    found = family_optimum(Problem.of(points, Limits.of(1.0, dof=1)))
    judged(found)
    assert found.seconds == pytest.approx(3.0133616762408, rel=1e-9)  # as T3 tends to 0
    assert "ok" in {start.status for start in found.starts}


@pytest.mark.parametrize("size", [1e-6, 1e3])
def test_tiny_and_huge_displacements_are_solved(size: float) -> None:
    points = size * np.array([[0.0, 0.0], [1.0, -2.0], [2.0, 1.0], [5.0, 3.0]])
    found = family_optimum(Problem.of(points, Limits.of(1.0, 2.0, 5.0, dof=2)))
    judged(found)
    assert found.seconds <= searched(found.problem)[0] * (1.0 + 1e-9)


OVERSHOOT = np.array([[0.0], [1.0], [1.1], [0.1]])


def bounded(top: float) -> Problem:
    limits = Limits.of(1.0, 2.0, position=[[-0.5, top]], dof=1)
    return Problem.of(OVERSHOOT, limits)


def test_position_limits_that_bind_cut_the_overshoot_and_cost_time() -> None:
    free = quick(bounded(9.0))
    swing = float(free.trajectory.extremes(0).high.max())
    assert swing > 1.3
    oracle, _ = searched(bounded(9.0))
    assert free.seconds == pytest.approx(oracle, rel=1e-6)
    last = free.seconds
    for top in (swing - 0.02, 1.3, 1.2):
        problem = bounded(top)
        found = quick(problem)
        judged(found)
        assert found.trajectory.extremes(0).high.max() == pytest.approx(top, abs=1e-6)  # it binds
        oracle, _ = searched(problem, reach=9.0)
        assert found.seconds <= oracle * (1.0 + 1e-8)
        assert found.seconds >= oracle * (1.0 - 1e-6)
        assert found.seconds > last
        last = found.seconds


def test_no_feasible_shape_is_said_to_be_none() -> None:
    """The cube reaches the limit with velocity 3 / T1 > 0: whatever follows, it must overshoot."""
    limits = Limits.of(1.0, 1.0, position=[[0.0, 1.0]], dof=1)
    problem = Problem.of([[0.0], [1.0], [0.0], [1.0]], limits)
    t = np.exp(np.random.default_rng(0).uniform(-3.0, 3.0, (20_000, 3)))
    assert (FAMILIES["3-5-3"].position_excess(problem, t) > 0.0).all()
    with pytest.raises(NoFeasibleMotion) as caught:
        family_optimum(problem, starts=3)
    assert len(str(caught.value).splitlines()) == 1
