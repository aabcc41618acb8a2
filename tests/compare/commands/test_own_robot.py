"""A robot's files and waypoints in place of a problem file: the same motion, and one line for misuse."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from small_robot import ARM, CSV, FILE, YAML

from compare.__main__ import main


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "robots").mkdir()
    (tmp_path / "robots" / "arm.urdf").write_text(ARM)
    (tmp_path / "robots" / "joint_limits.yaml").write_text(YAML)
    (tmp_path / "path.csv").write_text(CSV)
    (tmp_path / "mine.toml").write_text(FILE)
    monkeypatch.chdir(tmp_path)
    return tmp_path


OWN = ("--robot", "robots/arm.urdf", "--limits", "robots/joint_limits.yaml", "--waypoints", "path.csv")


def test_the_options_and_the_file_state_the_same_problem(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plan", *OWN, "--unit", "deg", "--json", "a.json"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("path: ")
    assert "of joint " in said
    assert main(["plan", "mine.toml", "--json", "b.json"]) == 0
    a, b = (json.loads((folder / name).read_text()) for name in ("a.json", "b.json"))
    assert a["seconds"] == pytest.approx(b["seconds"], rel=1e-9)
    assert [peak["name"] for peak in a["peaks"]] == [peak["name"] for peak in b["peaks"]]
    assert {peak["name"] for peak in a["peaks"]} <= {"turn", "bend", "slide"}


def test_joints_are_chosen_by_name(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "two.csv").write_text("0,0\n0.19,0.1\n")
    own = (*OWN[:4], "--waypoints", "two.csv", "--joints", "slide,turn")
    assert main(["plan", *own]) == 0
    assert "m/s" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--unit", "deg"), "--robot: missing: --robot URDF or --limits YAML"),
        (("--prismatic", "slide", *OWN), "--prismatic: given beside --robot"),
        ((), "FILE: missing: a problem file, a shipped case, or --robot URDF --limits YAML"),
        (("mine.toml", *OWN), "--robot: given beside FILE, mine.toml"),
        (("mine.toml", "--unit", "deg"), "--unit: given beside FILE"),
        (OWN[:2], "--waypoints: missing"),
        (OWN[4:], "--robot: missing"),
        ((*OWN, "--unit", "grad"), "--unit"),
        ((*OWN, "--joints", "trun"), "nearest known one is 'turn'"),
        ((*OWN, "--group", "arm"), "group: 'arm' needs an SRDF"),
        ((*OWN[:2], *OWN[4:]), "limits are missing: acceleration of turn, bend, slide"),
        ((*OWN,), "in degrees all would be inside"),
        ((*OWN[:5], "nowhere.csv"), "nowhere.csv: no such file"),
        (("--waypoint", "path.csv", *OWN[:4]), "--waypoint"),
    ],
)
@pytest.mark.parametrize("name", ["plan", "solve", "split", "motion_picture", "check"])
def test_misuse_is_one_line(
    name: str,
    arguments: tuple[str, ...],
    message: str,
    folder: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    if name == "check" and not arguments:
        message = "MOTION: missing"
    motion = ("nowhere-motion.csv",) if name == "check" else ()
    file = arguments[:1] if arguments[:1] == ("mine.toml",) else ()
    assert main([name, *file, *motion, *arguments[len(file) :]]) == 2
    said = capsys.readouterr()
    assert said.err.startswith("error: "), said.err
    assert message in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""


def test_check_judges_a_motion_for_the_robot_alone_with_names_and_conditions(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = (*OWN, "--unit", "deg")
    made = ("--stop", "1", "--end-velocity", "0,20,0", "--no-bound")
    assert main(["plan", *own, *made, "--export", "motion.csv"]) == 0
    capsys.readouterr()
    assert main(["check", "motion.csv", *own, *made[:4], "--json", "-"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["feasible"] is True
    assert answer["used_most"][0]["name"] in ("turn", "bend", "slide")
    assert answer["bound"] <= answer["seconds"]
    # the same motion breaks what it was not made for
    assert main(["check", "motion.csv", *own, "--no-bound", "--json", "-"]) == 3
    rest = json.loads(capsys.readouterr().out)["not_at_rest"]
    assert [(jump["quantity"], jump["name"]) for jump in rest if jump["quantity"] == "velocity"] == [
        ("velocity", "bend")
    ]
    assert rest[0]["size"] == pytest.approx(0.349066, abs=1e-6)  # 20 deg/s
    assert main(["check", "motion.csv", *own, *made[:4], "--pass", "1=0.3", "--no-bound"]) == 3
    said = capsys.readouterr().out
    assert "asked, at" in said
    assert "at waypoint 2, a stop" in said


def test_limits_and_waypoints_without_a_urdf(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "all.yaml").write_text(
        "joint_limits:\n  turn: {max_velocity: 2, max_acceleration: 4, max_jerk: 40}\n"
        "  bend: {max_velocity: 1, max_acceleration: 3, max_jerk: 30}\n"
        "  slide: {max_velocity: 0.5, max_acceleration: 2, max_jerk: 20}\n"
    )
    given = ("--limits", "all.yaml", "--waypoints", "path.csv", "--unit", "deg", "--prismatic", "slide")
    assert main(["plan", *given]) == 2
    assert "limits are missing: position of bend, turn, slide" in capsys.readouterr().err
    assert main(["plan", *given, "--unlimited", "position", "--json", "a.json"]) == 0
    assert main(["plan", *OWN, "--unit", "deg", "--json", "b.json"]) == 0
    a, b = (json.loads((folder / name).read_text())["seconds"] for name in ("a.json", "b.json"))
    assert a == pytest.approx(b, rel=1e-6)  # no position limit is in the way


def test_retime_takes_the_robot_or_its_limits_alone(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        main(["plan", *OWN, "--unit", "deg", "--no-bound", "--export", "motion.csv", "--rate", "100"])
        == 0
    )
    robot = ("--robot", "robots/arm.urdf", "--limits", "robots/joint_limits.yaml")
    assert main(["retime", "motion.csv", *robot, "--json", "a.json"]) == 0
    (folder / "more.yaml").write_text(
        "joint_limits:\n  turn: {max_velocity: 2, min_position: -3, max_position: 3}\n"
        "  bend: {max_velocity: 1, min_position: -2, max_position: 2}\n"
        "  slide: {max_velocity: 0.5, min_position: 0, max_position: 0.2}\n"
    )
    files = ("--limits", "robots/joint_limits.yaml", "--limits", "more.yaml")
    assert main(["retime", "motion.csv", *files, "--prismatic", "slide", "--json", "b.json"]) == 0
    a, b = (json.loads((folder / name).read_text())["ways"] for name in ("a.json", "b.json"))
    for way in a:
        assert a[way]["seconds_kept"] == pytest.approx(b[way]["seconds_kept"], rel=1e-9)
    capsys.readouterr()
    assert main(["retime", "motion.csv", "--limits", "mine.toml", *robot]) == 2
    assert "mine.toml is a problem file, which stands alone" in capsys.readouterr().err
    assert main(["retime", "motion.csv"]) == 2
    assert "--limits: missing" in capsys.readouterr().err


def test_the_robot_of_a_urdf_is_drawn(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["motion_picture", "mine.toml", "--out", "a.svg"]) == 0
    assert main(["motion_picture", *OWN, "--unit", "deg", "--out", "b.svg"]) == 0
    a, b = ((folder / name).read_text() for name in ("a.svg", "b.svg"))
    assert a == b
    assert "<title>arm: fastest 4-3-4 spline" in a
    (folder / "bare.toml").write_text(
        "waypoints = [[0], [1]]\n[limits]\nvelocity = 1\nacceleration = 1\n"
    )
    capsys.readouterr()
    assert main(["motion_picture", "bare.toml"]) == 2
    assert "bare.toml: no arm is known" in capsys.readouterr().err


def test_check_without_a_motion_says_so(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in ((), ("mine.toml",), OWN):
        assert main(["check", *arguments]) == 2
        assert "MOTION: missing" in capsys.readouterr().err
