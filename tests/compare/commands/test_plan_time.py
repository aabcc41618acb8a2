"""``plan`` within a time limit, and under a real Ctrl-C: the best verified motion so far, promptly."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from commands_run import ROOT

from compare.__main__ import main

LIMITS = {"velocity": 2.0, "acceleration": 8.0, "jerk": 60.0}


def large(n: int, dof: int = 7) -> np.ndarray:
    return np.cumsum(np.random.default_rng(1).uniform(-0.6, 0.6, (n, dof)), axis=0)


@pytest.fixture
def hundred(tmp_path: Path) -> Path:
    path = tmp_path / "hundred.toml"
    limits = "\n".join(f"{key} = {value}" for key, value in LIMITS.items())
    path.write_text(f'name = "hundred"\nwaypoints = {large(100).tolist()}\n[limits]\n{limits}\n')
    return path


def started(*arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "compare", *arguments],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT, env={**os.environ},
    )  # fmt: skip


def interrupted(process: subprocess.Popen[str], after: float) -> tuple[str, str, float]:
    """Output and errors, and how long Ctrl-C took to be answered [s]."""
    time.sleep(after)
    assert process.poll() is None, "the command was faster than its interrupt"
    sent = time.perf_counter()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    return out, err, time.perf_counter() - sent


@pytest.mark.parametrize("after", [4.0, 6.0])
def test_ctrl_c_gives_the_best_verified_motion_at_once(hundred: Path, after: float) -> None:
    answer = hundred.with_suffix(".json")
    out, err, took = interrupted(
        started("plan", str(hundred), "--gap", "1e-6", "--json", str(answer)), after
    )
    assert took < 4.0  # 2 s on an idle machine
    assert "Ctrl-C ended the search: this is the best verified motion until then" in out, err
    assert err == ""
    data = json.loads(answer.read_text())
    assert data["status"] == "interrupted"
    assert 40.0 < data["seconds"] < 66.0  # at least the optimum, at most stop and go


def test_ctrl_c_before_any_motion_is_one_line(tmp_path: Path) -> None:
    path = tmp_path / "timed.toml"
    limits = "\n".join(f"{key} = {value}" for key, value in LIMITS.items())
    path.write_text(f'name = "timed"\nwaypoints = {large(100).tolist()}\n[limits]\n{limits}\n')
    process = started("plan", str(path), "--total", "20")  # less than any motion takes
    out, err, took = interrupted(process, 5.0)
    assert took < 4.0
    assert process.returncode == 130
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith(
        "error: timed: interrupted: no motion was found yet that keeps conditions.total"
    )


def test_the_time_limit_is_kept_and_said(hundred: Path, capsys: pytest.CaptureFixture[str]) -> None:
    begun = time.perf_counter()
    assert main(["plan", str(hundred), "--time-limit", "2"]) == 0
    assert time.perf_counter() - begun < 6.0  # the import of the solvers is part of it
    out = capsys.readouterr().out
    assert "time limit)" in out.splitlines()[0]
    assert "the time limit ended the search: this is the best verified motion until then" in out


def test_solve_tells_each_rung_and_ctrl_c_keeps_what_is_there(hundred: Path) -> None:
    process = started("solve", str(hundred))
    out, err, took = interrupted(process, 6.0)
    assert took < 5.0
    assert process.returncode == 130
    assert "hundred: 99 segments: the rungs of the family are left out" in err
    assert "hundred: displacement: " in err
    assert "interrupted" in out


def test_plan_prints_what_is_proved_unless_it_is_not_wanted(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "ur5"]) == 0
    assert "proved: no such motion takes less than 14.7678" in capsys.readouterr().out
    assert main(["plan", "ur5", "--no-bound"]) == 0
    assert "proved" not in capsys.readouterr().out


def test_a_rung_that_is_not_there_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "ur5", "--rungs", "free_from"]) == 2
    assert "did you mean 'free_form'" in capsys.readouterr().err
