"""Durations in proportion to chord lengths, scaled to the limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from formulations import FAMILIES, InputError, Limits, Problem, check, chord_lengths, load

POSITIONS = st.floats(-2.0, 2.0)


@pytest.mark.parametrize(
    ("power", "seconds", "excess"), [(1.0, 18.646, 0.350), (0.5, 17.768, 0.0), (0.0, 20.502, 0.034)]
)
def test_z1(power: float, seconds: float, excess: float) -> None:
    problem = load("z1")
    durations = chord_lengths(problem, power=power)
    assert durations.sum() == pytest.approx(seconds, abs=1e-3)
    # truth by dense sampling
    motion = FAMILIES[problem.family].trajectory(problem, durations)
    x = motion.at(np.linspace(0.0, motion.seconds, 40_001))
    low, high = problem.position_bounds.T
    assert max((x - high).max(), (low - x).max(), 0.0) == pytest.approx(excess, abs=1e-3)
    assert check(problem, motion).feasible == (excess == 0.0)


@given(
    st.data(), st.sampled_from(["3-5-3", "b-spline-3", "b-spline-5", "quintic"]), st.floats(-1.0, 2.0)
)
def test_laws(data: st.DataObject, family: str, power: float) -> None:
    steps = data.draw(st.lists(st.tuples(*[st.floats(0.2, 1.0)] * 2), min_size=3, max_size=3))
    signs = data.draw(st.lists(st.sampled_from([-1.0, 1.0]), min_size=3, max_size=3))
    waypoints = np.cumsum(
        [(0.0, 0.0), *(sign * np.array(d) for sign, d in zip(signs, steps, strict=True))], axis=0
    )
    limits = Limits.of(velocity=2.0, acceleration=3.0, jerk=20.0, dof=2)
    problem = Problem.of(waypoints, limits, family=family)
    durations = chord_lengths(problem, power=power)
    lengths = [np.hypot(*d) for d in steps]
    ratios = np.array(lengths) ** power
    np.testing.assert_allclose(durations / durations.sum(), ratios / ratios.sum(), rtol=1e-9)
    # the limits are kept, and a slightly faster motion breaks one
    chosen = FAMILIES[family]
    assert check(problem, chosen.trajectory(problem, durations)).feasible
    assert not check(problem, chosen.trajectory(problem, durations * (1.0 - 1e-5))).feasible
    # the unit of the angles does not matter
    larger = replace(
        problem,
        waypoints=3.0 * waypoints,
        limits=Limits.of(velocity=6.0, acceleration=9.0, jerk=60.0, dof=2),
    )
    np.testing.assert_allclose(chord_lengths(larger, power=power), durations, rtol=1e-9)


def test_a_chord_of_no_length_and_bad_powers_are_refused() -> None:
    limits = Limits.of(velocity=2.0, acceleration=3.0, dof=1)
    same = Problem.of([[0.0], [1.0], [1.0], [2.0]], limits, family="b-spline-5")
    with pytest.raises(
        InputError, match="chord_lengths: waypoints 2 and 3 are the same; a chord of no length"
    ):
        chord_lengths(same)
    assert np.ptp(chord_lengths(same, power=0.0)) == 0.0
    with pytest.raises(InputError, match="power: nan is not a number"):
        chord_lengths(same, power=float("nan"))
    with pytest.raises(InputError, match="leaves the range of floats"):
        chord_lengths(Problem.of([[0.0], [1e-9], [1.0]], limits, family="b-spline-5"), power=50.0)
