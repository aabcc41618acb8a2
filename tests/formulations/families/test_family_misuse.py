"""What the spline families refuse, and what they say."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from spline_oracles import (
    NAMES,
)

from formulations import FAMILIES, InputError, Limits, Problem, UnsupportedProblem


@pytest.mark.parametrize("segments", [1, 2, 4, 7])
def test_3_5_3_refuses_all_but_three_segments_with_the_reason(segments: int) -> None:
    problem = Problem.of(np.arange(segments + 1.0)[:, None], Limits.of(1.0, dof=1))
    with pytest.raises(UnsupportedProblem, match=f"3 segments.* has {segments}"):
        FAMILIES["3-5-3"].require(problem)
    for use in ("coefficients", "peaks", "stretch"):
        with pytest.raises(UnsupportedProblem, match="3 segments"):
            getattr(FAMILIES["3-5-3"], use)(problem, np.ones((2, segments)))
    with pytest.raises(UnsupportedProblem, match="3 segments"):
        FAMILIES["3-5-3"].trajectory(problem, np.ones(segments))


def test_4_3_4_refuses_one_segment_with_the_reason() -> None:
    problem = Problem.of([[0.0], [1.0]], Limits.of(1.0, dof=1))
    with pytest.raises(UnsupportedProblem, match="2 segments"):
        FAMILIES["4-3-4"].trajectory(problem, [1.0])


@pytest.mark.parametrize("family", NAMES)
@pytest.mark.parametrize("limited", [False, True], ids=["unlimited", "position limits"])
@pytest.mark.parametrize(
    "bad",
    [
        [0.0, 1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, np.nan],
        [1.0, 1.0],
        [1.0, 1.0, 1.0, 1.0],
        [],
        [[1.0, 1.0, 1.0]],
    ],
    ids=["zero", "negative", "NaN", "too few", "too many", "none", "nested"],
)
@pytest.mark.parametrize("use", ["trajectory", "coefficients", "peaks", "stretch", "position_excess"])
def test_bad_durations_are_refused_by_every_method(
    family: str, limited: bool, bad: Any, use: str
) -> None:
    position = [[-9.0, 9.0]] if limited else (-np.inf, np.inf)
    limits = Limits.of(1.0, position=position, dof=1)
    problem = Problem.of([[0.0], [1.0], [2.0], [3.0]], limits, family=family)
    durations = bad if use == "trajectory" else np.array([bad])
    with pytest.raises(InputError, match=r"^durations: .*") as caught:
        getattr(FAMILIES[family], use)(problem, durations)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("family", NAMES)
def test_an_infinite_duration_is_no_motion(family: str) -> None:
    problem = Problem.of([[0.0], [1.0], [2.0], [3.0]], Limits.of(1.0, dof=1), family=family)
    with pytest.raises(InputError):
        FAMILIES[family].trajectory(problem, [np.inf, 1.0, 1.0])
