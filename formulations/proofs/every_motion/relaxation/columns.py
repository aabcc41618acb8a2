"""The variables of the relaxation: their columns, boxes and units. See ``rows`` for what they mean."""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array, Truths
from formulations.proofs.every_motion.relaxation.boxes import Boxes, joined_ends
from formulations.proofs.every_motion.relaxation.relaxed_problem import DOWN, UP, RelaxedProblem

_ROOM = 1.0 + 1e-9  # (10) is posed where there is more time than an acceleration needs to fade


class Columns:
    """The variables of one relaxed problem in its boxes: their order and their units.

    Attributes
    ----------
    T, inverse, square : Indices, shape (K,)
        Columns of the durations, of 1 / T and of T^2, all in units of ``typical``.
    v, a : Indices, shape (K + 1, n)
        Columns of velocities and accelerations, in units of the limits of ``relaxed``.
    W : Indices, shape (K, n, 2)
        Columns of T a at both ends, in units of T and a.
    e : Indices, shape (K + 1, n)
        Columns of the positions in zones, in units of ``relaxed.zones``; -1 where there is no zone.
    p : Indices, shape (K, n, 2)
        Columns of e / T at both ends, in units of e and T; -1 where there is no zone.
    box : Array, shape (size, 2)
        Lower and upper bound of every variable.
    cost : Array, shape (size,)
        The total time [s].
    """

    def __init__(self, relaxed: RelaxedProblem, boxes: Boxes, typical: Array) -> None:
        """Set up the variables.

        Parameters
        ----------
        relaxed : RelaxedProblem
        boxes : Boxes
            They hold every motion of at most ``relaxed.horizon`` seconds.
        typical : Array, shape (K,) [s]
            The unit of each duration.
        """
        self.relaxed, self.boxes, self.typical = relaxed, boxes, typical
        durations = boxes.durations
        K, n = self.K, self.n = relaxed.displacements.shape
        self._number_columns(K, n)
        self.low, self.high = durations[:, 0] / typical * DOWN, durations[:, 1] / typical * UP
        # velocities and accelerations in units of their limits, W = T a in those of T and a
        self.a_low, self.a_high = _shares(boxes.accelerations, relaxed.acceleration)
        self.e_low, self.e_high = _shares(boxes.offsets, relaxed.zones)
        self.box = self._boxes()
        self.cost = np.zeros(self.size)
        self.cost[self.T] = typical
        self._sizes = np.abs(self.box).max(axis=1)
        # dv/ds = T a and dW/ds = T^2 j in units of the velocity limit, and d / T, at typical durations
        scale = typical[:, None]
        self.ramp = scale * (relaxed.acceleration / relaxed.velocity)
        self.ramps = scale[..., None] * (relaxed.accelerations / relaxed.velocity[:, None])
        self.bend = scale**2 * (relaxed.jerks / relaxed.velocity)
        self.top = relaxed.velocities / relaxed.velocity[:, None]
        self.distance = relaxed.displacements / relaxed.velocity / scale
        both_ends = np.stack([relaxed.zones[:-1], relaxed.zones[1:]], axis=-1)
        self.shift = both_ends / relaxed.velocity[:, None] / scale[..., None]
        self.room = relaxed.room / relaxed.velocity[:, None]
        self.fades_within, self.fades = self._times_to_fade()

    def _number_columns(self, K: int, n: int) -> None:
        zones = self.relaxed.zones > 0.0
        at_ends = np.stack([zones[:-1], zones[1:]], axis=-1)
        sizes = [K, K, K, (K + 1) * n, (K + 1) * n, 2 * K * n, int(zones.sum()), int(at_ends.sum())]
        ends = np.cumsum(sizes)
        self.size = int(ends[-1])
        numbers = np.split(np.arange(self.size), ends[:-1])
        self.T, self.inverse, self.square = numbers[:3]
        self.v, self.a = (block.reshape(K + 1, n) for block in numbers[3:5])
        self.W = numbers[5].reshape(K, n, 2)
        self.e, self.p = np.full((K + 1, n), -1), np.full((K, n, 2), -1)
        self.e[zones], self.p[at_ends] = numbers[6], numbers[7]
        if self.relaxed.cyclic:
            for columns in (self.v, self.a, self.e):
                columns[-1] = columns[0]

    def _boxes(self) -> Array:
        low, high, relaxed = self.low, self.high, self.relaxed
        box = np.zeros((self.size, 2))
        box[self.T] = np.stack([low, high], axis=1)
        box[self.inverse] = np.stack([1.0 / high * DOWN, 1.0 / low * UP], axis=1)
        box[self.square] = np.stack([low**2 * DOWN, high**2 * UP], axis=1)
        speeds = _shares(joined_ends(relaxed, relaxed.v_boxes), relaxed.velocity)
        box[self.v] = np.stack(speeds, axis=-1)
        box[self.a] = np.stack([self.a_low, self.a_high], axis=-1)
        most = np.maximum(-self.a_low, self.a_high)
        for end in (0, 1):
            reach = most[end : self.K + end] * high[:, None] * UP
            box[self.W[:, :, end]] = np.stack([-reach, reach], axis=-1)
        there = relaxed.zones > 0.0
        box[self.e[there]] = np.stack([self.e_low[there], self.e_high[there]], axis=-1)
        most = np.maximum(np.abs(self.e_low), np.abs(self.e_high))
        for end in (0, 1):
            k, j = np.nonzero(there[end : self.K + end])
            reach = most[k + end, j] / low[k] * UP**2
            box[self.p[k, j, end]] = np.stack([-reach, reach], axis=-1)
        return box

    def _times_to_fade(self) -> tuple[Truths, Truths]:
        """Where an acceleration at a waypoint has the time to rise from 0 before it, or to fall to 0 after it.

        Returns
        -------
        within : Truths, shape (K, 2, n)
            Within a segment, for the waypoints at its start and at its end.
        fades : Truths, shape (2, K + 1, n)
            Within the motion, before and after the waypoint.
        """
        relaxed, T = self.relaxed, self.boxes.durations[:, 0]
        most = _ROOM * np.abs(self.boxes.accelerations).max(axis=-1)
        own = np.where(relaxed.jerks > 0.0, relaxed.jerks, np.inf)
        within = T[:, None, None] >= np.stack([most[:-1] / own, most[1:] / own], axis=1)
        lasting = np.concatenate([[0.0], np.cumsum(T)])
        needed = most / np.where(relaxed.has_jerk, relaxed.jerk, np.inf)
        start, end = relaxed.fades
        before = start | (lasting[:, None] >= needed)
        after = end | ((lasting[-1] - lasting)[:, None] >= needed)
        return within, np.stack([before, after])


def _shares(intervals: Array, unit: Array) -> tuple[Array, Array]:
    """Both ends of intervals (m, n, 2) in a unit per joint, or per entry, rounded outward."""
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(unit[..., None] > 0.0, intervals / unit[..., None], 0.0)
    low, high = share[..., 0], share[..., 1]
    return low - np.abs(low) * (UP - 1.0), high + np.abs(high) * (UP - 1.0)
