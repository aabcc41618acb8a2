"""Boxes: intervals that hold the segment durations and waypoint accelerations of all motions looked at."""

from __future__ import annotations

from dataclasses import dataclass

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
    empty : bool
        Whether it is proved that no motion is in the boxes.
    """

    durations: Array
    accelerations: Array
    empty: bool = False

    @staticmethod
    def around(relaxed: RelaxedProblem, least: Array, most: Array) -> Boxes:
        """Boxes with given durations and all accelerations within the limits.

        Parameters
        ----------
        relaxed : RelaxedProblem
        least, most : Array, shape (K,) [s]

        Returns
        -------
        Boxes
            Marked empty where a least duration is above the greatest.
        """
        limit = np.broadcast_to(relaxed.acceleration, (len(least) + 1, len(relaxed.joints)))
        accelerations = np.stack([-limit, limit], axis=-1)
        return Boxes(np.stack([least, most], axis=1), accelerations, bool((least > most).any()))

    @property
    def width(self) -> float:
        """Sum over the segments of the relative width of the duration's interval."""
        return float((self.durations[:, 1] / self.durations[:, 0] - 1.0).sum())
