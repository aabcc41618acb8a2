"""Rivals on tasks: one row each, whose numbers come from the independent check of the motion's exact pieces."""

from __future__ import annotations

import importlib.metadata
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from compare.interrupts import ctrl_c_stops
from compare.rivals import RIVALS
from compare.rivals.isolated import Ran, RivalEnding, run_apart
from compare.rivals.rival import Rival, has_zones, require_askable, without_zones
from formulations import NoFeasibleMotion, Problem, Trajectory, plan
from formulations.motion.judgement import Judgement, judge
from formulations.problem.errors import UnsupportedProblem

OURS = "timebound"
KEEPS, BREAKS, NO_MOTION, UNSUPPORTED = "keeps all", "breaks", "no motion", "cannot be asked"
NOT_GIVEN = (UNSUPPORTED, RivalEnding.NOT_RUN.value, RivalEnding.NOT_INSTALLED.value)
"""Status of a task that a program was not given."""
_NODES = 8  # of Gauss and Legendre, per piece
_GAP = 1e-4  # asked of our own bound
_ROUNDED, _KEPT = 1e-3, 1e-9  # excess over a limit between which it is written as 1 + excess
_UNITS = {"position": "rad", "velocity": "rad/s", "acceleration": "rad/s²"}


@dataclass(frozen=True)
class RivalRow:
    """One program on one task.

    Attributes
    ----------
    problem, rival, version, status, reason : str
        status: ``keeps all``, ``breaks``, ``no motion``, ``cannot be asked``, or how the process ended.
    time_limit : float
        What the program was given [s].
    claimed, seconds : float or None
        The time that the program states, and that of its pieces [s].
    fastest, bound : float or None
        Of the task: time of the fastest motion that keeps all, and the proved lower bound of all motions [s].
    own_bound : float or None
        The bound that the program itself states, of its own program [s].
    over_fastest, over_bound : float or None
        Time over both [1]; below 1 for a motion faster than any that keeps all.
    length, deviation : float or None
        Length of the path in joint space, and the largest distance of a joint from a waypoint [rad].
    factor : float or None
        The largest value over its limit.
    mended : float or None
        Time once slowed down until all is kept [s]; None where no stretch mends the motion.
    faults : str
        All that is broken, by name, with the largest factor of each quantity.
    computation : float or None
        Seconds of the program's own work.
    exact : bool
        Whether the task has zones, of which the program knows nothing: it was given the points, and passes
        them exactly.
    """

    problem: str
    rival: str
    version: str
    status: str
    reason: str = ""
    time_limit: float = 0.0
    claimed: float | None = None
    seconds: float | None = None
    fastest: float | None = None
    bound: float | None = None
    own_bound: float | None = None
    over_fastest: float | None = None
    over_bound: float | None = None
    length: float | None = None
    deviation: float | None = None
    factor: float | None = None
    mended: float | None = None
    faults: str = ""
    computation: float | None = None
    exact: bool = False


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
    return {
        "status": KEEPS if found.feasible else BREAKS,
        "seconds": found.seconds,
        "length": path_length(motion),
        "deviation": _off_waypoints(found, problem),
        "factor": max((p.factor for p in found.peaks), default=0.0),
        "mended": found.seconds * max(found.stretch, 1.0) if np.isfinite(found.stretch) else None,
        "faults": "; ".join(_faults(found)),
    }


def _off_waypoints(found: Judgement, problem: Problem) -> float:
    """The largest distance of a joint from a waypoint as the motion passes it [rad]."""
    motion = found.motion
    return float(np.abs(motion.at(motion.passage_times) - problem.waypoints).max())


def _faults(found: Judgement) -> list[str]:
    """All that is broken: each quantity with its worst joint and the number of the others."""
    words = [
        f"{quantity} {limit_factor(mine[0].factor)} of its limit (joint {mine[0].joint + 1}{_more(mine)})"
        for quantity, mine in _by_quantity(found.violations)
    ]
    words += [
        f"{quantity} jumps by {mine[0].size:.1e} {_UNITS[quantity]} (joint {mine[0].joint + 1}{_more(mine)})"
        for quantity, mine in _by_quantity(found.jumps)
    ]
    words += [
        f"{quantity} not zero at rest (joint {mine[0].joint + 1}{_more(mine)})"
        for quantity, mine in _by_quantity(found.not_at_rest)
    ]
    if found.missed:
        worst = max(found.missed, key=lambda m: abs(m.distance))
        words.append(
            f"misses waypoint {worst.waypoint + 1} by {abs(worst.distance):.3g} rad{_more(found.missed)}"
        )
    words += found.unkept
    if found.missed_total is not None:
        words.append(f"takes {found.seconds:.6g} s, asked for {found.missed_total:.6g} s")
    return words


def _by_quantity(faults: Iterable[Any]) -> list[tuple[str, list[Any]]]:
    """Faults by their quantity, the worst one of each first, as they come."""
    found: dict[str, list[Any]] = {}
    for fault in faults:
        found.setdefault(fault.quantity, []).append(fault)
    return list(found.items())


def _more(faults: Any) -> str:
    return f", and {len(faults) - 1} more" if len(faults) > 1 else ""


def limit_factor(factor: float) -> str:
    """Write a value over its limit, so that an excess within rounding is seen.

    Parameters
    ----------
    factor : float

    Returns
    -------
    str
        ``1.305``, or ``1 + 1.6e-08``.
    """
    excess = factor - 1.0
    return f"1 + {excess:.1e}" if _KEPT < excess < _ROUNDED else f"{factor:.3f}"


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


def answered(
    problem: Problem, zoned: Problem | None, key: str, version: str, seconds: float, memory: int
) -> list[RivalRow]:
    """Run one program on one task, as a call of the study.

    Parameters
    ----------
    problem : Problem
    zoned : Problem or None
        The same task with zones, for which the motion of a program that knows none is judged too.
    key : str
        Of ``RIVALS``, or ``OURS``.
    version : str
        Of its package: a stored row of another version is not kept.
    seconds : float
        Time limit of its work [s].
    memory : int
        Bytes that it may hold.

    Returns
    -------
    list of RivalRow
        One row per task.
    """
    if key != OURS:
        tasks = [problem] if zoned is None else [problem, zoned]
        return run_rival(tasks, RIVALS[key], seconds=seconds, memory=memory)
    with ctrl_c_stops() as stop:  # the solvers' own code does not hear of Ctrl-C
        row = _ours(problem, seconds, stop)
        if stop():
            raise KeyboardInterrupt
    return [row]


def run_rival(tasks: Sequence[Problem], rival: Rival, *, seconds: float, memory: int) -> list[RivalRow]:
    """Run one rival once, and judge what it answers on each task.

    Parameters
    ----------
    tasks : sequence of Problem
        They differ in their zones alone. A rival that knows no zones is given the points: its motion, which
        passes them exactly, is valid within any zones.
    rival : Rival
    seconds : float
        Time limit of its work [s].
    memory : int
        Bytes that it may hold.

    Returns
    -------
    list of RivalRow
        One row per task.
    """
    asked = tasks[0] if rival.zones else without_zones(tasks[0])
    called: dict[str, Any] = {
        "rival": rival.key,
        "version": version_of(rival.package),
        "time_limit": seconds,
    }
    if not rival.refusal:
        try:
            require_askable(asked, rival)
        except UnsupportedProblem as reason:
            called |= {"status": UNSUPPORTED, "reason": str(reason)}
            return [RivalRow(problem=task.name, **called) for task in tasks]
    ran = run_apart(rival, asked, seconds=seconds, memory=memory)
    called |= {"reason": ran.reason, "computation": ran.computation}
    given = ran.ending not in (RivalEnding.NOT_RUN, RivalEnding.NOT_INSTALLED)
    rows = []
    for task in tasks:
        row = RivalRow(problem=task.name, **called | _outcome(task, ran))
        if given and not rival.zones and has_zones(task):
            row = replace(row, exact=True)
            if row.deviation is not None:  # from the points, and not where it enters their zones
                row = replace(row, deviation=_outcome(asked, ran)["deviation"])
        rows.append(row)
    return rows


def _outcome(task: Problem, ran: Ran) -> dict[str, Any]:
    """The entries of a row that follow from an answer."""
    answer = ran.answer
    if ran.ending is not RivalEnding.ANSWERED or answer is None:
        return {"status": ran.ending.value}
    said = {"claimed": answer.claimed, "own_bound": answer.bound}
    if answer.motion is None:
        return {**said, "status": NO_MOTION}
    if answer.motion.dof != task.dof:
        words = f"answers {answer.motion.dof} joints of {task.dof}"
        return {**said, "status": BREAKS, "reason": words}
    entries = judged(task, answer.motion)
    if (
        answer.claimed is not None
        and abs(answer.claimed - entries["seconds"]) > 1e-6 * entries["seconds"]
    ):
        claim = f"claims {answer.claimed:.6g} s, takes {entries['seconds']:.6g} s"
        entries["faults"] = f"{claim}; {entries['faults']}".removesuffix("; ")
        entries["status"] = BREAKS
    return {**said, **entries}


def _ours(problem: Problem, seconds: float, stop: Callable[[], bool]) -> RivalRow:
    called: dict[str, Any] = {
        "problem": problem.name,
        "rival": OURS,
        "version": version_of(OURS),
        "time_limit": seconds,
    }
    begun = time.perf_counter()
    try:
        found = plan(problem, conditions=problem.conditions, gap=_GAP, time_limit=seconds, stop=stop)
    except NoFeasibleMotion as reason:
        return RivalRow(**called, status=NO_MOTION, reason=str(reason))
    called |= {"computation": time.perf_counter() - begun, "bound": found.bound or None}
    if found.found.trajectory is None:
        return RivalRow(**called, status=KEEPS, reason="no joint moves", seconds=0.0)
    return RivalRow(
        **called, claimed=found.seconds, own_bound=found.bound, **judged(problem, found.trajectory)
    )


def version_of(package: str) -> str:
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
