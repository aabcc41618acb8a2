"""What commands put out: strict JSON, alone where it is piped; tables that are never cut off."""

from __future__ import annotations

import json
import os
import pty
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from compare.__main__ import main

ROOT = Path(__file__).parents[3]


def strict(text: str) -> Any:
    """JSON without NaN and infinity."""

    def refuse(name: str) -> Any:
        raise AssertionError(f"{name} is no JSON")

    return json.loads(text, parse_constant=refuse)


PROBLEM = "waypoints = [[0.0], [1.0], [0.5], [2.0]]\n[limits]\nvelocity = 1.0\nacceleration = 2.0\n"


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("problem") / "mine.toml"
    path.write_text(PROBLEM)
    return path


@pytest.mark.parametrize(
    "arguments",
    [
        ["solve", "{}"],
        ["plan", "{}"],
        ["split", "{}", "--budget", "100", "--codings", "stretched"],
        ["papers", "--list"],
        pytest.param(["audit", "bagging"], marks=pytest.mark.slow),
        ["speed", "--case", "{}", "--rounds", "1"],
        ["free_form_study", "--count", "1"],
        pytest.param(
            [
                "proofs",
                "--count",
                "1",
                "--segments",
                "2",
                "--each",
                "1",
                "--jobs",
                "1",
                "--out",
                "{out}",
            ],
            marks=pytest.mark.slow,
        ),
    ],
    ids=lambda arguments: str(arguments[0]),
)
def test_json_on_standard_output_is_strict_and_alone(
    arguments: list[str],
    problem: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from compare.studies import free_form_study, proofs

    monkeypatch.setattr(free_form_study, "cases", lambda: iter(()))
    monkeypatch.setattr(free_form_study, "extremes", lambda: iter(()))
    monkeypatch.setattr(proofs, "GAPS", (1e-2,))
    given = [part.replace("{out}", str(tmp_path)).replace("{}", str(problem)) for part in arguments]
    assert main([*given, "--json", "-"]) == 0
    said = capsys.readouterr()
    on_screen = strict(said.out)
    assert on_screen
    assert "\x1b" not in said.err


def test_json_goes_to_a_file_beside_the_text(
    problem: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "ladder.json"
    assert main(["solve", str(problem), "--json", str(target)]) == 0
    shown = capsys.readouterr().out
    found = strict(target.read_text())
    assert set(found) >= {"problem", "ladder", "durations", "versions", "diagnosis"}
    for key, rung in found["ladder"].items():
        assert set(rung) == {"seconds", "kind", "status", "certified", "runtime", "note"}
        assert key in shown


def test_certificates_are_judged_as_json_too(
    problem: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("flint")
    proof = tmp_path / "proof.json"
    assert main(["solve", str(problem), "--certificate", str(proof)]) == 0
    capsys.readouterr()
    assert main(["check_certificate", str(proof), "--json", "-"]) == 0
    assert strict(capsys.readouterr().out)["certified"] is True
    other = tmp_path / "other.toml"
    other.write_text(PROBLEM.replace("2.0]]", "2.5]]"))
    assert main(["check_certificate", str(proof), "--problem", str(other), "--json", "-"]) == 1
    found = strict(capsys.readouterr().out)
    assert found["certified"] is False
    assert "waypoints differ" in found["words"]


def test_a_problem_without_any_motion_ends_solve_with_2(
    problem: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from dataclasses import replace

    from compare.commands.motions import climbing
    from formulations import Ladder, ladder, load

    climbed = ladder(load(str(problem)))
    rungs = {
        key: replace(rung, status=type(rung.status)("failed"), seconds=None, note="no room to move")
        if rung.kind == "upper" else rung
        for key, rung in climbed.rungs.items()
    }  # fmt: skip
    hopeless: Ladder = replace(climbed, rungs=rungs, trajectories={}, free_form=None)
    monkeypatch.setattr(climbing, "ladder", lambda *given, **more: hopeless)
    assert main(["solve", str(problem)]) == 2
    said = capsys.readouterr()
    assert said.err == "error: problem: no motion was found: no room to move\n"
    assert "no motion is faster" in said.out  # the bounds still stand


def test_a_table_is_not_cut_off_when_piped_and_wrapped_on_a_terminal() -> None:
    code = "from compare.screen import table; print(table(['a', 'what'], [['x' * 30, 'word ' * 30]]))"
    piped = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True,
        env={**os.environ, "COLUMNS": "80"},
    ).stdout  # fmt: skip
    assert max(map(len, piped.splitlines())) > 150
    assert piped.count("word") == 30
    leader, follower = pty.openpty()
    with os.fdopen(follower, "w") as screen:
        subprocess.run(
            [sys.executable, "-c", code], cwd=ROOT, stdout=screen, check=True,
            env={**os.environ, "COLUMNS": "80"},
        )  # fmt: skip
    shown = os.read(leader, 100_000).decode()
    os.close(leader)
    assert shown.count("word") == 30
    assert max(map(len, shown.splitlines())) <= 80
