"""The fastest motion through many waypoints: durations and waypoint states at once, in linear time.

The nonlinear programs of ``nlp`` have some thirty variables for each segment and joint, and take minutes
where there are hundreds of waypoints. Between two waypoint states the motion is known, so that two
variables for each joint and waypoint suffice (``proofs.every_motion.attaining_motion``).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from formulations.deadlines import Deadline
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict
from formulations.optima.free_form.chains import ConditionedChain, PlainChain, is_plain, least_ways
from formulations.optima.free_form.ending import SearchStatus
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.optima.free_form.stage import Stage
from formulations.proofs.every_motion.attaining_motion.state_descent import ChainDescent

MANY = 40  # segments from which this search is the faster one, by measurement: 1 s against 6 s there
_WIDE = 200  # segments times joints: fewer are quick in either way
_FINEST = 1e-5  # relative tolerance that the search reaches
_COARSEST = {False: 1e-4, True: 1e-3}  # and what costs it little, on a dense path
_SLOWER = (0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)  # tried in turn until the check is content
_PROGRAMS = 150  # segments up to which the programs are tried where this search does not converge
NAME = "waypoint states of the whole motion"


class FoundInLinearTime(NamedTuple):
    """A verified motion, and how the search for it ended."""

    trajectory: Trajectory
    verdict: Verdict
    status: SearchStatus
    stages: tuple[Stage, ...]


def has_many_waypoints(task: ConditionedProblem) -> bool:
    """Say whether the search in linear time is the better one.

    Parameters
    ----------
    task : ConditionedProblem

    Returns
    -------
    bool
        Not for cycles, latest times, times of arrival, moving ends, limits that differ by direction, and
        joints that have a velocity limit only.
    """
    S, n = task.n_segments, len(task.moving)
    if S < MANY or S * n < _WIDE or task.group(1):
        return False
    if is_plain(task):
        return True
    both_ways = all(np.array_equal(-each[..., 0], each[..., 1]) for each in task.intervals)
    others = task.demands.cyclic or task.windows or task.conditions.ties_joints
    return both_ways and task.stretchable and not others and bool(least_ways(task).any(axis=1).all())


def is_final(found: FoundInLinearTime, task: ConditionedProblem) -> bool:
    """Say whether the programs need not be tried as well.

    Parameters
    ----------
    found : FoundInLinearTime
    task : ConditionedProblem

    Returns
    -------
    bool
        False where this search did not converge, as on dense paths, and the programs are not too large.
    """
    return found.status is not SearchStatus.NOT_CONVERGED or task.n_segments > _PROGRAMS


def found_in_linear_time(
    task: ConditionedProblem,
    tolerance: float,
    deadline: Deadline,
    progress: Callable[[str, float], None] | None = None,
) -> FoundInLinearTime | None:
    """Search for the fastest motion through many waypoints.

    Parameters
    ----------
    task : ConditionedProblem
    tolerance : float
        Relative, of the total time; at least 1e-5.
    deadline : Deadline
        After it the best motion so far is the answer; the first one is stop and go, or a smooth timing of a
        dense path.
    progress : callable, optional
        Called as ``progress(stage, seconds)`` whenever a faster motion was found.

    Returns
    -------
    FoundInLinearTime or None
        None where the check refuses the motion: it may leave the position limits between waypoints.
    """
    clock = time.perf_counter()
    chain = PlainChain(task.problem) if is_plain(task) else ConditionedChain(task)
    descent = ChainDescent(chain.task, chain.start, chain.path, deadline)
    start = "smooth timing" if descent.dense else "stop and go"
    stages = [Stage(start, descent.seconds + chain.waits, "", time.perf_counter() - clock)]
    clock = time.perf_counter()

    def say(seconds: float) -> None:
        if progress is not None:
            progress(NAME, seconds + chain.waits)

    say(descent.seconds)
    with np.errstate(all="ignore"):  # what overflows is not finite, and the check refuses it
        descent.run(max(min(tolerance, _COARSEST[descent.dense]), _FINEST), deadline, say)
        status = SearchStatus.OK if descent.converged else SearchStatus.NOT_CONVERGED
        if not descent.converged and deadline.over:
            status = SearchStatus.INTERRUPTED if deadline.interrupted else SearchStatus.TIME_LIMIT
        for share in _SLOWER:
            found = chain.judged(descent.best.slower(1.0 + share))
            if found is None:
                return None
            motion, verdict = found
            if verdict.feasible:
                stages.append(Stage(NAME, verdict.seconds, "", time.perf_counter() - clock))
                return FoundInLinearTime(motion, verdict, status, tuple(stages))
            if not verdict.position_kept:
                return None
    return None
