"""Each demand of a task in words, and the task without it.

A new kind of demand is one more function in ``_KINDS``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

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
    kinds = (
        ("zone", "the zone of", "tolerance", True),
        ("window", "the window of", "windows", False),
        ("passage", "the passage time of", "passage", False),
    )
    if len(asked.tolerance) > 1:
        points = replace(asked, tolerance={})
        yield TaskWithout("zones", "all zones together", None, True, problem, points)
    for demand, words, key, saves in kinds:
        given: Mapping[int, Any] = getattr(asked, key)
        ends = (0, last) if asked.cyclic and demand == "zone" else ()  # they are one waypoint
        for k in sorted(given):
            if k == last and ends:
                continue
            gone = set(ends) if k in ends else {k}
            rest: dict[str, Any] = {key: _less(given, gone)}
            less = replace(asked, **rest)
            yield TaskWithout(demand, f"{words} waypoint {k + 1}", k, saves, problem, less)
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


_KINDS: tuple[Callable[[Problem], Iterator[TaskWithout]], ...] = (
    _of_waypoints,
    _of_segments,
    _of_ends,
    _of_directions,
)


def _less(given: Mapping[int, Any], gone: Iterable[int]) -> dict[int, Any]:
    dropped = set(gone)
    return {k: value for k, value in given.items() if k not in dropped}
