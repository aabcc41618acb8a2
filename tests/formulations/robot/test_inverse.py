"""Inverse kinematics: checked by forward kinematics; nearest branch by a search of the test's own; reach."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from robot_files import ROBOTS, planar, shared, written
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from formulations import InputError
from formulations.problem.errors import OutOfReach
from formulations.robot import Robot, inverse


def _robot(name: str) -> Robot:
    if name == "ur5":
        return Robot.from_urdf(shared("ur_description/urdf/ur5_robot.urdf"), tip="tool0")
    if name == "panda":
        joints = [f"panda_joint{k}" for k in range(1, 8)]
        return Robot.from_urdf(shared("panda_description/urdf/panda.urdf"), joints=joints)
    return Robot.from_urdf(ROBOTS / f"{name}.urdf")


def _path(robot: Robot, count: int, seed: int = 0) -> np.ndarray:
    low, high = np.array([joint.position for joint in robot.joints]).T
    low, high = np.maximum(low, -3.0), np.minimum(high, 3.0)
    return np.random.default_rng(seed).uniform(low, high, (count, robot.dof))


@pytest.mark.parametrize("name", ["ur5", "panda", "iiwa7", "irb910sc"])
def test_the_answer_reaches_the_pose_within_the_limits(name: str) -> None:
    robot = _robot(name)
    low, high = np.array([joint.position for joint in robot.joints]).T
    poses = robot.forward(_path(robot, 6))
    found = robot.inverse(poses)
    reached = robot.forward(found)
    np.testing.assert_allclose(reached[:, :3, 3], poses[:, :3, 3], atol=2e-6)
    np.testing.assert_allclose(reached[:, :3, :3], poses[:, :3, :3], atol=2e-4)
    assert (found >= low).all()
    assert (found <= high).all()


@pytest.mark.parametrize("name", ["ur5", "panda", "iiwa7", "irb910sc"])
def test_a_small_step_stays_on_the_branch(name: str) -> None:
    """The joint positions that made the pose are near by: the answer is as near or nearer."""
    robot = _robot(name)
    low, high = np.array([joint.position for joint in robot.joints]).T
    for start in _path(robot, 4, seed=3):
        aside = np.clip(start + 0.05 * np.cos(np.arange(robot.dof)), low, high)
        found = robot.inverse(robot.forward(aside)[None], near=start)[0]
        assert np.linalg.norm(found - start) <= np.linalg.norm(aside - start) + 1e-6


@pytest.mark.slow
def test_the_nearest_branch_of_ur5_among_all_that_a_search_finds() -> None:
    robot = _robot("ur5")
    rng = np.random.default_rng(5)
    for q in _path(robot, 3, seed=7):
        pose, near = robot.forward(q), rng.uniform(-2, 2, 6)
        best = float(np.linalg.norm(robot.inverse(pose[None], near=near)[0] - near))

        def miss(x: np.ndarray, pose: np.ndarray = pose) -> float:
            T = robot.forward(x)
            turn = Rotation.from_matrix(T[:3, :3].T @ pose[:3, :3]).magnitude()
            return float(np.sum((T[:3, 3] - pose[:3, 3]) ** 2) + turn**2)

        for start in rng.uniform(-3, 3, (12, 6)):
            other = minimize(miss, start, method="BFGS", options={"gtol": 1e-9})
            if other.fun < 1e-10:
                x = other.x + 2 * np.pi * np.round((near - other.x) / (2 * np.pi))
                assert best <= np.linalg.norm(x - near) + 1e-3


def test_closed_forms_and_newton_steps_alone_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = _robot("ur5")
    poses = robot.forward(_path(robot, 4, seed=11))
    with_eaik = robot.inverse(poses)
    monkeypatch.setattr(inverse, "_closed_forms", lambda chain, pose: np.empty((0, chain.dof)))
    alone = robot.inverse(poses)
    middle = np.zeros(6)
    assert np.linalg.norm(with_eaik[0] - middle) <= np.linalg.norm(alone[0] - middle) + 1e-6


def test_a_redundant_arm_moves_no_farther_than_it_must() -> None:
    """Seven joints, one pose: no self-motion leads nearer to the start, to first order."""
    robot = _robot("iiwa7")
    for start, goal in zip(_path(robot, 3, seed=2), _path(robot, 3, seed=4), strict=True):
        goal = start + 0.2 * (goal - start) / np.linalg.norm(goal - start)
        found = robot.inverse(robot.forward(goal)[None], near=start)[0]
        _, jacobian = robot.chain.pose_and_jacobian(found[None])
        still = np.linalg.svd(jacobian[0])[2][6:]
        assert np.linalg.norm(still @ (found - start)) < 1e-4
        assert np.linalg.norm(found - start) <= 0.2 + 1e-6


def test_whole_turns_are_added_towards_the_last_waypoint() -> None:
    robot = _robot("irb910sc")
    q = np.array([0.3, 0.4, 0.1, -0.2])
    near = np.array([0.3, 0.4, 0.1, 6.0])
    found = robot.inverse(robot.forward(q)[None], near=near)[0]
    np.testing.assert_allclose(found, [0.3, 0.4, 0.1, -0.2 + 2 * np.pi], atol=1e-6)
    far = robot.inverse(robot.forward(q)[None], near=[0.3, 0.4, 0.1, 8.0])[0]
    np.testing.assert_allclose(far[3], -0.2 + 2 * np.pi, atol=1e-6)  # not -0.2 + 4 pi: limit 400 deg


@pytest.mark.parametrize("distance", [1e-3, 0.5, 100.0])
def test_out_of_reach_says_by_how_much(tmp_path: Path, distance: float) -> None:
    robot = Robot.from_urdf(written(tmp_path, "x.urdf", planar(1.0, 0.7, 0.3)), tip="tip")
    pose = np.eye(4)
    pose[:3, 3] = 2.0 + distance, 0.0, 0.0
    with pytest.raises(OutOfReach, match="pose 1: its position is out of reach by") as caught:
        robot.inverse(pose[None])
    assert caught.value.distance == pytest.approx(distance, rel=1e-3)
    pose[:3, 3] = 0.0, 1.0, distance  # beside the plane
    with pytest.raises(OutOfReach) as caught:
        robot.inverse(pose[None])
    assert caught.value.distance == pytest.approx(distance, rel=1e-3)
    assert isinstance(caught.value, InputError)


def test_an_orientation_out_of_reach_is_said_to_be_that() -> None:
    robot = _robot("irb910sc")
    pose = robot.forward([0.3, 0.4, 0.1, 0.2])
    pose[:3, :3] = pose[:3, :3] @ Rotation.from_rotvec([0.5, 0.0, 0.0]).as_matrix()
    with pytest.raises(
        OutOfReach, match=r"position is within reach, but not with this orientation.* 28\.6 deg"
    ):
        robot.inverse(pose[None])


def test_a_joint_whose_limit_is_in_the_way_is_named(tmp_path: Path) -> None:
    narrow = planar(1.0, limit='lower="-1" upper="1" velocity="2"')
    robot = Robot.from_urdf(written(tmp_path, "x.urdf", narrow), tip="tip")
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = (
        Rotation.from_rotvec([0, 0, 1.25]).as_matrix(),
        [np.cos(1.25), np.sin(1.25), 0],
    )
    with pytest.raises(
        OutOfReach,
        match=r"pose 1: no solution keeps the position limits; .* that of joint 'joint1' by 0\.25 rad",
    ):
        robot.inverse(pose[None])


def test_faulty_arguments() -> None:
    robot = _robot("irb910sc")
    with pytest.raises(InputError, match=r"poses: expected shape \(n, 4, 4\)"):
        robot.inverse(np.eye(3))
    with pytest.raises(InputError, match="near: expected 4 finite joint positions"):
        robot.inverse(np.eye(4)[None], near=[0.0, 1.0])


def test_a_path_through_a_singular_pose_stays_on_its_branch() -> None:
    """The wrist of UR5 turns through zero, where two axes are in line and the branches meet."""
    robot = _robot("ur5")
    path = np.array([[0.3, -1.2, 1.4, -0.5, angle, 0.7] for angle in np.linspace(0.2, -0.2, 9)])
    found = robot.inverse(robot.forward(path), near=path[0])
    reached = robot.forward(found)
    np.testing.assert_allclose(reached, robot.forward(path), atol=2e-4)
    np.testing.assert_allclose(found[4], path[4], atol=1e-3)
    assert np.abs(np.diff(found, axis=0)).max() < 0.5


def test_branches_of_a_singular_pose_are_not_lost() -> None:
    """EAIK drops some where two axes are in line; one of them is the nearest here, 1.2204 rad away."""
    robot = _robot("ur5")
    rng = np.random.default_rng(1)
    for _ in range(12):
        q = rng.uniform(-2, 2, 6)
        q[4] = 0.0
        near = q + rng.uniform(-1, 1, 6)
    pose = robot.forward(q)
    found = robot.inverse(pose[None], near=near)[0]
    assert np.linalg.norm(found - near) < 1.2205
    np.testing.assert_allclose(robot.forward(found), pose, atol=2e-4)
