"""A problem made in code keeps the rules of the files; position limits and what print rounds away."""

from __future__ import annotations

import math
from typing import Any

import pytest
from problem_texts import message

from formulations import InputError, Limits, Problem, parse

DEG = math.pi / 180.0


# --- position limits and what print rounds away ---------------------------------------------------


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_waypoint_within_a_tenth_of_a_milliradian_outside_is_accepted(side: float) -> None:
    limits = Limits.of(1.0, position=[[-1.0, 1.0]], dof=1)
    problem = Problem.of([[0.0], [side * (1.0 + 0.99e-4)]], limits)
    # the limits in force are widened to the waypoint, on that side alone
    assert problem.position_bounds[0].tolist() == sorted([-side, side * (1.0 + 0.99e-4)])
    with pytest.raises(InputError, match=r"row 2, joint 1.*limits\.position"):
        Problem.of([[0.0], [side * (1.0 + 1.01e-4)]], limits)


def test_the_tolerance_of_position_limits_is_in_radians_even_in_a_file_of_degrees() -> None:
    text = 'unit = "deg"\nwaypoints = [[0], [{}]]\n[limits]\nvelocity = 1\nposition = [[-90, 90]]'
    parse(text.format(90.0 + 0.99e-4 / DEG))
    assert "joint 1" in message(text.format(90.0 + 1.01e-4 / DEG))


# --- the same rules without a file ----------------------------------------------------------------


@pytest.mark.parametrize(
    "value", [0.0, -1.0, math.nan, [1.0, math.nan], [1.0], [[1.0, 2.0]], "x", None]
)
def test_limits_made_in_code_keep_the_same_rules(value: Any) -> None:
    for name in ("velocity", "acceleration", "jerk"):
        with pytest.raises(InputError, match=rf"^limits\.{name}.*"):
            Limits.of(**{"velocity": 1.0, name: value}, dof=2)


@pytest.mark.parametrize(
    "points",
    [
        [[0.0, 1.0], [math.nan, 1.0]],
        [[0.0, 1.0], [math.inf, 1.0]],
        [[0.0, 1.0]],
        [0.0, 1.0],
        [[0.0], [1.0]],
        [[], []],
        [[0.0, 1.0], [1.0]],
        [["a", "b"], ["c", "d"]],
    ],
)
def test_waypoints_made_in_code_keep_the_same_rules(points: Any) -> None:
    with pytest.raises(InputError) as caught:
        Problem.of(points, Limits.of(1.0, dof=2))
    assert len(str(caught.value).splitlines()) == 1
