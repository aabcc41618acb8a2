"""How far a step of the descent may go: a radius at each segment and each joint by itself.

Segments far apart hardly feel one another. A radius shrinks where a step missed more than its linear rows
foresaw and more than half of what was missed before, and grows elsewhere.
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array, Truths
from formulations.proofs.every_motion.attaining_motion.chain_columns import ChainColumns
from formulations.proofs.every_motion.attaining_motion.chain_task import ChainTask
from formulations.proofs.every_motion.attaining_motion.reach_rows import ChainPoint

_WIDEST, _NARROWER, _WIDER = 0.5, 0.6, 1.4
_BEND = 0.3  # of what a row may miss: what the first step's change of a duration misses on a dense path
_NOTHING = 1e-6  # missed, in units of the rows


class TrustRegion:
    """Radii of durations, relative, and of states, in units of their limits.

    Attributes
    ----------
    width : Array, shape (K,)
    reach : Array, shape (K + 1, n)
    """

    def __init__(self, task: ChainTask) -> None:
        K, n = task.displacements.shape
        self.task = task
        self.width, self.reach = np.full(K, _WIDEST), np.ones((K + 1, n))

    def suit(self, point: ChainPoint, units: Array) -> None:
        """Begin with the radii in which the rows of a dense path are nearly linear.

        Parameters
        ----------
        point : ChainPoint
        units : Array, shape (K, n)
            Of the rows. A relative change x of a duration misses about x^2 of the mean speed.
        """
        speed = np.abs(self.task.displacements) / (point.T[:, None] * self.task.velocity)
        width = np.sqrt(_BEND * units / np.maximum(speed, 1e-9)).min(axis=1)
        self.width = np.clip(width, 1e-4, _WIDEST)

    def adapt(self, missing: Array, before: Array, foreseen: Array, allowed: float = 0.0) -> None:
        """Narrow the radii where a step missed too much, and widen them elsewhere.

        Parameters
        ----------
        missing, before : Array, shape (K, n)
            What the rows miss after and before the step, in their units.
        foreseen : Array, shape (K,)
            What the linear rows miss.
        allowed : float
            What may be missed beyond that anyway.
        """
        foreseen = foreseen[:, None]
        bad: Truths = missing - foreseen > np.maximum(
            0.5 * np.maximum(before, foreseen), max(allowed, _NOTHING)
        )
        self.width = _changed(self.width, np.asarray(bad.any(axis=1)), _WIDEST)
        touched = np.zeros(self.reach.shape, dtype=bool)
        touched[:-1] |= bad
        touched[1:] |= bad
        self.reach = _changed(self.reach, touched, 1.0)

    def box(self, columns: ChainColumns, point: ChainPoint) -> Array:
        """Bounds of the step's variables.

        Parameters
        ----------
        columns : ChainColumns
        point : ChainPoint

        Returns
        -------
        Array, shape (size, 2)
        """
        box = np.zeros((columns.size, 2))
        shortest = np.maximum(-self.width / (1.0 + self.width), self.task.least / point.T - 1.0)
        box[columns.T] = np.column_stack([np.minimum(shortest, -1e-6), self.width])
        box[columns.missed] = (0.0, 10.0)
        of_v, of_a = self.task.shares
        for column, value, reach, share in (
            (columns.v, point.v, 1.0, of_v),
            (columns.a, point.a, 2.0, of_a),
        ):
            low = np.maximum(-reach * self.reach, share[..., 0] - value)
            high = np.minimum(reach * self.reach, share[..., 1] - value)
            box[column] = np.stack([np.minimum(low, -1e-9), np.maximum(high, 1e-9)], axis=-1)
        if columns.e.size:
            zones = self.task.zones / self.task.velocity
            low, high = np.minimum(-zones - point.e, -1e-12), np.maximum(zones - point.e, 1e-12)
            box[columns.e] = np.stack([low, high], axis=-1)
        return box


def _changed(radius: Array, bad: Truths, widest: float) -> Array:
    return np.where(bad, radius * _NARROWER, np.minimum(radius * _WIDER, widest))
