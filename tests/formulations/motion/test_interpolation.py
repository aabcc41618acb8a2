"""Points of a file joined as a controller joins them, against SciPy's interpolants and exact motions."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from conftest import Array
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BPoly

from formulations import InputError, Trajectory
from formulations.motion.interpolation import joined


def points(seed: int, count: int, dof: int) -> tuple[Array, Array, Array, Array]:
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.01, 1.0, count))
    p, v, a = rng.normal(size=(3, count, dof))
    return times, p, v, a


@given(seed=st.integers(0, 10**6), count=st.integers(2, 6), dof=st.integers(1, 3))
@settings(max_examples=50)
def test_pieces_are_the_hermite_interpolants_of_what_the_points_state(
    seed: int, count: int, dof: int
) -> None:
    times, p, v, a = points(seed, count, dof)
    stated = {"linear": [p], "cubic": [p, v], "quintic": [p, v, a]}
    inside = np.concatenate([np.linspace(s, e, 9) for s, e in itertools.pairwise(times)])
    for name, values in stated.items():
        oracle = BPoly.from_derivatives(times, np.stack(values, axis=1))
        for how in (name, "auto"):
            mine = joined(times, *values, interpolation=how)
            assert np.allclose(mine.at(inside - times[0]), oracle(inside), rtol=1e-9, atol=1e-9)
    # a lower degree may be asked for
    assert joined(times, p, v, a, interpolation="linear").coefficients.shape[-1] == 2


def test_points_of_a_quintic_give_the_quintic_back() -> None:
    rng = np.random.default_rng(3)
    whole = Trajectory(np.array([2.0]), rng.normal(size=(1, 2, 6)))
    times = np.array([0.0, 0.3, 1.1, 2.0])
    mine = joined(times, *(whole.at(times, order) for order in range(3)))
    dense = np.linspace(0.0, 2.0, 101)
    for order in range(4):
        assert np.allclose(mine.at(dense, order), whole.at(dense, order), rtol=1e-9, atol=1e-9)


def test_microseconds_apart_keep_their_digits() -> None:
    """The error of the jerk is that of the positions over h^3, not more."""
    h = 1e-4
    times = 3.0 + np.arange(11) * h
    jerk = 7000.0
    p, v, a = jerk * times**3 / 6.0, jerk * times**2 / 2.0, jerk * times
    mine = joined(times, p[:, None], v[:, None], a[:, None])
    error = np.abs(mine.extremes(3).high - jerk).max()
    assert error <= 60.0 * 4.0 * np.finfo(float).eps * p.max() / h**3


def test_what_the_points_do_not_state_is_refused_by_name() -> None:
    times, p, v, a = points(1, 3, 2)
    with pytest.raises(InputError, match="quintic needs accelerations"):
        joined(times, p, v, interpolation="quintic")
    with pytest.raises(InputError, match="cubic needs velocities"):
        joined(times, p, interpolation="cubic")
    with pytest.raises(InputError, match="'spline' is not one of auto, linear, cubic, quintic"):
        joined(times, p, interpolation="spline")
    with pytest.raises(InputError, match="accelerations without velocities"):
        joined(times, p, None, a)
