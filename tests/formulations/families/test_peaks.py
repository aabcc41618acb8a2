"""Exact peaks, stretch and position excess: against dense samples and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Array, powers_of_ten
from hypothesis import given, settings
from hypothesis import strategies as st
from spline_oracles import (
    KNOWN,
    NAMES,
    at,
    candidates,
    dense,
    derivative,
    peak_rounding,
    pieces,
    rounding,
    some_problem,
    stretch_rounding,
)

from formulations import CASES, FAMILIES, Limits, Problem, load


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
@settings(max_examples=40)
def test_peaks_and_stretch_agree_with_dense_samples(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family))
    agree_with_dense_samples(problem, t)


@pytest.mark.parametrize("family", NAMES)
@pytest.mark.parametrize("times", [(100.0, 1.0, 0.01, 100.0), (1e-3, 1e3, 1e-3), (1e3, 0.1, 1e-3)])
def test_peaks_and_stretch_of_uneven_durations(family: str, times: tuple[float, ...]) -> None:
    """The equations of a B-spline are nearly singular where one duration is tiny beside the others."""
    if FAMILIES[family].refusal(len(times)) is not None:
        return
    for seed in range(5):
        rng = np.random.default_rng(seed)
        steps = rng.choice([-1.0, 1.0], (len(times), 2)) * 10.0 ** rng.uniform(-6, 3, (len(times), 2))
        points = np.cumsum(np.vstack([rng.uniform(-3.0, 3.0, (1, 2)), steps]), axis=0)
        limits = Limits.of(*10.0 ** rng.uniform(-1.0, 1.0, (3, 2)), dof=2)
        agree_with_dense_samples(Problem.of(points, limits, family=family), np.array(times))


def agree_with_dense_samples(problem: Problem, t: Array) -> None:
    chosen = FAMILIES[problem.family]
    lengths, c = pieces(problem, t)
    peaks = chosen.peaks(problem, t[None])[0]
    limits = problem.limits.derivatives
    ratios = np.zeros((3, problem.dof))
    for order in (1, 2, 3):
        sampled = np.abs(dense(c, lengths, order)).max(axis=(0, 2))
        exact = peaks[:, order - 1]
        slack = 1e-14 * (rounding(derivative(c, order)) / lengths[:, None] ** order).max(axis=0)
        assert (sampled <= exact * (1.0 + 1e-13) + slack).all()
        assert (sampled >= exact * (1.0 - 1e-6) - slack).all()
        ratios[order - 1] = (exact / limits[order - 1]) ** (1.0 / order)
    stretch = float(chosen.stretch(problem, t[None])[0])
    assert stretch == pytest.approx(ratios.max(), rel=1e-11, abs=0.0)
    if stretch > 0.0:
        again = t * stretch
        # the same spline, computed once more: both are off by their rounding
        off = stretch_rounding(problem, t) + stretch_rounding(problem, again)
        assert abs(chosen.stretch(problem, again[None])[0] - 1.0) <= off
        lengths, c = pieces(problem, again)
        for order in (1, 2, 3):
            sampled = np.abs(dense(c, lengths, order)).max(axis=(0, 2))
            slack = peak_rounding(problem, again, order)
            assert (sampled <= limits[order - 1] * (1.0 + 1.01 * order * off) + slack).all()


@pytest.mark.parametrize("case", CASES)
def test_peaks_agree_with_dense_samples_on_shipped_cases(case: str) -> None:
    problem = load(case)
    chosen = FAMILIES[problem.family]
    rng = np.random.default_rng(7)
    for t in np.exp(rng.uniform(np.log(0.05), np.log(20.0), (10, problem.n_segments))):
        lengths, c = pieces(problem, t)
        peaks = chosen.peaks(problem, t[None])[0]
        for order in (1, 2, 3):
            sampled = np.abs(dense(c, lengths, order)).max(axis=(0, 2))
            assert (sampled <= peaks[:, order - 1] * (1.0 + 1e-13) + 1e-300).all()
            assert (sampled >= peaks[:, order - 1] * (1.0 - 1e-6)).all()


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data(), n=st.integers(1, 300))
@settings(max_examples=25)
def test_a_population_is_judged_like_its_members_one_by_one(
    family: str, data: st.DataObject, n: int
) -> None:
    problem = data.draw(some_problem(family, position=True))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    t = 10.0 ** rng.uniform(-3.0, 3.0, (n, problem.n_segments))
    chosen = FAMILIES[family]
    rows = [row[None] for row in t]
    for method in (chosen.coefficients, chosen.peaks, chosen.position_excess):
        np.testing.assert_array_equal(
            method(problem, t), np.concatenate([method(problem, row) for row in rows])
        )
    alone = np.concatenate([chosen.stretch(problem, row) for row in rows])
    np.testing.assert_allclose(chosen.stretch(problem, t), alone, rtol=1e-14)
    # nor does the order matter
    shuffled = rng.permutation(n)
    np.testing.assert_allclose(chosen.stretch(problem, t[shuffled]), alone[shuffled], rtol=1e-14)


def test_a_population_that_is_a_strided_view_is_judged_alike() -> None:
    problem = load("sr4c")
    chosen = FAMILIES["3-5-3"]
    wide = np.random.default_rng(0).uniform(0.5, 5.0, (700, 6))
    np.testing.assert_array_equal(
        chosen.stretch(problem, wide[::2, ::2]), chosen.stretch(problem, wide[::2, ::2].copy())
    )
    assert chosen.stretch(problem, np.empty((0, 3))).shape == (0,)


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
@settings(max_examples=40)
def test_position_excess_agrees_with_dense_samples(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family, -2.0, 2.0, position=True))
    chosen = FAMILIES[family]
    lengths, c = pieces(problem, t)
    x = dense(c, lengths, 0)
    low, high = problem.position_bounds.T[:, None, :, None]
    sampled = max(float(np.maximum(low - x, x - high).max()), 0.0)
    exact = float(chosen.position_excess(problem, t[None])[0])
    scale = float(rounding(c).max())
    assert sampled <= exact + 1e-14 * scale
    assert sampled >= exact - 1e-6 * scale
    # the shape alone decides: no stretch mends it
    again = float(chosen.position_excess(problem, t[None] * 7.0)[0])
    assert again == pytest.approx(exact, rel=1e-9, abs=1e-12 * scale)


def test_position_excess_in_closed_form() -> None:
    """0 to 1 and back in two quartics, 1 s each: x = 4 s^3 - 3 s^4 mirrored, which peaks at 1."""
    problem = Problem.of(
        [[0.0], [1.0], [0.0]], Limits.of(1.0, position=[[-1.0, 1.5]], dof=1), family="4-3-4"
    )
    assert FAMILIES["4-3-4"].position_excess(problem, np.array([[1.0, 1.0]]))[0] == 0.0
    # unequal times: the spline turns after or before the waypoint; one quartic's peak in closed form
    t = np.array([1.0, 3.0])
    c = FAMILIES["4-3-4"].coefficients(problem, t[None])[0, :, 0]
    turn = np.roots(derivative(c[1], 1)[::-1])
    turn = turn[(np.abs(turn.imag) < 1e-12) & (turn.real > 0.0) & (turn.real < 1.0)].real
    top = float(at(c[1], turn).max())
    assert top > 1.0
    tight = Problem.of(problem.waypoints, Limits.of(1.0, position=[[-1.0, 1.0]], dof=1), family="4-3-4")
    found = FAMILIES["4-3-4"].position_excess(tight, t[None])[0]
    assert found == pytest.approx(top - 1.0, rel=1e-12)


@pytest.mark.parametrize("family", NAMES)
def test_an_infinite_side_of_the_position_limits_never_counts(family: str) -> None:
    points = np.array([[0.0], [1.0], [1.1], [0.0]])  # past 1.1 with speed, by the mean rule too
    t = np.array([[1.0, 1.0, 1.0]])
    chosen = FAMILIES[family]
    excess = []
    for bounds in ([-np.inf, 1.1], [0.0, np.inf], [-np.inf, np.inf], [0.0, 1.1]):
        limits = Limits.of(1.0, position=[bounds], dof=1)
        excess.append(float(chosen.position_excess(Problem.of(points, limits, family=family), t)[0]))
    if family in KNOWN:
        assert excess[0] > 0.01  # it overshoots above
    assert excess[1] < 1e-14  # and not below, but for rounding
    assert excess[2] == 0.0
    assert excess[3] == max(excess[0], excess[1])


# --- closed forms ---------------------------------------------------------------------------------


def test_a_symmetric_3_5_3_has_the_closed_form_peaks() -> None:
    """Displacements 1, 10, 1 in T each: the quintic's greatest velocity is in its middle.

    With v = 3, a = 6 at its ends (cubes, normalised) Hermite gives 15/8 10 - 7/16 6 - 12/32 = 15.75;
    rest = 10 - 3 - 3 = 4, slope = -6, bend = -12, so the jerk is 6 (40 + 24 - 6) at both its ends.
    """
    problem = Problem.of([[0.0], [1.0], [11.0], [12.0]], Limits.of(1.0, 1.0, 1.0, dof=1))
    for time in (0.1, 1.0, 3.0):
        peaks = FAMILIES["3-5-3"].peaks(problem, np.full((1, 3), time))[0, 0]
        assert peaks[0] * time == pytest.approx(15.75, rel=1e-13)
        assert peaks[2] * time**3 == pytest.approx(348.0, rel=1e-13)


def test_a_jerk_that_peaks_inside_a_quintic_has_the_closed_form() -> None:
    """Displacements 1, 4.2, 1: rest = -1.8: no jerk at either end of the quintic, -18 between."""
    for time in (0.1, 1.0, 3.0):
        t = np.full((1, 3), time)
        problem = Problem.of([[0.0], [1.0], [5.2], [6.2]], Limits.of(1e9, jerk=2.25, dof=1))
        peak = FAMILIES["3-5-3"].peaks(problem, t)[0, 0, 2]
        assert peak * time**3 == pytest.approx(18.0, rel=1e-12)
        assert FAMILIES["3-5-3"].stretch(problem, t)[0] * time == pytest.approx(2.0, rel=1e-12)


@given(candidate=candidates("3-5-3"))
def test_the_cubes_of_3_5_3_bound_its_peaks_from_below(candidate: tuple[Problem, Array]) -> None:
    """Displacement d (t/T)^3: v = 3 d/T and a = 6 d/T^2 at its end, j = 6 d/T^3 throughout."""
    problem, t = candidate
    peaks = FAMILIES["3-5-3"].peaks(problem, t[None])[0]
    for k in (0, 2):
        d = np.abs(np.diff(problem.waypoints, axis=0)[k])
        for order, factor in ((1, 3.0), (2, 6.0), (3, 6.0)):
            assert (peaks[:, order - 1] >= factor * d / t[k] ** order * (1.0 - 1e-12)).all()


def test_the_quartic_pair_of_4_3_4_has_the_closed_form_peaks() -> None:
    """0, 1, 0 with equal times T: x = 4 s^3 - 3 s^4; v = 16/9 / T, a = 12 / T^2, j = 48 / T^3."""
    problem = Problem.of([[0.0], [1.0], [0.0]], Limits.of(1.0, 1.0, 1.0, dof=1))
    for time in (0.1, 1.0, 3.0):
        peaks = FAMILIES["4-3-4"].peaks(problem, np.array([[time, time]]))[0, 0]
        expected = [16.0 / 9.0 / time, 12.0 / time**2, 48.0 / time**3]
        np.testing.assert_allclose(peaks, expected, rtol=1e-13)


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
def test_even_waypoints_and_times_are_solved_by_hand(family: str, data: st.DataObject) -> None:
    d = data.draw(powers_of_ten(-3.0, 3.0))
    problem = Problem.of([[0.0], [d], [2.0 * d], [3.0 * d]], Limits.of(1.0, dof=1), family=family)
    motion = FAMILIES[family].trajectory(problem, np.ones(3))
    assert motion.at(1.5)[0] == pytest.approx(1.5 * d, rel=1e-13)  # odd symmetry about the middle
    # 3-5-3: the cube's 3 d. 4-3-4: equal accelerations 6 v - 12 d = 6 d - 4 v - 2 v, so v = 1.5 d.
    # quintic: the mean of d and d. b-spline-3: knots 1/3, 1, 2, 8/3 and control points 0, 0, 0, a, b,
    # 3, 3, 3 give x(1) = 41/70 a + 8/70 b and v(1) = 9/10 a + 18/35 (b - a); a + b = 3 makes a = 46/33.
    # b-spline-5: knots 6/5, 9/5; between them 3/2 + A w + B w^3 + C w^5, w = t - 3/2, before them
    # less D (t - 6/5)^5, with rest at 0 and x(1) = 1: A, B, C, D and the speed are fractions
    speed = {"3-5-3": 3.0, "4-3-4": 1.5, "quintic": 1.0, "b-spline-3": 15.0 / 11.0}
    speed["b-spline-5"] = 2210.0 / 1533.0
    for time in (1.0, 2.0):
        assert motion.at(time)[0] == pytest.approx(time * d, rel=1e-13)
        if family in speed:
            assert motion.at(time, 1)[0] == pytest.approx(speed[family] * d, rel=1e-12)
