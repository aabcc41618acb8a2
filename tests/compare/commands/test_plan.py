"""The planner's command: what is asked for is kept, the file holds the motion, misuse is one line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from compare.__main__ import main
from formulations import check, load
from formulations.motion.files.motion_file import read_motion


def test_a_stop_and_a_passage_are_kept_and_the_file_holds_the_motion(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motion, out = tmp_path / "m.csv", tmp_path / "m.json"
    arguments = ("ur5", "--stop", "1", "--pass", "2=12.5", "--export", str(motion), "--json", str(out))
    assert main(["plan", *arguments]) == 0
    data = json.loads(out.read_text())
    first, second = data["passage_times"][1:3]
    assert second == pytest.approx(12.5, abs=1e-9)
    back = read_motion(motion)
    np.testing.assert_allclose(back.at(first, 1), 0.0, atol=1e-9)
    np.testing.assert_allclose(back.at(second), load("ur5").waypoints[2], atol=1e-9)
    assert max(peak["factor"] for peak in data["peaks"]) <= 1.0 + 1e-9
    assert "verified" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--pass", "2"), "--pass: '2' is not of the form K=T"),
        (("--pass", "2=soon"), "--pass: '2=soon' is not of the form K=T"),
        (("--stop", "9"), "waypoint 9"),
        (("--total", "10"), "conditions.total; the nearest one found passes waypoint 4 at 14.76"),
        (("--total", "nan"), "nan"),
        (("--start-velocity", "1,2"), "--start-velocity: expected 6 finite numbers"),
        (("--start-velocity", "-1,2"), "--start-velocity: expected 6 finite numbers, got '-1,2'"),
        (("--end-velocity", "a"), "--end-velocity: 'a' is not a list"),
        (("--end-velocity", "0,0,0,0,0,900"), "joint 6: 900 deg/s is over the limit"),
        (("--gap", "0"), "--gap: 0 is not positive"),
        (("--rate", "0"), "--rate: 0 is not positive"),
        (("--export", "motion.csv", "--rate", "1e9"), "rate: 1e+09 points per second over"),
        (("--export", "motion.xyz"), "written as .csv, .json, .yaml, .npz or .pieces.json, not '.xyz'"),
        (("--export", "nowhere/motion.csv"), "--export: nowhere/motion.csv: cannot be written"),
    ],
)
def test_misuse_is_one_line(
    arguments: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plan", "ur5", *arguments]) == 2
    said = capsys.readouterr()
    assert said.err.startswith("error: ")
    assert message in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""


def test_the_file_is_judged_and_a_bad_rate_is_told_before_solving(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = load("sr4c")
    for name in ("m.csv", "m.yaml"):
        assert main(["plan", "sr4c", "--export", str(tmp_path / name), "--rate", "125"]) == 0
        said = capsys.readouterr().out
        assert f"{name}: written, 377 points at 125 per second" in said
        assert "keeps every limit" in said
        assert check(problem, read_motion(tmp_path / name, waypoints=problem.waypoints)).feasible

    def solve(*arguments: object, **more: object) -> None:
        raise AssertionError("solved before the rate was looked at")

    monkeypatch.setattr("compare.commands.motions.plan.find_motion", solve)
    assert main(["plan", "sr4c", "--export", str(tmp_path / "n.csv"), "--rate", "1e9"]) == 2
    assert not (tmp_path / "n.csv").exists()


def test_a_task_without_a_solution_is_told_as_a_bad_file_is(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "ur5", "--total", "10"]) == 2
    infeasible = capsys.readouterr().err
    assert main(["plan", "nowhere.toml"]) == 2
    missing = capsys.readouterr().err
    # both: error, what was asked for, the reason; no colon less, no line more
    assert infeasible.startswith("error: ur5: waypoint 4: its latest time (conditions.total) is 10 s")
    assert "no motion found" in infeasible
    assert missing.startswith("error: nowhere.toml: no such file")
    assert infeasible.count("\n") == missing.count("\n") == 1
