"""Very short segments among long ones, and far position limits: numbers that a solver refuses."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import powers_of_ten
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import Limits, Problem, check, free_form, free_form_bound
from formulations.proofs.rest_to_rest import rest_to_rest
from formulations.proofs.status import BoundStatus


def ordered(problem: Problem, *, time_limit: float = 2.0) -> tuple[float, float]:
    """Bound and free-form time [s], after both are checked: bound <= free form <= stop and go."""
    found = free_form(problem)
    bound = free_form_bound(problem, upper=found.seconds, time_limit=time_limit)
    assert found.trajectory is not None
    assert check(problem, found.trajectory).feasible
    legs = [
        max(rest_to_rest(abs(d), *problem.limits.derivatives[:, j]) for j, d in enumerate(row) if d)
        for row in problem.displacements
    ]
    assert 0.0 < bound.least_verified <= found.seconds <= sum(legs) * (1.0 + 1e-9)
    assert bound.status != BoundStatus.SOLVER_FAILED, bound.reason
    return bound.seconds, found.seconds


def test_a_segment_of_two_millionths_does_not_end_in_a_traceback() -> None:
    """The tangents (10) at this point have coefficients of 1e16, which HiGHS refuses."""
    problem = Problem.of([[0.0], [-0.113948], [-0.11395], [0.0]], Limits.of(9.0, 5.0, 400.0, dof=1))
    lower, upper = ordered(problem, time_limit=10.0)
    assert upper / lower - 1.0 <= 1e-3


@pytest.mark.parametrize("far", [1e6, 1e12, 1e17, 1e300])
def test_position_limits_that_are_far_away_say_nothing(far: float) -> None:
    points, limits = [[0.0], [0.3], [-0.2]], (1.0, 2.0, 20.0)
    free = Problem.of(points, Limits.of(*limits, dof=1))
    walled = Problem.of(points, Limits.of(*limits, (-far, far), dof=1))
    assert ordered(walled)[0] == pytest.approx(ordered(free)[0], rel=1e-3)


SIZE = powers_of_ten(-1.0, 1.0)


@st.composite
def with_short_segments(draw: st.DrawFn) -> Problem:
    """Two to five segments, some of them 1e-6 to 1e-3 of the others."""
    n, dof = draw(st.integers(2, 5)), draw(st.integers(1, 2))
    short = draw(st.lists(st.booleans(), min_size=n, max_size=n).filter(any))
    scale = [draw(powers_of_ten(-6.0, -3.0)) if little else 1.0 for little in short]
    steps = [
        [draw(st.sampled_from([-1.0, 1.0])) * draw(SIZE) * size for _ in range(dof)] for size in scale
    ]
    waypoints = np.cumsum([[0.0] * dof, *steps], axis=0)
    jerk = draw(st.sampled_from([np.inf, 1.0, 40.0, 1e3]))
    return Problem.of(waypoints, Limits.of(draw(SIZE), draw(SIZE), jerk * draw(SIZE), dof=dof))


@pytest.mark.long
@given(problem=with_short_segments())
@settings(max_examples=20)
def test_short_segments_among_long_ones(problem: Problem) -> None:
    ordered(problem)
