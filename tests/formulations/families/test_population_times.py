"""Times of whole populations: against stretch and excess of each candidate, and against closed forms."""

from __future__ import annotations

from math import comb

import numpy as np
import pytest
from conftest import Array
from hypothesis import given, settings
from hypothesis import strategies as st
from spline_oracles import NAMES, at, derivative, pieces, some_problem

from formulations import FAMILIES, InputError, Limits, Problem, load
from formulations.families.family import BLOCK
from formulations.families.population_times import PopulationTimes
from formulations.families.position import stays_inside
from formulations.problem.errors import UnsupportedProblem


def plain(problem: Problem, t: Array, *, stretched: bool) -> Array:
    """The same from the family's own methods, which know neither hulls nor buffers."""
    family = FAMILIES[problem.family]
    factor = family.stretch(problem, t)
    total = t.sum(axis=1) * factor if stretched else np.where(factor > 1.0, np.inf, t.sum(axis=1))
    return np.where(family.position_excess(problem, t) > problem.position_slack, np.inf, total)


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data(), stretched=st.booleans(), spread=st.sampled_from([0.05, 1.0, 3.0]))
@settings(max_examples=40)
def test_times_follow_from_stretch_and_position_excess(
    family: str, data: st.DataObject, stretched: bool, spread: float
) -> None:
    problem = data.draw(some_problem(family, position=data.draw(st.booleans())))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    times = PopulationTimes(FAMILIES[family], problem, stretched=stretched)
    for n in (BLOCK + 3, 1, 50):  # the buffers of a call leave nothing behind for the next one
        t = 10.0 ** rng.uniform(-spread, spread, (n, problem.n_segments))
        np.testing.assert_array_equal(times(t), plain(problem, t, stretched=stretched))


@given(
    ratio=st.floats(1.2, 4.0),
    down=st.booleans(),
    inner=st.sampled_from([1e-3, 1e-6, 1e-8]),
)
def test_a_path_that_just_leaves_its_limit_is_told_from_one_that_just_stays_inside(
    ratio: float, down: bool, inner: float
) -> None:
    """The quintic between equal waypoints overshoots them; its peak is found here by its roots."""
    sign = -1.0 if down else 1.0
    x = sign * np.array([[0.0], [1.0], [1.0], [0.0]])
    t = np.array([1.0, ratio, 1.0])
    free = Problem.of(x, Limits.of(1.0, 1.0, dof=1), family="3-5-3")
    c = pieces(free, t)[1][1, 0]
    turns = np.roots(derivative(c, 1)[::-1])
    inside = turns.real[(abs(turns.imag) < 1e-9) & (turns.real > 0.0) & (turns.real < 1.0)]
    peak = float(np.abs(at(c, inside)).max())
    assert peak > 1.0 + 1e-2
    for limit, feasible in ((peak + inner, True), (peak - inner, False)):
        position = (-limit, 5.0) if down else (-5.0, limit)
        problem = Problem.of(x, Limits.of(1.0, 1.0, position=position, dof=1), family="3-5-3")
        found = PopulationTimes(FAMILIES["3-5-3"], problem, stretched=True)(t[None])
        assert np.isfinite(found).tolist() == [feasible]


@pytest.mark.parametrize("i", range(1, 6))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_bump_of_one_bernstein_coefficient_is_seen(i: int, sign: float) -> None:
    """p = C(5, i) s^i (1 - s)^(5 - i) has its peak at s = i / 5; no other coefficient shows it."""
    c = np.zeros((1, 1, 1, 6))
    for k in range(6 - i):
        c[0, 0, 0, i + k] = sign * comb(5, i) * comb(5 - i, k) * (-1.0) ** k
    peak = comb(5, i) * (i / 5) ** i * (1 - i / 5) ** (5 - i)
    for limit, inside in ((peak + 1e-9, True), (peak - 1e-9, False)):
        bounds = np.array([[-limit, limit, 1e-12]])
        assert stays_inside(0, c, np.array([5]), bounds, np.zeros((7, 6))) is inside


def test_misuse_is_refused_as_by_the_family() -> None:
    problem = load("sr4c")
    times = PopulationTimes(FAMILIES["3-5-3"], problem, stretched=True)
    assert times(np.empty((0, 3))).shape == (0,)
    good = np.ones((BLOCK + 2, 3))
    for bad in (0.0, -1.0, np.nan, np.inf):
        wrong = good.copy()
        wrong[-1, 1] = bad
        with pytest.raises(InputError, match="must be positive and finite"):
            times(wrong)
    for shape in ((3,), (2, 4), (0, 2)):
        with pytest.raises(InputError, match="expected"):
            times(np.ones(shape))
    np.testing.assert_array_equal(times(good[::2, ::-1]), plain(problem, good[::2], stretched=True))
    with pytest.raises(UnsupportedProblem, match="3-5-3"):
        PopulationTimes(FAMILIES["3-5-3"], load("bagging"), stretched=True)
