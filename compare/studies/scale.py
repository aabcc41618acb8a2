"""Time and memory of motion and proof against the number of waypoints: behind ``timebound scale``.

Random problems: every joint walks by steps drawn evenly from -step to step; where zones are asked for, each
inner waypoint may be passed that far from it. Each problem is planned and
proved in a process of its own, so that the peak of the memory is that of this problem, Python and its
libraries included.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator

from compare.engines import workers
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, styled
from compare.screen import table
from compare.studies.study import Call, Study
from formulations import Conditions, Limits, Problem, check, free_form, free_form_bound

TARGETS = {100: 10.0, 1000: 120.0}  # s for motion and proof of seven joints, by number of waypoints
_VELOCITY, _ACCELERATION, _JERK = 2.0, 5.0, 50.0  # limits of every joint [rad/s, rad/s^2, rad/s^3]
_MEGABYTE = 1e6


@dataclass(frozen=True)
class ScaleAnswer:
    """One problem.

    step: longest one of a joint, zones: how far from an inner waypoint it may be passed [rad]. seconds:
    time of the motion, bound: what no motion beats [s]. status: how the proof ended. motion, proof:
    processor time until they were found [s], which is that on an idle core, as there is one thread;
    elapsed: time of the clock for both [s]. memory: peak of the process [bytes], not a number where the
    system does not tell.
    """

    joints: int
    waypoints: int
    step: float
    zones: float
    seed: int
    seconds: float
    feasible: bool
    bound: float
    status: str
    motion: float
    proof: float
    elapsed: float
    memory: float

    @property
    def gap(self) -> float:
        """Seconds over the bound, minus 1."""
        return self.seconds / self.bound - 1.0

    @property
    def whole(self) -> float:
        """Processor time of motion and proof [s]."""
        return self.motion + self.proof


def random_walk(joints: int, waypoints: int, step: float, zones: float = 0.0, seed: int = 0) -> Problem:
    """Draw a problem.

    Parameters
    ----------
    joints, waypoints : int
    step : float [rad]
        Longest step of a joint between two waypoints.
    zones : float [rad]
        How far from each inner waypoint every joint may pass it.
    seed : int
        The same seed draws the same problem.

    Returns
    -------
    Problem
    """
    steps = np.random.default_rng(seed).uniform(-step, step, (waypoints - 1, joints))
    places = np.concatenate([np.zeros((1, joints)), np.cumsum(steps, axis=0)])
    inner = range(1, waypoints - 1) if zones else ()
    asked = Conditions(tolerance={k: np.full(joints, zones) for k in inner})
    limits = Limits.of(_VELOCITY, _ACCELERATION, _JERK, dof=joints)
    return Problem(places, limits, conditions=asked)


def answered_here(
    joints: int, waypoints: int, step: float, zones: float, seed: int, gap: float, time_limit: float
) -> ScaleAnswer:
    """Plan and prove one problem in this process.

    Parameters
    ----------
    joints, waypoints : int
    step, zones : float [rad]
        As of ``random_walk``.
    seed : int
    gap : float
        Relative gap at which the proof ends.
    time_limit : float [s]
        Of the proof.

    Returns
    -------
    ScaleAnswer
    """
    problem = random_walk(joints, waypoints, step, zones, seed)
    begun, started = time.perf_counter(), time.process_time()
    found = free_form(problem, tolerance=gap)
    motion = time.process_time() - started
    feasible = found.trajectory is not None and check(problem, found.trajectory).feasible
    started = time.process_time()
    bound = free_form_bound(problem, gap=gap, upper=found.seconds, time_limit=time_limit)
    proof, elapsed = time.process_time() - started, time.perf_counter() - begun
    return ScaleAnswer(
        joints, waypoints, step, zones, seed, found.seconds, feasible, bound.seconds, bound.ending,
        motion, proof, elapsed, peak_memory(),
    )  # fmt: skip


def answered(*problem: Any) -> list[ScaleAnswer]:
    """Plan and prove one problem in a process of its own.

    Parameters
    ----------
    *problem
        Arguments of ``answered_here``.

    Returns
    -------
    list of ScaleAnswer
        One row.
    """
    with workers(1) as process:
        return [process.submit(answered_here, *problem).result()]


def peak_memory() -> float:
    """Read the most memory that this process has held.

    Returns
    -------
    float
        [bytes], not a number where the system does not tell.
    """
    status = Path("/proc/self/status")
    if status.exists():  # getrusage counts the process that started this one, too
        peak = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM:"))
        return 1024.0 * int(peak.split()[1])
    if sys.platform == "darwin":
        import resource

        return float(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    return float("nan")


def calls(
    joints: int,
    counts: Sequence[int],
    step: float,
    zones: float,
    seed: int,
    gap: float,
    time_limit: float,
) -> list[Call]:
    """List the calls of the study, one per number of waypoints.

    Parameters
    ----------
    joints : int
    counts : sequence of int
        Numbers of waypoints.
    step, zones : float [rad]
    seed : int
    gap : float
    time_limit : float [s]
        As of ``answered_here``.

    Returns
    -------
    list of tuples
        Arguments of ``answered``.
    """
    return [(joints, count, step, zones, seed, gap, time_limit) for count in counts]


def summarise(rows: list[ScaleAnswer]) -> list[dict[str, Any]]:
    """Return all rows as plain data, with gap and whole time; None where a number is missing.

    Parameters
    ----------
    rows : list of ScaleAnswer

    Returns
    -------
    list of dict
    """
    found = []
    for row in rows:
        memory = row.memory if np.isfinite(row.memory) else None
        found.append(asdict(row) | {"memory": memory, "gap": row.gap, "whole": row.whole})
    return found


def as_text(rows: list[ScaleAnswer], summary: list[dict[str, Any]]) -> str:
    """Lay the rows out as a table.

    Parameters
    ----------
    rows : list of ScaleAnswer
    summary : list of dict
        Of ``summarise``.

    Returns
    -------
    str
    """
    head = ["waypoints", "joints", "motion takes [s]", "gap", "found [s]", "proved [s]", "both [s]"]
    head += ["by the clock [s]", "memory [MB]", "proof"]
    lines = [
        [
            str(row.waypoints), str(row.joints), f"{row.seconds:.5g}", f"{row.gap:.1e}", f"{row.motion:.2f}",
            f"{row.proof:.2f}", f"{row.whole:.2f}", f"{row.elapsed:.2f}", f"{row.memory / _MEGABYTE:.0f}",
            row.status,
        ]
        for row in rows
    ]  # fmt: skip
    return table(head, lines, right=tuple(range(9)))


@styled
def figure(rows: list[ScaleAnswer], summary: list[dict[str, Any]]) -> Figure:
    """Draw time and memory against the number of waypoints, beside a slope of 1 and the times aimed at.

    Parameters
    ----------
    rows : list of ScaleAnswer
    summary : list of dict
        Of ``summarise``.

    Returns
    -------
    Figure
    """
    drawn, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.8))
    rows = sorted(rows, key=lambda row: row.waypoints)
    counts = np.array([row.waypoints for row in rows])
    whole = np.array([row.whole for row in rows])
    for label, values, colour, mark in (
        ("motion", [row.motion for row in rows], BLUE, "o"),
        ("proof", [row.proof for row in rows], ORANGE, "s"),
        ("both", whole, BLACK, "D"),
    ):
        left.plot(counts, values, color=colour, marker=mark, ms=5, label=label)
    for k, (waypoints, seconds) in enumerate(TARGETS.items()):
        left.plot(
            [waypoints / 1.6, waypoints * 1.6], [seconds, seconds], color=VERMILION, lw=2,
            label=None if k else "aimed at",
        )  # fmt: skip
        words = f"{seconds:g} s for {waypoints:,}"
        left.annotate(words, (waypoints / 1.6, seconds), (0, 4), textcoords="offset points", fontsize=8)
    left.set_ylabel("processor time [s]")
    right.plot(
        counts, [row.memory / _MEGABYTE for row in rows], color=GREEN, marker="^", ms=5,
        label="peak of the process",
    )  # fmt: skip
    right.set_ylabel("memory [MB]")
    _linear(left, counts, float(whole[-1]))
    if np.isfinite(rows[-1].memory):
        _linear(right, counts, rows[-1].memory / _MEGABYTE)
    for axes in (left, right):
        axes.set(xscale="log", yscale="log", xlabel="waypoints")
        axes.set_xticks(counts, [f"{count:,}" for count in counts])
        axes.minorticks_off()
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.legend(frameon=False, fontsize=8)
    left.set_ylim(top=2.0 * max(float(whole.max()), *TARGETS.values()))
    if np.isfinite(rows[-1].memory):
        least, most = (pick(row.memory for row in rows) / _MEGABYTE for pick in (min, max))
        right.set_ylim(0.2 * least, 2.0 * most)
        right.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    return drawn


def _linear(axes: Axes, counts: Any, last: float) -> None:
    axes.plot(
        counts, last * counts / counts[-1], color=GREY, ls=":", label="in proportion to waypoints"
    )


STUDY = Study(
    name="scale",
    row=ScaleAnswer,
    compute=answered,
    summarise=summarise,
    text=as_text,
    figure=figure,
)
