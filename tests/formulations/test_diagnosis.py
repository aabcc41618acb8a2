"""What holds the time up: shares that add up, and savings that are what planning again gives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from formulations import Limits, Problem, free_form, load
from formulations.diagnosis import diagnose


@pytest.fixture(scope="module")
def ur5() -> Problem:
    return load("ur5")


def test_the_holds_share_out_the_time(ur5: Problem) -> None:
    found = diagnose(ur5, free_form(ur5), top=0)
    assert not found.savings
    assert abs(found.unexplained) < 1e-3 * found.seconds
    shown = sum(hold.seconds for hold in found.holds)
    assert shown == pytest.approx(found.seconds, rel=0.02)  # the rest is in holds too short to show
    assert [h.seconds for h in found.holds] == sorted((h.seconds for h in found.holds), reverse=True)


def test_savings_are_those_of_planning_again(ur5: Problem) -> None:
    motion = free_form(ur5)
    found = diagnose(ur5, motion, top=1)
    first = found.savings[0]
    assert (first.joint, first.quantity) == (4, "velocity")
    velocity = ur5.limits.velocity.copy()
    velocity[4] *= 1.1
    raised = Limits.of(velocity, ur5.limits.acceleration, ur5.limits.jerk, dof=6)
    faster = free_form(replace(ur5, limits=raised))
    assert first.seconds == pytest.approx(motion.seconds - faster.seconds, abs=1e-9)
    assert "joint 5's velocity holds segment 2 for" in found.lines()[0]
    assert "10 % more of it would save 0.4" in found.lines()[0]


def test_one_joint_in_closed_form() -> None:
    """Rest to rest over d at acceleration A, no plateau: T = 2 sqrt(d/A), s = -dT/d log A = T/2."""
    problem = Problem.of([[0.0], [1.0]], Limits.of(100.0, 4.0, dof=1))
    found = diagnose(problem, free_form(problem, tolerance=1e-6), more=0.21)
    assert found.seconds == pytest.approx(1.0, rel=1e-6)
    assert [(h.joint, h.quantity, h.segment) for h in found.holds] == [(0, "acceleration", 0)]
    assert found.holds[0].seconds == pytest.approx(1.0, rel=1e-4)
    assert found.savings[0].seconds == pytest.approx(1.0 - 1.0 / 1.1, rel=1e-4)


def test_with_velocity_alone_the_slowest_joint_holds_each_segment() -> None:
    problem = Problem.of([[0.0, 0.0], [1.0, 0.5], [1.5, 2.5]], Limits.of([1.0, 2.0], dof=2))
    found = diagnose(problem, free_form(problem))
    assert {(h.joint, h.segment): h.seconds for h in found.holds} == pytest.approx(
        {(0, 0): 1.0, (1, 1): 1.0}
    )


def test_where_nothing_moves_nothing_holds() -> None:
    still = Problem.of(np.ones((3, 2)), Limits.of(1.0, 1.0, dof=2))
    found = diagnose(still, free_form(still))
    assert (found.holds, found.savings, found.unexplained) == ((), (), 0.0)
