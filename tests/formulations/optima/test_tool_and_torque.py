"""Limits on tool and motors at once: the motion keeps both, in one program."""

from __future__ import annotations

import numpy as np
import pytest
from small_arms import VERTICAL, pendulum, two_links
from tool_problems import planar

from formulations import Conditions, Limits, Problem, check, free_form, plan
from formulations.problem.torque import TorqueLimits

pytest.importorskip("pinocchio", reason="pin is not installed (extra dynamics)")
pytest.importorskip("yourdfpy", reason="yourdfpy is not installed (extra robot)")

INERTIA = 0.1 + 2.0 * 0.5**2  # of the pendulum about its hinge [kg m^2]
POINTS = [[0.0], [0.5], [1.2]]


def test_a_hinge_has_a_velocity_and_an_acceleration_limit() -> None:
    """Tool at a lever of 0.5 m, vertical axis: |q'| <= s / 0.5 m, |q''| <= tau / I."""
    asked = Conditions(
        tool_speed=0.4, torque=TorqueLimits(pendulum(VERTICAL), ("hinge",), (2.0 * INERTIA,))
    )
    loose = Limits.of(velocity=3.0, acceleration=50.0, jerk=60.0, dof=1)
    problem = Problem(POINTS, loose, names=["hinge"], tool=planar([0.5]), conditions=asked)
    tight = Limits.of(velocity=0.8, acceleration=2.0, jerk=60.0, dof=1)
    exact = free_form(Problem(POINTS, tight), tolerance=1e-6).seconds
    found = free_form(problem)
    assert exact * (1.0 - 1e-5) <= found.seconds <= exact * 1.004
    assert found.verdict is not None
    assert found.verdict.feasible
    used = {peak.quantity: peak.factor for peak in found.verdict.peaks}
    assert used["tool speed"] == pytest.approx(1.0, abs=2e-3)
    assert used["torque"] == pytest.approx(1.0, abs=2e-3)


def arm(speed: float | None, share: float | None, **others: object) -> Problem:
    """Two links in a vertical plane."""
    torque = TorqueLimits(two_links(), ("one", "two"))
    limits = Limits.of(velocity=3.0, acceleration=20.0, jerk=200.0, dof=2)
    asked = Conditions(
        tool_speed=speed,
        torque=None if share is None else torque.scaled(share, np.array([33.0, 11.0])),
        **others,  # type: ignore[arg-type]
    )
    points = [[-1.2, 0.3], [-0.4, 1.0], [0.3, -0.5]]
    return Problem(points, limits, names=["one", "two"], tool=planar([0.6, 0.5]), conditions=asked)


@pytest.mark.long  # searches and proofs
def test_both_limits_take_no_less_than_either_and_less_than_slowing_down() -> None:
    both, tool, motors = (plan(arm(*asked)) for asked in ((1.5, 0.9), (1.5, None), (None, 0.9)))
    assert both.verdict is not None
    assert both.verdict.feasible
    assert check(arm(1.5, None), both.trajectory).feasible
    assert check(arm(None, 0.9), both.trajectory).feasible
    assert both.seconds >= max(tool.seconds, motors.seconds) * (1.0 - 3e-3)
    assert not check(arm(1.5, 0.9), tool.trajectory).feasible  # each limit acts
    assert not check(arm(1.5, 0.9), motors.trajectory).feasible
    slowed = next(
        s for s in both.found.stages if s.name.startswith("without limits on tool and torques")
    )
    assert both.seconds < 0.97 * slowed.seconds
    assert both.bound is not None
    assert both.bound <= both.seconds


def test_a_ball_of_the_tool_and_a_slow_segment_are_kept_beside_torques() -> None:
    problem = arm(2.0, 0.9, tool_zones={1: 0.01}, segment_tool_speed={1: 0.7})
    found = free_form(problem)
    assert found.verdict is not None
    assert found.verdict.feasible, found.verdict
    assert found.trajectory is not None
    assert found.method.startswith("program")
    assert problem.tool is not None
    points = np.stack([found.trajectory.at(found.trajectory.passage_times[1]), problem.waypoints[1]])
    passed, wanted = problem.tool.forward(points)[:, :3, 3]
    assert 1e-4 < np.linalg.norm(passed - wanted) <= 0.01 * (1.0 + 1e-9)
