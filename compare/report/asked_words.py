"""What is asked for beyond waypoints and limits, in sentences; waypoints count from 1, as on every page."""

from __future__ import annotations

from collections.abc import Iterator
from math import isinf

import numpy as np

from formulations import Problem
from formulations.problem.condition_values import EndState
from formulations.problem.conditions import Conditions, Interval


def sentences(problem: Problem, asked: Conditions) -> list[str]:
    """Say all that is asked for.

    Parameters
    ----------
    problem : Problem
        Whose waypoints, joints and units they are.
    asked : Conditions

    Returns
    -------
    list of str
        A sentence each.
    """
    return [*_waypoints(problem, asked), *_segments(problem, asked), *_ends(problem, asked)]


def _waypoints(problem: Problem, asked: Conditions) -> Iterator[str]:
    for k, zone in sorted(asked.tolerance.items()):
        near = [problem.amount(value, j, digits=4) for j, value in enumerate(zone)]
        if len(set(near)) == 1:
            yield f"It passes waypoint {k + 1} within {near[0]} in each joint."
        else:
            yield f"It passes waypoint {k + 1} within {', '.join(near)} of its joints."
    for stop in sorted(asked.stops):
        yield f"It stands still at waypoint {stop + 1}."
    for k, time in sorted(asked.waits.items()):
        yield f"It stands still at waypoint {k + 1} for {time:g} s."
    for k, time in sorted(asked.passage.items()):
        yield f"It passes waypoint {k + 1} at {time:g} s."
    for k, window in sorted(asked.windows.items()):
        yield f"It passes waypoint {k + 1} {_between(window)}."
    for k, radius in sorted(asked.tool_zones.items()):
        yield f"Its tool passes waypoint {k + 1} within {1e3 * radius:g} mm."
    if asked.total is not None:
        yield f"It takes {asked.total:g} s."


def _segments(problem: Problem, asked: Conditions) -> Iterator[str]:
    for k, (least, most) in sorted(asked.segment_times.items()):
        way = f"from waypoint {k + 1} to {k + 2}"
        yield (
            f"It takes {least:g} s or more {way}."
            if isinf(most)
            else (f"It takes {least:g} to {most:g} s {way}.")
        )
    if asked.tool_speed is not None:
        yield f"Its tool moves at {asked.tool_speed:g} m/s at most."
    for k, speed in sorted(asked.segment_tool_speed.items()):
        yield f"Its tool moves at {speed:g} m/s at most from waypoint {k + 1} to {k + 2}."
    for k in sorted(asked.segment_limits):
        yield f"Other limits hold from waypoint {k + 1} to {k + 2}."
    if asked.torque is not None:
        load = (
            ""
            if asked.torque.payload is None
            else f", with {asked.torque.payload.mass:g} kg at its end"
        )
        yield f"Its motors keep their torque limits{load}."


def _ends(problem: Problem, asked: Conditions) -> Iterator[str]:
    if asked.cyclic:
        yield "It is one turn of a cycle: it ends with the velocity and the acceleration of its start."
    for end in ("start", "end"):
        for order, quantity in ((1, "velocity"), (2, "acceleration")):
            value: EndState = getattr(asked, f"{end}_{quantity}")
            if isinstance(value, str):
                yield f"Its {quantity} at the {end} is free."
            elif value is not None:
                given = [problem.amount(x, j, order, digits=4) for j, x in enumerate(np.asarray(value))]
                yield f"Its {quantity} at the {end} is {', '.join(given)}."


def _between(window: Interval) -> str:
    early, late = window
    return f"after {early:g} s" if isinf(late) else f"between {early:g} and {late:g} s"
