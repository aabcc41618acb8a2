"""The relaxation's variables and rows, all of the form a x <= b, in finite boxes.

Variables, each of order 1: the duration T of a segment, 1 / T and T^2; velocity v and acceleration a of
a joint at a waypoint; W = T a at both ends of a segment; where a waypoint is a zone, how far e the joint
is from its middle, and p = e / T at the ends of both segments. At the ends of a cycle the variables are
the same. Rows:

    sum of T <= H, and of those before a waypoint within its bounds                              (5)
    1 / T <= 1 / l + 1 / h - T / (l h)       secant over l <= T <= h                             (6)
    1 / T >= 2 / t - T / t^2                 tangent at t                                        (7)
    T^2 <= (h + 2 t) T + h t^2 / T - 2 h t - t^2     (T - t)^2 (h - T) / T >= 0                   (8)
    (T - t) (a - f) of one sign              T at a bound t, a at a bound f (McCormick 1976)     (9)
    |v| + (2 c W - c^2 T^2) / (2 J) <= V     tangent of |v| + a^2 / (2 J) <= V, c = a / T        (10)
    (1 / T - u) (e - f) of one sign          1 / T at a bound u, e at a bound f                  (11)
    (1), (2) and (3) of ``reach``, where d / T is (distance of the middles) / T + p - p.

Row (8) makes the relaxation tight: together with (6) and (7) it bounds the convex hull of the curve
(T, 1 / T, T^2) where the optimum lies; the secant of T^2 is the case t = l. In (10) the acceleration a
falls to 0 after the waypoint, or rose from 0 before it, with |j| <= J, and the speed stays within V
meanwhile. V and J are those of the segment on that side where it has the time a / J for that, else the
greatest of all segments. Where an acceleration is free at an end of the motion, (10) is posed only where
there is certainly that time in the motion. The least sum of T over these rows is a lower
bound for every choice of t, c and the switches.

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
from formulations.proofs.every_motion.relaxation.columns import Columns
from formulations.proofs.every_motion.relaxation.cuts import (
    FADES,
    PEAKS,
    PRODUCTS,
    SPEED_PRODUCTS,
    SQUARE_PRODUCTS,
    STOPS,
    ZONES,
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
from formulations.proofs.every_motion.relaxation.relaxed_problem import DOWN, UP

_ALLOWANCE = 64.0 * 2.0**-53
_WIDEST = 9  # coefficients of a row, but (5)


class Frame(Columns):
    """The rows of one relaxed problem in its boxes."""

    def fixed(self) -> Rows:
        """Rows (5) and (6); the bounds of the sums before waypoints come last."""
        low, high, one = self.low, self.high, np.ones(self.L)
        T, typical = self.T[: self.K], self.typical[: self.K]
        share = list(typical[:, None] / self.relaxed.horizon)
        total = self._rows([np.array([column]) for column in T], share, np.ones(1))
        columns = [self.inverse, self.T]
        with np.errstate(divide="ignore", invalid="ignore"):
            a, upper = [one, 1.0 / (low * high)], 1.0 / low + 1.0 / high
        if self.short.any():  # times T and its two bounds
            columns = [np.where(self.short, self.square, self.inverse), self.T]
            a = [one, np.where(self.short, -(low + high), a[1])]
            upper = np.where(self.short, -low * high, upper)
        secants = self._rows(columns, a, upper).normal()
        blocks = [total.rows(self.size), secants.rows(self.size)]
        for leg in range(self.K, self.L):  # the time of a leg is the sum of its segments'
            i, k = self.relaxed.legs[leg]
            columns = [np.array([c]) for c in (self.T[leg], *T[i:k])]
            terms = np.concatenate([self.typical[[leg]], -typical[i:k]])[:, None] / self.typical[leg]
            for sign in (1.0, -1.0):
                blocks.append(self._rows(columns, list(sign * terms), np.zeros(1)).rows(self.size))
        for i, side in self.bounded_sums:
            bound = float(self.relaxed.arrivals[i, side])
            sign = 1.0 if side else -1.0
            terms = list(sign * typical[:i, None])
            row = self._rows([np.array([c]) for c in T[:i]], terms, np.array([sign * bound]))
            blocks.append(row.rows(self.size))
        return Rows.joined(blocks)

    @property
    def bounded_sums(self) -> list[tuple[int, int]]:
        """Waypoints and sides (0 earliest, 1 latest) whose arrival is bounded, in the order of rows (5)."""
        arrivals = self.relaxed.arrivals[1:]
        asked = (arrivals > 0.0) & np.isfinite(arrivals)
        return [(i + 1, side) for i, side in np.argwhere(asked).tolist()]

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
        if kind in (*SPEED_PRODUCTS, *SQUARE_PRODUCTS):
            return self._product_times_T(kind, cuts)
        if kind in ZONES:
            return self._zone(kind.end, cuts)
        if kind in FADES:
            return self._fade(kind.end, cuts)
        if kind == Kind.CHANGE:
            return self._change(cuts)
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
            column, a, upper = self._anchored(self.short[k], k, -one, -2.0 / t)
            return self._rows([self.of_T[k], column], [-1.0 / t**2, a], upper).normal()
        h = self.high[k]
        column, a, upper = self._anchored(self.short[k], k, -h * t**2, -(2.0 * h * t + t**2))
        columns = [self.of_square[k], self.of_T[k], column]
        return self._rows(columns, [one, -(h + 2.0 * t), a], upper).normal()

    def _anchored(
        self, times_T: Truths, k: Indices, of_inverse: Array, upper: Array
    ) -> tuple[Indices, Array, Array]:
        """The term in 1 / T and the right hand side of a row: where it is taken times T they are upper T and 1.

        Returns
        -------
        column : Indices, shape (m,)
        coefficient, upper : Array, shape (m,)
        """
        column = np.where(times_T, self.T[k], self.inverse[k])
        return (
            column,
            np.where(times_T, -upper, of_inverse),
            np.where(times_T, -of_inverse, upper),
        )

    def _product(self, end: int, cuts: Cuts) -> Terms:
        k, j = cuts.segment, cuts.joint
        at = self.relaxed.legs[k, end]
        t, e, side = self.corner(cuts, end)
        columns = [self.W[k, j, end], self.a[at, j], self.T[k]]
        return self._rows(columns, [-side, side * t, side * e], side * t * e)

    def _product_times_T(self, kind: Kind, cuts: Cuts) -> Terms:
        """Products (9) of T and v, or of T^2 and a, in short segments."""
        k, j, corner, end = cuts.segment, cuts.joint, cuts.at[:, 0], kind.end
        at = self.relaxed.legs[k, end]
        upper, low_T = (corner == 1) | (corner == 2), corner % 2 == 0
        if kind in SPEED_PRODUCTS:
            t = np.where(low_T, self.low[k], self.high[k])
            f = np.where(upper, self.v_high[at, j], self.v_low[at, j])
            columns = [self.g[k, j, end], self.v[at, j], self.T[k]]
        else:
            t = np.where(low_T, self.low[k] ** 2 * DOWN, self.high[k] ** 2 * UP)
            f = np.where(upper, self.a_high[at, j], self.a_low[at, j])
            columns = [self.X[k, j, end], self.a[at, j], self.square[k]]
        side = np.where(corner < 2, 1.0, -1.0)
        # a segment that is not short any more has no such product
        bound = np.where(self.short[k], side * t * f, np.inf)
        return self._rows(columns, [-side, side * t, side * f], bound)

    def _change(self, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        _require(self.relaxed.has_jerk[j])
        per_T = self.bend[k, j] / self.ramp[k, j]
        start, end = self.relaxed.legs[k].T
        columns = [self.a[end, j], self.a[start, j], self.T[k]]
        return self._rows(columns, [sign, -sign, -per_T], np.zeros(len(k)))

    def _fade(self, end: int, cuts: Cuts) -> Terms:
        """Tangents of (10) at an acceleration."""
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        _require(self.relaxed.has_jerk[j])
        f, at = cuts.at[:, 0] / self.relaxed.acceleration[j], self.relaxed.legs[k, end]
        top, bend, sound = self.peak(end, cuts)
        share = self.ramp[k, j] ** 2 / bend
        columns = [self.v[at, j], self.a[at, j]]
        upper = np.where(sound, top + 0.5 * share * f**2, np.inf)
        return self._rows(columns, [sign, sign * share * f], upper)

    def _zone(self, end: int, cuts: Cuts) -> Terms:
        k, j, corner = cuts.segment, cuts.joint, cuts.at[:, 0]
        at = self.relaxed.legs[k, end]
        with np.errstate(divide="ignore"):  # no such row where a segment has become short
            u = np.where(corner % 2 == 0, 1.0 / self.high[k] * DOWN, 1.0 / self.low[k] * UP)
        upper = (corner == 1) | (corner == 2)
        f = np.where(upper, self.e_high[at, j], self.e_low[at, j])
        side = np.where(corner < 2, 1.0, -1.0)
        columns = [self.p[k, j, end], self.e[at, j], self.inverse[k]]
        bound = np.where(self.short[k], np.inf, side * u * f)
        return self._rows(columns, [-side, side * u, side * f], bound)

    def _peak(self, end: int, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        _require(self.relaxed.has_jerk[j])
        at = self.relaxed.legs[k, end]
        c = cuts.at[:, 0] * self.typical[k] / self.relaxed.acceleration[j]
        top, bend, sound = self.peak(end, cuts)
        share = self.ramp[k, j] ** 2 / bend
        columns = [self.v[at, j], self.W[k, j, end], self.square[k]]
        # LinearProgram leaves infinite rows out
        upper = np.where(sound & ~self.short[k], top, np.inf)
        return self._rows(columns, [sign, share * c, -0.5 * share * c**2], upper)

    def peak(self, end: int, cuts: Cuts) -> tuple[Array, Array, Truths]:
        """Find the limits of (10): those of the segment where the acceleration fades, or of all segments.

        With c along the motion the speed rises after the waypoint, else it fell before it.

        Parameters
        ----------
        end : int
            0 for the start of a segment, 1 for its end.
        cuts : Cuts

        Returns
        -------
        top, bend : Array, shape (m,)
            V, and J T^2 for the typical duration, in units of the velocity limit.
        sound : Truths, shape (m,)
            Whether there is certainly the time.
        """
        i, j = self.relaxed.legs[cuts.segment, end], cuts.joint
        forwards, after = _forwards(cuts.sign), cuts.sign * cuts.at[:, 0] > 0.0
        k = np.where(after, i, i - 1)  # the segment on that side
        there = (k >= 0) & (k < self.K)
        k = np.clip(k, 0, self.K - 1)
        own = there & self.fades_within[k, np.where(after, 0, 1), j]
        top = np.where(own, self.top[k, j, forwards], self.top[:, j, forwards].max(axis=0))
        bend = np.where(own, self.relaxed.jerks[k, j], self.relaxed.jerk[j]) / self.relaxed.velocity[j]
        sound = own | self.fades[after.astype(np.intp), i, j]
        return top, self.typical[cuts.segment] ** 2 * bend, sound

    def _stop(self, end: int, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        c_v, c_W, c_A, c_J = stop_coefficients(cuts.at[:, :2])
        # with time turned W changes its sign, and the joint comes from where it would go
        c_W = -c_W if end else c_W
        _require(self.relaxed.has_jerk[j] | (c_J == 0.0))
        side = ((sign > 0.0) != bool(end)).astype(int)  # of the limit: 0 lower, 1 upper
        room = self.room[k, end, j, side] / self.typical[k]
        ramp, bend = self.ramp[k, j], self.bend[k, j]
        away = self.ramps[k, j, 1 - side]  # the acceleration that points away from the limit
        column, of_room, upper = self._anchored(self.times_T[k, j], k, -room, np.zeros(len(k)))
        columns = [self.of_v[k, j, end], self.of_W[k, j, end], column, self.of_T[k], self.of_square[k]]
        a = [sign * c_v, sign * c_W * ramp, of_room, -c_A * away, -c_J * bend]
        columns.append(np.maximum(self.of_p[k, j, end], 0))
        a.append(np.where(side == 1, 1.0, -1.0) * self.shift[k, j, end])
        return self._rows(columns, a, upper)

    def _speed(self, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        c_W0, c_W1, c_A, c_J = speed_coefficients(cuts.at[:, :2])
        _require(self.relaxed.has_jerk[j] | (c_J == 0.0))
        ramp, bend = self.ramp[k, j], self.bend[k, j]
        start, end = self.relaxed.legs[k].T
        columns = [self.v[end, j], self.v[start, j], self.W[k, j, 0], self.W[k, j, 1]]
        a = [sign, -sign, -sign * c_W0 * ramp, -sign * c_W1 * ramp]
        a += [-c_A * self.ramps[k, j, _forwards(sign)], -c_J * bend]
        return self._rows([*columns, self.T[k], self.square[k]], a, np.zeros(len(k)))

    def _distance(self, cruises: bool, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        c_v0, c_W0, c_v1, c_W1, c_V, _, c_J = distance_coefficients(cuts.at, cruises)
        rising, falling = arc_coefficients(cuts.at, cruises)
        _require(self.relaxed.has_jerk[j] | (c_J == 0.0))
        ramp, bend, forwards = self.ramp[k, j], self.bend[k, j], _forwards(sign)
        arcs = rising * self.ramps[k, j, forwards] + falling * self.ramps[k, j, 1 - forwards]
        column, of_distance, upper = self._anchored(
            self.times_T[k, j], k, sign * self.distance[k, j], c_V * self.top[k, j, forwards]
        )
        columns = [column, self.of_v[k, j, 0], self.of_v[k, j, 1], self.of_W[k, j, 0], self.of_W[k, j, 1]]
        a = [of_distance, -sign * c_v0, -sign * c_v1, -sign * c_W0 * ramp]
        a += [-sign * c_W1 * ramp, -arcs, -c_J * bend]
        columns += [self.of_T[k], self.of_square[k]]
        for end, side in ((0, -sign), (1, sign)):
            columns.append(np.maximum(self.of_p[k, j, end], 0))
            a.append(side * self.shift[k, j, end])  # 0 where there is no zone
        return self._rows(columns, a, upper)

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
        at = self.relaxed.legs[k, end]
        t = np.where(corner % 2 == 0, self.low[k], self.high[k])
        upper = (corner == 1) | (corner == 2)
        e = np.where(upper, self.a_high[at, j], self.a_low[at, j])
        return t, e, np.where(corner < 2, 1.0, -1.0)

    def _rows(self, columns: list[Indices], coefficients: list[Array], upper: Array) -> Terms:
        """Rows of w coefficients each, with the allowance for rounding; ``columns[i]`` is (m,)."""
        where, a = np.stack(columns, axis=1), np.stack(coefficients, axis=1)
        moduli = np.abs(a)
        size = (moduli * self._sizes[where]).sum(axis=1) + np.abs(upper)
        largest = moduli.max(axis=1, initial=0.0)
        return Terms(where, a, upper + _ALLOWANCE * size, np.ones(len(upper)), largest)


def _forwards(sign: Array) -> Indices:
    """The side of a limit that a sign chooses: 1 forwards, 0 backwards."""
    return (sign > 0.0).astype(np.intp)


def _require(sound: Truths) -> None:
    """Refuse rows with a term in the jerk limit of a joint that has none."""
    if not sound.all():
        raise ValueError("a row needs the jerk limit of a joint that has none")
