"""A trajectory: what it refuses, stretching and sampling."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from conftest import Array, durations, powers_of_ten
from hypothesis import given
from hypothesis import strategies as st
from planted_motions import (
    TIMES,
    WAYPOINTS,
    problem_of,
    rest_to_rest,
    spline,
)

from formulations import FAMILIES, InputError, Trajectory, check


def test_wrong_shapes_and_durations_are_refused() -> None:
    c = np.zeros((2, 1, 4))
    for times in ([1.0], [1.0, 0.0], [1.0, -1.0], [1.0, np.nan], [1.0, np.inf]):
        with pytest.raises(InputError, match="trajectory"):
            Trajectory(np.array(times), c)
    with pytest.raises(InputError, match="trajectory"):
        Trajectory(np.array([1.0, 1.0]), np.zeros((2, 4)))
    with pytest.raises(InputError, match="1 joints, the problem has 2"):
        check(problem_of(), Trajectory(np.array([1.0, 1.0]), c))


# --- stretching and sampling ----------------------------------------------------------------------


@given(times=durations(3, -1.0, 1.0), factor=powers_of_ten(-2.0, 2.0), passages=st.booleans())
def test_a_stretched_motion_is_the_same_path_at_another_pace(
    times: Array, factor: float, passages: bool
) -> None:
    motion = FAMILIES["3-5-3"].trajectory(problem_of(), times)
    if passages:
        motion = replace(motion, passages=motion.breaks[[0, 3]])
    slow = motion.stretched(factor)
    assert slow.seconds == pytest.approx(motion.seconds * factor, rel=1e-14)
    np.testing.assert_allclose(slow.passage_times, motion.passage_times * factor, rtol=1e-14)
    for order in range(4):
        for end in ("low", "high"):
            np.testing.assert_allclose(
                getattr(slow.extremes(order), end) * factor**order,
                getattr(motion.extremes(order), end),
                rtol=1e-10,
                atol=1e-12 * (1.0 + motion.extremes(order).high.max()),
            )
    t = np.linspace(0.0, motion.seconds, 57)
    np.testing.assert_allclose(slow.at(t * factor), motion.at(t), rtol=0.0, atol=1e-9)
    twice = slow.stretched(3.0)
    once = motion.stretched(3.0 * factor)
    np.testing.assert_allclose(twice.coefficients, once.coefficients, rtol=1e-12)
    np.testing.assert_allclose(twice.durations, once.durations, rtol=1e-14)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("factor", [0.0, -1.0, np.nan, np.inf])
def test_a_stretch_that_is_no_stretch_is_refused(factor: float) -> None:
    with pytest.raises(InputError):
        spline().stretched(factor)


@given(times=durations(3, -1.0, 0.5), rate=powers_of_ten(0.0, 3.0))
def test_samples_start_at_the_start_rise_and_end_at_the_end(times: Array, rate: float) -> None:
    motion = FAMILIES["3-5-3"].trajectory(problem_of(), times)
    t, values = motion.sample(rate)
    assert t[0] == 0.0
    assert t[-1] == motion.seconds
    assert (np.diff(t) > 0.0).all()
    assert np.diff(t).max() <= 1.0 / rate * (1.0 + 1e-9)
    assert values.shape == (4, len(t), 2)
    np.testing.assert_allclose(values[0, 0], WAYPOINTS[0], atol=1e-12)
    np.testing.assert_allclose(values[0, -1], WAYPOINTS[-1], atol=1e-12)
    for order in range(4):
        np.testing.assert_array_equal(values[order], motion.at(t, order))


def test_sampled_derivatives_are_those_of_the_samples() -> None:
    t, values = spline().sample(1e4)
    for order in range(3):
        slope = np.diff(values[order], axis=0) / np.diff(t)[:, None]
        middle = 0.5 * (values[order + 1, 1:] + values[order + 1, :-1])
        inner = slice(10, -10)
        away = np.abs(t[1:, None] - np.cumsum(TIMES)).min(axis=1)[inner] > 1e-3  # jerk jumps at knots
        assert np.abs(slope - middle)[inner][away].max() < 1e-3 * np.abs(values[order + 1]).max()


@pytest.mark.parametrize(
    ("seconds", "rate"), [(59.0 / 7.0, 7.0), (118.0 / 7.0, 7.0), (125.0 / 7.0, 7.0)]
)
def test_sample_times_never_repeat_where_the_end_is_a_multiple_of_the_step(
    seconds: float, rate: float
) -> None:
    motion = rest_to_rest(np.array([[0.0], [1.0]]), np.array([seconds]))
    t, _ = motion.sample(rate)
    assert t[-1] == seconds
    assert (np.diff(t) > 1e-9).all()


@pytest.mark.parametrize("rate", [0.0, -1.0, np.nan])
def test_a_rate_that_is_no_rate_is_refused(rate: float) -> None:
    with pytest.raises(InputError):
        spline().sample(rate)


def test_what_a_motion_reaches_is_its_largest_size_however_it_lies_in_memory() -> None:
    rng = np.random.default_rng(5)
    c = rng.normal(size=(40, 3, 6))
    rows = np.moveaxis(np.ascontiguousarray(np.moveaxis(c, -1, 0)), 0, -1)
    lengths = rng.uniform(0.1, 2.0, 40)
    motion, same = Trajectory(lengths, c), Trajectory(lengths, rows)
    u = np.linspace(0.0, 1.0, 4001)
    for order in range(4):
        sizes = np.zeros(3)
        for piece in range(40):
            for joint in range(3):
                values = np.polynomial.Polynomial(c[piece, joint]).deriv(order)(u * lengths[piece])
                sizes[joint] = max(sizes[joint], np.abs(values).max())
        np.testing.assert_allclose(motion.reach(order), sizes, rtol=1e-5)
        assert (motion.reach(order) >= sizes * (1.0 - 1e-12)).all()
        assert np.array_equal(motion.extremes(order).high, same.extremes(order).high)
        assert np.array_equal(motion.extremes(order).time_low, same.extremes(order).time_low)
    np.testing.assert_allclose(motion.jumps_between, same.jumps_between, rtol=1e-15)
