"""The options for conditions: what they mean, how they lie over the file's, and every mistake is one line."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from compare.__main__ import main
from formulations import Conditions, NoFeasibleMotion, Problem, load

FILE = """
unit = "deg"
joints = ["turn", "slide"]
prismatic = "slide"
waypoints = [[0, 0.0], [90, 0.1], [45, 0.2], [0, 0.0]]

[limits]
velocity = [90, 0.5]
acceleration = [300, 4]
jerk = [2000, 50]

[conditions]
tolerance = 1
stops = [2]
end_velocity = "free"

[[conditions.waypoint]]
at = 1
window = [1, 20]

[[conditions.segment]]
from = 1
time = [2, 9]
"""
DEG = math.pi / 180.0


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "mine.toml"
    path.write_text(FILE, "utf-8")
    return str(path)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[Conditions]:
    """The conditions with which the search is called, which then ends at once."""
    found: list[Conditions] = []

    def plan(problem: Problem, **options: object) -> None:
        found.append(problem.conditions)
        raise NoFeasibleMotion("not sought")

    monkeypatch.setattr("compare.commands.motions.plan.find_motion", plan)
    return found


def planned(asked: list[Conditions], *arguments: str) -> Conditions:
    assert main(["plan", *arguments]) != 0
    return asked.pop()


def test_without_options_the_conditions_are_those_of_the_file(
    file: str, asked: list[Conditions]
) -> None:
    assert planned(asked, file) == load(file).conditions


def test_options_lie_over_the_conditions_of_the_file(file: str, asked: list[Conditions]) -> None:
    found = planned(
        asked, file, "--tolerance", "2=3,0.01", "--stop", "1", "--window", "1=2:", "--least", "1=2.5",
        "--least", "0=1", "--wait", "2=0.5", "--start-velocity", "-9,0.1", "--end-velocity", "0,0",
        "--start-acceleration", "free", "--end-acceleration", "18,-1", "--total", "30",
    )  # fmt: skip
    np.testing.assert_allclose(found.tolerance[1], [DEG, 1.0])
    np.testing.assert_allclose(found.tolerance[2], [3 * DEG, 0.01])
    assert found.stops == {1, 2}
    assert found.windows == {1: (2.0, math.inf)}
    assert found.segment_times == {0: (1.0, math.inf), 1: (2.5, 9.0)}
    assert (found.waits, found.total) == ({2: 0.5}, 30.0)
    np.testing.assert_allclose(found.start_velocity, [-9 * DEG, 0.1])
    np.testing.assert_allclose(found.end_velocity, [0, 0])
    assert isinstance(found.start_acceleration, str)
    np.testing.assert_allclose(found.end_acceleration, [18 * DEG, -1])


@pytest.mark.parametrize("option", ["--tolerance", "--zone"])
def test_one_distance_is_that_of_all_inner_waypoints(
    file: str, asked: list[Conditions], option: str
) -> None:
    found = planned(asked, file, option, "2", option, "2=0.5,0.25")
    assert set(found.tolerance) == {1, 2}
    np.testing.assert_allclose(found.tolerance[1], [2 * DEG, 2.0])
    np.testing.assert_allclose(found.tolerance[2], [0.5 * DEG, 0.25])


def test_a_cycle_is_asked_for(asked: list[Conditions], file: str) -> None:
    text = Path(file).read_text("utf-8").replace('end_velocity = "free"', "")
    Path(file).write_text(text, "utf-8")
    assert planned(asked, file, "--cyclic").cyclic
    assert not planned(asked, file).cyclic


MISTAKES = [
    (("--tolerance", "1=a"), "--tolerance: 'a' is not a list of numbers"),
    (("--tolerance", "1,2,3"), "--tolerance: expected 2 finite numbers, got '1,2,3'"),
    (("--tolerance", "a=1"), "--tolerance: 'a=1' is not of the form K=R"),
    (("--tolerance", "1", "--tolerance", "2"), "--tolerance: '2': all inner waypoints are given twice"),
    (("--tolerance", "1=1", "--tolerance", "1=2"), "--tolerance: '1=2': 1 is given twice"),
    (("--tolerance", "9=1"), "waypoint 9 is not there: 0 to 3"),
    (("--tolerance", "1=inf"), "expected 2 finite numbers"),
    (("--tolerance=-1",), "no distance"),
    (("--window", "1=2"), "--window: '1=2' is not of the form K=A:B"),
    (("--window", "1=3:2"), "[3, 2] s holds no time"),
    (("--window", "1=a:2"), "--window: '1=a:2' is not of the form"),
    (("--least", "1"), "--least: '1' is not of the form K=T"),
    (("--least", "1=20"), "[20, 9] s holds no time"),
    (("--least", "3=1"), "segment 3 is not there: 0 to 2"),
    (("--wait", "1=0"), "0 s is not a positive time"),
    (("--wait", "0=1"), "at an end"),
    (("--cyclic",), "leave end_velocity out"),
    (("--pass", "1=21"), "21 s is outside conditions.windows"),
    (("--end-acceleration", "fre"), "--end-acceleration: 'fre' is not a list of numbers"),
    (("--end-velocity", "100,0"), "joint turn: 100 deg/s is over the limit 90 deg/s"),
]


@pytest.mark.parametrize(("arguments", "message"), MISTAKES)
def test_a_mistake_is_one_line(
    arguments: tuple[str, ...], message: str, file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plan", file, *arguments]) == 2
    said = capsys.readouterr()
    assert message in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""


def test_every_command_about_a_motion_is_asked_for_the_same(
    file: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    for command in ("plan", "solve", "check", "view"):
        motion = [str(tmp_path / "none.csv")] if command in ("check", "view") else []
        assert main([command, file, *motion, "--window", "1=3:2"]) == 2
        assert "[3, 2] s holds no time" in capsys.readouterr().err


def test_commands_without_conditions_refuse_a_file_that_has_them(
    file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for arguments in (
        ["split", file],
        ["all", "--quick", "--cases", file],
        ["grade", "whale", "--cases", file],
    ):
        assert main(arguments) == 2
        assert "conditions.tolerance" in capsys.readouterr().err, arguments


def test_the_help_says_that_options_lie_over_the_file(capsys: pytest.CaptureFixture[str]) -> None:
    main(["plan", "--help"])
    said = " ".join(capsys.readouterr().out.replace("│", " ").split())
    assert "lie over the conditions of FILE" in said
