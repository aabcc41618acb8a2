"""Legs: from one waypoint that is kept to the next, or to one beyond, and what is asked for on them.

A leg over several segments has rows of its own. They are sharp where a motion passes the waypoints in between
at no particular place and time, as it does where zones meet or are just passed through.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from formulations.problem.arrays import Array, Indices
from formulations.problem.demands import Demands
from formulations.proofs.every_motion.relaxation.kept_waypoints import gaps

_OVER, _MOST = 4, 100  # segments in a leg, and legs over several, at most
LONG = 30  # segments: above, legs over several are posed only where a segment may take no time


def legs_between(demands: Demands, kept: Indices) -> Indices:
    """List the legs: all segments, and legs over zones without a wait, short ones first.

    Many segments are bounded in time proportional to their number where no row goes beyond one of them.

    Parameters
    ----------
    demands : Demands
    kept : Indices, shape (K + 1,)
        Waypoints.

    Returns
    -------
    Indices, shape (L, 2)
        Their ends, as places in ``kept``; the K segments come first.
    """
    first = np.arange(max(len(kept) - 1, 0))
    legs = np.stack([first, first + 1], axis=1)
    if demands.plain:
        return legs
    box = demands.waypoints[kept]
    meets = np.asarray(gaps(box, legs).max(axis=(1, 2), initial=0.0) <= 0.0)
    zone = (box[..., 0] < box[..., 1]).any(axis=1) & (demands.waits[kept] == 0.0)
    over = [
        (i, i + many)
        for many in range(2, _OVER + 1)
        for i in range(len(kept) - many)
        if zone[i + 1 : i + many].all() and (len(legs) <= LONG or meets[i : i + many].any())
    ]
    return np.concatenate([legs, np.array(over[:_MOST], dtype=np.intp).reshape(-1, 2)])


class LegLimits:
    """Limits and times of legs, from those of the problem's segments on them."""

    def __init__(self, legs: Indices) -> None:
        """Take the legs as slices of the problem's segments.

        Parameters
        ----------
        legs : Indices, shape (L, 2)
            The problem's waypoints at their ends.
        """
        self.parts = [slice(i, k) for i, k in legs.tolist()]

    def _each(self, of: Callable[[slice], Array], shape: tuple[int, ...]) -> Array:
        return np.array([of(part) for part in self.parts]).reshape(len(self.parts), *shape)

    def hull(self, intervals: Array) -> Array:
        """Compute the intervals that hold those of all segments of a leg.

        Parameters
        ----------
        intervals : Array, shape (n_segments, n, 2)

        Returns
        -------
        Array, shape (L, n, 2)
        """
        low = self._each(lambda part: intervals[part, :, 0].min(axis=0), intervals.shape[1:2])
        high = self._each(lambda part: intervals[part, :, 1].max(axis=0), intervals.shape[1:2])
        return np.stack([low, high], axis=-1)

    def least(self, demands: Demands) -> Array:
        """Compute the time that is asked for at least, with waits at waypoints that are not kept.

        Parameters
        ----------
        demands : Demands

        Returns
        -------
        Array, shape (L,) [s]
        """

        def least(part: slice) -> Array:
            inside = demands.waits[part.start + 1 : part.stop]
            return down(2 * len(inside) + 2) * (demands.durations[part, 0].sum() + inside.sum())

        return self._each(least, ())

    def most(self, demands: Demands) -> Array:
        """Compute the time that is asked for at most.

        Parameters
        ----------
        demands : Demands

        Returns
        -------
        Array, shape (L,) [s]
            Infinite where there is a wait in between.
        """

        def most(part: slice) -> Array:
            inside = demands.waits[part.start + 1 : part.stop]
            whole = demands.durations[part, 1].sum() * (2.0 - down(len(inside) + 1))
            return np.asarray(np.inf if inside.any() else whole)

        return self._each(most, ())


def down(terms: int) -> float:
    """Compute a factor that makes a sum of floats less than their exact sum.

    Parameters
    ----------
    terms : int
        How many positive terms are added up.

    Returns
    -------
    float
        Just below 1.
    """
    return 1.0 - (terms + 1) * 2.0**-52
