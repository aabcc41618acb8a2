"""What a person reads speaks of joints by name, in the unit of the file, counted from 1."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from compare.__main__ import main
from formulations import Problem, free_form
from formulations.diagnosis import diagnose

TEXT = """unit = "deg"
joints = ["shoulder", "elbow"]
waypoints = [[0, 10], [40, -15], [60, 0]]
[limits]
velocity = [90, 120]
acceleration = 300
jerk = 3000
"""


def test_plan_names_joints_and_counts_from_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, out = tmp_path / "mine.toml", tmp_path / "out.json"
    file.write_text(TEXT)
    assert main(["plan", str(file), "--start-velocity", "30,0", "--json", str(out)]) == 0
    said = capsys.readouterr().out
    assert "of joint shoulder in segment 1" in said
    assert "deg/s" in said
    assert "rad/s" not in said
    peaks = json.loads(out.read_text())["peaks"]
    for peak in peaks:
        assert peak["name"] == ("shoulder", "elbow")[peak["joint"] - 1]
        assert peak["segment"] in (1, 2)


def test_a_velocity_on_the_command_line_is_in_the_unit_of_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(TEXT)
    assert main(["plan", str(file), "--end-velocity", "0,121"]) == 2
    assert "joint elbow: 121 deg/s is over the limit 120 deg/s" in capsys.readouterr().err


def test_degrees_read_as_radians_get_a_hint(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(TEXT.replace('unit = "deg"\n', ""))
    assert main(["plan", str(file)]) == 0
    said = capsys.readouterr()
    assert "hint: waypoints: row 3, joint shoulder: 60 rad takes 9.55 turns" in said.err


def test_a_diagnosis_names_joints() -> None:
    problem = Problem([[0.0, 0.0], [1.0, 0.1]], {"velocity": 100, "acceleration": 4}, names=("a", "b"))
    found = diagnose(problem, free_form(problem, tolerance=1e-6))
    assert found.lines()[0].startswith("joint a's acceleration holds segment 1 for 1 of 1 s")
    rows = found.to_json()["holds"]
    assert isinstance(rows, list)
    assert (rows[0]["joint"], rows[0]["name"], rows[0]["segment"]) == (1, "a", 1)


def test_a_proof_in_words_names_the_joints(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("flint")
    file, bare, proof = (tmp_path / name for name in ("mine.toml", "bare.toml", "cert.json"))
    file.write_text(TEXT)
    bare.write_text(TEXT.replace('joints = ["shoulder", "elbow"]\n', ""))
    for problem, names in ((file, ("shoulder", "elbow")), (bare, ("1", "2"))):
        made = ("--rungs", "free_form_lower", "--motion-certificate", str(proof))
        assert main(["solve", str(problem), *made]) == 0
        capsys.readouterr()
        assert main(["check_certificate", str(proof), "--show", "--problem", str(file)]) == 0
        said = capsys.readouterr().out
        found = set(re.findall(r", joint (\w+)\]", said))
        assert found
        assert found <= set(names)
        assert ("v[" in said) == (problem is file)
    data = json.loads(proof.read_text())
    for wrong in (["one"], ["a", "b\n"], ["a", "b" * 101], "ab"):
        proof.write_text(json.dumps({**data, "names": wrong}))
        assert main(["check_certificate", str(proof)]) == 2
        assert "error: " in capsys.readouterr().err


def test_a_velocity_of_almost_nothing_is_no_solver_error_in_a_line_of_success(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "slow.toml"
    file.write_text(
        "waypoints = [[0, 0], [1, 0.5], [0, 1]]\n[limits]\nvelocity = 1e-12\nacceleration = 1\njerk = 10\n"
    )
    assert main(["plan", str(file), "--no-bound"]) == 0
    said = capsys.readouterr().out
    assert "Model error" not in said
    # 1 rad there and 1 rad back at 1e-12 rad/s
    assert 2e12 <= float(said.split(": ")[1].split(" s")[0]) < 2.1e12
