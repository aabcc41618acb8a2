"""The models of the checker hold the true values, which are computed in rational numbers."""

from __future__ import annotations

from fractions import Fraction as Q
from itertools import combinations_with_replacement
from math import prod
from typing import Any

import numpy as np
import pytest
from exact_splines import control_points, derivative, function, knots
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.interpolate import BSpline

from compare.check_certificate.families.b_spline.conditions import (
    SplineLimits,
    SumRows,
    Sums,
    least_of,
    sums_of,
)
from compare.check_certificate.families.b_spline.interpolation import collocation, interpolation
from compare.check_certificate.families.b_spline.knots import Forms, TimeBoxes, basis, boxes_of
from compare.check_certificate.families.b_spline.taylor import (
    monomials,
    raised,
    sum_of_products,
)

SHAPES = st.sampled_from([(2, 3), (3, 3), (4, 3), (2, 5), (3, 5), (4, 5), (6, 5)])


def box(rng: np.random.Generator, n: int, width: float) -> tuple[Any, Any]:
    steps = rng.uniform(0.3, 1.5, n)
    t = np.concatenate([[0.0], np.cumsum(steps)])
    half = width * rng.uniform(0.0, 1.0, n + 1) * (rng.random(n + 1) < 0.9)
    half[0] = half[-1] = 0.0
    return (t - half)[:, None], (t + half)[:, None]


def point_in(rng: np.random.Generator, lo: Any, hi: Any) -> list[Q]:
    """Often at an end, where the terms of fourth order are largest."""
    share = np.where(rng.random(len(lo)) < 0.6, rng.integers(0, 2, len(lo)), rng.random(len(lo)))
    return [Q(a) + Q(s) * (Q(b) - Q(a)) for a, b, s in zip(lo[:, 0], hi[:, 0], share, strict=True)]


def powers(boxes: Any, t: list[Q]) -> list[Q]:
    """The monomials at a point of the first box."""
    inner = range(1, len(t) - 1)
    e = [(t[i] - Q(boxes.c[i, 0])) / Q(boxes.h[i, 0]) if boxes.h[i, 0] > 0.0 else Q(0) for i in inner]
    assert all(abs(x) <= 1 for x in e)
    sets = (combinations_with_replacement(range(len(e)), order) for order in range(4))
    return [prod((e[q] for q in s), start=Q(1)) for some in sets for s in some]


def value(terms: Any, at: list[Q]) -> Q:
    return sum((Q(x) * y for x, y in zip(terms.tolist(), at, strict=True)), Q(0))


@settings(max_examples=60, deadline=None)
@given(SHAPES, st.integers(0, 10**6), st.sampled_from([1e-6, 1e-3, 0.02, 0.08]))
def test_the_true_basis_functions_lie_in_their_models(shape: Any, seed: int, width: float) -> None:
    (n, degree), rng = shape, np.random.default_rng(seed)
    forms, (lo, hi) = Forms(n, degree), box(rng, n, width)
    boxes = boxes_of(lo, hi)
    span, order = int(rng.integers(forms.spans)), int(rng.integers(4))
    place = float(rng.choice([0.0, 1.0, rng.random()]))
    form = forms.knots[span] + place * (forms.knots[span + 1] - forms.knots[span])
    point = (form[:, None] * boxes.c).sum(axis=0), form[1:n, None] * boxes.h[1:n]
    terms, rest, fit = basis(forms, boxes, np.array([span]), order, point)
    if not fit[0]:
        return
    for _ in range(3):
        t = point_in(rng, lo, hi)
        u, at, k = knots(t, degree), powers(boxes, t), span + degree
        x = u[k] + Q(place) * (u[k + 1] - u[k])
        for j in range(degree + 1):
            true = function(u, span + j, degree, k, x, order)
            assert abs(value(terms[:, j, 0], at) - true) <= Q(rest[j, 0])


@settings(max_examples=40, deadline=None)
@given(SHAPES, st.integers(0, 10**6), st.sampled_from([1e-6, 1e-3, 0.02, 0.08]))
def test_the_true_sum_lies_above_its_bound(shape: Any, seed: int, width: float) -> None:
    (n, degree), rng = shape, np.random.default_rng(seed)
    forms, (lo, hi) = Forms(n, degree), box(rng, n, width)
    x, level = rng.normal(size=(n + 1, 2)), rng.uniform(0.5, 2.0, (4, 2, 2))
    count = int(rng.integers(1, 4))
    rows = SumRows(
        np.zeros(count, int), rng.integers(0, 2, count), rng.integers(0, forms.spans, count),
        rng.integers(0, 4, count), rng.choice([-1, 1], count), rng.integers(0, 9, count) / 8,
        rng.uniform(0.1, 2.0, count),
    )  # fmt: skip
    sums = sums_of(forms, SplineLimits(x, level), lo, hi, rows)
    k = int(rng.integers(0, n))
    slab = (0.3 * lo[k] + 0.7 * hi[k], hi[k]) if k else (lo[0], hi[0])
    bound = least_of(forms.of, sums, np.array([0]), np.array([k]), *slab)[0]
    if bound == -np.inf:
        assert width > 1e-3
        return
    lo[k], hi[k] = slab
    for _ in range(3):
        t, total = point_in(rng, lo, hi), Q(0)
        exact = [control_points(t, degree, [Q(y) for y in x[:, j]]) for j in range(2)]
        for _, j, span, order, sign, place, multiplier in zip(*rows, strict=True):
            true = derivative(t, degree, exact[j], int(span), Q(place), int(order))
            true -= Q(x[0, j]) if order == 0 else 0
            total += Q(multiplier) * (int(sign) * true - Q(level[order, j, (sign + 1) // 2]))
        assert total >= Q(bound)


@settings(max_examples=100, deadline=None)
@given(st.integers(1, 4), st.integers(0, 10**6), st.booleans())
def test_no_polynomial_falls_below_its_bound(m: int, seed: int, convex: bool) -> None:
    of, rng = monomials(m), np.random.default_rng(seed)
    terms = rng.normal(size=(of.K, 1))
    for part in (of.linear, of.square, of.cube):
        terms[part] *= rng.choice([0.0, 0.1, 1.0, 3.0])
    if convex:
        terms[of.square][of.row] = np.abs(terms[of.square][of.row])
    k = int(rng.integers(0, m + 1))
    c, h = np.full((m + 2, 1), 5.0), np.full((m + 2, 1), 0.5)
    sums = Sums(terms, np.array([0.01]), np.array([True]), TimeBoxes(c, h))
    slab = np.sort(rng.uniform(4.5, 5.5, 2))
    bound = least_of(of, sums, np.array([0]), np.array([k]), slab[:1], slab[1:])[0]
    e = rng.uniform(-1.0, 1.0, (3000, m))
    e = np.where(rng.random(e.shape) < 0.3, np.sign(e), e)
    if k:
        e[:, k - 1] = 2.0 * (rng.uniform(*slab, 3000) - 5.0)
    sets = (combinations_with_replacement(range(m), order) for order in range(4))
    values = np.stack([np.prod(e[:, list(s)], axis=1) for some in sets for s in some], axis=1)
    assert bound <= (values @ terms[:, 0]).min() - 0.01 + 1e-12


def test_on_a_point_the_bound_is_the_sum() -> None:
    rng = np.random.default_rng(3)
    for n, degree in ((3, 3), (4, 5)):
        forms, (lo, hi) = Forms(n, degree), box(rng, n, 1e-9)
        x, level = rng.normal(size=(n + 1, 1)), np.ones((4, 1, 2))
        one = [np.array([v]) for v in (0, 0, 1, 2, 1)]
        sums = sums_of(
            forms, SplineLimits(x, level), lo, hi, SumRows(*one, np.array([0.5]), np.array([1.0]))
        )
        zero = np.array([0])
        bound = least_of(forms.of, sums, zero, zero, lo[0], hi[0])[0]
        t = [Q(y) for y in lo[:, 0]]
        c = control_points(t, degree, [Q(y) for y in x[:, 0]])
        true = float(derivative(t, degree, c, 1, Q(1, 2), 2)) - 1.0
        assert bound == pytest.approx(true, abs=1e-6)


def test_collocation_agrees_with_scipy() -> None:
    rng = np.random.default_rng(0)
    for n, degree in ((2, 3), (5, 3), (3, 5), (7, 5)):
        forms = Forms(n, degree)
        for _ in range(5):
            lo, hi = box(rng, n, 0.0)
            rows, rest, fit = collocation(forms, lo, hi, boxes_of(lo, hi))
            assert fit[0]
            assert rest.max() < 1e-10
            u = np.array([float(y) for y in knots([Q(y) for y in lo[:, 0]], degree)])
            expected = BSpline.design_matrix(lo[1:-1, 0], u, degree).toarray()
            assert_allclose(rows[0, :, :, 0], expected, atol=1e-13)


def test_a_waypoint_that_crosses_a_knot_has_a_model_for_both_spans() -> None:
    forms = Forms(
        7, 5
    )  # waypoints 3 and 4 lie at the knots of their own numbers if all steps are equal
    t = np.arange(8.0)[:, None]
    half = np.full((8, 1), 0.02)
    half[0] = half[-1] = 0.0
    lo, hi = t - half, t + half
    boxes, rng = boxes_of(lo, hi), np.random.default_rng(1)
    rows, rest, fit = collocation(forms, lo, hi, boxes)
    assert fit[0]
    for _ in range(5):
        at = point_in(rng, lo, hi)
        u, e = knots(at, 5), powers(boxes, at)
        for i in range(1, 7):
            k = max(j for j in range(5, len(u) - 6) if u[j] <= at[i])
            for f in range(12):
                true = function(u, f, 5, k, at[i]) if k - 5 <= f <= k else Q(0)
                assert abs(value(rows[0, i - 1, f], e) - true) <= Q(rest[0, i - 1, f])


def test_the_inverse_of_the_collocation_is_bounded() -> None:
    rng = np.random.default_rng(5)
    for n, degree in ((4, 3), (7, 5)):
        forms = Forms(n, degree)
        for width in (1e-3, 0.03):
            lo, hi = box(rng, n, width)
            nobody = np.zeros((1, 1), bool)
            found = interpolation(forms, lo, hi, boxes_of(lo, hi), np.zeros((n + 1, 1)), nobody)
            assert found.fit[0]
            for _ in range(20):
                t = rng.uniform(lo[:, 0], hi[:, 0])
                u = np.array([float(y) for y in knots([Q(y) for y in t], degree)])
                N = BSpline.design_matrix(t[1:-1], u, degree).toarray()[:, 3 : n + 2]
                true = np.abs(np.linalg.inv(N)).sum(axis=1)
                assert (true <= found.inverse[0] * (1.0 + 1e-12)).all()
                if width == 1e-3:
                    assert (true * 1.2 > found.inverse[0]).all()


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 4), st.integers(0, 10**6))
def test_products_of_models_hold_the_products(m: int, seed: int) -> None:
    of, rng = monomials(m), np.random.default_rng(seed)
    a, rest = rng.normal(size=(1, 2, 3, of.K)), rng.uniform(0.0, 0.1, (1, 2, 3))
    constant, motion = rng.normal(size=(1, 2, 3)), rng.normal(size=(1, 3, of.K))
    motion[..., 0] = 0.0
    terms, error = sum_of_products(of, a, rest, constant, motion)
    for _ in range(5):
        e = [Q(float(x)) for x in rng.choice([-1.0, 1.0, rng.uniform(-1, 1)], m)]
        sets = (combinations_with_replacement(range(m), order) for order in range(4))
        at = [prod((e[q] for q in s), start=Q(1)) for some in sets for s in some]
        for i in range(2):
            true = sum(
                (value(a[0, i, f], at) + Q(rng.choice([-1, 0, 1]) * rest[0, i, f]))
                * (Q(constant[0, i, f]) + value(motion[0, f], at))
                for f in range(3)
            )
            assert abs(value(terms[0, i], at) - true) <= Q(error[0, i])


def test_terms_are_raised_by_a_linear_form() -> None:
    rng = np.random.default_rng(2)
    for m in (1, 2, 5):
        of, x, e = monomials(m), rng.normal(size=(m, 1)), rng.normal(size=m)
        a = rng.normal(size=(of.K, 1))
        sets = [list(combinations_with_replacement(range(m), order)) for order in range(4)]
        of_order = [np.array([prod(e[list(s)]) for s in some]) for some in sets]
        for order, part in ((1, slice(0, 1)), (2, of.linear), (3, of.square)):
            product = (x[:, 0] @ e) * (a[part, 0] @ of_order[order - 1])
            assert raised(of, order, x, a[part])[:, 0] @ of_order[order] == pytest.approx(product)
