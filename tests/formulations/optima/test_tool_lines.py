"""The start of the search on the tool's straight lines."""

from __future__ import annotations

import numpy as np
import pytest
from tool_problems import planar, two_links

from formulations import Conditions, Problem
from formulations.optima.shared_steps.lines import along_lines
from formulations.problem.demands import Demands

LIMITS = {"velocity": 2.0, "acceleration": 5.0, "jerk": 40.0}
THREE = planar([0.5, 0.4, 0.3])


def off_the_line(points: np.ndarray) -> float:
    """The largest distance of points (n, 3) from the line between the first and the last one."""
    way = points[-1] - points[0]
    along = (points - points[0]) @ way / (way @ way)
    return float(
        np.linalg.norm(points - points[0] - np.clip(along, 0.0, 1.0)[:, None] * way, axis=1).max()
    )


def test_the_tool_of_three_links_stays_on_its_lines() -> None:
    points = [[0.2, 0.9, 0.5], [0.6, 0.5, 1.2], [0.1, 1.2, 0.3]]
    problem = Problem(points, LIMITS, tool=THREE, conditions=Conditions(tool_speed=0.2))
    found = along_lines(Demands.of(problem), 50)
    np.testing.assert_array_equal(found.states[0, ::50], problem.waypoints)
    passed = THREE.forward(found.states[0])[:, :3, 3]
    straight = np.linspace(problem.waypoints[:-1], problem.waypoints[1:], 51)
    for k in range(2):
        mine = passed[50 * k : 50 * (k + 1) + 1]
        assert off_the_line(mine) < 2e-4  # between the steps of the line, it is interpolated
        assert off_the_line(THREE.forward(straight[:, k])[:, :3, 3]) > 1e-2
        # and as slow as asked for
        speeds = (
            np.linalg.norm(np.diff(mine, axis=0), axis=1)
            / found.durations.ravel()[50 * k : 50 * (k + 1)]
        )
        assert speeds.max() <= 0.2


def test_where_the_joints_get_stuck_they_go_straight() -> None:
    """Two links that bend to the other side have to be stretched in between: no line does that."""
    problem = Problem(
        [[0.0, 1.0], [1.0, -1.0]],
        LIMITS,
        tool=planar([0.5, 0.4]),
        conditions=Conditions(tool_speed=0.2),
    )
    found = along_lines(Demands.of(problem), 8)
    way = problem.waypoints[1] - problem.waypoints[0]
    shares = (found.states[0] - problem.waypoints[0]) / way
    np.testing.assert_allclose(shares[:, 0], shares[:, 1], atol=1e-9)
    assert np.isfinite(found.states).all()


@pytest.mark.parametrize("segment", [0, 1])
def test_a_segment_without_a_limit_is_as_fast_as_the_joints(segment: int) -> None:
    problem = two_links(Conditions(segment_tool_speed={segment: 0.05}))
    found = along_lines(Demands.of(problem), 8)
    times = found.durations.sum(axis=1)
    assert np.isfinite(times).all()
    assert times[segment] > times[1 - segment]
