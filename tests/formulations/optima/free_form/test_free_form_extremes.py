"""Legal numbers that are far apart: no warning, no traceback, no solver's own words for it in the answer."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from formulations import Limits, Problem, check, free_form, free_form_bound

POINTS = np.cumsum(np.random.default_rng(0).uniform(-0.6, 0.6, (5, 3)), axis=0)


@pytest.mark.parametrize(
    "size", [1.0, *(pytest.param(size, marks=pytest.mark.long) for size in (1e3, 1e6))]
)
@pytest.mark.parametrize(
    "limits", [(1e-12, 8.0, 60.0), (2.0, 1e12, 1e15), ([1e-12, 1.0, 1.0], 8.0, 1e-9)], ids=str
)
def test_extremes_are_answered_in_words(limits: tuple[float, float, float], size: float) -> None:
    problem = Problem.of(POINTS * size, Limits.of(*limits, dof=3))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = free_form(problem, time_limit=10.0)
        bound = free_form_bound(problem, upper=found.seconds, time_limit=3.0)
    assert found.trajectory is not None
    assert check(problem, found.trajectory).feasible
    assert bound.seconds <= found.seconds
    for words in (found.ending, bound.ending):
        assert "error" not in words.lower().replace("error in step computation", "")
        assert "not set" not in words


def test_times_whose_cubes_overflow_are_no_traceback() -> None:
    problem = Problem.of(POINTS, Limits.of(1e-112, 8.0, 60.0, dof=3))
    found = free_form(problem, time_limit=10.0)
    assert found.trajectory is not None
    assert check(problem, found.trajectory).feasible
    assert found.seconds > 1e112  # no shorter than displacement over velocity
