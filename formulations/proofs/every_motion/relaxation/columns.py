"""The variables of the relaxation: their columns, boxes and units. See ``rows`` for what they mean."""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.problem.arrays import Array, Truths
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.legs import LONG
from formulations.proofs.every_motion.relaxation.relaxed_problem import DOWN, UP, RelaxedProblem

_LEAST_UNIT = 1e-6  # of a short duration, in those of the longest
_SHORT, _NONE = 0.1, 1e-6  # of the greatest duration: rows times T are used below, 1 / T above
_ROOM = 1.0 + 1e-9  # (10) is posed where there is more time than an acceleration needs to fade


class Columns:
    """The variables of one relaxed problem in its boxes: their order and their units.

    Attributes
    ----------
    T, inverse, square : Indices, shape (L,)
        Columns of the durations, of 1 / T and of T^2, all in units of ``typical``.
    v, a : Indices, shape (K + 1, n)
        Columns of velocities and accelerations, in units of the limits of ``relaxed``.
    W : Indices, shape (L, n, 2)
        Columns of T a at both ends, in units of T and a.
    e : Indices, shape (K + 1, n)
        Columns of the positions in zones, in units of ``relaxed.zones``; -1 where there is no zone.
    p : Indices, shape (L, n, 2)
        Columns of e / T at both ends, in units of e and T; -1 where there is no zone.
    short : Truths, shape (L,)
        Which segments may be so short that their rows are posed times T.
    long : Truths, shape (L,)
        Which segments certainly take time, so that they have rows in 1 / T.
    g, X : Indices, shape (L, n, 2)
        Columns of T v and T^2 a at both ends of a short segment; -1 elsewhere.
    cube : Indices, shape (L,)
        Columns of T^3 of short segments; -1 elsewhere.
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
        typical : Array, shape (L,) [s]
            The unit of each duration.
        """
        self.relaxed, self.boxes = relaxed, boxes
        durations = boxes.durations
        self.short, self.long = _forms(relaxed, durations)
        least = _LEAST_UNIT * durations[:, 1].max(initial=0.0)
        typical = relaxed.over_legs(typical[: relaxed.n_segments])
        typical = np.where(self.long, typical, np.maximum(durations[:, 1], least))
        self.typical = typical
        self.K, (L, n) = relaxed.n_segments, relaxed.displacements.shape
        self.L, self.n = L, n
        self._number_columns(self.K, L, n)
        self.low, self.high = durations[:, 0] / typical * DOWN, durations[:, 1] / typical * UP
        # velocities and accelerations in units of their limits, W = T a in those of T and a
        self.a_low, self.a_high = _shares(boxes.accelerations, relaxed.acceleration)
        self.e_low, self.e_high = _shares(boxes.offsets, relaxed.zones)
        self.v_low, self.v_high = _shares(boxes.velocities, relaxed.velocity)
        self.box = self._boxes()
        self.cost = np.zeros(self.size)
        self.cost[self.T[: self.K]] = typical[: self.K]
        self._sizes = np.abs(self.box).max(axis=1)
        # dv/ds = T a and dW/ds = T^2 j in units of the velocity limit, and d / T, at typical durations
        scale = typical[:, None]
        self.ramp = scale * (relaxed.acceleration / relaxed.velocity)
        self.ramps = scale[..., None] * (relaxed.accelerations / relaxed.velocity[:, None])
        self.bend = scale**2 * (relaxed.jerks / relaxed.velocity)
        self.top = relaxed.velocities / relaxed.velocity[:, None]
        self.distance = relaxed.displacements / relaxed.velocity / scale
        both_ends = self._at_ends(relaxed.zones)
        self.shift = both_ends / relaxed.velocity[:, None] / scale[..., None]
        self.room = relaxed.room / relaxed.velocity[:, None]
        self.fades_within, self.fades = self._times_to_fade()

    def _at_ends(self, values: Any) -> Any:
        """Values (K + 1, n) of the waypoints at both ends of the legs, (L, n, 2)."""
        return np.moveaxis(values[self.relaxed.legs], 1, -1)

    def _number_columns(self, K: int, L: int, n: int) -> None:
        zones = self.relaxed.zones > 0.0
        at_ends = self._at_ends(zones)
        short = int(self.short.sum())
        sizes = [L, L, L, (K + 1) * n, (K + 1) * n, 2 * L * n, int(zones.sum()), int(at_ends.sum())]
        sizes += [2 * short * n, 2 * short * n, short]
        ends = np.cumsum(sizes)
        self.size = int(ends[-1])
        numbers = np.split(np.arange(self.size), ends[:-1])
        self.T, self.inverse, self.square = numbers[:3]
        self.v, self.a = (block.reshape(K + 1, n) for block in numbers[3:5])
        self.W = numbers[5].reshape(L, n, 2)
        self.e, self.p = np.full((K + 1, n), -1), np.full((L, n, 2), -1)
        self.e[zones], self.p[at_ends] = numbers[6], numbers[7]
        self.g, self.X, self.cube = np.full((L, n, 2), -1), np.full((L, n, 2), -1), np.full(L, -1)
        for columns, block in zip((self.g, self.X, self.cube), numbers[8:], strict=True):
            columns[self.short] = block.reshape(short, *columns.shape[1:])
        if self.relaxed.cyclic:
            for columns in (self.v, self.a, self.e):
                columns[-1] = columns[0]
        # what stands for T, T^2, v, W and p in the rows in 1 / T, as they are and times T
        self.parts = (
            (self.T, self.square, self._at_ends(self.v), self.W, self.p),
            (self.square, self.cube, self.g, self.X, self._at_ends(self.e)),
        )

    def _boxes(self) -> Array:
        low, high, relaxed = self.low, self.high, self.relaxed
        box = np.zeros((self.size, 2))
        box[self.T] = np.stack([low, high], axis=1)
        long = self.long
        bounds = [1.0 / high[long] * DOWN, 1.0 / low[long] * UP]
        box[self.inverse[long]] = np.stack(bounds, axis=1)
        box[self.square] = np.stack([low**2 * DOWN, high**2 * UP], axis=1)
        box[self.v] = np.stack([self.v_low, self.v_high], axis=-1)
        box[self.a] = np.stack([self.a_low, self.a_high], axis=-1)
        for end in (0, 1):
            at = relaxed.legs[:, end]
            a = self.a_low[at], self.a_high[at]
            box[self.W[:, :, end]] = _product(low[:, None], high[:, None], *a)
        there = relaxed.zones > 0.0
        box[self.e[there]] = np.stack([self.e_low[there], self.e_high[there]], axis=-1)
        for end in (0, 1):
            at = relaxed.legs[:, end]
            k, j = np.nonzero(there[at] & long[:, None])
            e = self.e_low[at[k], j], self.e_high[at[k], j]
            box[self.p[k, j, end]] = _product(1.0 / high[k] * DOWN, 1.0 / low[k] * UP, *e)
        self._fill_short_boxes(box)
        return box

    def _fill_short_boxes(self, box: Array) -> None:
        """Fill in the boxes of T v, T^2 a and T^3 of short segments."""
        low, high, short = self.low[self.short], self.high[self.short], self.short
        box[self.cube[short]] = np.stack([low**3 * DOWN, high**3 * UP], axis=1)
        square = low[:, None] ** 2 * DOWN, high[:, None] ** 2 * UP
        for columns, least, greatest, power in (
            (self.g, self.v_low, self.v_high, (low[:, None], high[:, None])),
            (self.X, self.a_low, self.a_high, square),
        ):
            for end in (0, 1):
                at = self.relaxed.legs[short, end]
                box[columns[short, :, end]] = _product(*power, least[at], greatest[at])

    def _times_to_fade(self) -> tuple[Truths, Truths]:
        """Where an acceleration at a waypoint has the time to rise from 0 before it, or to fall to 0 after it.

        Returns
        -------
        within : Truths, shape (K, 2, n)
            Within a segment, for the waypoints at its start and at its end.
        fades : Truths, shape (2, K + 1, n)
            Within the motion, before and after the waypoint.
        """
        relaxed, T = self.relaxed, self.boxes.durations[: self.K, 0]
        most = _ROOM * np.abs(self.boxes.accelerations).max(axis=-1)
        jerks = relaxed.jerks[: self.K]
        own = np.where(jerks > 0.0, jerks, np.inf)
        within = T[:, None, None] >= np.stack([most[:-1] / own, most[1:] / own], axis=1)
        lasting = np.concatenate([[0.0], np.cumsum(T)])
        needed = most / np.where(relaxed.has_jerk, relaxed.jerk, np.inf)
        start, end = relaxed.fades
        before = start | (lasting[:, None] >= needed)
        after = end | ((lasting[-1] - lasting)[:, None] >= needed)
        return within, np.stack([before, after])


def _product(low: Array, high: Array, least: Array, greatest: Array) -> Array:
    """Interval (..., 2) of the product of a number in [low, high], not below 0, and one in [least, greatest].

    It must be as narrow as a checker's: rows in narrower boxes are others, and multipliers are good for the
    rows for which they were found.
    """
    bottom, top = np.minimum(low * least, high * least), np.maximum(low * greatest, high * greatest)
    wider = UP - 1.0
    return np.stack([bottom - wider * np.abs(bottom), top + wider * np.abs(top)], axis=-1)


def _forms(relaxed: RelaxedProblem, durations: Array) -> tuple[Truths, Truths]:
    """Which legs have rows times T, and which have rows in 1 / T."""
    low, high = durations.T
    # of many segments the first boxes are wide because of their number, and soon narrower
    many = relaxed.n_segments > LONG and bool((low > 0.0).all())
    if relaxed.plain or many:
        return low <= 0.0 * high, low > 0.0
    # where both states are given, times T nothing is lost, wherever the joint is in a zone
    still = np.asarray((relaxed.v_boxes[..., 0] == relaxed.v_boxes[..., 1]).all(axis=1))
    still &= (relaxed.a_boxes[..., 0] == relaxed.a_boxes[..., 1]).all(axis=1)
    zone = np.asarray((relaxed.zones > 0.0).any(axis=1))
    given = still[relaxed.legs].all(axis=1) & zone[relaxed.legs].any(axis=1)
    return (low <= _SHORT * high) | given, (low > _NONE * high) & ~given


def _shares(intervals: Array, unit: Array) -> tuple[Array, Array]:
    """Both ends of intervals (m, n, 2) in a unit per joint, or per entry, rounded outward."""
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(unit[..., None] > 0.0, intervals / unit[..., None], 0.0)
    low, high = share[..., 0], share[..., 1]
    return low - np.abs(low) * (UP - 1.0), high + np.abs(high) * (UP - 1.0)
