"""Robots: the joints chosen, limits that are asked for and never invented, followers, factors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from robot_files import joint, planar, urdf, written

from formulations import InputError
from formulations.robot import Joint, JointKind, Mimic, Robot, robot_of
from formulations.robot.joints import limited_by

FULL = 'lower="-3" upper="3" velocity="2" acceleration="5" jerk="50" effort="1"'
HAND = urdf(
    '<link name="base"/>',
    joint("turn", "base", "arm", kind="continuous", limit=FULL),
    joint(
        "lift",
        "arm",
        "palm",
        kind="prismatic",
        limit='lower="0" upper="0.5" velocity="0.3" acceleration="2" jerk="9"',
    ),
    joint(
        "left",
        "palm",
        "l",
        kind="prismatic",
        limit='lower="0" upper="0.1" velocity="0.2" acceleration="1" jerk="8"',
    ),
    joint(
        "right",
        "palm",
        "r",
        kind="prismatic",
        limit='lower="-0.3" upper="0" velocity="0.3" jerk="4"',
        more='<mimic joint="left" multiplier="-2" offset="-0.02"/>',
    ),
    joint(
        "thumb",
        "r",
        "t",
        limit='lower="-1" upper="1" velocity="3"',
        more='<mimic joint="right" multiplier="0.5"/>',
    ),
    joint("tool", "palm", "tip", kind="fixed", limit=""),
)


@pytest.fixture
def hand(tmp_path: Path) -> Path:
    return written(tmp_path, "hand.urdf", HAND)


def test_all_that_moves_is_the_default(hand: Path) -> None:
    robot = Robot.from_urdf(hand)
    assert robot.names == ("turn", "lift", "left")
    assert robot.kinds == ("continuous", "prismatic", "prismatic")
    assert robot.units == ("rad", "m", "m")
    assert robot == robot_of(hand)
    assert hash(robot) == hash(robot_of(hand))
    assert "\n" not in str(robot)
    assert len(repr(robot)) < 2500


def test_joints_in_the_order_asked_for(hand: Path) -> None:
    robot = Robot.from_urdf(hand, joints=["lift", "turn"])
    assert robot.names == ("lift", "turn")
    np.testing.assert_array_equal(robot.limits.velocity, [0.3, 2.0])
    np.testing.assert_array_equal(robot.limits.position, [[0.0, 0.5], [-np.inf, np.inf]])
    assert (robot.base, robot.tip) == ("arm", "arm")


def test_followers_set_limits_of_their_leader_by_their_speed(hand: Path) -> None:
    """right = -2 left - 0.02; thumb = 0.5 right = -left - 0.01."""
    robot = Robot.from_urdf(hand)
    left = robot.joints[2]
    assert left.velocity == min(0.2, 0.3 / 2, 3.0 / 1)
    assert left.acceleration == 1.0  # the followers' are not known
    assert left.jerk == min(8.0, 4.0 / 2)
    # right within [-0.3, 0]: left within [-0.01, 0.14]; thumb within [-1, 1]: left within [-1.01, 0.99]
    np.testing.assert_allclose(left.position, (0.0, 0.1))
    assert [(m.joint.name, m.leader, m.multiplier, m.offset) for m in robot.mimics] == [
        ("right", "left", -2.0, -0.02),
        ("thumb", "left", -1.0, -0.01),
    ]
    assert Robot.from_urdf(hand, joints=["turn"]).mimics == ()


@given(
    m=st.floats(-5, 5).filter(lambda m: abs(m) > 1e-3),
    offset=st.floats(-1, 1),
    q=st.floats(-9, 9),
    speed=st.floats(0.1, 9),
    low=st.floats(-3, 0),
    width=st.floats(0.1, 4),
)
def test_a_leader_within_its_limits_keeps_its_follower_within_its_own(
    m: float, offset: float, q: float, speed: float, low: float, width: float
) -> None:
    leader = Joint("l", JointKind.REVOLUTE, 5.0, 6.0, 7.0, (-9.0, 9.0))
    follower = Joint("f", JointKind.REVOLUTE, speed, speed, speed, (low, low + width))
    found = limited_by(leader, Mimic(follower, "l", m, offset))
    for quantity, own in (("velocity", 5.0), ("acceleration", 6.0), ("jerk", 7.0)):
        limit = getattr(found, quantity)
        assert limit == min(own, speed / abs(m))
    inside = found.position[0] <= q <= found.position[1]
    moved = m * q + offset
    assert (
        inside == (low <= moved <= low + width)
        or min(abs(moved - low), abs(moved - low - width)) < 1e-9
    )


def test_every_missing_limit_of_every_joint_is_named(hand: Path, tmp_path: Path) -> None:
    arm = written(tmp_path, "arm.urdf", planar(1.0, 0.5, limit='velocity="2"'))
    with pytest.raises(InputError) as caught:
        _ = Robot.from_urdf(arm).limits
    message = str(caught.value)
    for part in (
        "acceleration of joint1, joint2",
        "jerk of joint1, joint2",
        "position of joint1, joint2",
        "max_acceleration, max_jerk, min_position, max_position in a joint_limits.yaml",
        "robot.with_limits(acceleration=...)",
        "unlimited=['acceleration', 'jerk', 'position']",
    ):
        assert part in message
    assert "velocity of" not in message


def test_what_a_file_took_away_is_missing_and_said(tmp_path: Path) -> None:
    arm = written(tmp_path, "arm.urdf", planar(1.0, limit=FULL))
    limits = written(tmp_path, "l.yaml", "joint_limits: {joint1: {has_jerk_limits: false}}")
    with pytest.raises(
        InputError, match=r"jerk of joint1 \(has_jerk_limits: false in the limits file\)"
    ):
        _ = Robot.from_urdf(arm, limits=limits).limits
    limits_in_force = Robot.from_urdf(arm, limits=limits, unlimited="jerk").limits
    np.testing.assert_array_equal(limits_in_force.jerk, [np.inf])


def test_unlimited_says_nothing_about_limits_that_are_known(tmp_path: Path) -> None:
    arm = written(tmp_path, "arm.urdf", planar(1.0, limit=FULL))
    robot = Robot.from_urdf(arm, unlimited=["acceleration", "jerk", "position"])
    assert robot.limits.jerk[0] == 50.0
    bare = written(tmp_path, "bare.urdf", planar(1.0, limit='velocity="1"'))
    found = Robot.from_urdf(bare, unlimited=["acceleration", "jerk", "position"]).limits
    assert not found.has_acceleration
    assert not found.has_jerk
    assert not found.has_position
    with pytest.raises(InputError, match="unlimited: 'velocity'; known: acceleration, jerk, position"):
        Robot.from_urdf(bare, unlimited="velocity")


def test_limits_given_in_python(tmp_path: Path) -> None:
    arm = written(tmp_path, "arm.urdf", planar(1.0, 0.5))
    robot = Robot.from_urdf(arm).with_limits(acceleration=4.0, jerk={"joint2": 30.0, "joint1": 20.0})
    np.testing.assert_array_equal(robot.limits.acceleration, [4.0, 4.0])
    np.testing.assert_array_equal(robot.limits.jerk, [20.0, 30.0])
    np.testing.assert_array_equal(
        robot.with_limits(position=(-1, 2)).limits.position, [[-1, 2], [-1, 2]]
    )


@pytest.mark.parametrize(
    ("given_", "reason"),
    [
        (
            {"jerk": {"joint3": 1.0}},
            "with_limits: jerk: no joint 'joint3'; the nearest known one is 'joint",
        ),
        ({"jerk": -1.0}, "with_limits: jerk of joint 'joint1': -1.0 is not a positive number"),
        (
            {"jerk": {"joint2": "1"}},
            "with_limits: jerk of joint 'joint2': '1' is not a positive number",
        ),
        ({"velocity": np.inf}, "inf is not finite"),
        ({"position": (1.0, 1.0)}, "lowest 1 is not below highest 1"),
        ({"position": 1.0}, "expected (lowest, highest), got 1.0"),
    ],
)
def test_faulty_limits_in_python(tmp_path: Path, given_: dict[str, object], reason: str) -> None:
    robot = Robot.from_urdf(written(tmp_path, "arm.urdf", planar(1.0, 0.5)))
    with pytest.raises(InputError) as caught:
        robot.with_limits(**given_)
    assert reason in str(caught.value)


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"joints": ["lifft"]}, "has no joint 'lifft'; the nearest known one is 'lift'"),
        ({"joints": ["right"]}, "joint 'right' follows joint 'left' and cannot be moved alone"),
        ({"joints": ["tool"]}, "joint 'tool' is fixed; it does not move along one axis"),
        ({"joints": ["lift", "lift"]}, "joint 'lift' is given twice"),
        ({"joints": []}, "joints: at least one is needed"),
        ({"joints": "lift"}, "joints: expected a list of names, got 'lift'"),
        ({"group": "arm"}, "group: 'arm' needs an SRDF"),
        ({"group": "arm", "joints": ["lift"]}, "group: 'arm' is given beside joints"),
        ({"srdf": "x.srdf"}, "srdf: x.srdf is given without a group"),
        ({"tip": "tipp"}, "tip: "),
        ({"base": "baze"}, "has no link 'baze'; the nearest known one is 'base'"),
        ({"velocity_scaling": 0.0}, "velocity_scaling: 0.0 is not a factor above 0, up to 1"),
        ({"acceleration_scaling": 1.1}, "acceleration_scaling: 1.1 is not a factor"),
        ({"jerk_scaling": True}, "jerk_scaling: True is not a factor"),
    ],
)
def test_faulty_options(hand: Path, options: dict[str, object], reason: str) -> None:
    with pytest.raises(InputError) as caught:
        Robot.from_urdf(hand, **options)
    assert reason in str(caught.value)


@pytest.mark.parametrize(
    ("parts", "reason"),
    [
        (
            joint("f", "b", "c", kind="floating", limit=""),
            "joint 'f' is floating, which is not moved here; name the joints",
        ),
        (joint("m", "b", "c", more='<mimic joint="m"/>'), "joint 'm' follows itself"),
        (
            joint("m", "b", "c", more='<mimic joint="n"/>')
            + joint("n", "c", "d", more='<mimic joint="m"/>'),
            "follows itself",
        ),
        (
            joint("m", "b", "c", more='<mimic joint="s"/>')
            + joint("s", "c", "d", kind="fixed", limit=""),
            "joint 'm' follows joint 's', which is fixed",
        ),
        (
            joint("m", "b", "c", limit='lower="5" upper="6" velocity="1"', more='<mimic joint="j"/>'),
            "joint 'j': its followers leave it no position",
        ),
    ],
)
def test_faulty_trees(tmp_path: Path, parts: str, reason: str) -> None:
    path = written(tmp_path, "x.urdf", urdf('<link name="a"/>', joint("j", "a", "b"), parts))
    with pytest.raises(InputError) as caught:
        Robot.from_urdf(path)
    assert reason in str(caught.value)
