"""Spline families: the papers' matrices, the laws that define the splines, exact peaks and stretch.

Interpolation, C2 and rest at both ends are as many equations as a spline has coefficients and they
have one solution for 3-5-3 and 4-3-4: a family that keeps them for all durations is the papers'
family. The quintic and the B-splines are pinned by dense solves of their own conditions.
"""

from __future__ import annotations

from typing import Any

import casadi
import numpy as np
import pytest
from conftest import Array, durations, powers_of_ten, problems
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from formulations import CASES, FAMILIES, InputError, Limits, Problem, UnsupportedProblem, check, load

NAMES = list(FAMILIES)
B_SPLINES = {"b-spline-3": 3, "b-spline-5": 5}
DENSE = 20_001
POWERS = np.arange(6)


def some_problem(family: str, **options: Any) -> st.SearchStrategy[Problem]:
    """Problems the family has a spline for."""
    segments: Any = 3 if family == "3-5-3" else st.integers(2 if family == "4-3-4" else 1, 6)
    return problems(segments=segments, family=family, **options)


@st.composite
def candidates(
    draw: st.DrawFn, family: str, low: float = -3.0, high: float = 3.0, **options: Any
) -> tuple[Problem, Array]:
    """A problem and durations for it."""
    problem = draw(some_problem(family, **options))
    return problem, draw(durations(problem.n_segments, low, high))


def derivative(c: Array, order: int) -> Array:
    """Ascending coefficients of a derivative, last axis."""
    for _ in range(order):
        c = c[..., 1:] * np.arange(1, c.shape[-1])
    return c


def at(c: Array, s: Any) -> Array:
    """Values (..., m) at points s (m,)."""
    return np.asarray(c @ np.power.outer(np.atleast_1d(s), np.arange(c.shape[-1])).T)


def rounding(c: Array) -> Array:
    """Sum of the terms' sizes: what rounding errors of a value on [0, 1] are measured by."""
    return np.asarray(np.abs(c).sum(axis=-1))


def pieces(problem: Problem, t: Array) -> tuple[Array, Array]:
    """Lengths (n_pieces,) [s] and normalised coefficients (n_pieces, dof, 6) for durations t (n,)."""
    lengths, c = FAMILIES[problem.family].pieces(problem, t[None])
    return lengths[0], c[0]


def dense(c: Array, lengths: Array, order: int) -> Array:
    """Samples (n_pieces, dof, DENSE) of a derivative in time of normalised pieces c."""
    return at(derivative(c, order), np.linspace(0.0, 1.0, DENSE)) / lengths[:, None, None] ** order


def degrees_of(family: str, n: int) -> tuple[int, ...]:
    """Degrees of the pieces as the papers state them; a B-spline has n + 4 - degree inner knots."""
    if family in B_SPLINES:
        return (B_SPLINES[family],) * (n + 5 - B_SPLINES[family])
    return {"3-5-3": (3, 5, 3), "4-3-4": (4, *[3] * (n - 2), 4), "quintic": (5,) * n}[family]


# --- the papers' own linear systems ---------------------------------------------------------------


def matrix_353(t1: float, t2: float, t3: float) -> Array:
    """000 eq. 5, 004 eq. 9, 002 eq. 5: unknowns k13 k12 k11 k10, k25..k20, k33..k30."""
    return np.array(
        [
            [t1**3, t1**2, t1, 1, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0],
            [3 * t1**2, 2 * t1, 1, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0],
            [6 * t1, 2, 0, 0, 0, 0, 0, -2, 0, 0, 0, 0, 0, 0],
            [0, 0, 0, 0, t2**5, t2**4, t2**3, t2**2, t2, 1, 0, 0, 0, -1],
            [0, 0, 0, 0, 5 * t2**4, 4 * t2**3, 3 * t2**2, 2 * t2, 1, 0, 0, 0, -1, 0],
            [0, 0, 0, 0, 20 * t2**3, 12 * t2**2, 6 * t2, 2, 0, 0, 0, -2, 0, 0],
            [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, t3**3, t3**2, t3, 1],
            [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3 * t3**2, 2 * t3, 1, 0],
            [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 6 * t3, 2, 0, 0],
            [0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
            [0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
            [0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
            [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1],
            [0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0],
        ],
        dtype=np.float64,
    )


def matrix_434(t: Array) -> Array:
    """001 eq. 9, its matrix C for any number of segments: quartic, cubics, quartic, descending."""
    n = len(t)
    degrees = [4, *[3] * (n - 2), 4]
    first = np.concatenate([[0], np.cumsum(np.array(degrees) + 1)])  # column of each leading one
    rows = []

    def row(*terms: tuple[int, int, float, float]) -> None:
        """Sum of sign * derivative of the given order of the given piece at time tau."""
        line = np.zeros(first[-1])
        for piece, order, tau, sign in terms:
            for power in range(order, degrees[piece] + 1):
                factor = np.prod(np.arange(power, power - order, -1.0))
                column = first[piece] + degrees[piece] - power
                line[column] += sign * factor * tau ** (power - order)
        rows.append(line)

    for k in range(n - 1):  # position, velocity, acceleration meet
        for order in range(3):
            row((k, order, t[k], 1.0), (k + 1, order, 0.0, -1.0))
    for order in range(3):
        row((n - 1, order, t[-1], 1.0))  # the end
    for order in range(3):
        row((0, order, 0.0, 1.0))  # the start
    for k in range(1, n):
        row((k, 0, 0.0, 1.0))  # the waypoints between
    return np.array(rows)


def test_the_matrix_of_six_segments_is_the_printed_one() -> None:
    c = matrix_434(np.array([2.0, 3.0, 5.0, 7.0, 11.0, 13.0]))
    assert c.shape == (26, 26)
    # rows 1 to 3 as printed: first quartic at t1, minus the cubic's value, slope, bend
    np.testing.assert_array_equal(c[0, :9], [16, 8, 4, 2, 1, 0, 0, 0, -1])
    np.testing.assert_array_equal(c[1, :9], [32, 12, 4, 1, 0, 0, 0, -1, 0])
    np.testing.assert_array_equal(c[2, :9], [48, 12, 2, 0, 0, 0, -2, 0, 0])
    # the rows of the end: quartic at t6
    t = 13.0
    np.testing.assert_array_equal(c[15, -5:], [t**4, t**3, t**2, t, 1])
    np.testing.assert_array_equal(c[16, -5:], [4 * t**3, 3 * t**2, 2 * t, 1, 0])
    np.testing.assert_array_equal(c[17, -5:], [12 * t**2, 6 * t, 2, 0, 0])


@given(candidate=candidates("3-5-3", -0.7, 0.7, reach=(-2.0, 1.0)))
def test_3_5_3_solves_the_papers_fourteen_equations(candidate: tuple[Problem, Array]) -> None:
    problem, t = candidate
    motion = FAMILIES["3-5-3"].trajectory(problem, t)
    for j in range(problem.dof):
        x0, x1, x2, x3 = problem.waypoints[:, j]
        k = np.linalg.solve(matrix_353(*t), [0, 0, 0, 0, 0, 0, x3, 0, 0, x0, 0, 0, x2, x1])
        pieces = (k[3::-1], k[9:3:-1], k[13:9:-1])
        for piece, ascending in enumerate(pieces):
            expected = np.zeros(6)
            expected[: len(ascending)] = ascending
            scale = t[piece] ** POWERS
            np.testing.assert_allclose(
                motion.coefficients[piece, j] * scale, expected * scale, rtol=1e-9, atol=1e-9
            )


@given(candidate=candidates("4-3-4", -0.7, 0.7, reach=(-2.0, 1.0)))
def test_4_3_4_solves_the_full_matrix_for_any_number_of_segments(
    candidate: tuple[Problem, Array],
) -> None:
    problem, t = candidate
    n = problem.n_segments
    motion = FAMILIES["4-3-4"].trajectory(problem, t)
    lengths = [5, *[4] * (n - 2), 5]
    for j in range(problem.dof):
        x = problem.waypoints[:, j]
        right = np.zeros(4 * n + 2)
        right[3 * (n - 1)] = x[-1]
        right[3 * (n - 1) + 3] = x[0]
        right[3 * (n - 1) + 6 :] = x[1:-1]
        solved = np.split(np.linalg.solve(matrix_434(t), right), np.cumsum(lengths)[:-1])
        for piece, descending in enumerate(solved):
            expected = np.zeros(6)
            expected[: len(descending)] = descending[::-1]
            scale = t[piece] ** POWERS
            np.testing.assert_allclose(
                motion.coefficients[piece, j] * scale, expected * scale, rtol=1e-9, atol=1e-8
            )


def test_4_3_4_solves_the_printed_matrix_of_the_bagging_robot() -> None:
    problem = load("bagging")
    t = np.array([0.9, 0.4, 0.2, 0.7, 0.5, 0.8])
    motion = FAMILIES["4-3-4"].trajectory(problem, t)
    for j in range(6):
        x = problem.waypoints[:, j]
        right = np.concatenate([np.zeros(15), [x[6], 0, 0, x[0], 0, 0], x[1:6]])
        solution = np.linalg.solve(matrix_434(t), right)
        np.testing.assert_allclose(motion.coefficients[0, j, 4::-1], solution[:5], atol=1e-9)
        np.testing.assert_allclose(motion.coefficients[3, j, 3::-1], solution[13:17], atol=1e-9)
        np.testing.assert_allclose(motion.coefficients[5, j, 4::-1], solution[21:], atol=1e-9)


# --- the quintic and the B-splines against dense solves -------------------------------------------


@given(candidate=candidates("quintic", -0.7, 0.7, reach=(-2.0, 1.0)))
def test_quintics_solve_six_conditions_each_with_the_mean_rule(
    candidate: tuple[Problem, Array],
) -> None:
    problem, t = candidate
    motion = FAMILIES["quintic"].trajectory(problem, t)
    for j in range(problem.dof):
        x = problem.waypoints[:, j]
        mean = np.diff(x) / t  # mean velocity of each segment
        inner = np.where(np.sign(mean[1:]) == np.sign(mean[:-1]), 0.5 * (mean[1:] + mean[:-1]), 0.0)
        v = np.concatenate([[0.0], inner, [0.0]])
        for k, time in enumerate(t):
            rows = []
            for tau in (0.0, time):
                for order in range(3):
                    factors = derivative(np.eye(6), order)  # of each power
                    rows.append(at(factors, tau)[:, 0])
            expected = np.linalg.solve(rows, [x[k], v[k], 0.0, x[k + 1], v[k + 1], 0.0])
            scale = time**POWERS
            np.testing.assert_allclose(
                motion.coefficients[k, j] * scale, expected * scale, rtol=1e-9, atol=1e-9
            )


@pytest.mark.parametrize("family", B_SPLINES)
@given(data=st.data())
def test_b_splines_solve_the_full_system_of_scipys_basis(family: str, data: st.DataObject) -> None:
    """003 eq. 1-12: knots by running means, interpolation, and rest at both ends as equations."""
    problem, t = data.draw(candidates(family, -1.0, 1.0, reach=(-2.0, 1.0)))
    degree, n = B_SPLINES[family], problem.n_segments
    total = t.sum()
    u = np.concatenate([[0.0], np.cumsum(t)]) / total
    u[-1] = 1.0
    windows = np.arange(n + 4 - degree)[:, None] + np.arange(-1, degree - 1)
    inner = u[np.clip(windows, 0, n)].mean(axis=1)
    vector = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    basis = BSpline(vector, np.eye(n + 5), degree)
    rows = [*basis(u), *(basis.derivative(order)(end) for end in (0.0, 1.0) for order in (1, 2))]
    sizes = np.abs(rows).max(axis=1, keepdims=True)
    matrix = rows / sizes
    right = np.zeros((n + 5, problem.dof))
    right[: n + 1] = problem.waypoints
    right /= sizes
    expected = BSpline(vector, np.linalg.solve(matrix, right), degree)
    # either solve is off by its condition; a derivative divides that by the shortest span
    reach = np.abs(expected.c).max(axis=0)
    digits = 1e-15 * float(np.linalg.cond(matrix))
    motion = FAMILIES[family].trajectory(problem, t)
    np.testing.assert_allclose(motion.breaks[1:-1], inner * total, rtol=1e-13)
    shortest = np.diff(vector[degree:-degree]).min()
    # inside of the spans: the jerk may jump between them
    fractions = np.linspace(0.02, 0.98, 11)
    times = (motion.breaks[:-1, None] + fractions * motion.durations[:, None]).ravel()
    for order in range(4):
        found = motion.at(times, order) * total**order
        miss = np.abs(found - expected.derivative(order)(times / motion.seconds))
        assert (miss <= digits * reach * (degree / shortest) ** order).all()


@pytest.mark.parametrize(
    ("family", "n"),
    [(f, n) for f in NAMES for n in (1, 2, 3, 4, 7) if FAMILIES[f].refusal(n) is None],
)
def test_symbols_are_the_compiled_formula_pattern_by_pattern(family: str, n: int) -> None:
    chosen = FAMILIES[family]
    rng = np.random.default_rng(n)
    problem = Problem.of(rng.normal(size=(n + 1, 2)), Limits.of(1.0, dof=2), family=family)
    rows = np.exp(rng.uniform(-2.0, 2.0, (200, n)))
    by_pattern: dict[tuple[int, ...], list[Array]] = {}
    for row in rows:
        by_pattern.setdefault(chosen.pattern(row), []).append(row)
    if family not in B_SPLINES:
        assert list(by_pattern) == [()]
    elif n > 2:
        assert len(by_pattern) > 1
    for same in sorted(by_pattern.values(), key=len)[-4:]:
        t = casadi.SX.sym("t", n)
        lengths, joints = chosen.symbols(problem.waypoints, [t[k] for k in range(n)], same[-1])
        numbers = [*lengths, *(value for joint in joints for piece in joint for value in piece)]
        function = casadi.Function("spline", [t], [casadi.vertcat(*numbers)])
        for row in same[:3]:  # all of a pattern share its symbols
            values = np.asarray(function(row)).ravel()
            expected_lengths, expected = pieces(problem, row)
            m = len(expected_lengths)
            np.testing.assert_allclose(values[:m], expected_lengths, rtol=1e-12)
            np.testing.assert_allclose(
                values[m:].reshape(problem.dof, m, 6),
                np.moveaxis(expected, 1, 0),
                rtol=1e-9,
                atol=1e-11 * np.abs(expected).max(),
            )


# --- laws that hold for every problem and all durations -------------------------------------------


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
@settings(max_examples=150)
def test_splines_interpolate_are_c2_and_rest_at_both_ends(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family))
    lengths, c = pieces(problem, t)
    degrees = degrees_of(family, problem.n_segments)
    assert FAMILIES[family].degrees(problem.n_segments) == degrees
    assert len(c) == len(lengths) == len(degrees)
    for k, degree in enumerate(degrees):
        assert not c[k, :, degree + 1 :].any()
    if family in B_SPLINES:
        assert lengths.sum() == pytest.approx(t.sum(), rel=1e-14)
    else:
        np.testing.assert_array_equal(lengths, t)
    # the waypoints: breakpoints or, of B-splines, inside of the pieces
    passed = np.concatenate([[0.0], np.cumsum(t)])
    breaks = np.concatenate([[0.0], np.cumsum(lengths)])
    piece = np.searchsorted(breaks[1:-1], passed, side="right")
    if family not in B_SPLINES:
        piece = np.append(np.arange(len(t)), len(t) - 1)
        ends = c.sum(axis=-1)
        assert (np.abs(ends - problem.waypoints[1:]) <= 1e-13 * rounding(c)).all()
    s = (passed - breaks[piece]) / lengths[piece]
    found = np.stack([at(c[k], place)[:, 0] for k, place in zip(piece, s, strict=True)])
    # a spline through many knots passes each to within the rounding of its largest excursion
    size = rounding(c).max(axis=0) if family in B_SPLINES else rounding(c)[piece]
    assert (np.abs(found - problem.waypoints) <= 1e-13 * size).all()
    # coefficients are differences of terms as large as the piece's way, however small they come out
    way = rounding(c[..., 1:])
    for order in range(3):
        d = derivative(c, order)
        unit = lengths[:, None] ** order
        starts, ends = d[..., 0] / unit, d.sum(axis=-1) / unit
        # both sides carry the rounding of the whole chain of pieces
        allowed = 1e-13 * np.maximum(rounding(d), way) / unit
        whole = allowed.max(axis=0)
        assert (np.abs(ends[:-1] - starts[1:]) <= whole).all()
        if order > 0:
            assert (np.abs(starts[0]) <= whole).all()
            assert (np.abs(ends[-1]) <= whole).all()


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
def test_the_trajectory_is_the_same_spline_in_seconds(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family, -2.0, 2.0))
    lengths, c = pieces(problem, t)
    motion = FAMILIES[family].trajectory(problem, t)
    assert motion.seconds == pytest.approx(t.sum(), rel=1e-14)
    np.testing.assert_allclose(motion.passage_times, np.append(0.0, np.cumsum(t)), rtol=1e-14)
    assert motion.passage_times[-1] == motion.seconds
    starts = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    for s in (0.0, 0.2, 0.7):
        for order in range(4):
            unit = lengths[:, None] ** order
            expected = at(derivative(c, order), s)[..., 0] / unit
            allowed = 1e-11 * (rounding(derivative(c, order)) / unit + 1e-30)
            # reading at a time rounds it: one derivative more per rounding of the clock
            next_one = rounding(derivative(c, order + 1)) / (unit * lengths[:, None])
            allowed += 1e-13 * t.sum() * next_one
            found = motion.at(starts + (s + 1e-13) * lengths, order)
            assert (np.abs(found - expected) <= allowed).all()


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data(), factor=powers_of_ten(-3.0, 3.0))
def test_scaling_durations_divides_peaks_by_powers_of_the_factor(
    family: str, data: st.DataObject, factor: float
) -> None:
    problem, t = data.draw(candidates(family))
    peaks = FAMILIES[family].peaks(problem, np.stack([t, t * factor]))
    for order in (1, 2, 3):
        np.testing.assert_allclose(
            peaks[1, :, order - 1] * factor**order, peaks[0, :, order - 1], rtol=1e-9, atol=0.0
        )


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
def test_the_reversed_problem_has_the_mirrored_motion(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family, -1.5, 1.5, reach=(-3.0, 2.0)))
    mirror = Problem.of(problem.waypoints[::-1], problem.limits, family=family)
    there = FAMILIES[family].coefficients(problem, t[None])[0]
    back = FAMILIES[family].coefficients(mirror, t[None, ::-1])[0]
    s = np.linspace(0.0, 1.0, 101)
    for order in range(4):
        first, second = derivative(there, order), derivative(back, order)[::-1]
        np.testing.assert_allclose(
            at(first, s),
            (-1.0) ** order * at(second, 1.0 - s),
            rtol=0.0,
            atol=1e-11 * max(rounding(first).max(), 1e-300),
        )
    assert FAMILIES[family].stretch(mirror, t[None, ::-1])[0] == pytest.approx(
        FAMILIES[family].stretch(problem, t[None])[0], rel=1e-9
    )


@pytest.mark.parametrize("family", NAMES)
@pytest.mark.parametrize("tiny", [1e-3, 1e-6, 1e-9])
def test_a_vanishing_segment_is_as_exact_at_the_end_as_at_the_start(family: str, tiny: float) -> None:
    """Equal waypoints at an end pull their segment to nothing: no digits may go with it."""
    points = np.array([[0.0, 1.0], [1.0, 0.5], [1.5, 2.0], [1.5, 2.0]])
    t = np.array([[2.0, 3.0, tiny]])
    limits = Limits.of(1.0, 2.0, 5.0, dof=2)
    there, back = (Problem.of(x, limits, family=family) for x in (points, points[::-1]))
    chosen = FAMILIES[family]
    np.testing.assert_allclose(chosen.peaks(there, t), chosen.peaks(back, t[:, ::-1]), rtol=1e-9)
    assert check(there, chosen.trajectory(there, t[0] * chosen.stretch(there, t))).feasible


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
def test_the_sign_of_a_joint_does_not_matter(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family))
    flipped = Problem.of(-problem.waypoints, problem.limits, family=family)
    one, other = (FAMILIES[family].coefficients(p, t[None]) for p in (problem, flipped))
    np.testing.assert_array_equal(one, -other)
    np.testing.assert_array_equal(
        FAMILIES[family].peaks(problem, t[None]), FAMILIES[family].peaks(flipped, t[None])
    )
    assert FAMILIES[family].stretch(problem, t[None]) == FAMILIES[family].stretch(flipped, t[None])


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
@settings(max_examples=40)
def test_peaks_and_stretch_agree_with_dense_samples(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family))
    chosen = FAMILIES[family]
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
        assert chosen.stretch(problem, again[None])[0] == pytest.approx(1.0, rel=1e-11)
        for order in (1, 2, 3):
            lengths, c = pieces(problem, again)
            sampled = np.abs(dense(c, lengths, order))
            assert (sampled.max(axis=(0, 2)) <= limits[order - 1] * (1.0 + 1e-11)).all()


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
    assert excess[0] > 0.01  # it overshoots above
    assert excess[1] < 1e-14  # and not below, but for rounding
    assert excess[2] == 0.0
    assert excess[3] == excess[0]


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
        assert motion.at(time, 1)[0] == pytest.approx(speed[family] * d, rel=1e-12)


# --- joints and waypoints that do not move --------------------------------------------------------


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
def test_a_joint_that_never_moves_stays_put_and_costs_nothing(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family, max_dof=2))
    still = data.draw(st.floats(-3.0, 3.0))
    wide = Problem.of(
        np.column_stack([problem.waypoints, np.full(problem.n_segments + 1, still)]),
        Limits(
            *(np.append(row, 1e-6) for row in problem.limits.derivatives),
            np.vstack([problem.limits.position, [-np.inf, np.inf]]),
        ),
        family=family,
    )
    chosen = FAMILIES[family]
    c = chosen.coefficients(wide, t[None])[0, :, -1]
    assert (c[:, 0] == still).all()
    assert not c[:, 1:].any()
    assert not chosen.peaks(wide, t[None])[0, -1].any()
    assert chosen.stretch(wide, t[None])[0] == pytest.approx(
        chosen.stretch(problem, t[None])[0], rel=1e-13
    )


@pytest.mark.parametrize("family", NAMES)
def test_nothing_that_moves_needs_no_time(family: str) -> None:
    problem = Problem.of(np.full((4, 2), 0.3), Limits.of(1.0, 1.0, 1.0, dof=2), family=family)
    assert FAMILIES[family].stretch(problem, np.array([[1.0, 2.0, 3.0], [1e-9, 1e9, 1.0]])).max() == 0.0


# --- misuse ---------------------------------------------------------------------------------------


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
