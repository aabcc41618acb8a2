"""Inequalities that every motion keeps, built anew.

Variables as of ``setting``; s1 .. s6 ascend in [0, 1]. T is in [l, h], and of each product the factors are in
intervals with ends t and f. The letters V and A mean the limits in the direction of the sign of a row, or
against it:

    h   sum T <= H - waits                      b, l   an arrival is not too early, not too late
    s   u <= 1 / l + 1 / h - T / (l h)          S      q <= (l + h) T - l h
    t   u >= 2 / t - T / t^2                    T      q >= 2 t T - t^2
    c   q <= (h + 2 t) T + h t^2 u - 2 h t - t^2
    C   r <= (h + 2 t) q - (2 h t + t^2) T + h t^2
    w   (T - t) (a - f) of one sign             m      (u - t) (e - f) of one sign
    g   (T - t) (v - f) of one sign             x      (q - t) (a - f) of one sign
    j   |a1 - a0| <= J T                        e      T of a leg over several others is their sum
    v   |v| + (2 c W - c^2 q) / (2 J) <= V      where the acceleration has to fade
    V   |v| + (2 f a - f^2) / (2 J) <= V        where it has to
    a   v1 - v0 <= s1 W0 + (1 - s2) W1 + (s2 - s1) A T + (s1^2 + (1 - s2)^2) / 2 J q
    r   s2 v0 + g W0 + p <= r u + (s2 - s1)^2 / 2 A T + .. J q,     r from c to a position limit
    d   (c1 - c0) u + p1 - p0 <= z v0 + .. W0 + (1 - y) v1 - .. W1 + (y - z) V + m A T + n A T + g J q

with the coefficients of ``_stop`` and ``_distance``; k is d without a piece at top speed. Those that divide
by T hold where l > 0. R, D and K are r, d and k times T, without a quotient, so T may be 0.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import Interval, R, most
from compare.check_certificate.families.every_motion.setting import PRODUCTS, LegName, Setting, Variable
from compare.check_certificate.families.every_motion.terms import Inequality, LegTerms
from compare.check_certificate.reading import index, items, number

WIDTHS = {
    "h": 2, "b": 3, "l": 3, "s": 3, "t": 4, "c": 4, "w": 6, "m": 6, "v": 7, "a": 7, "r": 8, "d": 11, "k": 11,
    "S": 3, "T": 4, "C": 4, "g": 6, "x": 6, "V": 6, "R": 8, "D": 11, "K": 11, "j": 5, "e": 4,
}  # fmt: skip
SUMS = ("h", "b", "l")  # rows about sums of durations
OF_DURATION = ("s", "t", "c", "S", "T", "C")
TIED = {"w": "W", "m": "p", "g": "g", "x": "X"}  # the product that a row ties to its factors


def require_row(raw: list[Any]) -> None:
    """Refuse what is no row.

    Parameters
    ----------
    raw : list
        From the file.
    """
    if WIDTHS.get(str(raw[0])) != len(raw):
        raise BadInput(f"unknown row {raw!r:.60}")


class Inequalities(Setting):
    """Builds rows in the boxes that are in force."""

    _sums: tuple[dict[Variable, Interval], dict[int, Any]] | None = None

    def row(self, raw: list[Any]) -> Inequality:
        """Build an inequality anew.

        Parameters
        ----------
        raw : list
            Its kind, where it is posed and its multiplier, from the file.

        Returns
        -------
        Inequality
            Coefficients by variable, and the right-hand side.
        """
        kind = str(raw[0])
        require_row(raw)
        if kind in SUMS:
            i, side, upper = self.arrival(raw)
            return {("T", k): R(side) for k in self.ks if k < i}, upper
        if kind in OF_DURATION:
            return self._of_duration(kind, self.leg(raw[1]), raw)
        if kind == "e":
            return self._tie(self.leg(raw[1]), _sign(raw[2]))
        j = index(raw[1], self.claim.dof)
        if kind == "V":
            return self._peak_of(j, index(raw[2], self.claim.n + 1), _sign(raw[3]), number(raw[4]))
        k = self.leg(raw[2])
        if kind in TIED:
            return self._product(TIED[kind], k, j, index(raw[3], 2), index(raw[4], 4))
        sign = _sign(raw[4] if kind in "vrR" else raw[3])
        if kind == "v":
            return self._peak(j, k, index(raw[3], 2), sign, number(raw[5]))
        if kind == "j":
            return self._change(j, k, sign)
        places = [number(x) for x in raw[5 if kind in "rR" else 4 : -1]]
        used = [places[i] for i in (0, 1, 4, 5)] if kind in "kK" else places
        ascending = all(x <= y for x, y in pairwise([R(0), *used, R(1)]))
        need(ascending, "places are not ascending in [0, 1]")
        if kind == "a":
            return self._speed(j, k, sign, *places)
        if kind in "rR":
            return self._stop(j, k, index(raw[3], 2), sign, *places, whole=kind == "R")
        return self._distance(j, k, sign, places, cruises=kind in "dD", whole=kind in "DK")

    def leg(self, value: Any) -> LegName:
        """Read the name of a leg.

        Parameters
        ----------
        value : object
            From the file.

        Returns
        -------
        int or tuple of int
            The waypoint where it starts; both its ends if it is over several others. Refuses the certificate
            if there is none.
        """
        if isinstance(value, list):
            return self.span(*(index(i, self.claim.n + 1) for i in items(value, 2, 2)))
        k = index(value, self.claim.n)
        need(k in self.legs, f"a row is about segment {k + 1}, on which nothing moves")
        return k

    def arrival(self, raw: list[Any]) -> tuple[int, int, Any]:
        """Build a row h, b or l: it bounds the sum of the durations before a waypoint.

        Parameters
        ----------
        raw : list
            From the file.

        Returns
        -------
        waypoint : int
        side : int
            1: the sum is bounded from above, -1: from below.
        upper : arb [s]
            Of side times the sum.
        """
        if raw[0] == "h":
            return self.ends[1], 1, self.budget
        i, latest = index(raw[1], self.claim.n + 1), raw[0] == "l"
        need(i in self.waited, f"a row is about waypoint {i + 1}, which is left out")
        time = self.demands.passages[i][latest]
        need(time is not None, f"a row is about the latest time of waypoint {i + 1}, which has none")
        side = 1 if latest else -1
        return i, side, side * (time - self.waited[i])

    def _of_duration(self, kind: str, k: LegName, raw: list[Any]) -> Inequality:
        """Rows s, t, c, S, T and C."""
        T, u, q, r = (("T", k), ("u", k), ("q", k), ("r", k))
        low, high = self.boxes[T]
        if kind in "stc":
            self.require_time(k)
        if kind == "s":
            return {u: R(1), T: 1 / (low * high)}, 1 / low + 1 / high
        if kind == "S":
            return {q: R(1), T: -(low + high)}, -low * high
        t = number(raw[2])
        if kind == "T":
            return {T: 2 * t, q: R(-1)}, t * t
        if kind == "C":
            return {r: R(1), q: -(high + 2 * t), T: 2 * high * t + t * t}, high * t * t
        need(t > 0, "a place is not positive")
        if kind == "t":
            return {T: -1 / (t * t), u: R(-1)}, -2 / t
        return {q: R(1), T: -(high + 2 * t), u: -high * t * t}, -(2 * high * t + t * t)

    def _product(self, kind: str, k: LegName, j: int, end: int, corner: int) -> Inequality:
        """Tie X = x y: X - t y - f x + t f is not negative at corners 0, 1, not positive at 2, 3."""
        power, state = PRODUCTS[kind]
        x, y = (power, k), self.at_end(state, k, j, end)
        t, f = self.box(x)[corner % 2], self.box(y)[corner in (1, 2)]
        side = 1 if corner < 2 else -1
        return {(kind, k, j, end): R(-side), y: side * t, x: side * f}, side * t * f

    def _tie(self, k: LegName, sign: int) -> Inequality:
        """Row e: both signs make the duration of a leg over several others their sum."""
        leg = self.legs[k]
        parts = [("T", part) for part in self.ks if leg.start <= part < leg.end]
        need(("T", k) not in parts, "a leg is over several others, or no row says so")
        return {("T", k): R(sign)} | dict.fromkeys(parts, R(-sign)), R(0)

    def _change(self, j: int, k: LegName, sign: int) -> Inequality:
        """Row j."""
        row = LegTerms(self, j, k, whole=False)
        for end in (0, 1):
            row.add(self.at_end("a", k, j, end), R(sign if end else -sign))
        row.less(2, R(1), self.legs[k].jerk[j])
        return row.inequality()

    def _peak(self, j: int, k: LegName, end: int, sign: int, c: Any) -> Inequality:
        """Row v: the acceleration fades after the waypoint, or rose from 0 before it, and adds a^2 / (2 J).

        If sign a and sign c differ, the row is weaker than the limit of the velocity at the waypoint.
        """
        i = self.waypoint(k, end)
        V, J = self._limits_of_peak(j, i, bool(sign * c > 0))
        v = self.at("v", i, j)
        return {v: R(sign), ("W", k, j, end): c / J, ("q", k): -c * c / (2 * J)}, V[sign > 0]

    def _peak_of(self, j: int, i: int, sign: int, f: Any) -> Inequality:
        """Row V: the same of the acceleration itself; f is on the side of sign a."""
        V, J = self._limits_of_peak(j, i, bool(f > 0))
        row = {self.at("v", i, j): R(sign), self.at("a", i, j): sign * f / J}
        return row, V[sign > 0] + f * f / (2 * J)

    def _limits_of_peak(self, j: int, i: int, later: bool) -> tuple[Interval, Any]:
        """Limits of velocity and jerk where the acceleration of a waypoint fades, later or before.

        They are those of the next leg if that is long enough; else the largest of the whole motion, which
        has to be long enough.
        """
        low, high = self.box(self.at("a", i, j))
        steepest, beside = most(abs(low), abs(high)), i if later else self.before.get(i)
        if beside in self.legs and self.boxes["T", beside][0] >= steepest / self.legs[beside].jerk[j]:
            return self.V[beside][j], self.legs[beside].jerk[j]
        enough = self.fades[j][later] or self.least_times(i)[later] >= steepest / self.J[j]
        need(enough, "a peak where the acceleration need not fade")
        return self.top[j], self.J[j]

    def least_times(self, i: int) -> tuple[Any, Any]:
        """Add up the least durations, in the boxes in force.

        Parameters
        ----------
        i : int
            A waypoint that is kept.

        Returns
        -------
        before, after : arb [s]
            Least times before and after the waypoint, without waits.
        """
        if self._sums is None or self._sums[0] is not self.boxes:
            sums, total = {self.ends[0]: R(0)}, R(0)
            for k in self.ks:
                total += self.boxes["T", k][0]
                sums[self.legs[k].end] = total
            self._sums = self.boxes, sums
        sums = self._sums[1]
        return sums[i], sums[self.ends[1]] - sums[i]

    def _speed(self, j: int, k: LegName, sign: int, s1: Any, s2: Any) -> Inequality:
        """Row a."""
        row, e2 = LegTerms(self, j, k, whole=False), 1 - s2
        for end, share in ((0, s1), (1, e2)):
            row.speed(end, R(sign if end else -sign))
            row.turn(end, -sign * share)
        row.less(2, s2 - s1, self.A[k][j][sign > 0])
        row.less(3, (s1 * s1 + e2 * e2) / 2, self.legs[k].jerk[j])
        return row.inequality()

    def _stop(
        self, j: int, k: LegName, end: int, sign: int, s1: Any, s2: Any, *, whole: bool
    ) -> Inequality:
        """Row r or R; at the end of a leg with time reversed, towards the side that the joint comes from.

        Only an acceleration that points away from the position limit holds the joint back.
        """
        i, towards = self.waypoint(k, end), -sign if end else sign
        bound = self.legs[k].position[j][towards > 0]
        need(
            bound is not None,
            f"a row poses a limit that joint {self.claim.joint_name(j)} does not have",
        )
        row = LegTerms(self, j, k, whole=whole)
        row.constant(-(towards * (bound - self.c[i][j]) + self.claim.slack))
        row.offset(end, towards)
        row.speed(end, sign * s2)
        row.turn(end, towards * (s1 * s2 - s1 * s1 / 2))
        row.less(2, (s2 - s1) ** 2 / 2, self.A[k][j][towards < 0])
        row.less(3, s1 * s1 * s2 / 2 - s1**3 / 3, self.legs[k].jerk[j])
        return row.inequality()

    def _distance(
        self, j: int, k: LegName, sign: int, s: list[Any], *, cruises: bool, whole: bool
    ) -> Inequality:
        """Row d or D; k or K without a piece at top speed: the pieces of jerk -J are one, z = y its middle."""
        s1, s2, s3, s4, s5, s6 = s if cruises else [s[0], s[1], s[4], s[1], s[4], s[5]]
        z, y = (s2 + s3) / 2, (s4 + s5) / 2
        turn = ((s3 - s2) ** 3 + (s5 - s4) ** 3) / 12 if cruises else (s5 - s2) ** 3 / 12
        o, e6 = (1 - y) * (1 - s6) - (1 - s6) ** 2 / 2, 1 - s6
        row = LegTerms(self, j, k, whole=whole)
        first, last = (self.c[self.waypoint(k, end)][j] for end in (0, 1))
        row.constant(sign * (last - first))
        for end, speed, turned in ((0, -z, -(z * s1 - s1 * s1 / 2)), (1, y - 1, o)):
            row.offset(end, sign if end else -sign)
            row.speed(end, sign * speed)
            row.turn(end, sign * turned)
        row.less(1, y - z if cruises else R(0), self.V[k][j][sign > 0])
        row.less(2, (s2 - s1) * (s3 - s1) / 2, self.A[k][j][sign > 0])
        row.less(2, (s6 - s5) * (s6 - s4) / 2, self.A[k][j][sign < 0])
        g = z * s1 * s1 / 2 - s1**3 / 3 + (1 - y) * e6 * e6 / 2 - e6**3 / 3 + turn
        row.less(3, g, self.legs[k].jerk[j])
        return row.inequality()


def _sign(raw: Any) -> int:
    if type(raw) is not int or raw not in (-1, 1):
        raise BadInput(f"a sign is {raw!r:.40}")
    return raw
