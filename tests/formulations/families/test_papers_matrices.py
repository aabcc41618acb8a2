"""Spline families against the papers' linear systems and dense solves of their conditions.

Interpolation, C2 and rest at both ends are as many equations as a spline has coefficients and they
have one solution for 3-5-3 and 4-3-4: a family that keeps them for all durations is the papers'
family. The quintic and the B-splines are pinned by dense solves of their own conditions.
"""

from __future__ import annotations

import casadi
import numpy as np
import pytest
from conftest import Array
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline
from spline_oracles import (
    B_SPLINES,
    NAMES,
    POWERS,
    at,
    b_spline_basis,
    candidates,
    derivative,
    pieces,
)

from formulations import FAMILIES, Limits, Problem, load

# --- the papers' own linear systems ---------------------------------------------------------------


def matrix_353(t1: float, t2: float, t3: float) -> Array:
    """Wang 2025, eq. 5; Zhang 2025, eq. 9; Zhou 2025, eq. 5: unknowns k13 k12 k11 k10, k25..k20, k33..k30."""
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
    """Li 2022, eq. 9, its matrix C for any number of segments: quartic, cubics, quartic, descending."""
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
    """Lu & Wang 2024, eq. 1-12: knots by running means, interpolation, and rest at both ends as equations."""
    problem, t = data.draw(candidates(family, -1.0, 1.0, reach=(-2.0, 1.0)))
    degree, n = B_SPLINES[family], problem.n_segments
    total = t.sum()
    u, basis, vector = b_spline_basis(t, degree)
    inner = vector[degree + 1 : -degree - 1]
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
