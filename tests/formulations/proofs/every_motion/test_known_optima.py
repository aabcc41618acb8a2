"""The bound where the fastest motion is known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from every_motion_helpers import SIZE, holds, problem_of
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import free_form_bound
from formulations.proofs.every_motion.closed_forms import least_durations
from formulations.proofs.rest_to_rest import rest_to_rest
from formulations.proofs.status import BoundStatus


@pytest.mark.parametrize(
    ("V", "A", "J"),
    [(1.0, 2.0, 10.0), (5.0, 2.0, 3.0), (1.0, 2.0, np.inf), (1.0, np.inf, 4.0)],
)
@pytest.mark.parametrize("inner", [[], [0.3], [0.1, 0.2, 0.9]])
def test_one_joint_that_never_turns_back(V: float, A: float, J: float, inner: list[float]) -> None:
    """Inner waypoints on the way change nothing: the motion from rest to rest passes them."""
    problem = problem_of([[0.0], *[[x] for x in inner], [1.0]], V, A, J)
    bound = free_form_bound(problem, gap=1e-6, time_limit=20.0)
    optimum = rest_to_rest(1.0, V, A, J)
    assert optimum * (1.0 - 1e-9) <= bound.seconds <= optimum
    # the relaxation knows nothing of the closed form, which ended the search
    assert bound.bounds["relaxation"] >= optimum * (1.0 - 2e-2)
    holds(problem, bound)


@pytest.mark.parametrize("limits", [(1.0, 2.0, 10.0), (5.0, 1.5, 3.0), (1.0, np.inf, 4.0), (1.0, 2.0)])
@pytest.mark.parametrize("distance", [0.003, 0.05, 0.2, 0.7, 3.0])
def test_a_first_segment_by_itself(limits: tuple[float, ...], distance: float) -> None:
    """Against the steepest start there is, step by step: a <= J t, a <= A, v + a^2 / (2 J) <= V."""
    V, A, J = (*limits, np.inf)[:3]
    t, h, x, v, a = 0.0, 1e-4, 0.0, 0.0, 0.0
    while x < distance:
        a = min(a + J * h if np.isfinite(J) else A, A, math.sqrt(2.0 * J * max(V - v, 0.0)))
        a = min(a, (V - v) / h)
        x, v, t = x + h * (v + h * a / 2.0), v + h * a, t + h
    alone = least_durations(problem_of([[0.0], [distance], [0.0]], *limits))
    assert alone[0] == alone[1] == pytest.approx(t, rel=1e-3, abs=1e-4)
    assert least_durations(problem_of([[-1.0], [0.0], [distance], [0.0]], *limits))[1] <= distance / V


@given(distances=st.lists(SIZE, min_size=1, max_size=4), V=SIZE, A=SIZE, J=SIZE)
@settings(max_examples=15)
def test_two_waypoints_are_ruckigs(distances: list[float], V: float, A: float, J: float) -> None:
    problem = problem_of([np.zeros(len(distances)), distances], V, A, J)
    optimum = max(rest_to_rest(d, V, A, J) for d in distances)
    bound = free_form_bound(problem, gap=1e-6)
    assert optimum * (1.0 - 1e-9) <= bound.seconds <= optimum
    assert bound.upper == pytest.approx(optimum, rel=1e-6)


def test_turning_between_walls_without_a_jerk_limit_is_a_row_of_trapezoids() -> None:
    problem = problem_of([[0.0], [1.0], [0.0], [1.0]], 1.0, 3.0, position=(0.0, 1.0))
    bound = free_form_bound(problem, gap=1e-6)
    trapezoids = 3.0 * rest_to_rest(1.0, 1.0, 3.0, np.inf)
    assert trapezoids * (1.0 - 1e-6) <= bound.seconds <= trapezoids * (1.0 + 1e-8)


def test_with_a_velocity_limit_alone_displacement_is_the_bound() -> None:
    problem = problem_of([[0.0, 0.0], [1.0, 3.0], [2.0, 2.0]], [1.0, 2.0])
    bound = free_form_bound(problem)
    assert bound.seconds == pytest.approx(2.5, rel=1e-11)
    assert bound.method == "displacement"
    assert bound.status == BoundStatus.SIMPLE
    assert "velocity limit alone" in bound.reason


def test_nothing_moves() -> None:
    bound = free_form_bound(problem_of([[1.0, 2.0]] * 3, 1.0, 2.0, 3.0))
    assert (bound.seconds, bound.upper, bound.gap, bound.status) == (0.0, 0.0, 0.0, "proved")
