"""Inequalities that every motion keeps, built anew.

Variables as of ``setting``; s1 .. s6 ascend in [0, 1]. T is in [l, h], a in an interval with an end f, and e
too. The letters V and A mean the limits in the direction of the sign of a row, or against it:

    h   sum T <= H - waits                      b, l   an arrival is not too early, not too late
    s   u <= 1 / l + 1 / h - T / (l h)          t   u >= 2 / t - T / t^2
    c   q <= (h + 2 t) T + h t^2 u - 2 h t - t^2
    w   (T - bound) (a - f) of one sign         m   (u - bound) (e - f) of one sign
    v   |v| + (2 c W - c^2 q) / (2 J) <= V      where the acceleration has to fade
    a   v1 - v0 <= s1 W0 + (1 - s2) W1 + (s2 - s1) A T + (s1^2 + (1 - s2)^2) / 2 J q
    r   s2 v0 + g W0 + p <= r u + (s2 - s1)^2 / 2 A T + .. J q,     r from c to a position limit
    d   (c1 - c0) u + p1 - p0 <= z v0 + .. W0 + (1 - y) v1 - .. W1 + (y - z) V + m A T + n A T + g J q

with the coefficients of ``_stop`` and ``_distance``; k is d without a piece at top speed.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import Interval, R, most
from compare.check_certificate.families.every_motion.setting import Setting, Variable
from compare.check_certificate.reading import index, number

WIDTHS = {
    "h": 2, "b": 3, "l": 3, "s": 3, "t": 4, "c": 4, "w": 6, "m": 6, "v": 7, "a": 7, "r": 8, "d": 11, "k": 11,
}  # fmt: skip
SUMS = ("h", "b", "l")  # rows about sums of durations
Inequality = tuple[dict[Variable, Any], Any]


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
        if kind in ("s", "t", "c"):
            return self._of_duration(kind, self.leg(raw[1]), raw)
        j, k = index(raw[1], self.claim.dof), self.leg(raw[2])
        need(j in self.joints, f"a row is about joint {j + 1}, which has no box")
        if kind in ("w", "m"):
            return self._product(kind, j, k, index(raw[3], 2), index(raw[4], 4))
        signs = raw[4] if kind in "vr" else raw[3]
        if type(signs) is not int or signs not in (-1, 1):
            raise BadInput(f"a sign is {signs!r:.40}")
        if kind == "v":
            return self._peak(j, k, index(raw[3], 2), signs, number(raw[5]))
        places = [number(x) for x in raw[5 if kind == "r" else 4 : -1]]
        used = [places[i] for i in (0, 1, 4, 5)] if kind == "k" else places
        ascending = all(x <= y for x, y in pairwise([R(0), *used, R(1)]))
        need(ascending, "places are not ascending in [0, 1]")
        if kind == "r":
            return self._stop(j, k, index(raw[3], 2), signs, *places)
        if kind == "a":
            return self._speed(j, k, signs, *places)
        return self._distance(j, k, signs, places, kind == "d")

    def leg(self, value: Any) -> int:
        """Read the number of a leg.

        Parameters
        ----------
        value : object
            From the file.

        Returns
        -------
        int
            The waypoint where it starts. Refuses the certificate if there is none.
        """
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

    def _of_duration(self, kind: str, k: int, raw: list[Any]) -> Inequality:
        """Rows s, t and c."""
        T, u, q = ("T", k), ("u", k), ("q", k)
        low, high = self.boxes[T]
        if kind == "s":
            return {u: R(1), T: 1 / (low * high)}, 1 / low + 1 / high
        t = number(raw[2])
        need(t > 0, "a place is not positive")
        if kind == "t":
            return {T: -1 / (t * t), u: R(-1)}, -2 / t
        return {q: R(1), T: -(high + 2 * t), u: -high * t * t}, -(2 * high * t + t * t)

    def _product(self, kind: str, j: int, k: int, end: int, corner: int) -> Inequality:
        """Rows w and m: X - t x - f y + t f is not negative at corners 0, 1, not positive at 2, 3."""
        product, of, by = ("W", "a", ("T", k)) if kind == "w" else ("p", "e", ("u", k))
        x = self.at(of, self.after[k] if end else k, j)
        need(x in self.boxes, "a row is about a zone that a waypoint does not have")
        t, f = self.box(by)[corner % 2], self.boxes[x][corner in (1, 2)]
        side = 1 if corner < 2 else -1
        return {(product, k, j, end): R(-side), x: side * t, by: side * f}, side * t * f

    def _peak(self, j: int, k: int, end: int, sign: int, c: Any) -> Inequality:
        """Row v: the acceleration fades after the waypoint, or rose from 0 before it, and adds a^2 / (2 J).

        If sign a and sign c differ, the row is weaker than the limit of the velocity at the waypoint.
        """
        need(self.J[j] is not None, "a row needs a jerk limit where there is none")
        i = self.after[k] if end else k
        V, J = self._limits_of_peak(j, i, bool(sign * c > 0))
        v = self.at("v", i, j)
        return {v: R(sign), ("W", k, j, end): c / J, ("q", k): -c * c / (2 * J)}, V[sign > 0]

    def _limits_of_peak(self, j: int, i: int, later: bool) -> tuple[Interval, Any]:
        """Limits of velocity and jerk where the acceleration of a waypoint fades, later or before.

        They are those of the next leg if that is long enough; else the largest of the whole motion, which
        has to be long enough.
        """
        low, high = self.boxes[self.at("a", i, j)]
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
                sums[self.after[k]] = total
            self._sums = self.boxes, sums
        sums = self._sums[1]
        return sums[i], sums[self.ends[1]] - sums[i]

    def _moving(self, j: int, k: int, jerk: Any, steep: Any) -> dict[Variable, Any]:
        """The terms - steep T - jerk J q; without a jerk limit the latter must be 0."""
        J = self.legs[k].jerk[j]
        need(J is not None or jerk == 0, "a row needs a jerk limit where there is none")
        return {("T", k): -steep, ("q", k): R(0) if J is None else -jerk * J}

    def _speed(self, j: int, k: int, sign: int, s1: Any, s2: Any) -> Inequality:
        """Row a."""
        e2 = 1 - s2
        row = self._moving(j, k, (s1 * s1 + e2 * e2) / 2, (s2 - s1) * self.A[k][j][sign > 0])
        self._add_ends(row, j, k, R(-sign), R(sign))
        return row | {("W", k, j, 0): -sign * s1, ("W", k, j, 1): -sign * e2}, R(0)

    def _add_ends(self, row: dict[Variable, Any], j: int, k: int, first: Any, last: Any) -> None:
        """Add the terms of both velocities, which are one variable where a cycle has one leg."""
        v0, v1 = self.at("v", k, j), self.at("v", self.after[k], j)
        row[v0] = first
        row[v1] = row.get(v1, R(0)) + last

    def _stop(self, j: int, k: int, end: int, sign: int, s1: Any, s2: Any) -> Inequality:
        """Row r; at the end of a leg with time reversed, towards the side that the joint comes from.

        Only an acceleration that points away from the position limit holds the joint back.
        """
        i, towards = self.after[k] if end else k, -sign if end else sign
        bound = self.legs[k].position[j][towards > 0]
        need(
            bound is not None,
            f"a row poses a limit that joint {self.claim.joint_name(j)} does not have",
        )
        away = self.A[k][j][towards < 0]
        row = self._moving(j, k, s1 * s1 * s2 / 2 - s1**3 / 3, (s2 - s1) ** 2 / 2 * away)
        row[("u", k)] = -(towards * (bound - self.c[i][j]) + self.claim.slack)
        if self.at("e", i, j) in self.boxes:
            row[("p", k, j, end)] = R(towards)
        row[self.at("v", i, j)] = sign * s2
        return row | {("W", k, j, end): towards * (s1 * s2 - s1 * s1 / 2)}, R(0)

    def _distance(self, j: int, k: int, sign: int, s: list[Any], cruises: bool) -> Inequality:
        """Row d, or k without a piece at top speed: there the pieces of jerk -J are one, z = y its middle."""
        s1, s2, s3, s4, s5, s6 = s if cruises else [s[0], s[1], s[4], s[1], s[4], s[5]]
        z, y = (s2 + s3) / 2, (s4 + s5) / 2
        turn = ((s3 - s2) ** 3 + (s5 - s4) ** 3) / 12 if cruises else (s5 - s2) ** 3 / 12
        o, e6 = (1 - y) * (1 - s6) - (1 - s6) ** 2 / 2, 1 - s6
        forth, back = self.A[k][j][sign > 0], self.A[k][j][sign < 0]
        steep = (s2 - s1) * (s3 - s1) / 2 * forth + (s6 - s5) * (s6 - s4) / 2 * back
        g = z * s1 * s1 / 2 - s1**3 / 3 + (1 - y) * e6 * e6 / 2 - e6**3 / 3 + turn
        row = self._moving(j, k, g, steep)
        i = self.after[k]
        row[("u", k)] = sign * (self.c[i][j] - self.c[k][j])
        for at, end in ((i, 1), (k, 0)):
            if self.at("e", at, j) in self.boxes:
                row[("p", k, j, end)] = R(sign if end else -sign)
        self._add_ends(row, j, k, -sign * z, -sign * (1 - y))
        row |= {("W", k, j, 0): -sign * (z * s1 - s1 * s1 / 2), ("W", k, j, 1): sign * o}
        return row, (y - z) * self.V[k][j][sign > 0] if cruises else R(0)
