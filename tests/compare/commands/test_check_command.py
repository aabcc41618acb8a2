"""``timebound check``: exit codes, the JSON to the letter, and text that fits a terminal."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from compare.__main__ import main
from formulations import FAMILIES, check, load, write_motion

KEYS = ["feasible", "seconds", "stretch", "violations", "missed_waypoints", "bound", "gap"]


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A spline of sr4c at its limits, one 10 % too fast, and one at 5 Hz that misses waypoints."""
    folder = tmp_path_factory.mktemp("motions")
    problem = load("sr4c")
    spline = FAMILIES["3-5-3"].trajectory(problem, [2.0, 1.0, 2.0])
    spline = spline.stretched(check(problem, spline).stretch * (1.0 + 1e-6))
    paths = {name: folder / f"{name}.csv" for name in ("good", "fast", "coarse")}
    write_motion(paths["good"], spline)
    write_motion(paths["fast"], spline.stretched(1.0 / 1.1))
    write_motion(paths["coarse"], spline.stretched(2.0), rate=0.7)
    return paths


def test_a_good_motion_ends_with_0_and_json_to_the_letter(
    files: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", "sr4c", str(files["good"]), "--json", "-"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert list(answer)[: len(KEYS)] == KEYS
    assert answer["feasible"] is True
    assert answer["violations"] == answer["missed_waypoints"] == answer["jumps"] == []
    assert answer["stretch"] == pytest.approx(1.0, abs=1e-5)
    # what no motion beats is proved elsewhere: 2.997581 s for sr4c
    assert answer["bound"] == pytest.approx(2.99758, abs=1e-4)
    assert answer["gap"] == pytest.approx(answer["seconds"] / answer["bound"] - 1.0)
    assert answer["interpolation"] == "quintic"
    assert answer["tolerance"] == 1e-4


def test_a_motion_that_is_too_fast_ends_with_3_and_says_where(
    files: dict[str, Path], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / "verdict.json"
    assert main(["check", "sr4c", str(files["fast"]), "--json", str(out), "--no-bound"]) == 3
    answer = json.loads(out.read_text("utf-8"))
    assert answer["feasible"] is False
    assert answer["bound"] is answer["gap"] is None
    assert answer["stretch"] == pytest.approx(1.1, abs=1e-5)
    worst = answer["violations"][0]
    assert set(worst) == {"quantity", "joint", "time", "value", "limit", "factor"}
    order = ["velocity", "acceleration", "jerk"].index(worst["quantity"])
    limit = load("sr4c").limits.derivatives[order, worst["joint"] - 1]  # joints count from 1
    assert worst["limit"] == limit
    assert abs(worst["value"]) == pytest.approx(worst["factor"] * limit)
    assert worst["factor"] == pytest.approx(1.1 ** (order + 1), abs=1e-4)
    said = capsys.readouterr().out
    assert "fast.csv: BREAKS what sr4c asks for" in said
    assert "stretched by 1.1, to" in said
    assert all(len(line) <= 80 for line in said.splitlines()[1:])


def test_missed_waypoints_are_named_and_no_stretch_is_said_to_mend_them(
    files: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", "sr4c", str(files["coarse"]), "--no-bound", "--json", "-"]) == 3
    answer = json.loads(capsys.readouterr().out)
    assert answer["stretch"] is None
    waypoints = load("sr4c").waypoints
    for miss in answer["missed_waypoints"]:
        assert set(miss) == {"waypoint", "joint", "distance", "time"}
        assert abs(miss["distance"]) > 1e-4
        assert 1 < miss["waypoint"] < len(waypoints)  # the ends are points of the file
    assert answer["missed_waypoints"]
    assert main(["check", "sr4c", str(files["coarse"]), "--no-bound"]) == 3
    said = capsys.readouterr().out
    assert "no uniform stretch mends it: waypoints are missed" in said
    assert "passed within 0.0001 rad" in said


def test_the_tolerance_and_the_interpolation_are_options(
    files: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["check", "sr4c", str(files["good"]), "--no-bound", "--json", "-"]
    assert main([*given, "--interpolation", "linear", "--tolerance", "10"]) == 3
    answer = json.loads(capsys.readouterr().out)
    assert answer["interpolation"] == "linear"
    assert answer["missed_waypoints"] == []
    assert {jump["quantity"] for jump in answer["jumps"]} == {"velocity"}
    assert np.isfinite(answer["stretch_for_limits"])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--tolerance", "0"], "--tolerance: 0 is not positive"),
        (["--interpolation", "spline"], "--interpolation: "),
    ],
)
def test_bad_options_end_with_2(
    files: dict[str, Path], options: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", "sr4c", str(files["good"]), *options]) == 2
    said = capsys.readouterr()
    assert said.err.startswith(f"error: {words}")
    assert said.out == ""


def test_a_motion_of_another_arm_ends_with_2(
    files: dict[str, Path], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    other = tmp_path / "two.toml"
    other.write_text("waypoints = [[0, 0], [1, 1]]\n[limits]\nvelocity = 1\n", "utf-8")
    assert main(["check", str(other), str(files["good"])]) == 2
    assert capsys.readouterr().err == "error: motion: 6 joints, the problem has 2\n"
