"""The least times that the checker finds under limits on the tool: never more than the tool needs."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from tool_problems import hinge, planar, random_chain, slider, ur5

from compare.check_certificate.answers import BadInput, Refused
from compare.check_certificate.balls import R
from compare.check_certificate.claim import Claim
from compare.check_certificate.tool.least_times import ClaimedTool, tool_times
from formulations import Conditions, Problem
from formulations.kinematics.link_chain import LinkChain
from formulations.problem.demands import Demands
from formulations.proofs.certificate import certificate_of
from formulations.proofs.tool.least_times import tool_least_times


def claimed(problem: Problem) -> Claim:
    """The claim of a bound of a microsecond, as it is read from a file."""
    data = certificate_of(problem, 1e-6, horizon=9.0, demands=Demands.of(problem))
    return Claim(json.loads(json.dumps(data)))


def places_of(chain: LinkChain, joints: np.ndarray) -> np.ndarray:
    """The tool point at joint positions (..., dof), by rotation vectors."""
    found = np.broadcast_to(chain.end[:3, 3], (*joints.shape[:-1], 3))
    for step in reversed(chain.steps):
        own = (step.factor * joints[..., step.variable] + step.offset)[..., None] * step.axis
        found = found @ step.after[:3, :3].T + step.after[:3, 3]
        turned = Rotation.from_rotvec(own.reshape(-1, 3)).apply(found.reshape(-1, 3))
        found = found + own if step.prismatic else turned.reshape(found.shape)
        found = found @ step.before[:3, :3].T + step.before[:3, 3]
    return found


def shortest(
    chain: LinkChain, passed: np.ndarray, tool: ClaimedTool, rng: np.random.Generator
) -> np.ndarray:
    """Upper bounds on what a bound of the tool's way may be, from points (m, 3, 3) within the zones."""
    found = np.linalg.norm(np.diff(passed, axis=1), axis=2).min(axis=0)
    for k, places in tool.places.items():
        joints = rng.uniform(-np.pi, np.pi, (5000, chain.dof))
        joints[:, places.joint] = float(places.values[0])
        x = places_of(chain, joints)
        p, other = passed[:200, k, None], passed[:200, k + 1, None]
        by = np.linalg.norm(x - p, axis=2) + np.linalg.norm(x - other, axis=2)
        found[k] = max(found[k], by.min())
    return found


@given(st.integers(0, 100_000), st.floats(0.0, 0.2), st.floats(0.01, 0.4), st.booleans())
@settings(max_examples=60, deadline=None)
def test_no_tool_is_faster_than_the_checker_says(seed: int, box: float, ball: float, far: bool) -> None:
    rng = np.random.default_rng(seed)
    joints = int(rng.integers(1, 5))
    slides = float(rng.choice([0.0, 0.3]))
    chain = random_chain(rng, joints, joints + int(rng.integers(0, 2)), slides)
    points = np.cumsum(rng.normal(scale=1.0 if far else 0.2, size=(3, joints)), axis=0)
    asked = Conditions(
        tool_speed=0.5,
        segment_tool_speed={1: 0.25},
        tolerance={k: rng.uniform(0.0, box, joints) for k in (0, 1)},
        tool_zones={1: ball},
    )
    problem = Problem(points, {"velocity": 2.0, "acceleration": 5.0}, tool=chain, conditions=asked)
    demands = claimed(problem).demands()
    assert demands.tool is not None
    times = np.array([float(x) for x in tool_times(demands, demands.tool)])
    theirs = tool_least_times(Demands.of(problem))
    assert (times >= theirs).all()  # or what the prover proves would be refused
    np.testing.assert_allclose(times, theirs, rtol=1e-9, atol=1e-11)
    low, high = np.moveaxis(Demands.of(problem).waypoints, -1, 0)
    some = rng.uniform(low, high, (400, 3, joints))
    corners = np.where(rng.random((400, 3, joints)) < 0.5, low, high)
    passed = places_of(chain, np.concatenate([some, corners, points[None]]))
    inside = np.linalg.norm(passed[:, 1] - places_of(chain, points)[1], axis=1) <= ball
    ways = shortest(chain, passed[inside], demands.tool, rng)
    assert (times <= ways / np.array([0.5, 0.25]) + 1e-12).all()
    # and no path of the joints is shorter, however it winds
    t = np.linspace(0.0, 1.0, 2000)[:, None]
    for k in (0, 1):
        for bump in rng.normal(size=(5, joints)):
            path = points[k] + t * (points[k + 1] - points[k]) + np.sin(np.pi * t) * bump
            winding = np.linalg.norm(np.diff(places_of(chain, path), axis=0), axis=1).sum()
            assert times[k] * (0.5, 0.25)[k] <= winding * (1.0 + 1e-5)


def test_an_arm_that_turns_by_the_front_has_farther_to_go_than_the_straight_line() -> None:
    """A UR5 between five random points: 2.66 times as far, as a million places say too."""
    rng = np.random.default_rng(0)
    for _ in range(4):  # the fourth one drawn
        points, speed = rng.uniform(-1.5, 1.5, (int(rng.integers(3, 6)), 6)), rng.uniform(0.2, 1.0)
    problem = replace(ur5(Conditions(tool_speed=speed)), waypoints=points)
    demands = claimed(problem).demands()
    assert problem.tool is not None
    assert demands.tool is not None
    speed = problem.conditions.tool_speed
    times = np.array([float(x) * speed for x in tool_times(demands, demands.tool)])
    passed = places_of(problem.tool, problem.waypoints)
    straight = np.linalg.norm(np.diff(passed, axis=0), axis=1)
    assert times / straight == pytest.approx([1.0, 1.094, 1.431, 2.662], abs=1e-3)
    rng = np.random.default_rng(0)
    by = np.array([shortest(problem.tool, passed[None], demands.tool, rng) for _ in range(20)]).min(
        axis=0
    )
    assert (times <= by).all()
    assert (by <= 1.003 * times).all()


def test_the_way_by_several_places_of_a_hinge_is_the_polygon() -> None:
    """A lever of 0.5 m from 0 to 2.4 rad, by 0.8 and 1.6 rad: three chords."""
    problem = hinge(0.5, Conditions(tool_speed=1.0), [[0.0], [2.4]])
    data = json.loads(
        json.dumps(certificate_of(problem, 1e-6, horizon=9.0, demands=Demands.of(problem)))
    )
    angles = np.array([0.0, 0.8, 1.6, 2.4])
    corners = 0.5 * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    chords = np.diff(corners, axis=0)
    vectors = chords / np.linalg.norm(chords, axis=1)[:, None] * (1.0 - 1e-15)

    def least(joint: int, values: list[float], rows: np.ndarray) -> float:
        hexed = [[float(x).hex() for x in row] for row in rows]
        data["demands"]["tool"]["passes"] = [[0, joint, [x.hex() for x in values], hexed]]
        demands = Claim(data).demands()
        assert demands.tool is not None
        return float(tool_times(demands, demands.tool)[0])

    assert least(0, [0.8, 1.6], vectors) == pytest.approx(3 * np.sin(0.4), rel=1e-12)  # 2 * 0.5 * sin
    assert least(0, [0.8, 1.6], vectors) < 1.2  # the arc
    with pytest.raises(Refused, match="need not pass"):
        least(0, [1.6, 0.8], vectors)
    with pytest.raises(Refused, match="need not pass"):
        least(0, [0.8, 2.5], vectors)
    with pytest.raises(Refused, match="too long"):
        least(0, [0.8, 1.6], 1.001 * vectors)
    with pytest.raises(BadInput):
        least(1, [0.8, 1.6], vectors)
    with pytest.raises(BadInput):
        least(0, [0.8], vectors)


def test_a_sliding_joint_without_limits_leaves_no_place_certain() -> None:
    """A slider behind a hinge may be anywhere; between limits it is somewhere."""
    step = replace(slider().steps[0], variable=1)
    chain = LinkChain(("a", "b"), (planar([0.5]).steps[0], step), np.eye(4))
    for bounds, surely in (([-np.inf, np.inf], False), ([-0.1, 0.1], True)):
        limits = {"velocity": 1.0, "acceleration": 2.0, "position": [[-4.0, 4.0], bounds]}
        problem = Problem(
            [[-1.2, 0.0], [1.2, 0.0]], limits, tool=chain, conditions=Conditions(tool_speed=1.0)
        )
        data = json.loads(
            json.dumps(certificate_of(problem, 1.0, horizon=9.0, demands=Demands.of(problem)))
        )
        assert bool(data["demands"]["tool"]["passes"]) is surely
        if surely:
            data["demands"]["position"][0][1] = [None, None]
            demands = Claim(data).demands()
            assert demands.tool is not None
            with pytest.raises(Refused, match="slides has no limits"):
                tool_times(demands, demands.tool)


def test_between_points_the_least_time_is_the_distance_over_the_speed() -> None:
    problem = ur5(Conditions(tool_speed=0.4, segment_tool_speed={1: 0.1}))
    demands = claimed(problem).demands()
    assert problem.tool is not None
    assert demands.tool is not None
    ways = np.linalg.norm(np.diff(places_of(problem.tool, problem.waypoints), axis=0), axis=1)
    times = [float(x) for x in tool_times(demands, demands.tool)]
    np.testing.assert_allclose(times, ways / [0.4, 0.1], rtol=1e-12)


@given(st.integers(0, 100_000))
@settings(max_examples=30, deadline=None)
def test_slopes_are_differences_and_bends_bound_second_differences(seed: int) -> None:
    rng = np.random.default_rng(seed)
    chain = random_chain(rng, 3, 4)
    points = rng.normal(size=(2, 3))
    claim = claimed(
        Problem(
            points,
            {"velocity": 1.0, "acceleration": 1.0},
            tool=chain,
            conditions=Conditions(tool_speed=1.0),
        )
    )
    tool = claim.demands().tool
    assert tool is not None
    columns = tool.chain.point_and_slopes([R(x) for x in points[0].tolist()])
    found = np.array([[float(x) for x in row] for row in columns.tolist()])
    np.testing.assert_allclose(found[:, 0], places_of(chain, points[0]), atol=1e-12)
    h = 1e-5
    steps = h * np.eye(3)
    slopes = (places_of(chain, points[0] + steps) - places_of(chain, points[0] - steps)) / (2 * h)
    np.testing.assert_allclose(found[:, 1:], slopes.T, atol=1e-8)
    bends = np.array(
        [[float(x) for x in row] for row in tool.chain.bends([R(x) for x in (5.0, 5.0, 5.0)])]
    )
    h = 1e-3
    grid = rng.uniform(-4.9, 4.9, (200, 3))
    for j, a in enumerate(h * np.eye(3)):
        for k, b in enumerate(h * np.eye(3)):
            second = (
                places_of(chain, grid + a + b)
                - places_of(chain, grid + a - b)
                - places_of(chain, grid - a + b)
                + places_of(chain, grid - a - b)
            ) / (4 * h * h)
            assert np.linalg.norm(second, axis=1).max() <= bends[j, k] + 1e-6
