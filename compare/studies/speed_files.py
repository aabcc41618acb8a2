"""What it takes to write a long motion: encoded, read back, joined as a controller does, judged, stored.

The study behind ``timebound speed --files``. The motion is known at its points; how long it took to find is
not counted. The formats take turns, and the best of several rounds counts.
"""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from compare.screen import table
from compare.studies.study import Study
from formulations import Limits, Problem, Trajectory, check
from formulations.motion.files.formats import FORMATS
from formulations.motion.files.motion_file import decode_motion, encode_motion, points_of
from formulations.motion.files.motion_points import MotionPoints
from formulations.problem.files import write_bytes

MOVE = 2.0  # s of each move of the motion
RATE, DOF = 1000.0, 7


@dataclass(frozen=True)
class FileCost:
    """One format of a file: its size [bytes], and the time of each step [s].

    Attributes
    ----------
    suffix : str
        The format.
    motion_seconds : float [s]
        Length of the motion.
    n_points, size : int
        Points and bytes of the file.
    encode, decode, judge, store : float [s]
        Points to bytes; bytes to points; points joined and judged by exact extremes; bytes to the disk.
    processor : float [s]
        Time of the processor in all: other programs on the machine count less in it.
    feasible : bool
        Whether the file keeps every limit.
    """

    suffix: str
    motion_seconds: float
    n_points: int
    size: int
    encode: float
    decode: float
    judge: float
    store: float
    processor: float
    feasible: bool

    @property
    def total(self) -> float:
        """All steps together [s]."""
        return self.encode + self.decode + self.judge + self.store


def long_motion(seconds: float, dof: int = DOF) -> tuple[Problem, Trajectory]:
    """Make a motion of many moves from rest to rest whose jerk switches at whole periods.

    Parameters
    ----------
    seconds : float [s]
        Its length, a multiple of 2 s.
    dof : int
        Number of joints.

    Returns
    -------
    problem : Problem
        A waypoint at each end of a move; limits of which each joint uses 99.9 % at most.
    motion : Trajectory
        Four phases of constant jerk, + - - +, in each move.
    """
    moves, h = round(seconds / MOVE), MOVE / 4.0
    waypoints = np.random.default_rng(0).uniform(-1.5, 1.5, (moves + 1, dof))
    jerk = np.diff(waypoints, axis=0) / (2.0 * h**3)
    x, v, a = waypoints[:-1], np.zeros_like(jerk), np.zeros_like(jerk)
    phases = []
    for sign in (1.0, -1.0, -1.0, 1.0):
        phases.append(np.stack([x, v, a / 2.0, sign * jerk / 6.0], axis=-1))
        x, v, a = (
            x + v * h + a * h**2 / 2.0 + sign * jerk * h**3 / 6.0,
            v + a * h + sign * jerk * h**2 / 2.0,
            a + sign * jerk * h,
        )
    pieces = np.stack(phases, axis=1).reshape(4 * moves, dof, 4)
    motion = Trajectory(np.full(4 * moves, h), pieces, np.arange(moves + 1, dtype=np.float64) * MOVE)
    v, a, j = (1.001 * motion.reach(order) for order in (1, 2, 3))
    return Problem(waypoints, Limits.of(v, a, j, (-1.6, 1.6), dof=dof), name="long"), motion


def costs(seconds: float, rounds: int) -> list[FileCost]:
    """Time every format on the same motion.

    Parameters
    ----------
    seconds : float [s]
        Length of the motion.
    rounds : int
        Rounds; the one with the least sum counts.

    Returns
    -------
    list of FileCost
        A row per format.
    """
    problem, motion = long_motion(seconds)
    points = points_of(motion, np.arange(round(seconds * RATE) + 1) / RATE)
    best: dict[str, FileCost] = {}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds):
            for suffix in (entry.suffixes[0] for entry in FORMATS):
                row = _once(Path(folder) / f"motion{suffix}", problem, motion, points)
                best[suffix] = min(best.get(suffix, row), row, key=lambda one: one.total)
    return list(best.values())


def _once(path: Path, problem: Problem, motion: Trajectory, points: MotionPoints) -> FileCost:
    """Write the points once."""
    processor = -time.process_time()
    moments = [time.perf_counter()]
    data = encode_motion(path, points)
    moments.append(time.perf_counter())
    back = decode_motion(path, data)
    moments.append(time.perf_counter())
    assert isinstance(back, MotionPoints)
    verdict = check(problem, back.motion("auto", motion.passage_times))
    moments.append(time.perf_counter())
    write_bytes(path, data)
    moments.append(time.perf_counter())
    processor += time.process_time()
    path.unlink()
    encode, decode, judge, store = np.diff(moments).tolist()
    return FileCost(
        suffix=path.suffix,
        motion_seconds=motion.seconds,
        n_points=len(points.times),
        size=len(data),
        encode=encode,
        decode=decode,
        judge=judge,
        store=store,
        processor=processor,
        feasible=verdict.feasible,
    )


def as_text(rows: list[FileCost], summary: dict[str, Any]) -> str:
    """Lay the formats out as a table.

    Parameters
    ----------
    rows : list of FileCost
        All formats.
    summary : dict
        Time in all, by format.

    Returns
    -------
    str
        A line per format.
    """
    first = rows[0]
    title = (
        f"{first.motion_seconds:g} s of {DOF} joints at {RATE:g} points per second, "
        f"{first.n_points} points; times in s"
    )
    header = [
        "file",
        "MB",
        "encode",
        "read back",
        "join, judge",
        "to disk",
        "in all",
        "processor",
        "keeps limits",
    ]
    lines = [
        [row.suffix, f"{row.size / 1e6:.0f}",
         *(f"{step:.2f}" for step in (row.encode, row.decode, row.judge, row.store)),
         f"{summary[row.suffix]:.2f}", f"{row.processor:.2f}", "yes" if row.feasible else "NO"]
        for row in rows
    ]  # fmt: skip
    return f"{title}\n{table(header, lines, right=(1, 2, 3, 4, 5, 6, 7))}"


FILES = Study(
    name="speed_files",
    row=FileCost,
    compute=costs,
    summarise=lambda rows: {row.suffix: row.total for row in rows},
    text=as_text,
)
