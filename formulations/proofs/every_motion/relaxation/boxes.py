"""Boxes: intervals that hold durations, accelerations and positions of all motions looked at."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem


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

        Returns
        -------
        Boxes
            Marked empty where a least duration is above the greatest.
        """
        return Boxes(
            np.stack([least, most], axis=1),
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
