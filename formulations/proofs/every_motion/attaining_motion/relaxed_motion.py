"""Where and when the relaxation passes the waypoints, and how fast: what a fastest motion is like.

Local searches end in the optimum that is nearest to their start. The relaxation knows no local optimum: where
it is tight, its point is that of the fastest motion of all.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from formulations.problem.arrays import Array, Indices
from formulations.problem.demands import Demands
from formulations.proofs.every_motion.relaxation.columns import Columns


@dataclass(frozen=True)
class RelaxedMotion:
    """The waypoint states of a point of the relaxation.

    Attributes
    ----------
    waypoints : Indices, shape (K + 1,)
        The problem's numbers of those that the relaxation keeps.
    joints : Indices, shape (n,)
        The problem's numbers of those that it keeps.
    durations : Array, shape (K,) [s]
        Between these waypoints, without the waits there.
    positions, velocities, accelerations : Array, shape (K + 1, n) [rad, rad/s, rad/s^2]
    """

    waypoints: Indices
    joints: Indices
    durations: Array
    positions: Array
    velocities: Array
    accelerations: Array

    @staticmethod
    def of(demands: Demands, columns: Columns, x: Array) -> RelaxedMotion:
        """Read the waypoint states off a point.

        Parameters
        ----------
        demands : Demands
            What the relaxed problem was made of.
        columns : Columns
        x : Array, shape (columns.size,)

        Returns
        -------
        RelaxedMotion
        """
        relaxed, K = columns.relaxed, columns.K
        middles = demands.waypoints[relaxed.waypoints][:, relaxed.joints].mean(axis=-1)
        offsets = np.where(columns.e >= 0, x[columns.e] * relaxed.zones, 0.0)
        return RelaxedMotion(
            relaxed.waypoints,
            relaxed.joints,
            (x[columns.T] * columns.typical)[:K],
            middles + offsets,
            x[columns.v] * relaxed.velocity,
            x[columns.a] * relaxed.acceleration,
        )


SearchNear = Callable[[RelaxedMotion], float | None]
