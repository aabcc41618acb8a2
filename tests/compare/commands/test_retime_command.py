"""``timebound retime``: three ways on screen and as JSON, and a file that was judged after it was written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from compare.__main__ import main
from formulations import FAMILIES, check, load, read_motion, write_motion
from formulations.motion.judgement import judge

PROBLEM = """
waypoints = [[0, 0], [0.5, 0.3], [0.8, 0.9], [1.4, 1.0]]
[limits]
velocity = [1.0, 1.2]
acceleration = [2.0, 2.5]
jerk = [15, 18]
"""


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    """A problem, and its 3-5-3 spline run at half the pace that it could have."""
    folder = tmp_path_factory.mktemp("path")
    (folder / "two.toml").write_text(PROBLEM, "utf-8")
    problem = load(str(folder / "two.toml"))
    spline = FAMILIES["3-5-3"].trajectory(problem, [1.0, 1.0, 1.0])
    slow = spline.stretched(2.0 * check(problem, spline).stretch)
    write_motion(folder / "slow.csv", slow, rate=20.0)
    return str(folder / "two.toml"), str(folder / "slow.csv")


def test_three_ways_stand_side_by_side_and_the_fastest_is_written(
    files: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    problem, slow = files
    out, answer = tmp_path / "fast.csv", tmp_path / "answer.json"
    given = ["retime", slow, "--limits", problem, "--tolerance", "0.01"]
    assert main([*given, "--export", str(out), "--rate", "250", "--json", str(answer)]) == 0
    ways = json.loads(answer.read_text("utf-8"))["ways"]
    assert list(ways) == ["given", "toppra", "copp", "free_form"]
    # a slow motion is good as it is, and every way that knows the jerk is faster
    assert ways["given"]["feasible"]
    assert ways["free_form"]["feasible"]
    assert ways["free_form"]["deviation"] <= 0.01
    assert ways["free_form"]["seconds_kept"] < ways["copp"]["seconds_kept"] * 1.01
    assert ways["copp"]["seconds_kept"] < 0.7 * ways["given"]["seconds"]
    assert {v["quantity"] for v in ways["toppra"]["violations"]} >= {"jerk"}
    said = capsys.readouterr().out
    assert all(len(line) <= 80 for line in said.splitlines()[1:-2])
    # the file, read back and joined by quintics, keeps every limit
    written = read_motion(out)
    posed = load(problem)
    verdict = judge(posed, written, tolerance=0.1)
    assert not verdict.violations, verdict.violations
    assert written.seconds == pytest.approx(ways["free_form"]["seconds_kept"], rel=0.02)
    assert "written" in said


def test_a_motion_of_other_joints_ends_with_2(
    files: tuple[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["retime", files[1], "--limits", "sr4c"]) == 2
    assert "2 joints, sr4c has 6" in capsys.readouterr().err


def test_a_way_can_be_chosen(
    files: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "copp.csv"
    given = ["retime", files[1], "--limits", files[0], "--tolerance", "0.05", "--way", "copp"]
    assert main([*given, "--export", str(out)]) == 0
    assert f"{out}: copp, " in capsys.readouterr().out
    assert not judge(load(files[0]), read_motion(out), tolerance=0.1).violations
