"""A new problem file: from files, from options, from answers; nothing is invented, nothing replaced."""

from __future__ import annotations

import io
import math
import sys
from pathlib import Path

import numpy as np
import pytest
from small_robot import ARM, CSV, YAML

from compare.__main__ import main
from compare.commands.motions import new as module
from formulations import load, parse


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "robots").mkdir()
    (tmp_path / "robots" / "arm.urdf").write_text(ARM)
    (tmp_path / "robots" / "joint_limits.yaml").write_text(YAML)
    (tmp_path / "path.csv").write_text(CSV)
    monkeypatch.chdir(tmp_path)
    return tmp_path


URDF = ("--from-urdf", "robots/arm.urdf")
OWN = (*URDF, "--limits", "robots/joint_limits.yaml", "--waypoints", "path.csv", "--unit", "deg")


def answers(monkeypatch: pytest.MonkeyPatch, *lines: str) -> None:
    monkeypatch.setattr(module, "at_a_terminal", lambda: True)
    monkeypatch.setattr(sys, "stdin", io.StringIO("".join(f"{line}\n" for line in lines)))


def test_a_file_from_a_robot_and_its_files_loads_from_anywhere(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "below").mkdir()
    assert main(["new", *OWN, "-o", "below/mine.toml"]) == 0
    said = capsys.readouterr().out
    assert "below/mine.toml: written, 3 waypoints of 3 joints" in said
    assert "next: timebound plan below/mine.toml" in said
    text = (folder / "below" / "mine.toml").read_text()
    assert 'robot = "../robots/arm.urdf"' in text
    assert "# " in text
    monkeypatch.chdir("/")
    problem = load(folder / "below" / "mine.toml")
    assert problem.name == "mine"
    assert problem.names == ("turn", "bend", "slide")
    np.testing.assert_allclose(problem.waypoints[1], [math.pi / 4, -math.pi / 9, 0.1])
    np.testing.assert_allclose(problem.limits.jerk, [40, 30, 20])


def test_a_missing_limit_is_taken_from_an_option_and_never_invented(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = [*URDF, "--waypoints", "path.csv", "--unit", "deg"]
    assert main(["new", *own]) == 2
    line = capsys.readouterr().err
    assert "limits are missing: acceleration of turn, bend, slide; jerk of" in line
    assert "or give --velocity, --acceleration" in line
    assert not (folder / "problem.toml").exists()
    assert main(["new", *own, "--acceleration", "180,90,2", "--unlimited", "jerk"]) == 0
    limits = load(folder / "problem.toml").limits
    np.testing.assert_allclose(limits.acceleration, [math.pi, math.pi / 2, 2])
    assert not limits.has_jerk


def test_a_missing_limit_is_asked_for_joint_by_joint(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    answers(monkeypatch, "deg", "180", "lots", "-3", "90", "2", "none", "none", "none", "path.csv")
    assert main(["new", *URDF]) == 0
    said = capsys.readouterr().err
    assert "acceleration limit of joint turn [deg/s²]; none: unlimited: " in said
    assert "acceleration limit of joint slide [m/s²]" in said
    assert "'lots' is not a number" in said
    assert "-3 is not positive" in said
    limits = load(folder / "problem.toml").limits
    np.testing.assert_allclose(limits.acceleration, [math.pi, math.pi / 2, 2])
    assert not limits.has_jerk


def test_a_file_without_a_robot_from_options_and_from_answers(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = ("--joints", "a,b", "--velocity", "90,120", "--acceleration", "300", "--unlimited", "jerk")
    rows = ("--waypoint", "0,10", "--waypoint", "-20,-15", "--waypoint", "60,0")
    assert main(["new", *given, *rows, "--unit", "deg"]) == 0
    expected = parse("""name = "problem"
unit = "deg"
joints = ["a", "b"]
waypoints = [[0, 10], [-20, -15], [60, 0]]
[limits]
velocity = [90, 120]
acceleration = 300
""")
    assert load(folder / "problem.toml") == expected
    answers(monkeypatch, "a, b", "deg", "90 120", "300", "none", "0,10", "-20,-15", "1,2,3", "60,0", "")
    assert main(["new", "-o", "problem.toml", "--force"]) == 0
    assert load(folder / "problem.toml") == expected


def test_a_file_that_is_there_is_kept(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "mine.toml").write_text("precious")
    assert main(["new", *OWN, "-o", "mine.toml"]) == 2
    assert "mine.toml is there already; --force replaces it" in capsys.readouterr().err
    assert (folder / "mine.toml").read_text() == "precious"
    assert main(["new", *OWN, "-o", "mine.toml", "--force"]) == 0
    assert load(folder / "mine.toml").dof == 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "--joints: missing: names of the joints, or a robot"),
        (("--joints", "a"), "--velocity: missing"),
        (("--joints", "a", "--velocity", "-1"), "--velocity: -1 is not positive"),
        (("--joints", "a,b", "--velocity", "1,2,3"), "--velocity: 3 numbers where 1 or 2 are expected"),
        (("--group", "arm"), "--group: needs a robot"),
        ((*URDF, "--limits", "nowhere.yaml"), "nowhere.yaml: no such file"),
        ((*OWN[:4],), "--waypoints: missing"),
        ((*OWN[:6],), "in degrees all would be inside"),
        ((*OWN, "--waypoint", "1,2,3"), "--waypoint: given beside --waypoints"),
        ((*OWN[:4], "--waypoint", "1,2"), "--waypoint: '1,2': 2 numbers for 3 joints"),
        ((*OWN, "-o", "nowhere/mine.toml"), "nowhere is no folder"),
        ((*OWN, "--acceleration", "1,2"), "--acceleration: 2 numbers where 1 or 3"),
    ],
)
def test_misuse_is_one_line_and_nothing_is_written(
    arguments: tuple[str, ...],
    message: str,
    folder: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    before = sorted(folder.rglob("*"))
    assert main(["new", *arguments]) == 2
    said = capsys.readouterr()
    assert said.err.startswith("error: "), said.err
    assert message in said.err
    assert said.err.count("\n") == 1
    assert sorted(folder.rglob("*")) == before


def test_answers_that_end_early_are_one_line(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    answers(monkeypatch, "a")
    assert main(["new"]) == 2
    assert "no answer was given" in capsys.readouterr().err
    assert not (folder / "problem.toml").exists()


@pytest.mark.parametrize("name", ['qu"ote', "back\\slash", "dél\x7f", "ünïcode"])
def test_any_name_is_written_so_that_it_is_read_back(name: str, folder: Path) -> None:
    assert main(["new", *OWN, "--name", name, "--force"]) == 0
    assert load(folder / "problem.toml").name == name


def test_waypoints_of_a_robot_are_typed_row_by_row(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    own = (*URDF, "--limits", "robots/joint_limits.yaml")
    # nothing in place of a file; a row too short is asked for again; nothing ends the list
    answers(monkeypatch, "deg", "", "0,10,0", "1,2", "45 -20 0.1", "90 30 0.2", "")
    assert main(["new", *own]) == 0
    said = capsys.readouterr().err
    assert "waypoint 1: turn [deg], bend [deg], slide [m]: " in said
    assert "2 numbers for 3 joints" in said
    typed = load(folder / "problem.toml")
    assert main(["new", *own, "--unit", "deg", "--waypoints", "path.csv", "-o", "read.toml"]) == 0
    read = load(folder / "read.toml")
    np.testing.assert_allclose(typed.waypoints, read.waypoints, atol=1e-15)
    assert typed.limits == read.limits
    rows = ("--waypoint", "0,10,0", "--waypoint", "45,-20,0.1", "--waypoint", "90,30,0.2")
    assert main(["new", *own, "--unit", "deg", *rows, "-o", "given.toml"]) == 0
    np.testing.assert_array_equal(load(folder / "given.toml").waypoints, typed.waypoints)


def test_a_file_from_limits_and_waypoints_without_a_urdf(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = ("--limits", "robots/joint_limits.yaml", "--waypoints", "path.csv", "--unit", "deg")
    more = ("--prismatic", "slide", "--unlimited", "position")
    assert main(["new", *files, *more]) == 2
    assert "limits are missing: velocity of bend, turn, slide" in capsys.readouterr().err
    assert main(["new", *files, *more, "--velocity", "90,45,0.5"]) == 0
    text = (folder / "problem.toml").read_text()
    assert "robot =" not in text
    assert 'limits_file = ["robots/joint_limits.yaml"]' in text
    problem = load(folder / "problem.toml")
    assert problem.names == ("bend", "turn", "slide")
    assert problem.units == ("rad", "rad", "m")
    np.testing.assert_allclose(problem.limits.velocity, [math.pi / 2, math.pi / 4, 0.5])
    np.testing.assert_allclose(problem.waypoints[1], [-math.pi / 9, math.pi / 4, 0.1])
    assert main(["new", *URDF, *files, "--prismatic", "slide", "--force"]) == 2
    assert "--prismatic: given beside --from-urdf" in capsys.readouterr().err
