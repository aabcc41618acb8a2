"""Forward kinematics against products written by hand and yourdfpy; Jacobians by differences."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from robot_files import ROBOTS, joint, planar, shared, urdf, written

from formulations import InputError
from formulations.robot import Robot


def _turn(axis: str, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    T = np.eye(4)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    T[i, i], T[i, j], T[j, i], T[j, j] = c, -s, s, c
    return T


def _move(x: float, y: float, z: float) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def _product(*factors: np.ndarray) -> np.ndarray:
    return np.linalg.multi_dot(factors)


def _random(robot: Robot, count: int) -> np.ndarray:
    low, high = np.clip(np.array([joint.position for joint in robot.joints]).T, -4.0, 4.0)
    return np.random.default_rng(1).uniform(low, high, (count, robot.dof))


def test_iiwa_by_the_dimensions_of_its_data_sheet() -> None:
    robot = Robot.from_urdf(ROBOTS / "iiwa7.urdf", srdf=ROBOTS / "iiwa7.srdf", group="arm")
    assert (robot.base, robot.tip) == ("lbr_link_0", "lbr_flange")
    np.testing.assert_allclose(robot.forward(np.zeros(7)), _move(0, 0, 1.266), atol=1e-15)
    for q in _random(robot, 20):
        expected = _product(
            _turn("z", q[0]),
            _move(0, 0, 0.34),
            _turn("y", q[1]),
            _turn("z", q[2]),
            _move(0, 0, 0.4),
            _turn("y", -q[3]),
            _turn("z", q[4]),
            _move(0, 0, 0.4),
            _turn("y", q[5]),
            _turn("z", q[6]),
            _move(0, 0, 0.126),
        )
        np.testing.assert_allclose(robot.forward(q), expected, atol=1e-13)


def test_scara_by_the_dimensions_of_its_data_sheet() -> None:
    robot = Robot.from_urdf(ROBOTS / "irb910sc.urdf")
    for q in _random(robot, 20):
        expected = _product(
            _turn("z", q[0]),
            _move(0.4, 0, 0),
            _turn("z", q[1]),
            _move(0.25, 0, -q[2]),
            _turn("z", q[3]),
        )
        np.testing.assert_allclose(robot.forward(q), expected, atol=1e-13)


@pytest.mark.parametrize(
    ("ending", "joints", "tip"),
    [
        (
            "panda_description/urdf/panda.urdf",
            [f"panda_joint{k}" for k in range(1, 8)],
            "panda_hand_tcp",
        ),
        ("ur_description/urdf/ur5_robot.urdf", None, "tool0"),
        ("kinova_description/robots/kinova.urdf", None, None),
        ("xarm_description/urdf/xarm7.urdf", None, None),
        ("z1_description/urdf/z1.urdf", None, None),
    ],
)
def test_as_yourdfpy_has_it(ending: str, joints: list[str] | None, tip: str | None) -> None:
    import yourdfpy

    path = shared(ending)
    robot = Robot.from_urdf(path, joints=joints, tip=tip)
    other = yourdfpy.URDF.load(io.BytesIO(path.read_bytes()), load_meshes=False)
    for q in _random(robot, 5):
        other.update_cfg(dict(zip(robot.names, q.tolist(), strict=True)))
        np.testing.assert_allclose(
            robot.forward(q), other.get_transform(robot.tip, robot.base), atol=1e-12
        )


def test_followers_move_with_their_leader_and_a_chain_may_go_up_and_down(tmp_path: Path) -> None:
    text = urdf(
        '<link name="base"/>',
        joint("hip", "base", "torso", xyz="0 0 1", axis="0 0 2"),
        joint("left", "torso", "l", xyz="0 1 0", rpy="0.3 0 0.2", axis="0 1 0"),
        joint("slide", "torso", "r", kind="prismatic", xyz="0 -1 0", axis="3 0 0"),
        joint(
            "follow", "r", "f", xyz="0.5 0 0", more='<mimic joint="left" multiplier="-2" offset="0.1"/>'
        ),
    )
    path = written(tmp_path, "x.urdf", text)
    robot = Robot.from_urdf(path, base="l", tip="f")
    assert robot.names == ("hip", "left", "slide")
    rng = np.random.default_rng(0)
    for hip, left, slide in rng.uniform(-1, 1, (10, 3)):
        fixed = _product(_move(0, 1, 0), _turn("z", 0.2), _turn("x", 0.3))
        to_l = _product(fixed, _turn("y", left))
        to_f = _product(
            _move(0, -1, 0), _move(slide, 0, 0), _move(0.5, 0, 0), _turn("z", -2 * left + 0.1)
        )
        np.testing.assert_allclose(
            robot.forward([hip, left, slide]), np.linalg.inv(to_l) @ to_f, atol=1e-14
        )
    _check_jacobian(robot)


def _check_jacobian(robot: Robot) -> None:
    h = 1e-6
    for q in np.clip(_random(robot, 5), -1.0, 1.0):
        pose, jacobian = (found[0] for found in robot.chain.pose_and_jacobian(q[None]))
        np.testing.assert_allclose(pose, robot.forward(q), atol=1e-15)
        for k in range(robot.dof):
            step = h * np.eye(robot.dof)[k]
            ahead, behind = robot.forward(q + step), robot.forward(q - step)
            np.testing.assert_allclose(
                jacobian[:3, k], (ahead[:3, 3] - behind[:3, 3]) / (2 * h), atol=1e-8
            )
            spin = (ahead[:3, :3] - behind[:3, :3]) / (2 * h) @ pose[:3, :3].T
            np.testing.assert_allclose(jacobian[3:, k], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-8)


@pytest.mark.parametrize("name", ["iiwa7.urdf", "irb910sc.urdf"])
def test_jacobian_by_differences(name: str) -> None:
    _check_jacobian(Robot.from_urdf(ROBOTS / name))


def test_a_batch_is_its_rows() -> None:
    robot = Robot.from_urdf(ROBOTS / "iiwa7.urdf")
    q = _random(robot, 6).reshape(2, 3, 7)
    np.testing.assert_allclose(robot.forward(q)[1, 2], robot.forward(q[1, 2]), atol=1e-15)


def test_a_moving_joint_on_the_way_that_is_not_moved_is_named(tmp_path: Path) -> None:
    path = written(tmp_path, "x.urdf", planar(1.0, 1.0, 1.0))
    robot = Robot.from_urdf(path, joints=["joint1", "joint3"])
    with pytest.raises(
        InputError, match=r"joint 'joint2' between links 'base' and 'link3' moves, but is not among"
    ):
        _ = robot.chain
