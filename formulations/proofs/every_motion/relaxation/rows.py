"""The relaxation's variables and rows, all of the form a x <= b, in finite boxes.

Variables, each of order 1: the duration T of a segment, 1 / T and T^2; velocity v and acceleration a of
a joint at a waypoint; W = T a at both ends of a segment. Rows:

    sum of T <= H                                                                                (5)
    1 / T <= 1 / l + 1 / h - T / (l h)       secant over l <= T <= h                             (6)
    1 / T >= 2 / t - T / t^2                 tangent at t                                        (7)
    T^2 <= (h + 2 t) T + h t^2 / T - 2 h t - t^2     (T - t)^2 (h - T) / T >= 0                   (8)
    (T - t) (a - e) of one sign              T at a bound t, a at a bound e (McCormick 1976)     (9)
    |v| + (2 c W - c^2 T^2) / (2 J) <= V     tangent of |v| + a^2 / (2 J) <= V, c = a / T        (10)
    (1), (2) and (3) of ``reach``.

Row (8) makes the relaxation tight: together with (6) and (7) it bounds the convex hull of the curve
(T, 1 / T, T^2) where the optimum lies; the secant of T^2 is the case t = l. In (10) the acceleration a
falls to 0, or rose from 0, with |j| <= J, and the speed stays within V meanwhile. The least sum of T
over these rows is a lower bound for every choice of t, c and the switches.

Rounding. A coefficient differs from the exact one by at most 32 roundings, none of which cancels. Each
right hand side is raised by 64 u sum |a_i| max |x_i|, u = 2^-53, so that the rows in floats hold for
every motion.

References
----------
McCormick 1976, "Computability of global solutions to factorable nonconvex programs: part I",
Mathematical Programming 10, pp. 147-175.
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array, Indices, Truths
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import PEAKS, PRODUCTS, STOPS, Cuts, Kind
from formulations.proofs.every_motion.relaxation.inequalities import Rows, Terms
from formulations.proofs.every_motion.relaxation.reach import (
    distance_coefficients,
    speed_coefficients,
    stop_coefficients,
)
from formulations.proofs.every_motion.relaxation.relaxed_problem import DOWN, UP, RelaxedProblem

_ALLOWANCE = 64.0 * 2.0**-53
_WIDEST = 7  # coefficients of a row, but (5)


class Frame:
    """The variables of one relaxed problem in its boxes: their order, their units and their rows.

    Attributes
    ----------
    T, inverse, square : Indices, shape (K,)
        Columns of the durations, of 1 / T and of T^2, all in units of ``typical``.
    v, a : Indices, shape (K + 1, n)
        Columns of velocities and accelerations, in units of the limits of ``relaxed``.
    W : Indices, shape (K, n, 2)
        Columns of T a at both ends, in units of T and a.
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
        durations, accelerations = boxes.durations, boxes.accelerations
        K, n = self.K, self.n = relaxed.displacements.shape
        ends = np.cumsum([K, K, K, (K + 1) * n, (K + 1) * n, 2 * K * n])
        self.size = int(ends[-1])
        numbers = np.split(np.arange(self.size), ends[:-1])
        self.T, self.inverse, self.square = numbers[:3]
        self.v, self.a = (block.reshape(K + 1, n) for block in numbers[3:5])
        self.W = numbers[5].reshape(K, n, 2)
        self.low, self.high = durations[:, 0] / typical * DOWN, durations[:, 1] / typical * UP
        # velocities and accelerations in units of their limits, W = T a in those of T and a
        share = accelerations / relaxed.acceleration[:, None]
        self.least_a = share[..., 0] - np.abs(share[..., 0]) * (UP - 1.0)
        self.most_a = share[..., 1] + np.abs(share[..., 1]) * (UP - 1.0)
        for bound in (self.least_a, self.most_a):
            bound[[0, -1]] = 0.0
            bound[:, ~relaxed.has_jerk] = 0.0
        self.box = self._boxes()
        self.cost = np.zeros(self.size)
        self.cost[self.T] = typical
        self._sizes = np.abs(self.box).max(axis=1)
        # dv/ds = T a and dW/ds = T^2 j in units of the velocity limit, and d / T, at typical durations
        scale = typical[:, None]
        self.ramp = scale * (relaxed.acceleration / relaxed.velocity)
        self.bend = scale**2 * (relaxed.jerk / relaxed.velocity)
        self.distance = relaxed.displacements / relaxed.velocity / scale
        self.room = relaxed.room / relaxed.velocity[:, None]

    def _boxes(self) -> Array:
        low, high = self.low, self.high
        box = np.zeros((self.size, 2))
        box[self.T] = np.stack([low, high], axis=1)
        box[self.inverse] = np.stack([1.0 / high * DOWN, 1.0 / low * UP], axis=1)
        box[self.square] = np.stack([low**2 * DOWN, high**2 * UP], axis=1)
        box[self.v[1:-1]] = (-1.0, 1.0)
        box[self.a] = np.stack([self.least_a, self.most_a], axis=-1)
        most = np.maximum(-self.least_a, self.most_a)
        for end in (0, 1):
            reach = most[end : self.K + end] * high[:, None] * UP
            box[self.W[:, :, end]] = np.stack([-reach, reach], axis=-1)
        return box

    def fixed(self) -> Rows:
        """Rows (5) and (6)."""
        low, high, one = self.low, self.high, np.ones(self.K)
        share = list(self.typical[:, None] / self.relaxed.horizon)
        total = self._rows([np.array([column]) for column in self.T], share, np.ones(1))
        columns = [self.inverse, self.T]
        secants = self._rows(columns, [one, 1.0 / (low * high)], 1.0 / low + 1.0 / high).normal()
        return Rows.joined([total.rows(self.size), secants.rows(self.size)])

    def of(self, cuts: Cuts) -> Rows:
        """Compute one row for each cut, in the order of the table.

        Parameters
        ----------
        cuts : Cuts

        Returns
        -------
        Rows
        """
        columns, a = np.zeros((len(cuts), _WIDEST), dtype=np.intp), np.zeros((len(cuts), _WIDEST))
        each = np.zeros((3, len(cuts)))
        for kind in np.unique(cuts.kind):
            which = np.flatnonzero(cuts.kind == kind)
            found = self.terms(Kind(int(kind)), cuts[which])
            width = found.columns.shape[1]
            columns[which, :width], a[which, :width] = found.columns, found.coefficients
            each[:, which] = found.upper, found.scale, found.largest
        return Terms(columns, a, *each).rows(self.size)

    def terms(self, kind: Kind, cuts: Cuts) -> Terms:
        """Compute the rows of cuts that are all of one kind.

        Parameters
        ----------
        kind : Kind
        cuts : Cuts

        Returns
        -------
        Terms
        """
        return self._of_kind(kind, cuts).in_range()

    def _of_kind(self, kind: Kind, cuts: Cuts) -> Terms:
        if kind in (Kind.TANGENT, Kind.HULL):
            return self._of_duration(kind, cuts)
        if kind in PRODUCTS:
            return self._product(kind.end, cuts)
        if kind in PEAKS:
            return self._peak(kind.end, cuts)
        if kind in STOPS:
            return self._stop(kind.end, cuts)
        return self._speed(cuts) if kind == Kind.SPEED else self._distance(kind == Kind.CRUISE, cuts)

    def place(self, cuts: Cuts) -> Array:
        """Where the rows (7) and (8) of these cuts are posed, in units of ``typical``, in the boxes.

        Parameters
        ----------
        cuts : Cuts

        Returns
        -------
        Array, shape (m,)
        """
        k = cuts.segment
        return np.asarray(np.clip(cuts.at[:, 0] / self.typical[k], self.low[k], self.high[k]))

    def _of_duration(self, kind: Kind, cuts: Cuts) -> Terms:
        k, t, one = cuts.segment, self.place(cuts), np.ones(len(cuts))
        if kind == Kind.TANGENT:
            return self._rows([self.T[k], self.inverse[k]], [-1.0 / t**2, -one], -2.0 / t).normal()
        h = self.high[k]
        columns = [self.square[k], self.T[k], self.inverse[k]]
        a = [one, -(h + 2.0 * t), -h * t**2]
        return self._rows(columns, a, -(2.0 * h * t + t**2)).normal()

    def _product(self, end: int, cuts: Cuts) -> Terms:
        k, j = cuts.segment, cuts.joint
        t, e, side = self.corner(cuts, end)
        columns = [self.W[k, j, end], self.a[k + end, j], self.T[k]]
        return self._rows(columns, [-side, side * t, side * e], side * t * e)

    def _peak(self, end: int, cuts: Cuts) -> Terms:
        k, j = cuts.segment, cuts.joint
        _require(self.relaxed.has_jerk[j])
        c = cuts.at[:, 0] * self.typical[k] / self.relaxed.acceleration[j]
        share = self.ramp[k, j] ** 2 / self.bend[k, j]
        columns = [self.v[k + end, j], self.W[k, j, end], self.square[k]]
        return self._rows(columns, [cuts.sign, share * c, -0.5 * share * c**2], np.ones(len(cuts)))

    def _stop(self, end: int, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        c_v, c_W, c_A, c_J = stop_coefficients(cuts.at[:, :2])
        # with time turned W changes its sign, and the joint comes from where it would go
        c_W = -c_W if end else c_W
        _require(self.relaxed.has_jerk[j] | (c_J == 0.0))
        room = self.room[k + end, j, ((sign > 0.0) != bool(end)).astype(int)] / self.typical[k]
        columns = [self.v[k + end, j], self.W[k, j, end], self.inverse[k], self.T[k], self.square[k]]
        ramp, bend = self.ramp[k, j], self.bend[k, j]
        a = [sign * c_v, sign * c_W * ramp, -room, -c_A * ramp, -c_J * bend]
        return self._rows(columns, a, np.zeros(len(k)))

    def _speed(self, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        c_W0, c_W1, c_A, c_J = speed_coefficients(cuts.at[:, :2])
        _require(self.relaxed.has_jerk[j] | (c_J == 0.0))
        ramp, bend = self.ramp[k, j], self.bend[k, j]
        columns = [self.v[k + 1, j], self.v[k, j], self.W[k, j, 0], self.W[k, j, 1]]
        a = [sign, -sign, -sign * c_W0 * ramp, -sign * c_W1 * ramp, -c_A * ramp, -c_J * bend]
        return self._rows([*columns, self.T[k], self.square[k]], a, np.zeros(len(k)))

    def _distance(self, cruises: bool, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        c_v0, c_W0, c_v1, c_W1, c_V, c_A, c_J = distance_coefficients(cuts.at, cruises)
        _require(self.relaxed.has_jerk[j] | (c_J == 0.0))
        ramp, bend = self.ramp[k, j], self.bend[k, j]
        columns = [self.inverse[k], self.v[k, j], self.v[k + 1, j], self.W[k, j, 0], self.W[k, j, 1]]
        a = [sign * self.distance[k, j], -sign * c_v0, -sign * c_v1, -sign * c_W0 * ramp]
        a += [-sign * c_W1 * ramp, -c_A * ramp, -c_J * bend]
        return self._rows([*columns, self.T[k], self.square[k]], a, c_V)

    def corner(self, cuts: Cuts, end: int) -> tuple[Array, Array, Array]:
        """Return the bounds t and e of products (9) and the sign of their rows.

        Parameters
        ----------
        cuts : Cuts
        end : int
            0 for the start of a segment, 1 for its end.

        Returns
        -------
        t, e, sign : Array, shape (m,)
            In units of ``typical`` and of the acceleration limits.
        """
        k, j, corner = cuts.segment, cuts.joint, cuts.at[:, 0]
        t = np.where(corner % 2 == 0, self.low[k], self.high[k])
        upper = (corner == 1) | (corner == 2)
        e = np.where(upper, self.most_a[k + end, j], self.least_a[k + end, j])
        return t, e, np.where(corner < 2, 1.0, -1.0)

    def _rows(self, columns: list[Indices], coefficients: list[Array], upper: Array) -> Terms:
        """Rows of w coefficients each, with the allowance for rounding; ``columns[i]`` is (m,)."""
        where, a = np.stack(columns, axis=1), np.stack(coefficients, axis=1)
        moduli = np.abs(a)
        size = (moduli * self._sizes[where]).sum(axis=1) + np.abs(upper)
        largest = moduli.max(axis=1, initial=0.0)
        return Terms(where, a, upper + _ALLOWANCE * size, np.ones(len(upper)), largest)


def _require(sound: Truths) -> None:
    """Refuse rows with a term in the jerk limit of a joint that has none."""
    if not sound.all():
        raise ValueError("a row needs the jerk limit of a joint that has none")
