"""Rivals on tasks: one row each, whose numbers come from the independent check of the motion's exact pieces."""

from __future__ import annotations

import importlib.metadata
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from compare.rivals.isolated import RivalEnding, run_apart
from compare.rivals.rival import Rival
from formulations import NoFeasibleMotion, Problem, Trajectory, plan
from formulations.motion.judgement import judge
from formulations.problem.errors import UnsupportedProblem

OURS = "timebound"
KEEPS, BREAKS, NO_MOTION, UNSUPPORTED = "keeps all", "breaks", "no motion", "cannot be asked"
_NODES = 8  # of Gauss and Legendre, per piece


@dataclass(frozen=True)
class RivalRow:
    """One program on one task.

    Attributes
    ----------
    problem, rival, version, status, reason : str
        status: ``keeps all``, ``breaks``, ``no motion``, ``cannot be asked``, or how the process ended.
    claimed, seconds : float or None
        The time that the program states, and that of its pieces [s].
    bound : float or None
        The proved lower bound of all motions [s].
    own_bound : float or None
        The bound that the program itself states, of its own program [s].
    length, deviation : float or None
        Length of the path in joint space, and the largest distance of a joint from a waypoint [rad].
    factor : float or None
        The largest value over its limit.
    mended : float or None
        Time once slowed down until all is kept [s]; None where no stretch mends the motion.
    faults : tuple of str
        All that is broken.
    computation : float or None
        Seconds of the program's own work.
    """

    problem: str
    rival: str
    version: str
    status: str
    reason: str = ""
    claimed: float | None = None
    seconds: float | None = None
    bound: float | None = None
    own_bound: float | None = None
    length: float | None = None
    deviation: float | None = None
    factor: float | None = None
    mended: float | None = None
    faults: tuple[str, ...] = ()
    computation: float | None = None

    @property
    def gap(self) -> float | None:
        """Time over the proved bound, minus 1; negative for a motion faster than any that keeps all."""
        return None if self.seconds is None or not self.bound else self.seconds / self.bound - 1.0

    def to_json(self) -> dict[str, Any]:
        """Return the row as plain data, the gap with it.

        Returns
        -------
        dict
        """
        return asdict(self) | {"gap": self.gap, "faults": list(self.faults)}


def judged(problem: Problem, motion: Trajectory) -> dict[str, Any]:
    """Judge a motion in continuous time.

    Parameters
    ----------
    problem : Problem
    motion : Trajectory

    Returns
    -------
    dict
        The entries of a row that the check knows.
    """
    found = judge(problem, motion, conditions=problem.conditions)
    faults = [f"{p.quantity} of joint {p.joint + 1} by factor {p.factor:.6g}" for p in found.violations]
    faults += [f"{j.quantity} of joint {j.joint + 1} jumps {j.count} times" for j in found.jumps]
    faults += [f"{j.quantity} of joint {j.joint + 1} not zero at rest" for j in found.not_at_rest]
    faults += [f"misses waypoint {m.waypoint + 1} by {abs(m.distance):.4g}" for m in found.missed]
    away = np.abs(motion.at(found.motion.passage_times) - problem.waypoints).max()
    return {
        "status": KEEPS if found.feasible else BREAKS,
        "seconds": found.seconds,
        "length": path_length(motion),
        "deviation": float(away),
        "factor": max((p.factor for p in found.peaks), default=0.0),
        "mended": found.seconds * max(found.stretch, 1.0) if np.isfinite(found.stretch) else None,
        "faults": tuple(faults),
    }


def path_length(motion: Trajectory) -> float:
    """Return the length of a motion's path in joint space.

    Parameters
    ----------
    motion : Trajectory

    Returns
    -------
    float
        [rad]
    """
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    times = motion.breaks[:-1, None] + motion.durations[:, None] * (nodes + 1.0) / 2.0
    speed = np.linalg.norm(motion.at(times, 1), axis=-1)
    return float(((speed @ weights) * motion.durations / 2.0).sum())


def rows(
    problems: Sequence[Problem],
    rivals: Sequence[Rival],
    *,
    seconds: float,
    memory: int,
    stop: Callable[[], bool] = lambda: False,
    stage: Callable[[str], None] = lambda words: None,
) -> Iterator[RivalRow]:
    """Run rivals on tasks, ours first.

    Parameters
    ----------
    problems : sequence of Problem
    rivals : sequence of Rival
    seconds : float
        Time limit of each run [s].
    memory : int
        Bytes that each may hold.
    stop : callable
        Whether to end; the run that it ends gives a row, and no further run begins.
    stage : callable
        Called with the name of each run as it begins.

    Yields
    ------
    RivalRow
    """
    for problem in problems:
        stage(f"{problem.name}: {OURS}")
        mine = _ours(problem, seconds, stop)
        yield mine
        for rival in rivals:
            if stop():
                return
            stage(f"{problem.name}: {rival.name}")
            yield run_rival(problem, rival, mine.bound, seconds=seconds, memory=memory, stop=stop)
        if stop():
            return


def run_rival(
    problem: Problem,
    rival: Rival,
    bound: float | None,
    *,
    seconds: float,
    memory: int,
    stop: Callable[[], bool] = lambda: False,
) -> RivalRow:
    """Run one rival on one task, and judge what it answers.

    Parameters
    ----------
    problem : Problem
    rival : Rival
    bound : float or None
        The proved lower bound of all motions [s].
    seconds : float
        Time limit of its work [s].
    memory : int
        Bytes that it may hold.
    stop : callable
        Whether to end it now.

    Returns
    -------
    RivalRow
    """
    called: dict[str, Any] = {
        "problem": problem.name,
        "rival": rival.key,
        "version": version(rival.package),
        "bound": bound,
    }
    if not rival.refusal:
        try:
            problem.require_plain(rival.name)
        except UnsupportedProblem as reason:
            return RivalRow(**called, status=UNSUPPORTED, reason=str(reason))
    ran = run_apart(rival, problem, seconds=seconds, memory=memory, stop=stop)
    answer = ran.answer
    called |= {"reason": ran.reason, "computation": ran.computation}
    if ran.ending is not RivalEnding.ANSWERED or answer is None:
        return RivalRow(**called, status=ran.ending.value)
    called |= {"claimed": answer.claimed, "own_bound": answer.bound}
    if answer.motion is None:
        return RivalRow(**called, status=NO_MOTION)
    if answer.motion.dof != problem.dof:
        words = f"answers {answer.motion.dof} joints of {problem.dof}"
        return RivalRow(**called | {"reason": words}, status=BREAKS)
    entries = judged(problem, answer.motion)
    if (
        answer.claimed is not None
        and abs(answer.claimed - entries["seconds"]) > 1e-6 * entries["seconds"]
    ):
        entries["faults"] = (
            f"claims {answer.claimed:.6g} s, takes {entries['seconds']:.6g} s",
            *entries["faults"],
        )
        entries["status"] = BREAKS
    return RivalRow(**called, **entries)


def _ours(problem: Problem, seconds: float, stop: Callable[[], bool]) -> RivalRow:
    called: dict[str, Any] = {"problem": problem.name, "rival": OURS, "version": version(OURS)}
    begun = time.perf_counter()
    try:
        found = plan(problem, conditions=problem.conditions, gap=1e-4, time_limit=seconds, stop=stop)
    except NoFeasibleMotion as reason:
        return RivalRow(**called, status=NO_MOTION, reason=str(reason))
    called |= {"computation": time.perf_counter() - begun, "bound": found.bound or None}
    if found.found.trajectory is None:
        return RivalRow(**called, status=KEEPS, reason="no joint moves", seconds=0.0)
    return RivalRow(
        **called, claimed=found.seconds, own_bound=found.bound, **judged(problem, found.trajectory)
    )


def version(package: str) -> str:
    """Return the version of a package.

    Parameters
    ----------
    package : str

    Returns
    -------
    str
        Empty where it is not installed.
    """
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return ""
