"""Waypoints from tables and messages: every order, separator, unit and wrapping; faults by name."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from robot_files import joint, planar, urdf, written

from formulations import InputError
from formulations.robot import Robot, waypoints_of
from formulations.robot.waypoints.reader import parse_waypoints

ARM = urdf(
    '<link name="base"/>',
    joint("hip", "base", "l1"),
    joint("lift", "l1", "l2", kind="prismatic", limit='lower="-1" upper="1" velocity="1"'),
    joint("wrist", "l2", "l3", kind="continuous", limit='velocity="1"'),
    joint("slave", "l3", "l4", kind="continuous", limit="", more='<mimic joint="wrist"/>'),
)
NAMES = ("hip", "lift", "wrist")
ROWS = [[0.1, 0.2, -0.3], [1.5, -0.25, 40.0], [-2.0, 1e-3, 0.0]]


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Robot:
    return Robot.from_urdf(written(tmp_path_factory.mktemp("arm"), "arm.urdf", ARM))


def _read(robot: Robot, text: str, name: str = "w.csv", **units: str) -> np.ndarray:
    return parse_waypoints(text.encode(), name, robot, **units)


def _csv(
    rows: list[list[float]], header: tuple[str, ...] | None, separator: str, spell: str = "{!r}"
) -> str:
    lines = [] if header is None else [separator.join(header)]
    return "\n".join([*lines, *(separator.join(spell.format(x) for x in row) for row in rows)])


@given(
    order=st.permutations(range(3)),
    separator=st.sampled_from([",", ";", "\t", " ", "   ", ", "]),
    prefix=st.sampled_from(["", "position_"]),
    end=st.sampled_from(["\n", "\r\n"]),
    mark=st.sampled_from(["", "\ufeff"]),
    tail=st.sampled_from(["", "\n", "\n\n# end\n"]),
    rows=st.lists(st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3), min_size=2, max_size=5),
)
def test_the_order_of_columns_and_the_separator_do_not_matter(
    robot: Robot,
    order: list[int],
    separator: str,
    prefix: str,
    end: str,
    mark: str,
    tail: str,
    rows: list[list[float]],
) -> None:
    header = tuple(prefix + NAMES[k] for k in order)
    text = mark + _csv([[row[k] for k in order] for row in rows], header, separator) + tail
    np.testing.assert_array_equal(_read(robot, text.replace("\n", end)), rows)


@pytest.mark.parametrize("separator", [",", ";", "\t", " "])
def test_without_a_header_the_columns_are_the_joints(robot: Robot, separator: str) -> None:
    np.testing.assert_array_equal(_read(robot, _csv(ROWS, None, separator)), ROWS)


def test_quotes_comments_and_decimal_commas(robot: Robot) -> None:
    text = '# from Excel\n"hip";"lift";"wrist"\n0,5;-1e-1;"0,25"\n-0,5;0;1\n'
    np.testing.assert_array_equal(_read(robot, text), [[0.5, -0.1, 0.25], [-0.5, 0.0, 1.0]])


def test_degrees_and_millimetres(robot: Robot) -> None:
    found = _read(robot, "90 500 -45\n45 250 360", unit="deg", length="mm")
    expected = [[math.pi / 2, 0.5, -math.pi / 4], [math.pi / 4, 0.25, 2 * math.pi]]
    np.testing.assert_allclose(found, expected, rtol=1e-15)


def test_degrees_taken_for_radians_are_noticed(robot: Robot) -> None:
    with pytest.raises(InputError) as caught:
        _read(robot, "hip,lift,wrist\n0,0,0\n90,0.5,45\n")
    assert str(caught.value) == (
        "w.csv: waypoint 2: joint 'hip': 90 rad lies outside its position limits [-3, 3] rad; "
        "in degrees all would be inside: unit='deg'?"
    )
    with pytest.raises(
        InputError,
        match=r"waypoint 1: joint 'hip': 200 deg lies outside its .* \[-171.887, 171.887\] deg$",
    ):
        _read(robot, "200 0 0\n0 0 0", unit="deg")
    with pytest.raises(
        InputError, match=r"waypoint 2: joint 'lift': 2 m lies outside its position limits \[-1, 1\] m$"
    ):
        _read(robot, "0 0 0\n0 2 0")


FAULTS = [
    ("hip,lift\n0,0\n0,0", "column: no column for joint 'wrist'"),
    ("hip,wirst,lift\n0,0,0\n0,0,0", "column 'wirst' is no joint; the nearest known one is 'wrist'"),
    ("hip,lift,wrist,time\n0,0,0,0", "column 'time' is no joint; known: hip, lift, wrist"),
    (
        "hip,lift,wrist,slave\n0,0,0,0",
        "column 'slave': joint 'slave' is not among those that are moved",
    ),
    ("hip,lift,wrist,position_hip\n0,0,0,0", "column: joint 'hip' is given twice"),
    ("0,0\n0,0", "line 1: 2 columns without names for 3 joints (hip, lift, wrist)"),
    ("0,0,0\n0,0", "line 2: 2 values for 3 columns (hip, lift, wrist)"),
    ("hip,lift,wrist\n0,0,0\n0,x,0", "line 3: lift: 'x' is not a finite number"),
    ("hip,lift,wrist\n0,0,0\n0,,0", "line 3: lift: '' is not a finite number"),
    ("hip,lift,wrist\n0,0,nan\n0,0,0", "line 2: wrist: 'nan' is not a finite number"),
    ("nan,0,0\n0,0,0", "line 1: hip: 'nan' is not a finite number"),
    ("0,0,inf\n0,0,0", "line 1: wrist: 'inf' is not a finite number"),
    ("0,0,1e300\n0,0,0", "line 1: wrist: '1e300' is beyond 1e+09"),
    ("0,0," + "9" * 5000 + "\n0,0,0", "is beyond 1e+09"),
    ("hip,lift,wrist\n", "has a header and no rows below it"),
    ("hip,lift,wrist\n0,0,0", "1 waypoint; a motion needs two or more"),
    ("# only\n", "has no rows"),
    ('hip,lift,wrist\n0,"0,0\n', "line 2: not valid CSV"),
    ("", "is empty"),
    (" \n", "is empty"),
]


@pytest.mark.parametrize(("text", "reason"), FAULTS)
def test_faulty_tables_are_named_in_one_line(robot: Robot, text: str, reason: str) -> None:
    with pytest.raises(InputError) as caught:
        _read(robot, text)
    assert reason in str(caught.value)
    assert str(caught.value).startswith("w.csv: ")
    assert len(str(caught.value)) < 250


def _message(rows: list[list[float]], names: tuple[str, ...] = NAMES) -> dict[str, object]:
    points = [
        {"positions": row, "time_from_start": {"sec": k, "nanosec": 0}} for k, row in enumerate(rows)
    ]
    return {"header": {"frame_id": ""}, "joint_names": list(names), "points": points}


WRAPPINGS = [
    lambda m: m,
    lambda m: {"joint_trajectory": m, "multi_dof_joint_trajectory": {}},
    lambda m: {"trajectory": m, "goal_time_tolerance": {"sec": 1}},
    lambda m: {"goal": {"trajectory": m}},
    lambda m: {"model_id": "arm", "trajectory": [{"joint_trajectory": m}], "trajectory_start": {}},
]


@pytest.mark.parametrize("wrap", WRAPPINGS)
@pytest.mark.parametrize("order", [(0, 1, 2), (2, 0, 1)])
def test_joint_trajectories_in_all_wrappings(
    robot: Robot, wrap: object, order: tuple[int, ...]
) -> None:
    names, rows = tuple(NAMES[k] for k in order), [[row[k] for k in order] for row in ROWS]
    data = wrap(_message(rows, names))
    np.testing.assert_array_equal(_read(robot, json.dumps(data), "w.json"), ROWS)
    np.testing.assert_array_equal(_read(robot, json.dumps(data), "w.yaml"), ROWS)  # JSON is YAML


def test_what_ros2_topic_echo_prints(robot: Robot) -> None:
    text = """header:
  stamp:
    sec: 0
    nanosec: 0
  frame_id: ''
joint_names:
- wrist
- hip
- lift
points:
- positions:
  - 1.0
  - 0.5
  - 0.25
  velocities: []
  accelerations: []
  effort: []
  time_from_start:
    sec: 1
    nanosec: 0
- positions: [-1, 5e-1, .25]
---
"""
    np.testing.assert_array_equal(_read(robot, text, "w.yml"), [[0.5, 0.25, 1.0], [0.5, 0.25, -1.0]])


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda m: m.pop("joint_names"), "joint_names is missing"),
        (lambda m: m.pop("points"), "points is missing"),
        (
            lambda m: m.update(joint_names=["hip", "lift", "wirst"]),
            "joint_names[2]: 'wirst' is not a joint that is moved; the nearest known one is 'wrist'",
        ),
        (
            lambda m: m.update(joint_names=["hip", "lift"]),
            "joint_names: no joint_names for joint 'wrist'",
        ),
        (
            lambda m: m.update(joint_names=["hip", "lift", "hip"]),
            "joint_names: joint 'hip' is given twice",
        ),
        (
            lambda m: m.update(joint_name=[]),
            "joint_name: unknown key; the nearest known one is 'joint_names'",
        ),
        (lambda m: m["points"][1].pop("positions"), "points[1]: positions are missing"),
        (
            lambda m: m["points"][1].update(positions=[1.0]),
            "points[1].positions: 1 positions for 3 joints",
        ),
        (
            lambda m: m["points"][1].update(position=[1.0]),
            "points[1].position: unknown key; the nearest known one is 'positions'",
        ),
        (
            lambda m: m["points"][1].update(positions=[1.0, "a", 2.0]),
            "points[1].positions[1]: expected a number, got 'a' (joint 'lift')",
        ),
        (
            lambda m: m["points"][1].update(positions=[1.0, float("nan"), 2.0]),
            "nan is not a finite number (joint 'lift')",
        ),
        (
            lambda m: m["points"][1].update(positions=[1.0, True, 2.0]),
            "expected a number, got True (joint 'lift')",
        ),
        (
            lambda m: m["points"][1].update(positions=[1.0, 10**400, 2.0]),
            "inf is not a finite number (joint 'lift')",
        ),
        (lambda m: m.update(points=m["points"][:1]), "1 waypoint; a motion needs two or more"),
        (lambda m: m.update(points=[]), "0 waypoint"),
        (lambda m: m.update(points=7), "points: expected a list, got 7.0"),
    ],
)
def test_faulty_messages_are_named_by_their_key(robot: Robot, change: object, reason: str) -> None:
    message = _message(ROWS)
    change(message)
    with pytest.raises(InputError) as caught:
        _read(robot, json.dumps(message), "w.json")
    assert reason in str(caught.value)
    assert str(caught.value).startswith("w.json: ")


@pytest.mark.parametrize(
    ("text", "name", "reason"),
    [
        (
            '{"jointnames": []}',
            "w.json",
            "neither poses nor a JointTrajectory: key 'jointnames'; the nearest known one is 'joint_names'",
        ),
        ("[]", "w.json", "0 trajectories; one is read"),
        ("[1, 2]", "w.json", "2 trajectories; one is read"),
        ("5", "w.json", "expected keys with values, got 5.0"),
        ('{"points": [], "points": []}', "w.json", "key 'points' is given twice"),
        ('{"points": [}', "w.json", "w.json: line 1: not valid JSON"),
        ("points: [", "w.yaml", "not valid YAML"),
        ("{}", "w.json", "neither poses nor"),
    ],
)
def test_what_is_no_message(robot: Robot, text: str, name: str, reason: str) -> None:
    with pytest.raises(InputError) as caught:
        _read(robot, text, name)
    assert reason in str(caught.value)


def test_files_by_their_suffix(robot: Robot, tmp_path: Path) -> None:
    path = written(tmp_path, "w.TXT", _csv(ROWS, NAMES, "\t"))
    np.testing.assert_array_equal(waypoints_of(path, robot), ROWS)
    with pytest.raises(
        InputError, match=r"waypoints are read from .csv, .txt, .json, .yaml, .yml, not from '.xlsx'"
    ):
        waypoints_of(tmp_path / "w.xlsx", robot)
    with pytest.raises(InputError, match="unit: 'grad' is not one of rad, deg"):
        waypoints_of(path, robot, unit="grad")
    with pytest.raises(InputError, match="length: 'inch' is not one of m, mm"):
        waypoints_of(path, robot, length="inch")


def test_a_robot_may_have_a_joint_called_x(tmp_path: Path) -> None:
    text = planar(1.0, 1.0, 1.0)
    for k, name in enumerate("xyz"):
        text = text.replace(f'name="joint{k + 1}"', f'name="{name}"')
    robot = Robot.from_urdf(written(tmp_path, "a.urdf", text))
    np.testing.assert_array_equal(
        _read(robot, "x,z,y\n1,2,0.5\n0,0,0"), [[1.0, 0.5, 2.0], [0.0, 0.0, 0.0]]
    )
