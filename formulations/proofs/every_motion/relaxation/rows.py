"""The relaxation's variables and rows, all of the form a x <= b, in finite boxes.

Variables, each of order 1: the duration T of a segment, 1 / T and T^2; velocity v and acceleration a of
a joint at a waypoint; W = T a at both ends of a segment; where a waypoint is a zone, how far e the joint
is from its middle, and p = e / T at the ends of both segments. At the ends of a cycle the variables are
the same. A leg over several segments has variables as a segment has; its T is their sum. Rows:

    sum of T <= H, and of those before a waypoint within its bounds                              (5)
    1 / T <= 1 / l + 1 / h - T / (l h)       secant over l <= T <= h                             (6)
    1 / T >= 2 / t - T / t^2                 tangent at t                                        (7)
    T^2 <= (h + 2 t) T + h t^2 / T - 2 h t - t^2     (T - t)^2 (h - T) / T >= 0                   (8)
    (T - t) (a - f) of one sign              T at a bound t, a at a bound f (McCormick 1976)     (9)
    |v| + (2 c W - c^2 T^2) / (2 J) <= V     tangent of |v| + a^2 / (2 J) <= V, c = a / T        (10)
    (1 / T - u) (e - f) of one sign          1 / T at a bound u, e at a bound f                  (11)
    |a - a| <= J T                           the accelerations at both ends                      (14)
    (1), (2) and (3) of ``reach``, where d / T is (distance of the middles) / T + p - p.

Where a segment may take no time, or next to none, the rows in 1 / T are posed times T. The variables
g = T v, X = T^2 a and T^3 stand for v, W and T^2 then, T^2 for T, and e for p; T stands for 1, and 1 for
1 / T. g and X are products (9) of T and v, and of T^2 and a; (10) is posed at an acceleration f,
|v| + (2 f a - f^2) / (2 J) <= V.

Row (8) makes the relaxation tight: together with (6) and (7) it bounds the convex hull of the curve
(T, 1 / T, T^2) where the optimum lies; the secant of T^2 is the case t = l. In (10) the acceleration a
falls to 0 after the waypoint, or rose from 0 before it, with |j| <= J, and the speed stays within V
meanwhile. V and J are those of the segment on that side where it has the time a / J for that, else the
greatest of all segments. Where an acceleration is free at an end of the motion, (10) is posed only where
there is certainly that time in the motion. The least sum of T over these rows is a lower
bound for every choice of t, c, f and the switches.

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

from formulations.proofs.every_motion.relaxation.cuts import (
    ALL_PRODUCTS,
    CRUISES,
    FADES,
    HULLS,
    PEAKS,
    STOPS,
    TANGENTS,
    Cuts,
    Kind,
)
from formulations.proofs.every_motion.relaxation.inequalities import Rows, Terms
from formulations.proofs.every_motion.relaxation.reach import (
    arc_coefficients,
    distance_coefficients,
    speed_coefficients,
    stop_coefficients,
)
from formulations.proofs.every_motion.relaxation.ties import Ties, forwards_of, require

_WIDEST = 9  # coefficients of a row, but (5)


class Frame(Ties):
    """The rows of one relaxed problem in its boxes."""

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
        if kind in (*TANGENTS, *HULLS):
            return self._of_duration(kind, cuts)
        if kind in ALL_PRODUCTS:
            return self._product(kind, cuts)
        if kind in (*PEAKS, *FADES):
            return self._peak(kind, cuts)
        if kind == Kind.CHANGE:
            return self._change(cuts)
        if kind in STOPS:
            return self._stop(kind, cuts)
        return self._speed(cuts) if kind == Kind.SPEED else self._distance(kind, cuts)

    def _stop(self, kind: Kind, cuts: Cuts) -> Terms:
        k, j, sign, end = cuts.segment, cuts.joint, cuts.sign, kind.end
        c_v, c_W, c_A, c_J = stop_coefficients(cuts.at[:, :2])
        # with time turned W changes its sign, and the joint comes from where it would go
        c_W = -c_W if end else c_W
        require(self.relaxed.has_jerk[j] | (c_J == 0.0))
        side = ((sign > 0.0) != bool(end)).astype(int)  # of the limit: 0 lower, 1 upper
        room = self.room[k, end, j, side] / self.typical[k]
        ramp, bend = self.ramp[k, j], self.bend[k, j]
        away = self.ramps[k, j, 1 - side]  # the acceleration that points away from the limit
        column, of_room, upper = self._anchored(kind, cuts, -room, np.zeros(len(k)))
        T, square, v, W, p = self.parts[kind.times_T]
        columns = [v[k, j, end], W[k, j, end], column, T[k], square[k]]
        a = [sign * c_v, sign * c_W * ramp, of_room, -c_A * away, -c_J * bend]
        columns.append(np.maximum(p[k, j, end], 0))
        a.append(np.where(side == 1, 1.0, -1.0) * self.shift[k, j, end])
        return self._rows(columns, a, upper)

    def _speed(self, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        c_W0, c_W1, c_A, c_J = speed_coefficients(cuts.at[:, :2])
        require(self.relaxed.has_jerk[j] | (c_J == 0.0))
        ramp, bend = self.ramp[k, j], self.bend[k, j]
        start, end = self.relaxed.legs[k].T
        columns = [self.v[end, j], self.v[start, j], self.W[k, j, 0], self.W[k, j, 1]]
        a = [sign, -sign, -sign * c_W0 * ramp, -sign * c_W1 * ramp]
        a += [-c_A * self.ramps[k, j, forwards_of(sign)], -c_J * bend]
        return self._rows([*columns, self.T[k], self.square[k]], a, np.zeros(len(k)))

    def _distance(self, kind: Kind, cuts: Cuts) -> Terms:
        k, j, sign, cruises = cuts.segment, cuts.joint, cuts.sign, kind in CRUISES
        c_v0, c_W0, c_v1, c_W1, c_V, _, c_J = distance_coefficients(cuts.at, cruises)
        rising, falling = arc_coefficients(cuts.at, cruises)
        require(self.relaxed.has_jerk[j] | (c_J == 0.0))
        ramp, bend, forwards = self.ramp[k, j], self.bend[k, j], forwards_of(sign)
        arcs = rising * self.ramps[k, j, forwards] + falling * self.ramps[k, j, 1 - forwards]
        column, of_distance, upper = self._anchored(
            kind, cuts, sign * self.distance[k, j], c_V * self.top[k, j, forwards]
        )
        T, square, v, W, p = self.parts[kind.times_T]
        columns = [column, v[k, j, 0], v[k, j, 1], W[k, j, 0], W[k, j, 1]]
        a = [of_distance, -sign * c_v0, -sign * c_v1, -sign * c_W0 * ramp]
        a += [-sign * c_W1 * ramp, -arcs, -c_J * bend]
        columns += [T[k], square[k]]
        for end, side in ((0, -sign), (1, sign)):
            columns.append(np.maximum(p[k, j, end], 0))
            a.append(side * self.shift[k, j, end])  # 0 where there is no zone
        return self._rows(columns, a, upper)
