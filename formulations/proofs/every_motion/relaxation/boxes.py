"""Boxes: intervals that hold durations, accelerations and positions of all motions looked at."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.every_motion.relaxation.legs import down
from formulations.proofs.every_motion.relaxation.relaxed_problem import DOWN, RelaxedProblem


@dataclass(frozen=True)
class Boxes:
    """Intervals of all variables that have a free range.

    Attributes
    ----------
    durations : Array, shape (K, 2) [s]
        Least and greatest duration of each segment.
    accelerations : Array, shape (K + 1, n, 2) [rad/s^2]
        Least and greatest acceleration of each joint at each waypoint.
    offsets : Array, shape (K + 1, n, 2) [rad]
        Least and greatest position in the zone of each waypoint, from the middle of the zone.
    velocities : Array, shape (K + 1, n, 2) [rad/s]
        Least and greatest velocity of each joint at each waypoint.
    empty : bool
        Whether it is proved that no motion is in the boxes.
    """

    durations: Array
    accelerations: Array
    offsets: Array
    velocities: Array
    empty: bool = False

    @staticmethod
    def around(relaxed: RelaxedProblem, least: Array, most: Array) -> Boxes:
        """Boxes with given durations, all accelerations within the limits, and whole zones.

        Parameters
        ----------
        relaxed : RelaxedProblem
        least, most : Array, shape (K,) [s]
            Of the segments.

        Returns
        -------
        Boxes
            Marked empty where a least duration is above the greatest.
        """
        own = np.stack([np.maximum(relaxed.least, DOWN * relaxed.at_top_speed), relaxed.most], axis=1)
        durations = np.stack([least, most], axis=1)
        return Boxes(
            np.concatenate([durations, own[relaxed.n_segments :]]),
            joined_ends(relaxed, relaxed.a_boxes),
            joined_ends(relaxed, relaxed.zones[..., None] * (-1.0, 1.0)),
            joined_ends(relaxed, relaxed.v_boxes),
            bool((least > most).any()),
        )

    @property
    def width(self) -> float:
        """Sum over the segments of the relative width of the duration's interval."""
        low, high = self.durations.T
        return float((high / np.where(low > 0.0, low, high) - 1.0).sum())


def with_legs(relaxed: RelaxedProblem, boxes: Boxes) -> Boxes:
    """Intersect the durations of legs over several segments with what the segments leave them.

    Parameters
    ----------
    relaxed : RelaxedProblem
    boxes : Boxes

    Returns
    -------
    Boxes
        Empty where an interval is.
    """
    if len(relaxed.legs) == relaxed.n_segments:
        return boxes
    durations, K = boxes.durations.copy(), relaxed.n_segments
    up = 2.0 - down(K + 1)
    low, high = (relaxed.over_legs(durations[:K, side]) for side in (0, 1))
    others = (durations[:K, 0].sum() - low) * down(K + 1) - (1.0 - down(K + 1)) * low
    high = np.minimum(high * up, (relaxed.horizon - np.maximum(others, 0.0)) * up)
    durations[K:, 0] = np.maximum(durations[K:, 0], low[K:] * down(K + 1))
    durations[K:, 1] = np.minimum(durations[K:, 1], high[K:])
    empty = boxes.empty or bool((durations[:, 0] > durations[:, 1]).any())
    return replace(boxes, durations=durations, empty=empty)


def joined_ends(relaxed: RelaxedProblem, intervals: Array) -> Array:
    """Intersect the intervals at both ends of a cycle, which are one waypoint.

    Parameters
    ----------
    relaxed : RelaxedProblem
    intervals : Array, shape (K + 1, n, 2)

    Returns
    -------
    Array, shape (K + 1, n, 2)
        The same where the problem is no cycle.
    """
    if not relaxed.cyclic:
        return intervals
    found = intervals.copy()
    found[[0, -1], :, 0] = intervals[[0, -1], :, 0].max(axis=0)
    found[[0, -1], :, 1] = intervals[[0, -1], :, 1].min(axis=0)
    return found


def clipped(relaxed: RelaxedProblem, boxes: Boxes) -> Boxes:
    """Clip boxes of another horizon to the limits of this one.

    Parameters
    ----------
    relaxed : RelaxedProblem
    boxes : Boxes

    Returns
    -------
    Boxes
    """
    found = []
    for mine, limits in (
        (boxes.accelerations, relaxed.a_boxes),
        (boxes.velocities, relaxed.v_boxes),
    ):
        limits = joined_ends(relaxed, limits)
        low, high = np.maximum(mine[..., 0], limits[..., 0]), np.minimum(mine[..., 1], limits[..., 1])
        found.append(np.stack([low, high], axis=-1))
    return replace(boxes, accelerations=found[0], velocities=found[1])
