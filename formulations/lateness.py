"""Why a task has no motion: a latest time that is before any motion can be there, proved.

Up to a waypoint the task is one of its own, whose end is free. Its lower bound is the earliest arrival,
and only where this is after the latest time is it said that no motion is in time.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from formulations.deadlines import NEVER, Deadline
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.errors import NoFeasibleMotion, NotFoundInTime
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.bound import free_form_bound

_PROOF, _GAP = 20.0, 1e-5  # s for all bounds together; of each


def too_early(
    problem: Problem, conditions: Conditions | None = None, *, deadline: Deadline = NEVER
) -> str:
    """Look for a latest time that no motion keeps.

    Parameters
    ----------
    problem : Problem
    conditions : Conditions, optional
        In place of the problem's own.
    deadline : Deadline
        Of the search, which takes 20 s at most.

    Returns
    -------
    str
        In one line the condition, its time, and the proved earliest one; empty where nothing was proved.
        Waypoints and segments count from 1, as in all that is printed; keys of the conditions from 0.

    Examples
    --------
    From rest, 0.5 rad at 4 rad/s^2 take 0.5 s at least:

    >>> from formulations import Conditions, Limits, Problem
    >>> problem = Problem.of([[0.0], [0.5], [1.0]], Limits.of(velocity=10.0, acceleration=4.0, dof=1))
    >>> print(too_early(problem, Conditions(windows={1: (0.0, 0.4)})).partition(", ")[0])
    waypoint 2: its latest time (conditions.windows[1]) is 0.4 s
    """
    demands = Demands.of(problem, conditions)
    ends = deadline.within(_PROOF)
    for k, latest in enumerate(demands.passages[:, 1].tolist()):
        if k > 0 and np.isfinite(latest):
            earliest = _least_time(demands, 0, k, ends)
            if earliest > latest:
                return (
                    f"waypoint {k + 1}: its latest time ({_key(demands, k)}) is {latest:.9g} s, "
                    f"{earliest - latest:.3g} s before any motion can be there (proved: none arrives before "
                    f"{earliest:.6g} s)"
                )
    for k, greatest in enumerate(demands.durations[:, 1].tolist()):
        if np.isfinite(greatest):
            least = _least_time(demands, k, k + 1, ends)
            if least > greatest:
                return (
                    f"segment {k + 1}: its greatest time (conditions.segment_times[{k}]) is {greatest:.9g} s, "
                    f"{least - greatest:.3g} s less than any motion takes (proved: none takes less than "
                    f"{least:.6g} s)"
                )
    return ""


@contextmanager
def explained(
    problem: Problem, conditions: Conditions | None = None, *, deadline: Deadline = NEVER
) -> Iterator[None]:
    """Say what is proved of the latest times where no motion is found inside.

    Parameters
    ----------
    problem : Problem
    conditions : Conditions, optional
        In place of the problem's own.
    deadline : Deadline
        Of the proof, which takes 20 s at most.

    Returns
    -------
    context manager

    Raises
    ------
    NoFeasibleMotion
        That of the body, with the proof before its words.
    """
    try:
        yield
    except NotFoundInTime:
        raise
    except NoFeasibleMotion as failure:
        proved = too_early(problem, conditions, deadline=deadline)
        if not proved:
            raise
        raise NoFeasibleMotion(f"{proved}; {failure}") from None


def _key(demands: Demands, waypoint: int) -> str:
    asked = demands.conditions
    if waypoint == demands.problem.n_segments and asked.total is not None:
        return "conditions.total"
    return f"conditions.{'passage' if waypoint in asked.passage else 'windows'}[{waypoint}]"


def _least_time(demands: Demands, first: int, last: int, deadline: Deadline) -> float:
    """Bound the time from leaving ``first`` to arriving at ``last`` from below [s]; 0 where time is over."""
    if deadline.over:
        return 0.0
    part = _part(demands, first, last)
    bound = free_form_bound(part, gap=_GAP, time_limit=deadline.left, stop=deadline.stop)
    return bound.least_verified


def _part(demands: Demands, first: int, last: int) -> Problem:
    """The task between two waypoints, with every demand on it but the latest arrival at the last one.

    An end inside the whole motion is free, unless the motion stands still there.
    """
    whole, asked = demands.problem, demands.conditions
    n = whole.n_segments
    points, segments = range(first, last + 1), range(first, last)
    timed = first == 0  # times of arrival count from the start of the motion

    def states(end: int, at_end: bool, name: str) -> dict[str, object]:
        given = {key: getattr(asked, f"{name}_{key}") for key in ("velocity", "acceleration")}
        if not at_end or asked.cyclic:
            given = dict.fromkeys(given, None if demands.stops[end] else "free")
        return {f"{name}_{key}": value for key, value in given.items()}

    earliest = demands.passages[last, 0]
    windows = {
        k - first: tuple(demands.passages[k].tolist())
        for k in points[1:-1]
        if timed and (demands.passages[k] != (0.0, np.inf)).any()
    }
    if timed and earliest > 0.0:
        windows[last - first] = (float(earliest), np.inf)
    times = {
        k - first: tuple(demands.durations[k].tolist())
        for k in segments
        if timed and k in asked.segment_times
    }
    conditions = Conditions(
        tolerance={k - first: asked.tolerance[k] for k in points if k in asked.tolerance},
        windows=windows,
        segment_times=times,
        stops=frozenset(k - first for k in points[1:-1] if demands.stops[k]),
        waits={k - first: asked.waits[k] for k in points[1:-1] if k in asked.waits},
        segment_limits={
            k - first: replace(given, position=_kept(given.position, demands.position[k], whole))
            for k, given in asked.segment_limits.items()
            if k in segments
        },
        **states(first, first == 0, "start"),  # type: ignore[arg-type]
        **states(last, last == n, "end"),  # type: ignore[arg-type]
    )
    limits = replace(whole.limits, position=_kept(whole.limits.position, whole.position_bounds, whole))
    return Problem(
        whole.waypoints[first : last + 1],
        limits,
        names=whole.names,
        units=whole.units,
        conditions=conditions,
    )


def _kept(given: Array, bounds: Array, whole: Problem) -> Array:
    """Position limits of a part, (dof, 2): as wide as the whole task's, which widens them to its waypoints."""
    slack = whole.position_slack * np.array([-1.0, 1.0])
    return np.where(np.isfinite(given), bounds + slack, given)
