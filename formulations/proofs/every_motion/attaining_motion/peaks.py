"""Top speed while an acceleration at a waypoint fades: |v| + a^2 / (2 J) <= V, row (10) of ``rows``.

V and J are those of the segment on whose side the acceleration is in the direction of the velocity: there
it has to fall to 0, or it has risen from 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.every_motion.attaining_motion.chain_task import ChainTask

_NONE = 10.0  # top speeds: where no segment follows or came before


@dataclass(frozen=True)
class PeakRows:
    """The rows at all waypoints, in both directions; all in units of the limits.

    Attributes
    ----------
    top, bend : Array, shape (2 sides, K + 1, n)
        V and a^2 / (2 J) at full acceleration, of the segments before and after.
    """

    top: Array
    bend: Array

    @staticmethod
    def of(task: ChainTask) -> PeakRows:
        """Set up the rows.

        Parameters
        ----------
        task : ChainTask

        Returns
        -------
        PeakRows
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            bend = task.acceleration**2 / (2.0 * task.jerks * task.velocity)
        bend = np.where(task.jerks > 0.0, bend, 0.0)
        top = task.velocities / task.velocity
        nothing = np.full((1, top.shape[1]), _NONE)
        return PeakRows(
            np.stack([np.concatenate([nothing, top]), np.concatenate([top, nothing])]),
            np.stack([np.concatenate([bend[:1], bend]), np.concatenate([bend, bend[-1:]])]),
        )

    def at(self, a: Array, sign: float) -> tuple[Array, Array]:
        """Choose the sides for accelerations.

        Parameters
        ----------
        a : Array, shape (K + 1, n)
        sign : float
            Direction, 1 or -1.

        Returns
        -------
        top, bend : Array, shape (K + 1, n)
        """
        after = sign * a > 0.0
        return np.where(after, self.top[1], self.top[0]), np.where(after, self.bend[1], self.bend[0])

    def kept(self, v: Array, a: Array) -> bool:
        """Say whether states keep all rows.

        Parameters
        ----------
        v, a : Array, shape (K + 1, n)

        Returns
        -------
        bool
        """
        for sign in (1.0, -1.0):
            top, bend = self.at(a, sign)
            if (sign * v + bend * a**2 > top).any():
                return False
        return True
