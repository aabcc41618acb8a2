"""Certificates under limits on the tool: least times, claims that are refused, words that name the tool."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from tool_problems import hinge, planar, random_chain, slider, two_links, ur5

from compare.check_certificate.answers import BadInput, Refused
from compare.check_certificate.balls import R
from compare.check_certificate.certificate_file import compare_with
from compare.check_certificate.claim import Claim
from compare.check_certificate.tool.least_times import ClaimedTool, tool_times
from compare.check_certificate.verify import verify
from compare.studies.tool_gaps import problems
from formulations import Conditions, Problem, free_form, free_form_bound, load, save
from formulations.kinematics.link_chain import LinkChain
from formulations.problem.demands import Demands
from formulations.proofs.certificate import certificate_of
from formulations.proofs.tool.least_times import tool_least_times

FILE = """
arm = "ur5"
unit = "deg"
waypoints = [[0, -60, 60, 0, 30, 0], [35, -40, 35, 10, 5, 25], [65, -70, 75, -15, 10, 5]]
[limits]
velocity = 180
acceleration = 600
jerk = 6000
[conditions]
tool_speed = 0.3
[[conditions.waypoint]]
at = 1
tool_radius = 0.03
tolerance = 4
[[conditions.segment]]
from = 1
tool_speed = 0.15
"""


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
    """The UR5 of problem 3 of the study: 2.66 times as far, as a million places say too."""
    problem = next(islice(problems(4), 3, None))
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


# --- from the prover to the checker -----------------------------------------------------------------


@cache
def proof() -> tuple[Problem, str]:
    """Two links with a ball of the tool, and the certificate of their bound as text."""
    problem = two_links(Conditions(tool_speed=0.3, segment_tool_speed={1: 0.2}, tool_zones={1: 0.02}))
    bound = free_form_bound(problem, upper=9.0, time_limit=5.0, record=True)
    assert bound.certificate is not None
    assert float.fromhex(bound.certificate["seconds"]) >= bound.seconds * (1.0 - 1e-9)
    return problem, json.dumps(bound.certificate)


def test_what_is_proved_is_certified_and_no_motion_is_faster() -> None:
    problem, text = proof()
    data = json.loads(text)
    said = verify(data, show=True)
    assert "a tool speed of at most 0.2 to 0.3 m/s, balls of the tool at 1 waypoint" in said
    assert "the tool on 2 turning joints and at (0.9, 0, 0) m when they are at 0" in said
    assert (
        "link 2: shifted by (0, 0, 0); turns about (0, 0, 1) by q2; then shifted by (0.4, 0, 0)" in said
    )
    seconds = float.fromhex(data["seconds"])
    assert seconds <= free_form(problem, tolerance=1e-1).seconds
    without = {key: value for key, value in data["demands"].items() if key != "tool"}
    for false in ({"demands": without}, {"seconds": (seconds * (1.0 + 1e-9)).hex()}):
        with pytest.raises(Refused):
            verify({**data, **false})


def scaled(where: str, by: float) -> Callable[[dict[str, Any]], None]:
    """Multiply the numbers of one key by a factor."""

    def change(tool: dict[str, Any]) -> None:
        tool[where] = [None if x is None else (by * float.fromhex(x)).hex() for x in tool[where]]

    return change


def longer(by: float) -> Callable[[dict[str, Any]], None]:
    """Lengthen the last link by a factor."""

    def change(tool: dict[str, Any]) -> None:
        entry = tool["chain"][-1]["after"][0]
        entry[3] = (by * float.fromhex(entry[3])).hex()

    return change


def less_turned(tool: dict[str, Any]) -> None:
    for link in tool["chain"]:
        link["factor"] = (0.9).hex()


def no_speed(tool: dict[str, Any]) -> None:
    tool["speed"] = [None, None]


@pytest.mark.parametrize(
    "fault",
    [
        scaled("speed", 1.001),
        scaled("radius", 1.01),
        longer(0.999),
        less_turned,
        no_speed,
    ],
    ids=["faster", "a larger ball", "shorter", "less turned", "without a speed"],
)
def test_a_proof_for_another_tool_is_refused(fault: Callable[[dict[str, Any]], None]) -> None:
    data = json.loads(proof()[1])
    fault(data["demands"]["tool"])
    with pytest.raises(Refused):
        verify(data)


def test_a_longer_link_is_certified_as_another_tool() -> None:
    """It has farther to go, so the bound holds for it too; the words say which tool it is about."""
    data = json.loads(proof()[1])
    longer(1.5)(data["demands"]["tool"])
    assert "at (1.1, 0, 0) m when they are at 0" in verify(data)


def test_wider_zones_leave_less_of_the_distance() -> None:
    data = json.loads(proof()[1])
    data["demands"]["tool"]["radius"] = [None, (5.0).hex(), None]  # now the box says how far
    with pytest.raises(Refused):
        verify(data)
    for pair in data["demands"]["waypoints"][1]:
        low, high = (float.fromhex(x) for x in pair)
        pair[:] = [(low + 0.09).hex(), (high - 0.09).hex()]
    verify(data)


def moved(link: dict[str, Any], key: str, value: Any) -> None:
    link[key] = value


SPOILT: dict[str, tuple[type[Exception], str, Callable[[dict[str, Any]], Any]]] = {
    "a place of no segment": (
        BadInput,
        "from 0 to 1",
        lambda t: t.update(passes=[[2, 0, [], []]]),
    ),
    "a key too many": (BadInput, "has the keys", lambda t: t.update(mass=1)),
    "no chain": (BadInput, "expected a list", lambda t: t.update(chain=[])),
    "a joint too many": (BadInput, "from 0 to 1", lambda t: moved(t["chain"][0], "joint", 2)),
    "a link without a key": (BadInput, "a step has the keys", lambda t: t["chain"][0].pop("axis")),
    "neither": (BadInput, "true or false", lambda t: moved(t["chain"][0], "prismatic", 1)),
    "a long axis": (
        Refused,
        "no unit vector",
        lambda t: moved(t["chain"][0], "axis", [(1.0).hex()] * 3),
    ),
    "a stretch": (
        Refused,
        "does not turn and shift only",
        lambda t: moved(t["chain"][0]["after"][0], 0, (1.1).hex()),  # type: ignore[arg-type]
    ),
    "infinite": (BadInput, "not finite", lambda t: moved(t["chain"][0], "offset", "inf")),
    "backwards": (Refused, "not positive", lambda t: moved(t, "speed", [(-1.0).hex(), None])),
    "nothing": (Refused, "none is given", lambda t: t.update(speed=[None] * 2, radius=[None] * 3)),
    "too short": (BadInput, "expected a list", lambda t: t.update(radius=[None])),
}


@pytest.mark.parametrize("name", SPOILT)
def test_a_spoilt_chain_is_refused(name: str) -> None:
    error, said, spoil = SPOILT[name]
    data = json.loads(proof()[1])
    spoil(data["demands"]["tool"])
    with pytest.raises(error, match=said):
        verify(data)


def test_the_certificate_is_about_the_tool_of_the_problem(tmp_path: Path) -> None:
    path = tmp_path / "slow.toml"
    path.write_text(FILE)
    problem = load(str(path))
    bound = free_form_bound(problem, upper=30.0, time_limit=3.0, record=True)
    data = json.loads(json.dumps(bound.certificate))
    assert "a tool speed of at most 0.15 to 0.3 m/s" in verify(data)
    compare_with(data, str(path))
    for text in (
        FILE.replace("tool_speed = 0.3", "tool_speed = 0.31"),
        FILE.replace("tool_speed = 0.15", "tool_speed = 0.3"),
        FILE.replace("tool_radius = 0.03", "tool_radius = 0.02"),
        FILE.replace('"ur5"', '"cobot"'),
    ):
        path.write_text(text)
        with pytest.raises(Refused, match=r"tool differs|differ from"):
            compare_with(data, str(path))
    path.write_text(FILE.split("[conditions]")[0])
    with pytest.raises(Refused):
        compare_with(data, str(path))
    # another place of the tool on the same arm
    assert problem.tool is not None
    longer_chain = problem.tool.extended([0.0, 0.0, 0.1])
    other = copy.deepcopy(data)
    end = [[float(x).hex() for x in row] for row in longer_chain.end[:3]]
    other["demands"]["tool"]["end"] = end
    path.write_text(FILE)
    with pytest.raises(Refused, match="the tool differs"):
        compare_with(other, str(path))
    save(problem, tmp_path / "again.toml")
    compare_with(data, str(tmp_path / "again.toml"))
