"""Which consecutive waypoints are passed at one time: those that are equal, or whose zones hold each other."""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Truths
from formulations.problem.demands import Demands


def passed_at_once(demands: Demands, vanishing: frozenset[int] = frozenset()) -> Truths:
    """Find the segments that need no time of their own.

    A motion that passes a zone inside another one is in both of them at that time. So nothing is lost.

    Parameters
    ----------
    demands : Demands
    vanishing : frozenset of int
        Segments that are to take no time where their zones overlap, though something may be lost.

    Returns
    -------
    Truths, shape (n_segments,)
    """
    n = len(demands.jerk)
    found = np.zeros(n, dtype=bool)
    start, box = 0, demands.waypoints[0]
    for k in range(n + 1):
        if k < n:
            after = demands.waypoints[k + 1]
            both = np.stack(
                [np.maximum(box[:, 0], after[:, 0]), np.minimum(box[:, 1], after[:, 1])], axis=1
            )
            nested = np.array_equal(both, box) or np.array_equal(both, after)
            if nested or (k in vanishing and bool((both[:, 0] <= both[:, 1]).all())):
                box = both
                continue
            box = after
        if k > start:
            found[start:k] = _at_once(demands, start, k)
        start = k + 1
    return found


def _at_once(demands: Demands, first: int, last: int) -> Truths:
    """Of the segments between waypoints first..last, whose zones have a place in common, those without time."""
    group = slice(first, last + 1)
    early, late = demands.passages[group].T
    is_moving = False
    for end, waypoint in ((0, 0), (1, len(demands.jerk))):
        ends = np.stack([demands.end_velocity[end], demands.end_acceleration[end]])
        given = (ends[..., 0] == ends[..., 1]) & (ends[..., 0] != 0.0)
        is_moving |= first <= waypoint <= last and bool(given.any())
    stands = bool(demands.stops[group].any()) or (first == 0 and last == len(demands.jerk))
    if (
        early.max() > late.min()
        or demands.durations[first:last, 0].any()
        or demands.waits[group].any()
        or (is_moving and stands)
    ):
        # equal fixed times leave no time between
        same = (early[1:] == early[:-1]) & (late[1:] == late[:-1]) & (early[1:] == late[1:])
        return np.asarray(same & ~demands.waits[group][:-1].astype(bool))
    return np.ones(last - first, dtype=bool)
