"""The bound under conditions: the motion is cut at its stops, and the bounds of its parts are added up.

Between two stops a motion runs from rest to rest, so the bound of every motion holds for that part alone.
Three kinds of condition change what is proved:

*Segment limits.* A part is bounded under the looser of its segments' limits, joint by joint. Each of its
motions keeps those too.

*End velocities.* A motion that does not start from rest, or does not end at rest, can be faster than any
from rest to rest. Of such a part only this is proved: no segment is faster than its displacement at top
speed.

*Passage times.* A waypoint that is passed at T seconds is passed no earlier, and the segments after it take
at least their displacements at top speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.closed_forms import SAFE

_DOWN = 1.0 - 1e-15  # more than the rounding of one sum or product


@dataclass(frozen=True)
class Part:
    """A motion between two stops.

    Attributes
    ----------
    problem : Problem
        Its waypoints, under limits that each of its motions keeps.
    first, last : int
        Its waypoints in the whole problem.
    rests : bool
        Whether it starts from rest and ends at rest.
    least : Array, shape (last - first,) [s]
        Lower bounds on its segments: displacement at top speed, rounded down.
    """

    problem: Problem
    first: int
    last: int
    rests: bool
    least: Array


def parts_of(problem: Problem, conditions: Conditions) -> list[Part]:
    """Cut a problem at the stops of its conditions.

    Parameters
    ----------
    problem : Problem
    conditions : Conditions
        Valid for the problem.

    Returns
    -------
    list of Part
        In their order; together they have all segments.
    """
    n = problem.n_segments
    cuts = sorted({0, n, *conditions.stops})
    derivatives = conditions.derivatives(problem)
    positions = conditions.position_bounds(problem)
    from_speed, to_speed = (bool(end.any()) for end in conditions.end_velocities(problem))
    distances = np.abs(problem.displacements)
    least = (distances / derivatives[0]).max(axis=1) * (1.0 - SAFE)
    slack, found = problem.position_slack, []
    for first, last in pairwise(cuts):
        inside = slice(first, last)
        velocity, acceleration, jerk = derivatives[:, inside].max(axis=1)
        low = positions[inside, :, 0].min(axis=0) - slack
        high = positions[inside, :, 1].max(axis=0) + slack
        limits = replace(
            problem.limits,
            velocity=velocity,
            acceleration=acceleration,
            jerk=jerk,
            position=np.stack([low, high], axis=1),
        )
        part = replace(problem, waypoints=problem.waypoints[first : last + 1].copy(), limits=limits)
        rests = not ((first == 0 and from_speed) or (last == n and to_speed))
        found.append(Part(part, first, last, rests, least[inside]))
    return found


def added_up(parts: Sequence[Part], bounds: Sequence[float], times: dict[int, float]) -> float:
    """Add up the bounds of the parts, and take account of the fixed times.

    Parameters
    ----------
    parts : sequence of Part
    bounds : sequence of float [s]
        A lower bound of each.
    times : dict of int to float [s]
        Fixed times of waypoints, from the start.

    Returns
    -------
    float
        Lower bound on the total time [s], rounded down.
    """
    reached = 0.0  # no motion is at the end of the part any sooner
    for part, bound in zip(parts, bounds, strict=True):
        sooner = [(reached + bound) * _DOWN]
        for waypoint, time in times.items():
            if part.first < waypoint <= part.last:
                after = float(part.least[waypoint - part.first :].sum()) * (1.0 - SAFE)
                sooner.append((time + after) * _DOWN if after else time)
        reached = max(sooner)
    return reached
