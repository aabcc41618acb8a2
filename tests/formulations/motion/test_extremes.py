"""Exact extremes: against closed forms and dense samples, whatever the polynomial."""

from __future__ import annotations

from time import process_time

import numpy as np
import pytest
from conftest import Array, durations, powers_of_ten
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from planted_motions import (
    HERMITE_PEAKS,
    THIRD,
    at,
    one_piece,
    rest_to_rest,
)

from formulations import Trajectory
from formulations.motion.interpolation import joined

# --- exact extremes: closed forms -----------------------------------------------------------------


@pytest.mark.parametrize("duration", [1e-3, 1.0, 17.0])
def test_the_rest_to_rest_quintic_has_its_textbook_extremes(duration: float) -> None:
    motion = rest_to_rest(np.array([[0.0], [2.0]]), np.array([duration]))
    velocity, acceleration, jerk = (motion.extremes(order) for order in (1, 2, 3))
    peaks = [2.0 * peak / duration**order for order, peak in enumerate(HERMITE_PEAKS, 1)]
    assert velocity.high[0, 0] == pytest.approx(peaks[0], rel=1e-14)
    assert velocity.time_high[0, 0] == pytest.approx(duration / 2.0, rel=1e-7)
    assert velocity.low[0, 0] == pytest.approx(0.0, abs=1e-14 * peaks[0])
    assert acceleration.high[0, 0] == pytest.approx(peaks[1], rel=1e-14)
    assert acceleration.low[0, 0] == pytest.approx(-peaks[1], rel=1e-13)
    assert acceleration.time_high[0, 0] == pytest.approx(duration * THIRD, rel=1e-7)
    assert acceleration.time_low[0, 0] == pytest.approx(duration * (1.0 - THIRD), rel=1e-7)
    assert jerk.high[0, 0] == pytest.approx(peaks[2], rel=1e-13)
    assert jerk.low[0, 0] == pytest.approx(-peaks[2] / 2.0, rel=1e-13)
    assert jerk.time_low[0, 0] == pytest.approx(duration / 2.0, rel=1e-7)
    position = motion.extremes(0)
    assert position.low[0, 0] == pytest.approx(0.0, abs=1e-15)
    assert position.high[0, 0] == pytest.approx(2.0, rel=1e-14)


@pytest.mark.parametrize("degree", range(1, 8))
def test_chebyshev_polynomials_swing_between_minus_one_and_one(degree: int) -> None:
    shifted = np.polynomial.Chebyshev.basis(degree, domain=[0.0, 3.0])
    c = shifted.convert(kind=np.polynomial.Polynomial, domain=[-1, 1], window=[-1, 1]).coef
    found = one_piece(*c, duration=3.0).extremes(0)
    assert found.high[0, 0] == pytest.approx(1.0, abs=1e-11)
    assert found.low[0, 0] == pytest.approx(-1.0, abs=1e-11)
    for time, value in ((found.time_high, 1.0), (found.time_low, -1.0)):
        assert shifted(time[0, 0]) == pytest.approx(value, abs=1e-11)


def test_extremes_are_told_apart_by_piece_and_joint() -> None:
    waypoints = np.array([[0.0, 0.0], [1.0, -3.0], [1.0, 5.0]])
    times = np.array([2.0, 0.5])
    found = rest_to_rest(waypoints, times).extremes(1)
    expected = 15.0 / 8.0 * np.diff(waypoints, axis=0) / times[:, None]
    np.testing.assert_allclose(found.high, np.maximum(expected, 0.0), atol=1e-14)
    np.testing.assert_allclose(found.low, np.minimum(expected, 0.0), atol=1e-14)
    assert found.time_low[0, 1] == pytest.approx(1.0)
    assert found.time_high[1, 1] == pytest.approx(2.25)


def test_derivatives_beyond_the_degree_are_zero() -> None:
    for coefficients in ((3.0,), (3.0, 2.0), (3.0, 2.0, 1.0)):
        found = one_piece(*coefficients).extremes(3)
        assert found.low[0, 0] == 0.0
        assert found.high[0, 0] == 0.0


# --- exact extremes: against dense samples, whatever the polynomial -------------------------------

COEFFICIENTS = st.one_of(
    st.floats(-10.0, 10.0),
    st.sampled_from([0.0, 1.0, -1.0, 1e-14, -1e-14, 3e-15, 1e-16, 1e-300]),
)


@st.composite
def polynomials(draw: st.DrawFn) -> Array:
    """Coefficients of degree 1 to 7: any, with leading dust, zero, or with chosen double roots."""
    kind = draw(st.sampled_from(["any", "dust", "zero", "turns"]))
    degree = draw(st.integers(1, 7))
    c = np.zeros(8)
    if kind == "turns":
        # a derivative with chosen roots, often twice the same and at the very ends
        roots = draw(st.lists(st.sampled_from([0.0, 0.25, 0.3, 0.5, 1.0, 1.5]), max_size=degree - 1))
        p = np.polynomial.Polynomial.fromroots(roots).integ() if roots else [0.0, 1.0]
        c[: len(np.atleast_1d(getattr(p, "coef", p)))] = getattr(p, "coef", p)
        return c * draw(st.sampled_from([1.0, -20.0, 1e-9]))
    if kind != "zero":
        c[: degree + 1] = draw(st.lists(COEFFICIENTS, min_size=degree + 1, max_size=degree + 1))
    if kind == "dust":
        c[degree] = draw(st.sampled_from([1e-14, -1e-14, 1e-13, -3e-15, 1e-15, 1e-16]))
    return c


@given(
    rows=st.lists(polynomials(), min_size=1, max_size=4),
    duration=powers_of_ten(-2.0, 2.0),
    order=st.integers(0, 3),
)
@settings(max_examples=300)
def test_extremes_agree_with_dense_samples(rows: list[Array], duration: float, order: int) -> None:
    c = np.array(rows)[None]
    motion = Trajectory(np.array([duration]), c / duration ** np.arange(8))
    found = motion.extremes(order)
    values = at(c[0], order) / duration**order
    size = np.abs(c[0]).sum(axis=-1) * 7.0**order / duration**order + 1e-290
    high, low = values.max(axis=-1), values.min(axis=-1)
    assert (found.high[0] >= high - 1e-14 * size).all()
    assert (found.low[0] <= low + 1e-14 * size).all()
    # samples lie within curvature * step^2 / 8 of the extremes
    assert (found.high[0] <= high + 1e-7 * size).all()
    assert (found.low[0] >= low - 1e-7 * size).all()
    # and they occur when they are said to
    for value, time in ((found.high, found.time_high), (found.low, found.time_low)):
        assert ((time >= 0.0) & (time <= duration * (1.0 + 1e-15))).all()
        for joint in range(len(rows)):
            there = motion.at(min(time[0, joint], duration), order)[joint]
            assert there == pytest.approx(value[0, joint], rel=1e-9, abs=1e-9 * size[joint])


@given(
    inside=st.lists(st.floats(0.02, 0.98), min_size=1, max_size=3),
    far=powers_of_ten(1.0, 15.0),
    sign=st.sampled_from([-1.0, 1.0]),
)
@settings(max_examples=200)
def test_turning_points_are_found_beside_a_root_that_is_far_away(
    inside: list[float], far: float, sign: float
) -> None:
    """A factor 1 - s / far leaves a leading coefficient of 1 / far: tiny, but not to be trusted."""
    gaps = np.diff(sorted(inside))
    assume(len(gaps) == 0 or gaps.min() > 0.01)
    slope = np.polynomial.Polynomial.fromroots(inside) * np.polynomial.Polynomial([1.0, -sign / far])
    p = slope.integ()
    found = one_piece(*p.coef).extremes(0)
    values = p(np.array([0.0, 1.0, *inside]))
    assert found.high[0, 0] == pytest.approx(values.max(), abs=1e-12)
    assert found.low[0, 0] == pytest.approx(values.min(), abs=1e-12)


@given(
    rows=st.lists(polynomials(), min_size=6, max_size=6),
    times=durations(3, -1.0, 1.0),
)
def test_pieces_of_unlike_degrees_do_not_disturb_each_other(rows: list[Array], times: Array) -> None:
    c = np.array(rows).reshape(3, 2, 8) / times[:, None, None] ** np.arange(8)
    together = Trajectory(times, c)
    for order in range(4):
        found = together.extremes(order)
        for piece in range(3):
            for joint in range(2):
                alone = Trajectory(times[piece : piece + 1], c[piece : piece + 1, joint : joint + 1])
                one = alone.extremes(order)
                size = float(np.abs(rows[2 * piece + joint]).sum()) * (7.0 / times[piece]) ** order
                for a, b in ((found.low, one.low), (found.high, one.high)):
                    assert a[piece, joint] == pytest.approx(b[0, 0], rel=1e-12, abs=1e-13 * size)


# --- pieces without a turning point are left out of the search for roots ---------------------------


def by_roots_of_every_piece(c: Array, order: int) -> tuple[float, float]:
    """Least and greatest value on [0, 1] of a derivative, all roots of its slope looked at."""
    p = np.polynomial.Polynomial(c).deriv(order) if order else np.polynomial.Polynomial(c)
    roots = p.deriv().roots()
    inside = roots.real[(np.abs(roots.imag) < 1e-6) & (roots.real > 0.0) & (roots.real < 1.0)]
    values = p(np.concatenate([[0.0, 1.0], inside]))
    return float(values.min()), float(values.max())


@given(seed=st.integers(0, 10**6), decay=st.floats(0.0, 3.0), order=st.integers(0, 3))
@settings(max_examples=30)
def test_pieces_that_only_rise_or_fall_have_the_same_extremes_as_ever(
    seed: int, decay: float, order: int
) -> None:
    """With a strong decay, most pieces are monotone; without, most turn."""
    c = np.random.default_rng(seed).normal(size=(10, 4, 6)) * 10.0 ** (-decay * np.arange(6))
    found = Trajectory(np.ones(10), c).extremes(order)
    for piece, joint in np.ndindex(10, 4):
        low, high = by_roots_of_every_piece(c[piece, joint], order)
        size = float(np.abs(c[piece, joint]).sum()) * 5.0**order
        assert found.low[piece, joint] == pytest.approx(low, abs=1e-12 * size)
        assert found.high[piece, joint] == pytest.approx(high, abs=1e-12 * size)


def test_a_minute_of_seven_joints_at_1_khz_is_searched_in_a_second() -> None:
    t = np.arange(60_001)[:, None] * 1e-3
    speed, phase = np.linspace(0.5, 3.0, 7), np.arange(7.0)
    swing = speed * t + phase
    motion = joined(t[:, 0], np.sin(swing), speed * np.cos(swing), -(speed**2) * np.sin(swing))
    start = process_time()
    for order in range(4):
        found = motion.extremes(order)
        if order < 3:  # the jerk of a quintic between samples is not that of the sine
            assert found.high.max(axis=0) == pytest.approx(speed**order, rel=1e-9)
    assert process_time() - start < 3.0  # eigenvalues of every piece: 4 s and more
