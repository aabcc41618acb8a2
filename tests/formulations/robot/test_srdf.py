"""SRDF groups as MoveIt reads them: joints, links, chains, groups of groups, and what is left out."""

from __future__ import annotations

import pytest
from robot_files import joint, shared, urdf

from formulations import InputError
from formulations.robot.srdf import Group, parse_group
from formulations.robot.urdf import Urdf, parse_urdf

TREE = urdf(
    '<link name="base"/>',
    joint("hip", "base", "torso"),
    joint("left1", "torso", "l1"),
    joint("left2", "l1", "l2"),
    joint("left_tool", "l2", "lt", kind="fixed", limit=""),
    joint("right1", "torso", "r1"),
    joint("right2", "r1", "r2", more='<mimic joint="right1"/>'),
    joint("right3", "r2", "r3", kind="prismatic"),
)


@pytest.fixture
def tree() -> Urdf:
    return parse_urdf(TREE, "x.urdf")


def _group(tree: Urdf, body: str, name: str = "g") -> Group:
    return parse_group(f'<robot name="arm">{body}</robot>', "x.srdf", name, tree)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<joint name="left2"/><joint name="left1"/>', ("left1", "left2")),
        ('<link name="l2"/><link name="base"/><link name="torso"/>', ("hip", "left2")),
        ('<chain base_link="base" tip_link="lt"/>', ("hip", "left1", "left2")),
        ('<chain base_link="torso" tip_link="r3"/>', ("right1", "right3")),  # right2 follows right1
        ('<chain base_link="l1" tip_link="r1"/>', ("left1", "right1")),  # by way of the torso
        ('<joint name="left_tool"/><joint name="hip"/>', ("hip",)),  # fixed
    ],
)
def test_groups(tree: Urdf, body: str, expected: tuple[str, ...]) -> None:
    assert _group(tree, f'<group name="g">{body}</group>').joints == expected


def test_groups_of_groups_and_passive_joints(tree: Urdf) -> None:
    body = (
        '<group name="left"><chain base_link="torso" tip_link="lt"/></group>'
        '<group name="g"><group name="left"/><joint name="hip"/></group>'
        '<group name="only"><group name="left"/></group>'
        '<passive_joint name="left2"/>'
    )
    assert _group(tree, body).joints == ("hip", "left1")
    assert _group(tree, body, "left") == Group(("left1",), "torso", "lt")
    assert _group(tree, body, "only") == Group(("left1",), "torso", "lt")
    assert _group(tree, body).tip is None


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ('<group name="gg"/>', "no group 'g'; the nearest known one is 'gg'"),
        ('<group name="g"/>', "group 'g' has no joint that moves"),
        ('<group name="g"><joint name="left9"/></group>', "group 'g': <joint>: no joint 'left9'"),
        (
            '<group name="g"><joints name="hip"/></group>',
            "<joints>: unknown element; the nearest known one is 'joint'",
        ),
        ('<group name="g"><chain base_link="base"/></group>', "<chain>: attribute tip_link is missing"),
        (
            '<group name="g"><chain base_link="bas" tip_link="lt"/></group>',
            "no link 'bas'; the nearest known one is 'base'",
        ),
        ('<group name="g"><group name="g"/></group>', "group 'g' contains itself"),
        (
            '<group name="g"><group name="h"/></group><group name="h"><group name="g"/></group>',
            "group 'g' contains itself",
        ),
        ('<group name="g"><joint name="hip"/></group><group name="g"/>', "group 'g' is given twice"),
        ('<group name="g"><joint name="hip"/></group><passive_joint name="hop"/>', "no joint 'hop'"),
    ],
)
def test_faults_are_named(tree: Urdf, body: str, reason: str) -> None:
    with pytest.raises(InputError) as caught:
        _group(tree, body)
    assert reason in str(caught.value)
    assert "x.srdf" in str(caught.value)


def test_panda() -> None:
    tree = parse_urdf(shared("panda_description/urdf/panda.urdf").read_text("utf-8"), "panda.urdf")
    text = shared("panda_description/srdf/panda.srdf").read_text("utf-8")
    arm = [f"panda_joint{k}" for k in range(1, 8)]
    assert list(parse_group(text, "panda.srdf", "arm", tree).joints) == arm
    assert list(parse_group(text, "panda.srdf", "arm_and_hand", tree).joints) == [
        *arm,
        "panda_finger_joint1",
    ]
    with pytest.raises(InputError, match=r"panda.srdf: no group 'arn'; the nearest known one is 'arm'"):
        parse_group(text, "panda.srdf", "arn", tree)
