"""Which waypoints the relaxation keeps: all but those that ask for nothing, and those that it is told.

A motion with a waypoint less can only be faster, so that leaving one out proves no more than is true. It is
useful where a motion passes through a zone on its way: then many positions and times there belong to a
fastest motion, and no narrow box holds them all.
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array, Indices
from formulations.problem.demands import Demands


def kept_waypoints(demands: Demands, without: frozenset[int] = frozenset()) -> Indices:
    """List the waypoints that are kept, in their order.

    Of a plain problem: where a segment with a displacement starts, and the end of the last one.

    Parameters
    ----------
    demands : Demands
    without : frozenset of int
        Inner waypoints to leave out besides.

    Returns
    -------
    Indices, shape (K + 1,)
        Empty where a plain problem has no displacement.
    """
    if demands.plain:
        moving = np.flatnonzero((demands.problem.displacements != 0.0).any(axis=1))
        return np.append(moving, moving[-1:] + 1)
    return np.array([i for i in range(len(demands.waits)) if i not in without], dtype=np.intp)


def idle_waypoints(demands: Demands) -> frozenset[int]:
    """Find inner waypoints that ask for nothing: a motion may be there when it is at a neighbour.

    Their box holds that of the waypoint before or after them, nothing forces time in between, and the limits
    before and after them are the same.

    Parameters
    ----------
    demands : Demands

    Returns
    -------
    frozenset of int
        Without these the fastest motion takes as long. None for a plain problem.
    """
    if demands.plain:
        return frozenset()
    found: set[int] = set()
    for ahead in (-1, 1):
        inner = range(1, len(demands.waits) - 1)
        for i in inner if ahead < 0 else reversed(inner):
            beside = i + ahead
            while beside in found:
                beside += ahead
            if i not in found and _idle(demands, i, beside):
                found.add(i)
    return frozenset(found)


def _idle(demands: Demands, i: int, beside: int) -> bool:
    between = slice(min(i, beside), max(i, beside))
    around = slice(min(i - 1, beside), max(i, beside - 1) + 1)  # segments before, between and after
    limits = (demands.velocity, demands.acceleration, demands.jerk, demands.position)
    mine, other = demands.waypoints[i], demands.waypoints[beside]
    return bool(
        (mine[:, 0] <= other[:, 0]).all()
        and (other[:, 1] <= mine[:, 1]).all()
        and not demands.stops[i]
        and not demands.durations[between, 0].any()
        and np.isinf(demands.durations[around, 1]).all()
        and demands.passages[i, 0] <= 0.0
        and np.isinf(demands.passages[i, 1])
        and all((of[around] == of[i]).all() for of in limits)
    )


def gaps(boxes: Array, legs: Indices) -> Array:
    """Compute the least distance between the zones at both ends of legs, backwards and forwards.

    Parameters
    ----------
    boxes : Array, shape (K + 1, n, 2) [rad]
        Least and greatest position.
    legs : Indices, shape (L, 2)
        Waypoints at their ends.

    Returns
    -------
    Array, shape (L, n, 2) [rad]
        0 where a joint need not move in that direction; each rounded once.
    """
    start, end = boxes[legs[:, 0]], boxes[legs[:, 1]]
    apart = [start[..., 0] - end[..., 1], end[..., 0] - start[..., 1]]
    return np.maximum(np.stack(apart, axis=-1), 0.0)
