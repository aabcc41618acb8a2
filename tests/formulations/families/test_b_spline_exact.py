"""The B-spline's formula in rational arithmetic: what the compiled one loses is rounding and no more."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from conftest import Array
from spline_oracles import B_SPLINES, derivative, stretch_rounding

from formulations import FAMILIES, Limits, Problem
from formulations.families import b_spline


class Exact:
    """A rational number that takes in the floats it meets, so that a formula can run on it."""

    def __init__(self, value: Any) -> None:
        self.value: Fraction = value.value if isinstance(value, Exact) else Fraction(value)

    def __add__(self, other: Any) -> Exact:
        return Exact(self.value + Exact(other).value)

    def __sub__(self, other: Any) -> Exact:
        return Exact(self.value - Exact(other).value)

    def __rsub__(self, other: Any) -> Exact:
        return Exact(Exact(other).value - self.value)

    def __mul__(self, other: Any) -> Exact:
        return Exact(self.value * Exact(other).value)

    def __truediv__(self, other: Any) -> Exact:
        return Exact(self.value / Exact(other).value)

    def __neg__(self) -> Exact:
        return Exact(-self.value)

    __radd__, __rmul__ = __add__, __mul__


def value(c: list[Fraction], s: Fraction) -> Fraction:
    """A polynomial at a rational place."""
    total = Fraction(0)
    for x in reversed(c):
        total = total * s + x
    return total


def exact_stretch(problem: Problem, t: Array) -> float:
    """The stretch from exact coefficients; peaks at the roots of floats, where errors are squared."""
    near, symbols = [Exact(x) for x in t.tolist()], FAMILIES[problem.family].symbols
    points = np.array([[Exact(x) for x in row] for row in problem.waypoints.tolist()], dtype=object)
    lengths, joints = symbols(points, near, t)
    worst = 0.0
    for j, pieces in enumerate(joints):
        for T, piece in zip(lengths, pieces, strict=True):
            c = [Exact(x).value for x in piece]
            for order in (1, 2, 3):
                slope = derivative(np.array([float(x) for x in c]), order + 1)
                size = np.abs(slope).max()
                roots = np.roots(slope[::-1] / size) if size > 0.0 else np.empty(0)
                places = [Fraction(0), Fraction(1)]
                places += [Fraction(float(r.real)) for r in roots if 0.0 < r.real < 1.0]
                differentiated = c
                for _ in range(order):
                    differentiated = [i * x for i, x in enumerate(differentiated)][1:]
                peak = max(abs(value(differentiated, s)) for s in places) / T.value**order
                limit = Fraction(float(problem.limits.derivatives[order - 1, j]))
                worst = max(worst, float(peak / limit) ** (1.0 / order))
    return worst


@pytest.mark.parametrize("family", B_SPLINES)
@pytest.mark.parametrize("seed", range(4))
def test_the_stretch_is_the_exact_one_to_within_its_rounding(family: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    even = 10.0 ** rng.uniform(-2.0, 2.0, rng.integers(2, 6))
    for t in (np.array([100.0, 1.0, 0.01, 100.0]), even):
        steps = rng.choice([-1.0, 1.0], (len(t), 2)) * 10.0 ** rng.uniform(-6, 3, (len(t), 2))
        points = np.cumsum(np.vstack([rng.uniform(-3.0, 3.0, (1, 2)), steps]), axis=0)
        limits = Limits.of(*10.0 ** rng.uniform(-1.0, 1.0, (3, 2)), dof=2)
        problem = Problem.of(points, limits, family=family)
        found = float(FAMILIES[family].stretch(problem, t[None])[0])
        exact = exact_stretch(problem, t)
        assert abs(found / exact - 1.0) <= stretch_rounding(problem, t)
        # where the equations are well conditioned the bound is no excuse
        assert stretch_rounding(problem, np.ones(len(t))) < 1e-11


def test_the_formula_on_exact_numbers_passes_the_waypoints_exactly() -> None:
    """Rational waypoints and durations: the spline is a rational one, and it interpolates."""
    t = np.array([1.0, 0.25, 4.0])
    points = [0.0, 1.0, -2.0, 5.0]
    symbols = FAMILIES["b-spline-5"].symbols
    column = np.array([[Exact(x)] for x in points], dtype=object)
    lengths, (pieces,) = symbols(column, [Exact(x) for x in t.tolist()], t)
    assert sum((T.value for T in lengths), Fraction(0)) == Fraction(21, 4)
    assert Exact(pieces[0][0]).value == 0
    assert value([Exact(x).value for x in pieces[-1]], Fraction(1)) == 5
    spans = b_spline._spans(t, 5)
    starts = [sum((T.value for T in lengths[:k]), Fraction(0)) for k in range(len(lengths))]
    for i, time in ((1, Fraction(1)), (2, Fraction(5, 4))):
        k = spans[i]
        s = (time - starts[k]) / lengths[k].value
        assert value([Exact(x).value for x in pieces[k]], s) == points[i]
