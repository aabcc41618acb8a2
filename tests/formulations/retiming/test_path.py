"""A choice of points and the distance from a path, against loops and closed forms."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import InputError, Trajectory
from formulations.motion.files.motion_points import MotionPoints
from formulations.retiming.path import Path


def from_segment(point: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    """Distance of a point from a segment."""
    share = float(np.dot(point - a, b - a) / np.dot(b - a, b - a))
    return float(np.linalg.norm(point - a - min(max(share, 0.0), 1.0) * (b - a)))


@given(seed=st.integers(0, 10**6), count=st.integers(3, 60), tolerance=st.floats(1e-3, 0.5))
@settings(max_examples=60, deadline=None)
def test_every_point_lies_within_the_tolerance_of_its_chord(
    seed: int, count: int, tolerance: float
) -> None:
    points = np.cumsum(np.random.default_rng(seed).normal(size=(count, 3)) * 0.1, axis=0)
    chosen = Path(points).simplified(tolerance)
    assert chosen[0] == 0
    assert chosen[-1] == count - 1
    for first, last in pairwise(chosen):
        for k in range(first + 1, last):
            assert from_segment(points[k], points[first], points[last]) <= tolerance * (1.0 + 1e-12)


def test_a_straight_line_needs_its_ends_alone() -> None:
    points = np.linspace(0.0, 1.0, 50)[:, None] * np.array([1.0, -2.0, 0.5])
    assert Path(points).simplified(1e-9) == [0, 49]


def test_a_parabola_is_farthest_from_its_chord_where_it_runs_alongside() -> None:
    # (t, t - t^2) beside the chord from (0, 0) to (1, 0): 1/4 at t = 1/2
    coefficients = np.array([[[0.0, 1.0, 0.0], [0.0, 1.0, -1.0]]])
    motion = Trajectory(np.array([1.0]), coefficients)
    chord = Path(np.array([[0.0, 0.0], [1.0, 0.0]]))
    time, distance = chord.farthest(motion)
    assert time == pytest.approx(0.5, abs=1e-6)
    assert distance == pytest.approx(0.25, abs=1e-12)
    # in a part of it, at its end
    assert chord.farthest(motion, 0.0, 0.3) == (pytest.approx(0.3), pytest.approx(0.21))


def test_a_point_that_the_motion_cuts_off_is_left_out() -> None:
    line = Trajectory(np.array([1.0]), np.array([[[0.0, 1.0], [0.0, 0.0]]]))
    path = Path(np.array([[0.0, 0.0], [0.5, 0.2], [1.0, 0.0]]))
    assert path.left_out(line) == pytest.approx(0.2)


def test_the_path_of_points_with_velocities_is_what_a_controller_makes_of_them() -> None:
    # a cubic from 0 to 1 and a joint that swings out between two points at 0
    points = MotionPoints(
        np.array([0.0, 1.0]), np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([[1.0, 4.0], [1.0, -4.0]])
    )
    assert Path.of(points).points[:, 1].max() == pytest.approx(1.0)
    still = MotionPoints(np.array([0.0, 1.0]), np.ones((2, 2)))
    with pytest.raises(InputError, match="no joint moves"):
        Path.of(still)
    repeated = np.array([[0.0], [0.0], [0.5], [0.5], [1.0]])
    assert Path.of(repeated).points.ravel().tolist() == [0.0, 0.5, 1.0]


def test_a_path_of_many_points_is_measured_as_one_of_few() -> None:
    rng = np.random.default_rng(3)
    u = np.sort(rng.uniform(0.0, 1.0, 400))
    points = np.stack([np.sin(3.0 * u), np.cos(5.0 * u), u], axis=1)
    points[200:] += 0.7  # a long straight line between two dense parts
    away = rng.uniform(-1.0, 2.0, (40, 3))
    for scale in (1.0, 1e-3):
        places = points[rng.integers(0, 400, 40)] + scale * away
        # each place as a motion that stands there
        for place in places:
            still = Trajectory(np.array([1.0]), np.stack([place, 1e-12 * place], axis=1)[None])
            expected = min(
                from_segment(place, a, b) for a, b in pairwise(points) if np.linalg.norm(b - a) > 0.0
            )
            assert Path(points).farthest(still)[1] == pytest.approx(
                expected, abs=1e-3 * expected + 1e-9
            )
