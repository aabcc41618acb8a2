"""Each demand of a task in words, and the task without it.

A new kind of demand is one more function in ``_KINDS``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from formulations.dynamics import dynamics_of
from formulations.problem.conditions import Conditions
from formulations.problem.problem import Problem


class TaskWithout(NamedTuple):
    """One demand, and the task without it."""

    demand: str
    what: str
    place: int | None
    saves: bool
    problem: Problem
    conditions: Conditions


def left_out(problem: Problem) -> Iterator[TaskWithout]:
    """Leave out each demand of a problem in turn.

    Parameters
    ----------
    problem : Problem
        With its conditions.

    Yields
    ------
    TaskWithout
        The total time alone, where it is given.
    """
    asked = problem.conditions
    if problem.n_segments in asked.times(problem):
        less = asked.without_total(problem)
        yield TaskWithout("total", "the given total time", None, False, problem, less)
        return
    for kind in _KINDS:
        yield from kind(problem)


def _of_waypoints(problem: Problem) -> Iterator[TaskWithout]:
    asked, last = problem.conditions, problem.n_segments
    zones = asked.boxes(problem.dof)  # a ball of the tool is a zone too
    if len(zones) > 1:
        points = replace(asked, tolerance={}, tool_zones={})
        yield TaskWithout("zones", "all zones together", None, True, problem, points)
    ends = {0, last} if asked.cyclic else set()  # they are one waypoint
    for k in sorted(zones):
        if k == last and ends:
            continue
        gone = ends if k in ends else {k}
        less = replace(
            asked, tolerance=_less(asked.tolerance, gone), tool_zones=_less(asked.tool_zones, gone)
        )
        yield TaskWithout("zone", f"the zone of waypoint {k + 1}", k, True, problem, less)
    for demand, words, key in (
        ("window", "the window of", "windows"),
        ("passage", "the passage time of", "passage"),
    ):
        given: Mapping[int, Any] = getattr(asked, key)
        for k in sorted(given):
            rest: dict[str, Any] = {key: _less(given, {k})}
            less = replace(asked, **rest)
            yield TaskWithout(demand, f"{words} waypoint {k + 1}", k, False, problem, less)
    for k in sorted(asked.waits):
        less = replace(asked, waits=_less(asked.waits, {k}))
        yield TaskWithout("wait", f"the wait at waypoint {k + 1}", k, False, problem, less)
    for k in sorted(asked.stops - set(asked.waits) - (set() if asked.cyclic else {0, last})):
        less = replace(asked, stops=asked.stops - {k})
        yield TaskWithout("stop", f"the stop at waypoint {k + 1}", k, False, problem, less)


def _of_segments(problem: Problem) -> Iterator[TaskWithout]:
    asked = problem.conditions
    for k, (least, greatest) in sorted(asked.segment_times.items()):
        others = _less(asked.segment_times, {k})
        for demand, there, rest in (
            ("least time", least > 0.0, (0.0, greatest)),
            ("greatest time", np.isfinite(greatest), (least, np.inf)),
        ):
            if there:
                less = replace(asked, segment_times={**others, k: rest})
                yield TaskWithout(demand, f"the {demand} of segment {k + 1}", k, False, problem, less)
    for k in sorted(asked.segment_limits):
        less = replace(asked, segment_limits=_less(asked.segment_limits, {k}))
        yield TaskWithout("segment limits", f"the limits of segment {k + 1}", k, False, problem, less)


def _of_ends(problem: Problem) -> Iterator[TaskWithout]:
    """States at the ends: those given cost against free ones, free ones save against rest."""
    asked = problem.conditions
    for end in ("start", "end"):
        for quantity in ("velocity", "acceleration"):
            key = f"{end}_{quantity}"
            value = getattr(asked, key)
            if value is None:
                continue
            free = isinstance(value, str)
            what = f"the {'free' if free else 'given'} {quantity} at the {end}"
            other: dict[str, Any] = {key: None if free else "free"}
            less = replace(asked, **other)
            yield TaskWithout(f"{end} state", what, None, free, problem, less)
    if asked.cyclic:
        less = replace(asked, cyclic=False)
        yield TaskWithout("cycle", "going round without a halt", None, True, problem, less)


def _of_directions(problem: Problem) -> Iterator[TaskWithout]:
    """Limits that differ between the directions, against the greater one in both."""
    limits = problem.limits
    for quantity in ("velocity", "acceleration"):
        interval = getattr(limits, f"{quantity}_interval")
        for j in () if interval is None else np.flatnonzero(interval.sum(axis=1) != 0.0).tolist():
            even = interval.copy()
            even[j] = np.abs(even[j]).max() * np.array([-1.0, 1.0])
            wider = replace(problem, limits=replace(limits, **{f"{quantity}_interval": even}))
            low, high = np.abs(interval[j])
            way = "back" if low < high else "forth"
            what = f"{problem.joint_name(j)}'s lower {quantity} limit on the way {way}"
            yield TaskWithout("asymmetric limit", what, j, False, wider, problem.conditions)


def _of_tool(problem: Problem) -> Iterator[TaskWithout]:
    """The tool's speed, and its balls against the boxes of the joints alone."""
    asked = problem.conditions
    most = asked.tool_speed
    if most is not None:
        less = replace(asked, tool_speed=None)
        yield TaskWithout("tool speed", "the limit of the tool's speed", None, False, problem, less)
    for k, speed in sorted(asked.segment_tool_speed.items()):
        less = replace(asked, segment_tool_speed=_less(asked.segment_tool_speed, {k}))
        what = f"the limit of the tool's speed on segment {k + 1}"
        saves = most is not None and speed > most
        yield TaskWithout("segment tool speed", what, k, saves, problem, less)
    boxes = asked.boxes(problem.dof)
    for k in sorted(asked.tool_zones):
        less = replace(
            asked,
            tolerance={**asked.tolerance, k: boxes[k]},
            tool_zones=_less(asked.tool_zones, {k}),
        )
        what = f"the ball of the tool at waypoint {k + 1}, within the joints' zone,"
        yield TaskWithout("tool ball", what, k, False, problem, less)


def _of_motors(problem: Problem) -> Iterator[TaskWithout]:
    """The torque limits, all and one by one."""
    torque = problem.conditions.torque
    if torque is None:
        return
    less = problem.conditions.without_torque()
    yield TaskWithout("torque", "the torque limits", None, False, problem, less)
    limits = dynamics_of(torque).limits
    for j in range(problem.dof if problem.dof > 1 else 0):
        free = np.where(np.arange(problem.dof) == j, np.inf, limits)
        less = replace(problem.conditions, torque=torque.scaled(1.0, free))
        what = f"{problem.joint_name(j)}'s torque limit"
        yield TaskWithout("joint torque", what, j, False, problem, less)


_KINDS: tuple[Callable[[Problem], Iterator[TaskWithout]], ...] = (
    _of_waypoints,
    _of_segments,
    _of_ends,
    _of_directions,
    _of_tool,
    _of_motors,
)


def _less(given: Mapping[int, Any], gone: Iterable[int]) -> dict[int, Any]:
    dropped = set(gone)
    return {k: value for k, value in given.items() if k not in dropped}
