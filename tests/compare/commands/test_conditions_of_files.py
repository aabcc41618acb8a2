"""A file with conditions, through every command about motions: each of them keeps or judges what it says."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from compare.__main__ import main
from formulations import check, load, read_motion

CELL = """
name = "cell"
unit = "deg"
waypoints = [[0, -90], [40, -60], [80, -75], [120, -90]]

[limits]
velocity = [120, [-90, 120]]
acceleration = [400, 400]
jerk = [4000, 4000]
"""
ASKED = """
[conditions]
tolerance = {tolerance}
end_velocity = "free"

[[conditions.waypoint]]
at = 2
window = [1.2, 2]
wait = 0.25
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("plain.toml").write_text(CELL, "utf-8")
    Path("cell.toml").write_text(CELL + ASKED.replace("{tolerance}", "3"), "utf-8")
    return tmp_path


def planned(*arguments: str) -> dict[str, object]:
    assert main(["plan", *arguments, "--json", "out.json"]) == 0
    return json.loads(Path("out.json").read_text("utf-8"))


def test_plan_keeps_them(folder: Path) -> None:
    free, asked = planned("plain.toml"), planned("cell.toml", "--export", "m.pieces.json")
    assert asked["seconds"] != free["seconds"]
    said = asked["conditions"]
    assert said["waypoint"] == [{"at": 2, "window": [1.2, 2.0], "wait": 0.25}]  # type: ignore[index]
    assert "conditions" not in free
    motion, problem = read_motion("m.pieces.json"), load("cell.toml")
    passed = np.array(asked["passage_times"])
    assert passed[2] >= 1.2 - 1e-9
    still = motion.at(np.linspace(passed[2] + 1e-6, passed[2] + 0.25 - 1e-6, 9), 1)
    assert np.abs(still).max() < 1e-6
    near = np.abs(motion.at(passed) - problem.waypoints).max(axis=1)
    assert (near <= np.deg2rad([1e-6, 3.0 + 1e-6, 3.0 + 1e-6, 1e-6])).all()
    assert motion.at(passed[-1:], 1).any()
    assert check(problem, motion).feasible
    assert not check(load("plain.toml"), motion).feasible


def test_check_refuses_a_motion_that_was_planned_without_them(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("plain.toml", "cell.toml"):
        text = Path(name).read_text("utf-8")
        Path(name).write_text(text.replace("[-90, 120]", "90"), "utf-8")
    planned("plain.toml", "--export", "m.csv")
    assert main(["check", "plain.toml", "m.csv", "--no-bound"]) == 0
    capsys.readouterr()
    assert main(["check", "cell.toml", "m.csv", "--no-bound"]) == 3
    options = ["--window", "2=1.2:2", "--wait", "2=0.25", "--zone", "3", "--end-velocity", "free"]
    assert main(["check", "plain.toml", "m.csv", "--no-bound", *options]) == 3


def test_options_ask_for_the_same_as_the_file(folder: Path) -> None:
    options = ["--window", "2=1.2:2", "--wait", "2=0.25", "--tolerance", "3", "--end-velocity", "free"]
    by_file, by_options = planned("cell.toml"), planned("plain.toml", *options)
    assert by_file["seconds"] == pytest.approx(by_options["seconds"], rel=1e-9)
    assert by_file["bound"] == pytest.approx(by_options["bound"], rel=1e-9)


@pytest.mark.long  # searches and proofs
def test_the_ladder_and_the_diagnosis_are_those_of_the_conditions(folder: Path) -> None:
    assert main(["solve", "cell.toml", "--json", "ladder.json"]) == 0
    ladder = json.loads(Path("ladder.json").read_text("utf-8"))["ladder"]
    assert ladder["free_form"]["seconds"] == pytest.approx(planned("cell.toml")["seconds"], rel=1e-3)
    assert 1.2 + 0.25 < ladder["displacement"]["seconds"] <= ladder["free_form"]["seconds"]
    assert ladder["displacement"]["seconds"] <= ladder["free_form_lower"]["seconds"]
    assert ladder["family"]["status"] == "not-applicable"
    assert "knows no conditions" in ladder["family"]["note"]


def test_the_page_says_all_that_is_asked_for(folder: Path) -> None:
    assert main(["view", "cell.toml", "--out", "page.html", "--no-open", "--rungs", "free_form"]) == 0
    page = Path("page.html").read_text("utf-8")
    for said in (
        "It passes waypoint 2 within 3 deg in each joint.",
        "It stands still at waypoint 3 for 0.25 s.",
        "It passes waypoint 3 between 1.2 and 2 s.",
        "Its velocity at the end is free.",
        "-90 to 120",
    ):
        assert said in page, said


def test_a_hint_ends_where_the_options_answer_it(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [f"[{0.00083 * k:.4f}, {0.00047 * k:.4f}]" for k in range(30)]
    text = f"waypoints = [{', '.join(rows)}]\n[limits]\nvelocity = 2\nacceleration = 8\njerk = 80\n"
    Path("dense.toml").write_text(text, "utf-8")
    assert main(["plan", "dense.toml", "--no-bound"]) == 0
    assert "hint: waypoints: all 30 are multiples of 0.0001 rad" in capsys.readouterr().err
    assert main(["plan", "dense.toml", "--no-bound", "--tolerance", "5e-5"]) == 0
    assert "hint" not in capsys.readouterr().err


def test_retime_says_that_conditions_are_about_other_waypoints(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = "\n".join(f"{k},{0.01 * k:.4f},{0.02 * k:.4f}" for k in range(20))
    Path("path.csv").write_text(f"time,position_1,position_2\n{rows}\n", "utf-8")
    assert main(["retime", "path.csv", "--limits", "cell.toml"]) == 0
    assert (
        "hint: --limits cell.toml: its [conditions] are about its waypoints" in capsys.readouterr().err
    )
