"""``timebound retime --limits joint_limits.yaml``: with a URDF, or alone by the names in the motion."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_robot import ARM, YAML

from compare.__main__ import main
from formulations import InputError
from formulations.robot import robot_of_joints

# the limits of the small robot, typed here again
VELOCITY = {"turn": 2.0, "bend": 1.0, "slide": 0.5}
ACCELERATION = {"turn": 4.0, "bend": 3.0, "slide": 2.0}
WHOLE = """joint_limits:
  slide: {max_velocity: 0.5, max_acceleration: 2, max_jerk: 20, min_position: 0, max_position: 0.2}
  bend: {max_velocity: 1, max_acceleration: 3, max_jerk: 30, min_position: -2, max_position: 2}
  turn: {max_velocity: 2, max_acceleration: 4, max_jerk: 40, min_position: -3, max_position: 3}
  finger: {max_velocity: 1}
default_velocity_scaling_factor: 0.5
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "arm.urdf").write_text(ARM)
    (tmp_path / "joint_limits.yaml").write_text(YAML)
    (tmp_path / "whole.yml").write_text(WHOLE)
    u = np.linspace(0.0, 1.0, 60)
    table = np.stack([10.0 * u, 0.1 * np.sin(3.0 * u), 0.8 * u, u**2], axis=1)
    for name, header in (
        ("named.csv", "time,position_slide,position_bend,position_turn"),
        ("plain.csv", "time,position_1,position_2,position_3"),
        ("other.csv", "time,position_slide,position_bnd,position_turn"),
    ):
        np.savetxt(tmp_path / name, table, "%.12g", ",", header=header, comments="")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def seconds(folder: Path, *given: str) -> dict[str, Any]:
    """What each way takes; COPP and the free motion are left out of the search by a short path."""
    assert main(["retime", *given, "--tolerance", "0.05", "--json", "out.json"]) == 0
    ways: dict[str, Any] = json.loads((folder / "out.json").read_text())["ways"]
    return ways


def test_the_limits_of_urdf_and_yaml_are_those_of_the_joints_by_name(folder: Path) -> None:
    ways = seconds(folder, "named.csv", "--robot", "arm.urdf", "--limits", "joint_limits.yaml")
    toppra = ways["toppra"]
    assert {"turn", "bend", "slide"} >= {v["name"] for v in toppra["violations"]} != set()
    # TOPP-RA keeps velocity and acceleration: each joint within its own limit, some joint at it
    free = ways["free_form"]
    assert free["feasible"]
    # no joint can be faster than its own bang-bang motion through its largest displacement
    moves = {"slide": 0.1, "bend": 0.8, "turn": 1.0}
    least = max(
        d / VELOCITY[n] + VELOCITY[n] / ACCELERATION[n]
        if d > VELOCITY[n] ** 2 / ACCELERATION[n]
        else 2.0 * (d / ACCELERATION[n]) ** 0.5
        for n, d in moves.items()
    )
    assert free["seconds"] >= least
    assert free["seconds"] <= 1.6 * least


def test_a_file_alone_is_enough_where_it_has_all_limits(folder: Path) -> None:
    alone = seconds(folder, "named.csv", "--limits", "whole.yml")
    # its scaling factor halves every velocity
    found = robot_of_joints(("slide", "bend", "turn"), limits="whole.yml").limits
    np.testing.assert_allclose(found.velocity, [0.25, 0.5, 1.0])
    np.testing.assert_allclose(found.acceleration, [2.0, 3.0, 4.0])
    np.testing.assert_allclose(found.jerk, [20.0, 30.0, 40.0])
    np.testing.assert_allclose(found.position, [[0.0, 0.2], [-2.0, 2.0], [-3.0, 3.0]])
    # joints that are named on the command line, for a motion that names none
    again = seconds(folder, "plain.csv", "--limits", "whole.yml", "--joints", "slide,bend,turn")
    assert again["toppra"]["seconds"] == pytest.approx(alone["toppra"]["seconds"], rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("named.csv",), "--limits: missing"),
        (("plain.csv", "--limits", "whole.yml"), "MOTION: names no joints"),
        (("other.csv", "--limits", "whole.yml"), "no limits file has joint 'bnd'"),
        (("other.csv", "--limits", "whole.yml"), "nearest known one is 'bend'"),
        (("named.csv", "--limits", "joint_limits.yaml"), "velocity of slide, bend, turn"),
        (("named.csv", "--limits", "joint_limits.yaml"), "position of slide, bend, turn"),
        (
            ("named.csv", "--limits", "joint_limits.yaml", "--unlimited", "jrk"),
            "unlimited: 'jrk'",
        ),
        (
            ("named.csv", "--limits", "sr4c", "--unlimited", "jerk"),
            "sr4c is a problem file, which stands alone",
        ),
        (("named.csv", "--limits", "sr4c", "--limits", "whole.yml"), "sr4c is a problem file"),
        (("named.csv", "--robot", "arm.urdf"), "acceleration of slide, bend, turn"),
        (("other.csv", "--robot", "arm.urdf", "--limits", "joint_limits.yaml"), "'bnd'"),
        (
            ("plain.csv", "--limits", "whole.yml", "--joints", "slide,bend"),
            "MOTION: 3 joints, whole.yml has 2",
        ),
        (("named.csv", "--limits", "nowhere.yaml"), "nowhere.yaml: no such file"),
    ],
)
def test_misuse_is_one_line(
    arguments: tuple[str, ...], message: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["retime", *arguments]) == 2
    said = capsys.readouterr()
    assert message in said.err
    assert said.err.startswith("error: ")
    assert said.err.count("\n") == 1


def test_a_joint_that_is_missing_is_an_error_in_python_too(folder: Path) -> None:
    with pytest.raises(InputError, match="no limits file has joint 'elbow'"):
        robot_of_joints(("elbow",), limits=folder / "whole.yml")
    free = ("acceleration", "jerk", "position")
    found = robot_of_joints(("finger",), limits="whole.yml", unlimited=free).limits
    assert found.velocity.tolist() == [0.5]
    assert not np.isfinite(found.position).any()
