"""``timebound retime``: three ways on screen and as JSON, and a file that was judged after it was written."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Array
from scipy.interpolate import BPoly

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
    assert all(len(line) <= 80 for line in said.split("\n\n")[1].splitlines())
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
    said = capsys.readouterr().out
    assert f"{out}: written, " in said
    assert "copp; " in said.splitlines()[-1]
    assert not judge(load(files[0]), read_motion(out), tolerance=0.1).violations


def joined_by_quintics(file: Path) -> tuple[Array, Array]:
    """Largest velocity, acceleration and jerk of each joint, (3, dof), and times, without the project."""
    with file.open() as stream:
        rows = list(csv.reader(stream))
    table = np.array([[float(x) for x in row] for row in rows[1:]])
    times, values = table[:, 0], table[:, 1:].reshape(len(table), 3, -1)
    found = np.zeros((3, values.shape[2]))
    for joint in range(values.shape[2]):
        spline = BPoly.from_derivatives(times, values[:, :, joint])
        for order in (1, 2, 3):
            derived = spline.derivative(order)
            at = (times[:-1, None] + np.diff(times)[:, None] * np.linspace(0.0, 1.0, 41)).ravel()
            found[order - 1, joint] = np.abs(derived(np.clip(at, times[0], times[-1]))).max()
    return found, times


@pytest.mark.parametrize(("way", "rate"), [("copp", 125), ("toppra", None)])
def test_a_file_of_a_path_way_keeps_the_limits_between_its_points(
    way: str,
    rate: int | None,
    files: tuple[str, str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    out = tmp_path / "on_path.csv"
    given = ["retime", files[1], "--limits", files[0], "--way", way, "--export", str(out)]
    given += [] if rate is None else ["--rate", str(rate)]
    assert main([*given, "--json", str(tmp_path / "ways.json")]) == 0
    said = capsys.readouterr().out
    found, times = joined_by_quintics(out)
    limits = load(files[0]).limits
    for order, limit in enumerate((limits.velocity, limits.acceleration, limits.jerk)):
        assert (found[order] <= limit * (1.0 + 1e-6)).all(), (order, found[order] / limit)
    if rate is not None:  # the last step too
        np.testing.assert_allclose(np.diff(times), 1.0 / rate, rtol=1e-6)
    kept = json.loads((tmp_path / "ways.json").read_text("utf-8"))["ways"][way]["seconds_kept"]
    assert times[-1] >= kept * (1.0 - 1e-9)
    assert "keeps every limit" in said
    assert "longer than the motion found: stretched by" in said
