"""Franka, UR, KUKA and a SCARA, from their files to a verified fastest motion."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from robot_files import ROBOTS, shared, written

from formulations import InputError, Problem, check, free_form
from formulations.robot import Robot, waypoints_of


def _robot(name: str) -> Robot:
    limits = ROBOTS / f"{name}_joint_limits.yaml"
    if name == "panda":
        folder = shared("panda_description/urdf/panda.urdf").parents[1]
        return Robot.from_urdf(
            folder / "urdf" / "panda.urdf",
            srdf=folder / "srdf" / "panda.srdf",
            group="arm",
            limits=limits,
        )
    if name == "ur5":
        urdf = shared("ur_description/urdf/ur5_robot.urdf")
        return Robot.from_urdf(urdf, limits=limits, unlimited="jerk", tip="tool0")
    if name == "iiwa7":
        return Robot.from_urdf(
            ROBOTS / "iiwa7.urdf", srdf=ROBOTS / "iiwa7.srdf", group="arm", limits=limits
        )
    return Robot.from_urdf(ROBOTS / "irb910sc.urdf", limits=limits)


WAYPOINTS = {  # tables as an engineer writes them: in degrees, and m for the prismatic axis
    "panda": ("csv", """\
panda_joint1,panda_joint2,panda_joint3,panda_joint4,panda_joint5,panda_joint6,panda_joint7
0,-45,0,-135,0,90,45
20,-30,10,-120,0,100,60
40,-20,0,-110,-10,100,45
10,-40,0,-130,0,90,30
"""),
    "ur5": ("txt", """# elbow up, without names: base to wrist
0 -90 90 -90 -90 0
45 -70 80 -100 -90 30
90 -100 100 -90 -90 0
"""),
    "iiwa7": ("csv", """\ufefflbr_A7;lbr_A1;lbr_A2;lbr_A3;lbr_A4;lbr_A5;lbr_A6
0;0;30;0;-60;0;60
10;30;40;0;-50;0;70,5
0;60;20;10;-70;0;60
"""),
    "irb910sc": ("csv", """joint_3,joint_1,joint_2,joint_4
0.02,-60,40,0
0.17,-10,60,180
0.02,45,20,-90
0.17,60,-30,0
"""),
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(WAYPOINTS))
def test_from_the_files_to_a_verified_motion(name: str, tmp_path: Path) -> None:
    robot = _robot(name)
    suffix, text = WAYPOINTS[name]
    waypoints = waypoints_of(written(tmp_path, f"path.{suffix}", text), robot, unit="deg")
    problem = Problem.of(waypoints, robot.limits, name=name)
    motion = free_form(problem)
    assert motion.trajectory is not None
    assert check(problem, motion.trajectory).feasible

    # by samples of the test's own, against numbers of the test's own
    velocity, acceleration = _data_sheet(name)
    times = np.linspace(0.0, motion.seconds, 2001)
    for order, limit in ((1, velocity), (2, acceleration)):
        assert (np.abs(motion.trajectory.at(times, order)) <= np.array(limit) * (1 + 1e-6)).all()
    slowest = (np.abs(np.diff(waypoints, axis=0)) / velocity).max(axis=1).sum()
    assert slowest < motion.seconds < 20 * slowest


def _data_sheet(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Velocity and acceleration limits in force, typed once more [rad/s, rad/s^2; m]."""
    if name == "panda":
        return np.array([2.175] * 4 + [2.61] * 3), np.array([15, 7.5, 10, 12.5, 15, 20, 20])
    if name == "ur5":
        return np.full(6, math.pi), np.full(6, 5.0)
    if name == "iiwa7":
        return np.deg2rad([98, 98, 100, 130, 140, 180, 180]), np.full(7, 10.0)
    full = np.array([*np.deg2rad([415.0, 659.0]), 1.02, np.deg2rad(2400.0)])
    return 0.5 * full, 0.5 * 10 * full  # half speed by the limits file


@pytest.mark.parametrize("name", sorted(WAYPOINTS))
def test_the_limits_are_those_of_the_data_sheet(name: str) -> None:
    robot = _robot(name)
    velocity, acceleration = _data_sheet(name)
    np.testing.assert_allclose(robot.limits.velocity, velocity, rtol=1e-9)
    np.testing.assert_allclose(robot.limits.acceleration, acceleration, rtol=1e-9)
    assert robot.units == tuple("m" if kind == "prismatic" else "rad" for kind in robot.kinds)


def test_position_limits_of_the_makers() -> None:
    degrees = {
        "iiwa7": [170, 120, 170, 120, 170, 120, 175],
        "ur5": [360, 360, 180, 360, 360, 360],
    }
    for name, ends in degrees.items():
        expected = np.deg2rad(np.array([[-end, end] for end in ends], dtype=float))
        np.testing.assert_allclose(_robot(name).limits.position, expected, rtol=1e-9)
    panda = [(-2.8973, 2.8973), (-1.7628, 1.7628), (-2.8973, 2.8973), (-3.0718, -0.0698)]
    np.testing.assert_array_equal(_robot("panda").limits.position[:4], panda)
    np.testing.assert_allclose(_robot("irb910sc").limits.position[2], [0.0, 0.18])


def test_ur5_without_a_word_about_its_jerk_is_asked_for_it() -> None:
    urdf = shared("ur_description/urdf/ur5_robot.urdf")
    robot = Robot.from_urdf(urdf, limits=ROBOTS / "ur5_joint_limits.yaml")
    with pytest.raises(
        InputError,
        match=r"jerk of shoulder_pan_joint, .* \(has_jerk_limits: false in the limits file\)",
    ):
        _ = robot.limits


def test_every_file_of_data_says_its_source() -> None:
    for path in sorted(ROBOTS.iterdir()):
        if path.suffix in (".yaml", ".urdf"):
            head = path.read_text("utf-8")[:1500]
            assert re.search(r"Source|Position and velocity:", head), path
            assert re.search(r"Written \d{4}-\d{2}-\d{2}", head), path


def test_five_poses_of_the_panda_in_ten_lines(tmp_path: Path) -> None:
    robot = _robot("panda")
    poses = "poses:\n" + "".join(
        f"  - {{position: [{0.4 + 0.03 * k}, {0.1 * k - 0.2}, 0.5], rpy: [3.14159265, 0, {0.1 * k}]}}\n"
        for k in range(5)
    )
    text = "tip: panda_hand_tcp\nnear: [0, -0.785, 0, -2.356, 0, 1.571, 0.785]\n" + poses
    waypoints = waypoints_of(written(tmp_path, "poses.yaml", text), robot)
    hand = Robot.from_urdf(
        shared("panda_description/urdf/panda.urdf"), joints=robot.names, tip="panda_hand_tcp"
    )
    reached = hand.forward(waypoints)[:, :3, 3]
    np.testing.assert_allclose(
        reached, [[0.4 + 0.03 * k, 0.1 * k - 0.2, 0.5] for k in range(5)], atol=1e-6
    )
    assert np.abs(np.diff(waypoints, axis=0)).max() < 0.6  # no jump to another branch
    motion = free_form(Problem.of(waypoints, robot.limits))
    assert motion.verdict is not None
    assert motion.verdict.feasible
