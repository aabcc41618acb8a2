"""``plan`` within a time limit, and under a real Ctrl-C: the best verified motion so far, promptly."""

from __future__ import annotations

import json
import os
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
    text = f'name = "hundred"\nwaypoints = {large(100).tolist()}\n[limits]\n{limits}\n'
    # a window is left to the programs, which take half a minute
    path.write_text(f"{text}[[conditions.waypoint]]\nat = 50\nwindow = [0.1, inf]\n")
    return path


# a process that gets a real SIGINT so many seconds after its search has begun
_INTERRUPTED = """
import importlib, os, signal, sys, threading
after, module, name = float(sys.argv[1]), importlib.import_module(sys.argv[2]), sys.argv[3]
search = getattr(module, name)
def begun(*arguments, **options):
    threading.Timer(after, os.kill, (os.getpid(), signal.SIGINT)).start()
    return search(*arguments, **options)
setattr(module, name, begun)
signal.signal(signal.SIGINT, signal.default_int_handler)
from compare.__main__ import main
sys.exit(main(sys.argv[4:]))
"""
_SEARCH = {
    "plan": ("compare.commands.motions.plan", "find_motion"),
    "solve": ("compare.commands.motions.climbing", "ladder"),
}


def interrupted(after: float, command: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run a command that is interrupted ``after`` seconds of its search, which would take far longer."""
    return subprocess.run(
        [sys.executable, "-c", _INTERRUPTED, str(after), *_SEARCH[command], command, *arguments],
        capture_output=True, text=True, cwd=ROOT, env={**os.environ}, timeout=60.0, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("after", [0.5, 3.0])
def test_ctrl_c_gives_the_best_verified_motion_at_once(hundred: Path, after: float) -> None:
    answer = hundred.with_suffix(".json")
    ended = interrupted(after, "plan", str(hundred), "--gap", "1e-6", "--json", str(answer))
    assert ended.returncode == 130, ended.stderr
    said = "Ctrl-C ended the search: this is the best verified motion until then"
    assert said in ended.stdout, ended.stderr
    assert ended.stderr == ""
    data = json.loads(answer.read_text())
    assert data["status"] == "interrupted"
    assert 40.0 < data["seconds"] < 66.0  # at least the optimum, at most stop and go


def test_ctrl_c_before_any_motion_is_one_line(tmp_path: Path) -> None:
    path = tmp_path / "timed.toml"
    limits = "\n".join(f"{key} = {value}" for key, value in LIMITS.items())
    path.write_text(f'name = "timed"\nwaypoints = {large(100).tolist()}\n[limits]\n{limits}\n')
    ended = interrupted(1.0, "plan", str(path), "--total", "20")  # less than any motion takes
    assert ended.returncode == 130
    assert ended.stdout == ""
    assert ended.stderr.count("\n") == 1
    assert ended.stderr.startswith(
        "error: timed: interrupted: no motion was found yet that keeps conditions.total"
    )


def test_the_time_limit_is_kept_and_said(hundred: Path, capsys: pytest.CaptureFixture[str]) -> None:
    begun = time.perf_counter()
    assert main(["plan", str(hundred), "--time-limit", "2"]) == 0
    assert time.perf_counter() - begun < 15.0  # far less than the whole search
    out = capsys.readouterr().out
    assert "time limit)" in out.splitlines()[0]
    assert "the time limit ended the search: this is the best verified motion until then" in out


def test_solve_tells_each_rung_and_ctrl_c_keeps_what_is_there(hundred: Path) -> None:
    ended = interrupted(3.0, "solve", str(hundred))
    assert ended.returncode == 130
    out, err = ended.stdout, ended.stderr
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
