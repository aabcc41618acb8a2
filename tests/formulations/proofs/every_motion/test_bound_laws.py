"""Laws of the bound: scaling, symmetry, what changes nothing, and what limits cost."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from every_motion_helpers import problem_of, unbounded

from formulations import Limits, free_form_bound, load


@pytest.mark.parametrize("scale", [1e-3, 7.0])
def test_it_scales_with_time_and_with_space(scale: float) -> None:
    problem = load("ur5")
    limits, bound = problem.limits, free_form_bound(problem, gap=1e-6).seconds
    faster = replace(
        limits,
        velocity=limits.velocity * scale,
        acceleration=limits.acceleration * scale**2,
        jerk=limits.jerk * scale**3,
    )
    quick = free_form_bound(replace(problem, limits=faster), gap=1e-6)
    assert quick.seconds == pytest.approx(bound / scale, rel=1e-6)
    v, a, j = limits.derivatives * scale
    wider = replace(limits, velocity=v, acceleration=a, jerk=j, position=limits.position * scale)
    wide = free_form_bound(
        replace(problem, waypoints=problem.waypoints * scale, limits=wider), gap=1e-6
    )
    assert wide.seconds == pytest.approx(bound, rel=1e-6)


def test_it_is_the_same_backwards_mirrored_and_with_joints_in_any_order() -> None:
    problem = unbounded(load("ur5"))
    bound = free_form_bound(problem, gap=1e-6).seconds
    order = [3, 0, 5, 1, 4, 2]
    limits = Limits.of(*problem.limits.derivatives[:, order], dof=6)
    for other in (
        replace(problem, waypoints=problem.waypoints[::-1]),
        replace(problem, waypoints=-problem.waypoints),
        replace(problem, waypoints=problem.waypoints[:, order], limits=limits),
    ):
        assert free_form_bound(other, gap=1e-6).seconds == pytest.approx(bound, rel=1e-6)


def test_a_waypoint_said_twice_and_a_joint_at_rest_change_nothing() -> None:
    problem = unbounded(load("ur5"))
    bound = free_form_bound(problem, gap=1e-6).seconds
    twice = replace(problem, waypoints=problem.waypoints[[0, 0, 1, 2, 2, 2, 3]])
    more = free_form_bound(twice, gap=1e-6)
    assert more.seconds == pytest.approx(bound, rel=1e-6)
    assert more.durations is not None
    assert (more.durations[[0, 3, 4]] == 0.0).all()
    points = np.column_stack([problem.waypoints, np.full(4, 0.3)])
    v, a, j = np.column_stack([problem.limits.derivatives, [1e-3, 1e-3, 1e-3]])
    still = free_form_bound(problem_of(points, v, a, j), gap=1e-6)
    assert still.seconds == pytest.approx(bound, rel=1e-6)


def test_savings_are_the_derivatives_and_obey_the_scaling_law() -> None:
    problem = unbounded(load("ur5"))
    bound = free_form_bound(problem, gap=1e-6)
    saved = bound.savings
    assert saved is not None
    assert saved.shape == (3, 3, 6)
    assert (saved >= -1e-9).all()
    by_limit = saved.sum(axis=1)
    assert float(np.array([1.0, 2.0, 3.0]) @ by_limit.sum(axis=1)) == pytest.approx(
        bound.seconds, rel=1e-3
    )
    h = 1e-4
    for quantity, joint in zip(*np.nonzero(by_limit > 0.05), strict=True):
        more = problem.limits.derivatives.copy()
        more[quantity, joint] *= 1.0 + h
        other = replace(problem, limits=Limits.of(*more, dof=6))
        gained = bound.seconds - free_form_bound(other, gap=1e-6).seconds
        assert gained / h == pytest.approx(by_limit[quantity, joint], rel=0.02, abs=0.02)
