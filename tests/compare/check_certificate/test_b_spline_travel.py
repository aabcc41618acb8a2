"""What travel cuts off holds no motion: against motions that are made, and against a fine grid."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.check_certificate.families.b_spline.travel import Travel, _reach, _shortest, _slowest, cut

NUMBER = st.floats(0.05, 3.0)


@given(NUMBER, NUMBER, st.floats(0.0, 4.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_the_reach_is_the_integral_of_the_greatest_speed(
    V: float, A: float, T: float, a: float, b: float
) -> None:
    v0, v1 = a * V, b * V
    t = (np.arange(4000) + 0.5) / 4000 * T
    greatest = np.minimum(V, np.minimum(v0 + A * t, v1 + A * (T - t)))
    assert float(_reach(v0, v1, T, V, A)) == pytest.approx(
        greatest.mean() * T, abs=1e-5 * V * T + 1e-12
    )


def test_a_joint_at_rest_that_need_not_stop_is_not_slowed_down() -> None:
    # from rest with A = 1 for 0.45 s: it gets 0.10125 far, whatever the speed that it is allowed at the end
    assert _reach(0.0, 1.0, 0.45, 1.0, 1.0) >= 0.5 * 0.45**2


@given(NUMBER, NUMBER, st.floats(0.01, 2.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_roots_are_found_from_the_safe_side(V: float, A: float, d: float, a: float, b: float) -> None:
    v0, v1 = np.array([a * V]), np.array([b * V])
    T = _shortest(d, v0, v1, np.zeros(1), V, A)[0]
    assert _reach(v0, v1, T, V, A)[0] < d <= _reach(v0, v1, T * (1.0 + 1e-9) + 1e-9, V, A)[0] + 1e-9
    span = (np.array([0.8 * T]), np.array([1.1 * T]))
    v = _slowest(d, -np.full(1, V), v1, span, V, A)[0]
    if v > -V:
        assert max(_reach(v, v1[0], float(x[0]), V, A) for x in span) < d


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.booleans())
def test_no_motion_is_cut_off(seed: int, boundless: bool) -> None:
    """Motions of random speed at the waypoints, accelerated as their limits allow, are kept."""
    rng = np.random.default_rng(seed)
    n, joints, per = int(rng.integers(2, 5)), int(rng.integers(1, 4)), 400
    T = rng.uniform(0.3, 1.5, n)
    dt = np.repeat(T / per, per)
    v = np.cumsum(rng.normal(size=(n * per, joints)), axis=0) * np.sqrt(dt[:, None])
    smooth = np.ones(40) / 40
    v = np.stack([np.convolve(x, smooth, "same") for x in v.T], axis=1)
    s = np.linspace(0.0, 1.0, n * per)[:, None]
    v = v * np.minimum(1.0, 8.0 * np.minimum(s, 1.0 - s))
    v[0] = v[-1] = 0.0
    acceleration = np.abs(np.diff(v, axis=0) / dt[1:, None]).max(axis=0)
    at = np.concatenate(
        [np.zeros((1, joints)), np.cumsum(0.5 * (v[1:] + v[:-1]) * dt[1:, None], axis=0)]
    )
    ends = at[[0, *(per * k - 1 for k in range(1, n + 1))]]
    times = np.concatenate([[0.0], np.cumsum(dt[1:])])[[0, *(per * k - 1 for k in range(1, n + 1))]]
    d = np.diff(ends, axis=0)
    task = Travel(
        np.abs(d) * (1.0 - 1e-9), np.sign(d), np.abs(v).max(axis=0) * (1.0 + 1e-12),
        np.full(joints, np.inf) if boundless else acceleration * (1.0 + 1e-12),
    )  # fmt: skip
    wide = rng.uniform(0.0, 2.0, (2, n + 1)) * (rng.random((2, n + 1)) < 0.8)
    wide[:, [0, -1]] = 0.0
    lo = np.maximum(times - wide[0], 0.0)[:, None]
    hi = np.minimum(times + wide[1], times[-1])[:, None]
    for _ in range(3):
        assert cut(task, lo, hi)[0]
        assert (lo[:, 0] <= times * (1 + 1e-12)).all()
        assert (times <= hi[:, 0] * (1 + 1e-12)).all()


def test_one_joint_from_rest_to_rest() -> None:
    # 1 rad with V = 1, A = 2 takes 1.5 s; the second segment needs 0.5 s more at full speed to stop
    task = Travel(np.array([[1.0], [0.75]]), np.ones((2, 1)), np.array([1.0]), np.array([2.0]))
    lo, hi = np.array([[0.0], [0.0], [2.3]]), np.array([[0.0], [2.3], [2.3]])
    assert cut(task, lo, hi)[0]
    assert lo[1, 0] == pytest.approx(1.25, abs=1e-9)  # starts at rest, passes at full speed
    assert hi[1, 0] == pytest.approx(1.3, abs=1e-9)
    lo, hi = np.array([[0.0], [0.0], [2.2]]), np.array([[0.0], [2.2], [2.2]])
    assert not cut(task, lo, hi)[0]


def test_what_is_no_number_cuts_nothing() -> None:
    task = Travel(np.array([[1.0], [1.0]]), np.ones((2, 1)), np.array([np.nan]), np.array([np.nan]))
    lo, hi = np.array([[0.0], [0.5], [1.0]]), np.array([[0.0], [0.5], [1.0]])
    assert cut(task, lo, hi)[0]
