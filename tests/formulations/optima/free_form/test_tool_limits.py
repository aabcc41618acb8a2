"""Motions under limits on the tool, and their bounds: closed forms, and laws that hold for every problem."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tool_problems import LIMITS, hinge, planar, slider, two_links, ur5

from formulations import Conditions, Problem, UnsupportedProblem, check, free_form, free_form_bound
from formulations.problem.demands import Demands
from formulations.proofs.tool.least_times import tool_least_times, with_tool_times
from formulations.proofs.tool.passing import places_passed


@pytest.mark.parametrize("lever", [pytest.param(0.25, marks=pytest.mark.long), 0.8])
def test_a_hinge_has_the_velocity_limit_s_over_its_lever(lever: float) -> None:
    speed = 0.6 * lever  # 0.6 rad/s, below its limit of 2 rad/s
    mine = free_form(hinge(lever, Conditions(tool_speed=speed)), tolerance=1e-4)
    other = Problem(((0.0,), (1.0,), (0.3,)), {**LIMITS, "velocity": 0.6})
    exact = free_form(other, tolerance=1e-6).seconds
    assert exact * (1.0 - 1e-7) <= mine.seconds <= exact * (1.0 + 2e-3)
    assert mine.verdict is not None
    assert mine.verdict.feasible
    bound = free_form_bound(hinge(lever, Conditions(tool_speed=speed)), upper=mine.seconds)
    chords = 2.0 * np.sin(np.array([0.5, 0.35])) / 0.6  # of the tool's circle, over its speed
    least = tool_least_times(Demands.of(hinge(lever, Conditions(tool_speed=speed))))
    assert least == pytest.approx(chords, rel=1e-12)
    assert (least <= chords).all()
    assert bound.seconds >= least.sum() * (1.0 - 1e-12)
    assert bound.seconds <= mine.seconds


def test_a_slider_has_the_velocity_limit_s_and_the_same_bound() -> None:
    points = [[0.0], [1.0], [0.3]]
    problem = Problem(points, LIMITS, tool=slider(), conditions=Conditions(tool_speed=0.6))
    other = Problem(points, {**LIMITS, "velocity": 0.6})
    exact = free_form(other, tolerance=1e-6).seconds
    found = free_form(problem, tolerance=1e-4)
    assert exact * (1.0 - 1e-7) <= found.seconds <= exact * (1.0 + 2e-3)
    least = tool_least_times(Demands.of(problem))
    assert least == pytest.approx([1.0 / 0.6, 0.7 / 0.6], rel=1e-12)  # the straight line is the way
    assert (least <= np.array([1.0, 0.7]) / 0.6).all()


@pytest.mark.long  # searches and proofs
@given(st.floats(0.15, 1.0), st.floats(1.05, 2.0))
@settings(max_examples=3, deadline=None)
def test_a_looser_limit_is_not_slower_and_the_bound_holds(speed: float, more: float) -> None:
    tight = two_links(Conditions(tool_speed=speed))
    loose = two_links(Conditions(tool_speed=speed * more))
    found = [free_form(problem, tolerance=1e-2) for problem in (tight, loose)]
    assert found[1].seconds <= found[0].seconds * (1.0 + 2e-3)
    for problem, motion in zip((tight, loose), found, strict=True):
        assert motion.trajectory is not None
        assert check(problem, motion.trajectory).feasible
        bound = free_form_bound(problem, upper=motion.seconds, time_limit=5.0)
        assert bound.seconds <= motion.seconds
        least = tool_least_times(Demands.of(problem))
        assert bound.seconds >= least.sum() * (1.0 - 1e-12)
        assert (motion.durations >= least).all()


def test_a_limit_that_costs_nothing_changes_nothing() -> None:
    plain = free_form(two_links(Conditions()))
    assert free_form(two_links(Conditions(tool_speed=50.0))).seconds == plain.seconds


@pytest.mark.long
def test_a_ball_of_the_tool_saves_time_and_is_kept() -> None:
    through = free_form(two_links(Conditions(tool_speed=0.8)), tolerance=1e-2)
    asked = Conditions(tool_speed=0.8, tool_zones={1: 0.05})
    near = free_form(two_links(asked), tolerance=1e-2)
    assert near.seconds < through.seconds * (1.0 - 1e-3)
    assert near.trajectory is not None
    problem = two_links(asked)
    assert problem.tool is not None
    off = near.trajectory.at(near.trajectory.passage_times[1])
    ends = problem.tool.forward(np.stack([off, problem.waypoints[1]]))[:, :3, 3]
    assert np.linalg.norm(ends[0] - ends[1]) <= 0.05 * (1.0 + 1e-9)
    assert np.abs(off - problem.waypoints[1]).max() <= 0.1 + 1e-9
    assert free_form_bound(problem, upper=near.seconds, time_limit=5.0).seconds <= near.seconds


@given(st.integers(0, 10_000), st.floats(0.0, 0.3), st.floats(0.01, 0.5))
@settings(max_examples=30, deadline=None)
def test_no_two_points_of_zones_are_nearer_than_the_bound_says(
    seed: int, box: float, ball: float
) -> None:
    rng = np.random.default_rng(seed)
    asked = Conditions(
        tool_speed=1.0, tolerance={k: np.full(6, box) for k in (1, 2)}, tool_zones={1: ball}
    )
    problem = ur5(asked)
    demands = Demands.of(problem)
    least = tool_least_times(demands)
    low, high = demands.waypoints[..., 0], demands.waypoints[..., 1]
    assert problem.tool is not None
    home = problem.tool.forward(problem.waypoints)[:, :3, 3]
    place = places_passed(demands, problem.tool)
    points = problem.tool.forward(rng.uniform(low, high, (400, 3, 6)))[..., :3, 3]
    corners = np.where(rng.random((400, 3, 6)) < 0.5, low, high)
    points = np.concatenate([points, problem.tool.forward(corners)[..., :3, 3]])
    inside = np.linalg.norm(points[:, 1] - home[1], axis=1) <= ball
    points = points[inside]
    ways = np.linalg.norm(np.diff(points, axis=1), axis=2).min(axis=0)
    for k in np.flatnonzero(place.joint >= 0):  # all that the arm reaches with this joint at this value
        joints = rng.uniform(-np.pi, np.pi, (4000, 6))
        joints[:, place.joint[k]] = place.value[k]
        x = problem.tool.forward(joints)[:, :3, 3]
        by = sum(np.linalg.norm(x - points[:100, k + i, None], axis=2) for i in (0, 1))
        ways[k] = max(ways[k], by.min())
    assert (ways >= least - 1e-12).all()
    assert (with_tool_times(demands).durations[:, 0] >= least).all()


def test_windows_and_waits_are_kept_beside_the_tool() -> None:
    asked = Conditions(tool_speed=0.4, waits={1: 0.5}, windows={1: (3.0, 9.0)})
    found = free_form(two_links(asked), tolerance=1e-2)
    assert found.trajectory is not None
    assert found.trajectory.passage_times[1] >= 3.0 - 1e-9
    assert check(two_links(asked), found.trajectory).feasible


def test_a_joint_without_an_acceleration_limit_is_refused() -> None:
    problem = Problem(
        [[0.0, 0.0], [1.0, 1.0]],
        {"velocity": 1.0},
        tool=planar([0.5, 0.4]),
        conditions=Conditions(tool_speed=0.1),
    )
    with pytest.raises(UnsupportedProblem, match="joint 1 has no acceleration limit"):
        free_form(problem)


def test_without_a_jerk_limit_the_steps_have_constant_acceleration() -> None:
    problem = replace(
        two_links(Conditions(tool_speed=0.4)),
        limits=Problem([[0.0, 0.0], [1.0, 1.0]], {"velocity": 2.0, "acceleration": 5.0}).limits,
    )
    found = free_form(problem, tolerance=1e-2)
    jerked = free_form(two_links(Conditions(tool_speed=0.4)), tolerance=1e-2)
    assert found.seconds <= jerked.seconds
    assert found.verdict is not None
    assert found.verdict.feasible
