"""What the descent over durations and waypoint states has to keep."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from formulations.problem.arrays import Array, Truths
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem


@dataclass(frozen=True)
class ChainTask:
    """Segments, zones and limits of the joints that move; limits are the same in both directions.

    Attributes
    ----------
    displacements : Array, shape (K, n) [rad]
        Between the middles of the zones.
    zones : Array, shape (K + 1, n) [rad]
        How far a waypoint may be from its middle; 0 where it is fixed.
    least : Array, shape (K,) [s]
        Least durations.
    velocities, accelerations, jerks : Array, shape (K, n)
        Limits of the segments; a jerk limit of 0 means none.
    v_boxes, a_boxes : Array, shape (K + 1, n, 2)
        Least and greatest velocity and acceleration at the waypoints.
    """

    displacements: Array
    zones: Array
    least: Array
    velocities: Array
    accelerations: Array
    jerks: Array
    v_boxes: Array
    a_boxes: Array

    @staticmethod
    def of(relaxed: RelaxedProblem) -> ChainTask:
        """Take over a relaxed problem without conditions.

        Parameters
        ----------
        relaxed : RelaxedProblem

        Returns
        -------
        ChainTask
        """
        return ChainTask(
            relaxed.displacements,
            relaxed.zones,
            relaxed.least,
            relaxed.velocities[..., 1],
            relaxed.accelerations[..., 1],
            relaxed.jerks,
            relaxed.v_boxes,
            relaxed.a_boxes,
        )

    @cached_property
    def velocity(self) -> Array:
        """The greatest velocity limit of each joint, the unit of its velocities, (n,) [rad/s]."""
        return np.asarray(self.velocities.max(axis=0))

    @cached_property
    def acceleration(self) -> Array:
        """The greatest acceleration limit of each joint, the unit of its accelerations, (n,) [rad/s^2]."""
        return np.asarray(self.accelerations.max(axis=0))

    @cached_property
    def has_jerk(self) -> Truths:
        """Which joints have a jerk limit, (n,)."""
        return np.asarray((self.jerks > 0.0).any(axis=0))

    @cached_property
    def in_zones(self) -> bool:
        """Whether a position at a waypoint is free."""
        return bool((self.zones > 0.0).any())

    @cached_property
    def shares(self) -> tuple[Array, Array]:
        """The boxes of velocities and accelerations in units of the limits, (K + 1, n, 2) each."""
        return self.v_boxes / self.velocity[:, None], self.a_boxes / self.acceleration[:, None]
