"""Which waypoints the relaxation keeps: those that a motion cannot pass at one time with the one before.

A motion with a waypoint less can only be faster, so that leaving one out proves no more than is true. It is
necessary where nothing forces time between two waypoints, since 1 / T would have no bound. It is useful
where a motion passes through a zone on its way: then many positions and times there belong to a fastest
motion, and no narrow box holds them all.
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
    last = len(demands.waits) - 1
    kept = [0]
    for i in range(1, last):
        if i not in without:
            kept.append(i)
    return np.array([*kept, last], dtype=np.intp)


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
