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
@pytest.mark.parametrize("name", ["plan", "solve", "split"])
def test_misuse_is_one_line(
    name: str,
    arguments: tuple[str, ...],
    message: str,
    folder: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main([name, *arguments]) == 2
    said = capsys.readouterr()
    assert said.err.startswith("error: "), said.err
    assert message in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""
