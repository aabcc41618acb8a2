"""One local solve of the family's nonlinear program: whatever it is asked, it answers with a status."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import problems
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

from formulations import FAMILIES, Limits, Problem
from formulations.optima.family.nlp import Exchange
from formulations.optima.family.optimum import polished

STILL = Problem.of(
    [[0.0], [1e-3], [1e-3], [1.0], [1.5]], Limits.of(1.0, 2.0, 5.0, dof=1), family="4-3-4"
)


@pytest.mark.parametrize("shortest", [1e-30, 1e-200, 1e-300])
def test_a_segment_far_below_the_least_duration_is_a_legal_start(shortest: float) -> None:
    """The proof asks for such starts: an open segment may be as short as it likes."""
    found = polished(STILL, np.array([1.0, shortest, 1.0, 1.0]))
    assert np.isfinite(found.seconds)


@pytest.mark.parametrize("radius", [1e-9, 1e-3, 1.0, 30.0])
@pytest.mark.parametrize("y", [-40.0, -50.0, -60.0])
def test_a_trust_region_below_the_least_duration_is_no_crossed_box(y: float, radius: float) -> None:
    centre = np.array([1.0, np.exp(y), 1.0, 1.0])
    solved, outcome = Exchange(STILL, FAMILIES["4-3-4"])._program(centre).solve(centre, radius, True)
    assert outcome
    assert (np.abs(np.log(solved / centre)) <= radius * (1.0 + 1e-6) + 1e-6).all()


@pytest.mark.parametrize("guess", [[1e-300] * 4, [1e300] * 4, [1e300, 1e-300, 1.0, 1.0]])
def test_a_start_that_cannot_be_stretched_is_a_status(guess: list[float]) -> None:
    found = polished(STILL, np.array(guess))
    assert found.status
    assert np.isfinite(found.durations).all() or found.seconds == np.inf


@given(
    problem=problems(segments=st.integers(2, 5), family="4-3-4", reach=(-5.0, 1.0)),
    y=st.lists(st.floats(-300.0, 300.0), min_size=5, max_size=5),
)
@settings(max_examples=40, phases=(Phase.explicit, Phase.generate))  # each costs up to a second
def test_every_start_ends_in_a_status(problem: Problem, y: list[float]) -> None:
    """The law behind it: whatever box a proof points at, the program answers, and never raises."""
    assume(problem.moving_joints)
    found = polished(problem, 10.0 ** np.array(y[: problem.n_segments]))
    assert found.status
    if np.isfinite(found.seconds):
        stretch = FAMILIES["4-3-4"].stretch(problem, found.durations[None])[0]
        assert stretch == pytest.approx(1.0, rel=1e-6)
