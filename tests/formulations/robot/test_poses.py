"""Waypoints from Cartesian poses: all spellings agree; checked by forward kinematics; faults by name."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from robot_files import ROBOTS
from scipy.spatial.transform import Rotation

from formulations import InputError
from formulations.problem.errors import OutOfReach
from formulations.robot import Robot
from formulations.robot.waypoints.reader import parse_waypoints

JOINTS = np.array([[0.3, 0.5, 0.05, -0.2], [0.6, 0.4, 0.10, 0.1], [0.9, 0.3, 0.02, 0.4]])


@pytest.fixture(scope="module")
def scara() -> Robot:
    return Robot.from_urdf(ROBOTS / "irb910sc.urdf")


def _poses(robot: Robot) -> list[tuple[list[float], list[float], list[float]]]:
    """Position, roll-pitch-yaw and quaternion (x, y, z, w) of each pose."""
    found = []
    for pose in robot.forward(JOINTS):
        turn = Rotation.from_matrix(pose[:3, :3])
        found.append((pose[:3, 3].tolist(), turn.as_euler("xyz").tolist(), turn.as_quat().tolist()))
    return found


def _read(robot: Robot, data: object, name: str = "p.yaml", **units: str) -> np.ndarray:
    text = data if isinstance(data, str) else json.dumps(data)
    return parse_waypoints(text.encode(), name, robot, **units)


NEAR = JOINTS[0].tolist()


def test_all_spellings_give_the_joint_positions_that_made_the_poses(scara: Robot) -> None:
    poses = _poses(scara)
    spellings = [
        {"near": NEAR, "poses": [{"position": p, "rpy": a} for p, a, _ in poses]},
        {"near": NEAR, "poses": [{"position": p, "quaternion": q} for p, _, q in poses]},
        {
            "near": dict(zip(scara.names, NEAR, strict=True)),
            "tip": "link_4",
            "base": "base_link",
            "poses": [
                {
                    "position": dict(zip("xyz", p, strict=True)),
                    "orientation": dict(zip("xyzw", q, strict=True)),
                }
                for p, _, q in poses
            ],
        },
        {
            "length": "mm",
            "unit": "deg",
            "near": [math.degrees(NEAR[0]), math.degrees(NEAR[1]), NEAR[2], math.degrees(NEAR[3])],
            "poses": [
                {"position": [1e3 * x for x in p], "rpy": np.rad2deg(a).tolist()} for p, a, _ in poses
            ],
        },
    ]
    for data in spellings:
        for name in ("p.yaml", "p.json"):
            np.testing.assert_allclose(_read(scara, data, name), JOINTS, atol=1e-5)


def test_tables_of_poses(scara: Robot) -> None:
    poses = _poses(scara)
    angles = "\n".join(",".join(map(repr, [*p, *a])) for p, a, _ in poses)
    found = _read(scara, "x,y,z,roll,pitch,yaw\n" + angles, "p.csv")
    np.testing.assert_allclose(scara.forward(found), scara.forward(JOINTS), atol=1e-5)
    turned = "\n".join(";".join(map(repr, [*q, *p])) for p, _, q in poses)
    np.testing.assert_allclose(_read(scara, "qx;qy;qz;qw;x;y;z\n" + turned, "p.csv"), found, atol=1e-6)


def test_rounded_angles_are_reached_as_they_are_meant(scara: Robot) -> None:
    """Four joints cannot do a roll of 2e-5 rad; within 1e-4 rad the pose counts as reached."""
    (p, a, _), *_ = _poses(scara)
    data = {"near": NEAR, "poses": [{"position": p, "rpy": [2e-5, 0.0, a[2]]}] * 2}
    np.testing.assert_allclose(_read(scara, data), [JOINTS[0]] * 2, atol=1e-4)


def test_another_tip_and_base(scara: Robot) -> None:
    robot = Robot.from_urdf(ROBOTS / "iiwa7.urdf")
    q = np.array([[0.2, 0.4, 0.1, -0.9, 0.2, 0.6, 0.1], [0.3, 0.5, 0.1, -1.0, 0.2, 0.6, 0.2]])
    flange = Robot.from_urdf(ROBOTS / "iiwa7.urdf", tip="lbr_flange").forward(q)
    poses = [
        {
            "position": T[:3, 3].tolist(),
            "quaternion": Rotation.from_matrix(T[:3, :3]).as_quat().tolist(),
        }
        for T in flange
    ]
    found = _read(robot, {"tip": "lbr_flange", "near": q[0].tolist(), "poses": poses})
    np.testing.assert_allclose(
        Robot.from_urdf(ROBOTS / "iiwa7.urdf", tip="lbr_flange").forward(found), flange, atol=1e-5
    )


def test_out_of_reach_says_which_pose_and_by_how_much(scara: Robot) -> None:
    data = {
        "poses": [
            {"position": [0.5, 0.0, -0.1], "rpy": [0, 0, 0]},
            {"position": [0.9, 0.0, -0.1], "rpy": [0, 0, 0]},
        ]
    }
    with pytest.raises(OutOfReach) as caught:
        _read(scara, data)
    assert str(caught.value) == "p.yaml: link 'link_4': pose 2: its position is out of reach by 0.25 m"
    assert caught.value.distance == pytest.approx(0.25, abs=1e-6)


POSE = {"position": [0.5, 0.0, -0.1], "rpy": [0, 0, 0]}


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (
            {"poses": [{**POSE, "rpyy": 1}]},
            "p.yaml: line 1: poses[0].rpyy: unknown key; the nearest known one is 'rpy'",
        ),
        (
            {"poses": [{"position": [1, 2, 3]}]},
            "poses[0]: expected one of rpy, quaternion and orientation, got 0",
        ),
        (
            {"poses": [{**POSE, "quaternion": [0, 0, 0, 1]}]},
            "expected one of rpy, quaternion and orientation, got 2",
        ),
        ({"poses": [{"rpy": [0, 0, 0]}]}, "poses[0]: position is missing"),
        (
            {"poses": [{**POSE, "position": [1, 2]}]},
            "poses[0].position: 2 numbers where 3 are expected",
        ),
        ({"poses": [{**POSE, "position": {"x": 1, "y": 2}}]}, "poses[0].position: z is missing"),
        (
            {"poses": [{**POSE, "position": {"x": 1, "y": 2, "Z": 3}}]},
            "position.Z: unknown key; the nearest known one is 'z'",
        ),
        (
            {"poses": [{"position": [0, 0, 0], "quaternion": [0, 0, 0, 0.5]}]},
            "the quaternion (x, y, z, w) has norm 0.5, not 1",
        ),
        (
            {"poses": [{**POSE, "position": [500, 0, 1e6]}]},
            "1e+06 m from the base; give length: mm if it is mm",
        ),
        ({"poses": []}, "poses: holds no pose"),
        ({"poses": [POSE], "unit": "grad"}, "unit: 'grad' is not one of rad, deg"),
        ({"poses": [POSE], "tip": "link_9"}, "tip: no link 'link_9'; the nearest known one is 'link_"),
        ({"poses": [POSE], "base": 5}, "base: expected text, got 5.0"),
        (
            {"poses": [POSE], "near": [1.0]},
            "near: 1 positions for 4 joints (joint_1, joint_2, joint_3, joint_4)",
        ),
        (
            {"poses": [POSE], "near": {"joint_1": 1.0}},
            "near: no position for 'joint_2', 'joint_3', 'joint_4'",
        ),
        (
            {"poses": [POSE], "near": {"joint_11": 1.0}},
            "near: no joint 'joint_11'; the nearest known one is 'joint_1'",
        ),
        ({"poses": [POSE]}, "1 waypoint; a motion needs two or more"),
        ({"poses": [POSE], "points": []}, "points: unknown key; known: poses, tip"),
    ],
)
def test_faults_are_named(scara: Robot, data: object, reason: str) -> None:
    with pytest.raises(InputError) as caught:
        _read(scara, data)
    assert reason in str(caught.value)
    assert str(caught.value).startswith("p.yaml: ")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("x,y,z,roll,pitch\n0,0,0,0,0", "columns are missing: yaw"),
        ("x,y,z,roll,pitch,yaw,time\n0,0,0,0,0,0,0", "column 'time'"),
        ("x,y,z,roll,pitch,yaw,x\n0,0,0,0,0,0,0", "column 'x' is given twice"),
        (
            "x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,2\n",
            "p.csv: line 2: the quaternion (x, y, z, w) has norm 2, not 1",
        ),
    ],
)
def test_faulty_tables(scara: Robot, text: str, reason: str) -> None:
    with pytest.raises(InputError) as caught:
        _read(scara, text, "p.csv")
    assert reason in str(caught.value)


def test_the_example_of_the_module_reads(tmp_path: Path) -> None:
    from formulations.robot.waypoints import poses

    lines = (poses.__doc__ or "").splitlines()
    block = [line[4:] for line in lines if line.startswith("    ")]
    text = "\n".join(line.split("  #")[0] for line in block)
    found = poses.poses_of_entry(
        __import__("formulations.robot.text.trees", fromlist=["x"]).parse_yaml(text, "doc")
    )
    assert len(found.poses) == 2
    np.testing.assert_allclose(found.poses[1][:3, :3], np.diag([1.0, -1.0, -1.0]), atol=1e-12)
