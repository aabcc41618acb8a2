"""URDF: every number against a parse of the test's own; faults named with line, joint and value."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from robot_files import all_shared, joint, planar, urdf

from formulations import InputError
from formulations.robot.joints import JointKind
from formulations.robot.urdf import parse_urdf


def _rotation(rpy: list[float]) -> np.ndarray:
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    X = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    Y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    Z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return Z @ Y @ X


def _numbers(element: ElementTree.Element | None, key: str, default: str) -> list[float]:
    return [float(x) for x in (default if element is None else element.get(key, default)).split()]


@pytest.mark.slow
def test_every_urdf_of_example_robot_data_as_the_test_itself_parses_it() -> None:
    """69 robots: joints, origins, axes and limits, by an XML parser that the readers do not use."""
    read = 0
    for path in all_shared(".urdf"):
        text = path.read_text("utf-8")
        try:
            found = parse_urdf(text, path.name).named()
        except InputError as error:
            if not _is_really_faulty(text, str(error)):
                raise
            continue
        read += 1
        root = ElementTree.fromstring(text)
        assert set(found) == {element.get("name") for element in root.findall("joint")}
        for element in root.findall("joint"):
            mine = found[element.get("name", "")]
            limit, origin = element.find("limit"), element.find("origin")
            assert mine.parent == element.find("parent").get("link")
            assert mine.child == element.find("child").get("link")
            pose = np.array(mine.origin)
            np.testing.assert_allclose(pose[:3, 3], _numbers(origin, "xyz", "0 0 0"), atol=1e-12)
            np.testing.assert_allclose(
                pose[:3, :3], _rotation(_numbers(origin, "rpy", "0 0 0")), atol=1e-12
            )
            if mine.joint is None:
                assert element.get("type") in ("fixed", "floating", "planar")
                continue
            axis = np.array(_numbers(element.find("axis"), "xyz", "1 0 0"))
            np.testing.assert_allclose(mine.axis, axis / np.linalg.norm(axis), atol=1e-12)
            velocity = None if limit is None else float(limit.get("velocity", 0.0)) or None
            assert mine.joint.velocity == velocity
            if element.get("type") != "continuous" and element.find("safety_controller") is None:
                assert limit is not None
                low, high = (float(limit.get(end, "nan")) for end in ("lower", "upper"))
                if low < high:  # false where either is left out
                    expected = (low, high) if high < 1e16 else (-math.inf, math.inf)
                    assert mine.joint.position == expected
                else:
                    assert mine.joint.position is None
    assert read >= 60


def _is_really_faulty(text: str, message: str) -> bool:
    """Whether a refusal has its ground in the file, by the test's own look at it."""
    root = ElementTree.fromstring(text)
    names = {element.get("name") for element in root.findall("joint")}
    leaders = {
        element.find("mimic").get("joint")
        for element in root.findall("joint")
        if element.find("mimic") is not None
    }
    if "has no joints" in message:
        return not names
    return "<mimic>: no joint" in message and not leaders <= names


def test_limits_of_urdf_1_2_and_what_is_left_out() -> None:
    text = urdf(
        '<link name="a"/>',
        joint("full", "a", "b", limit='lower="-1" upper="2" velocity="3" acceleration="4" jerk="5"'),
        joint("turn", "b", "c", kind="continuous", limit='velocity="1.5"'),
        joint("bare", "c", "d", limit=""),
        joint("slide", "d", "e", kind="prismatic", limit='lower="0" upper="0.2" velocity="0"'),
    )
    found = [j.joint for j in parse_urdf(text, "x.urdf").joints]
    full, turn, bare, slide = found
    assert (full.velocity, full.acceleration, full.jerk, full.position) == (3.0, 4.0, 5.0, (-1.0, 2.0))
    assert full.missing == ()
    assert turn.kind is JointKind.CONTINUOUS
    assert turn.position == (-math.inf, math.inf)
    assert turn.missing == ("acceleration", "jerk")
    assert bare.missing == ("velocity", "acceleration", "jerk", "position")
    assert slide.missing == (
        "velocity",
        "acceleration",
        "jerk",
    )  # exporters write 0 where none is known
    assert [j.unit for j in found] == ["rad", "rad", "rad", "m"]


def test_soft_limits_narrow_the_position_limits() -> None:
    soft = '<safety_controller k_velocity="0" soft_lower_limit="-0.5" soft_upper_limit="9"/>'
    (only,) = parse_urdf(urdf('<link name="a"/>', joint("j", "a", "b", more=soft)), "x.urdf").joints
    assert only.joint.position == (-0.5, 3.0)
    wide = soft.replace("-0.5", "-9").replace('"9"', '"0.5"')
    (only,) = parse_urdf(urdf('<link name="a"/>', joint("j", "a", "b", more=wide)), "x.urdf").joints
    assert only.joint.position == (-3.0, 0.5)


def test_meshes_and_other_files_are_never_opened(tmp_path: Path) -> None:
    trap = tmp_path / "mesh.stl"
    text = planar(1.0).replace(
        '<link name="base"/>',
        f'<link name="base"><visual><geometry><mesh filename="{trap}"/></geometry></visual></link>'
        f'<gazebo><plugin filename="{trap}"/></gazebo>',
    )
    assert len(parse_urdf(text, "x.urdf").joints) == 2
    assert list(tmp_path.iterdir()) == []


BASE = '<link name="a"/>'
FAULTS = [
    (joint("j", "a", "b", limit='jerk="1e-12"'), "joint 'j': <limit>: jerk 1e-12 is below 1e-09"),
    ("", "has no joints"),
    ("<joint/>", "attribute name is missing"),
    (
        joint("j", "a", "b", kind="revolut"),
        "joint 'j': type 'revolut': the nearest known one is 'revolute'",
    ),
    (joint("j", "aa", "b"), "joint 'j': <parent>: no link 'aa'; the nearest known one is 'a'"),
    (joint("j", "a", "b", xyz="0 0"), "joint 'j': <origin>: xyz: expected 3 numbers, got '0 0'"),
    (joint("j", "a", "b", xyz="0 0 nan"), "joint 'j': <origin>: xyz: 'nan' is not a finite number"),
    (joint("j", "a", "b", xyz="0 0 1e300"), "joint 'j': <origin>: xyz: 1e+300 is beyond 1e+09"),
    (joint("j", "a", "b", axis="0 0 0"), "joint 'j': <axis>: xyz '0 0 0' is zero"),
    (joint("j", "a", "b", limit='velocity="-1"'), "joint 'j': <limit>: velocity -1 is negative"),
    (
        joint("j", "a", "b", limit='jerk="inf"'),
        "joint 'j': <limit>: jerk: 'inf' is not a finite number",
    ),
    (joint("j", "a", "b", limit='velocity="${v}"'), "is a xacro file; expand it first"),
    (
        joint("j", "a", "b", limit='lower="2" upper="1"'),
        "joint 'j': <limit>: lower 2 is not below upper 1",
    ),
    (joint("j", "a", "b") + joint("j", "b", "c"), "joint 'j' is given twice"),
    (joint("j", "a", "b") + '<link name="b"/>', "link 'b' is given twice"),
    (joint("j", "a", "b") + joint("k", "b", "a").replace('<link name="a"/>', ""), "go in a circle"),
    (joint("j", "a", "b") + '<link name="c"/>', "has several root links: 'a', 'c'"),
    (joint("j", "a", "b", more='<mimic joint="k"/>'), "joint 'j': <mimic>: no joint 'k'"),
    (joint("j", "a", "b", more='<limit velocity="1"/>'), "joint 'j': <limit> is given twice"),
    (joint("j", "a", "b").replace('<child link="b"/>', ""), "joint 'j': <child> is missing"),
    (
        joint("j", "a", "b") + joint("k", "a", "b").replace('<link name="b"/>', ""),
        "joint 'k': link 'b' is already moved by joint 'j'",
    ),
]


@pytest.mark.parametrize(("parts", "reason"), FAULTS)
def test_faults_are_named_in_one_line(parts: str, reason: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_urdf(urdf(BASE, parts), "x.urdf")
    assert reason in str(caught.value)
    assert str(caught.value).startswith("x.urdf")
    assert "\n" not in str(caught.value)


def test_the_line_of_a_fault_is_that_of_its_element() -> None:
    lines = planar(1.0).replace("<", "\n<").splitlines()
    row = next(k for k, line in enumerate(lines) if line.startswith("<limit"))
    lines[row] = '<limit velocity="fast"/>'
    with pytest.raises(
        InputError, match=rf"x.urdf: line {row + 1}: joint 'joint1': <limit>: velocity: 'fast'"
    ):
        parse_urdf("\n".join(lines), "x.urdf")


@pytest.mark.parametrize(
    "text",
    [
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="x"><xacro:include filename="y"/></robot>',
        '<robot name="x"><xacro:macro name="m"/></robot>',
    ],
)
def test_xacro_files_are_refused_with_the_line_that_expands_them(text: str) -> None:
    with pytest.raises(
        InputError, match=r"arm.xacro: is a xacro file; expand it first: xacro arm.xacro > robot.urdf"
    ):
        parse_urdf(text, "arm.xacro")


def test_a_comment_left_by_xacro_is_no_xacro() -> None:
    text = planar(1.0).replace("</robot>", "<!-- <xacro:include filename='y'/> --></robot>")
    assert parse_urdf(text, "x.urdf").root == "base"
