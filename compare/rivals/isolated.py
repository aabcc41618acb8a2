"""A rival in a process of its own, with limits of time and memory: only its row shows a crash."""

from __future__ import annotations

import contextlib
import json
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from enum import StrEnum
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from compare.rivals.rival import Rival, RivalAnswer
from formulations import Trajectory
from formulations.problem.problem import Problem

START = 60.0  # s that a process may take to load the program; not counted
_GRACE = 2.0  # s beyond the limit, for a program that ends by itself
_GLANCE = 0.02  # s between two looks at the process
_LONGEST = 300  # characters of a last word


class RivalEnding(StrEnum):
    """How the process of a rival ended."""

    ANSWERED = "answered"
    NOT_INSTALLED = "not installed"
    NOT_RUN = "not run"
    CRASHED = "crashed"
    TIMED_OUT = "timed out"


@dataclass(frozen=True)
class Ran:
    """One run: how it ended, why, the answer if there is one, and the seconds of the rival's function."""

    ending: RivalEnding
    reason: str = ""
    answer: RivalAnswer | None = None
    computation: float | None = None


def installed(rival: Rival) -> bool:
    """Say whether the package of a rival is there.

    Parameters
    ----------
    rival : Rival

    Returns
    -------
    bool
    """
    return all(find_spec(module.partition(".")[0]) is not None for module in rival.modules)


def run_apart(rival: Rival, problem: Problem, *, seconds: float, memory: int) -> Ran:
    """Run a rival in a process of its own.

    Parameters
    ----------
    rival : Rival
    problem : Problem
    seconds : float
        Time limit of its work [s].
    memory : int
        Bytes that it may hold (on Linux).

    Returns
    -------
    Ran
    """
    if rival.refusal:
        return Ran(RivalEnding.NOT_RUN, rival.refusal)
    if not installed(rival):
        return Ran(RivalEnding.NOT_INSTALLED, f"pip install {rival.package}")
    with tempfile.TemporaryDirectory(prefix="timebound-") as name:
        folder = Path(name)
        task = (rival.target, rival.modules, problem, seconds, memory)
        (folder / "task.pickle").write_bytes(pickle.dumps(task))
        path = [os.path.abspath(p) for p in (os.getcwd(), *sys.path)]
        with (folder / "words").open("wb") as words:
            process = subprocess.Popen(
                [sys.executable, "-m", "compare.rivals.child", name],
                stdin=subprocess.DEVNULL, stdout=words, stderr=words, cwd=name,
                env=os.environ | {"PYTHONPATH": os.pathsep.join(path)},
                start_new_session=True,  # the terminal's Ctrl-C is for this side
            )  # fmt: skip
            try:
                ended = _wait(process, folder, seconds)
            finally:
                _kill(process)
        return ended or _answer(process.returncode, folder)


def _wait(process: subprocess.Popen[bytes], folder: Path, seconds: float) -> Ran | None:
    """Wait until the process has ended; what ended it before that."""
    begun, started = time.monotonic(), None
    while process.poll() is None:
        now = time.monotonic()
        if started is None and (folder / "started").exists():
            started = now
        if started is None and now - begun > START:
            return Ran(RivalEnding.TIMED_OUT, f"took more than {START:g} s to load")
        if started is not None and now - started > seconds + _GRACE:
            return Ran(
                RivalEnding.TIMED_OUT, f"took more than {seconds:g} s", computation=now - started
            )
        time.sleep(_GLANCE)
    return None


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End the process and what it started."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _answer(code: int, folder: Path) -> Ran:
    """Read what the process has left, as plain numbers."""
    if code != 0:
        lines = (folder / "words").read_text("utf-8", "replace").strip().splitlines()
        last = lines[-1][:_LONGEST] if lines and "Traceback" in "".join(lines) else ""
        how = f"ended by {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
        return Ran(RivalEnding.CRASHED, f"{how}: {last}" if last else how)
    try:
        said = json.loads((folder / "answer.json").read_text("utf-8"))
        motion = None
        if (folder / "answer.npz").exists():
            with np.load(folder / "answer.npz", allow_pickle=False) as pieces:
                motion = Trajectory(pieces["durations"], pieces["coefficients"])
        answer = RivalAnswer(motion, said["claimed"], said["bound"], said["note"])
        return Ran(RivalEnding.ANSWERED, said["note"], answer, said["computation"])
    except (OSError, ValueError, KeyError) as error:
        return Ran(RivalEnding.CRASHED, f"its answer cannot be read: {error}"[:_LONGEST])
