"""Every motion through the waypoints: a linear relaxation, whose inequalities are built anew.

The claim: no motion of at most H seconds takes L or less. Segment k takes T seconds, u = 1 / T, q = T^2;
velocity v and acceleration a are those at waypoints, W = T a at both ends of a segment. All motions
obey, for any places named in a row (s1 .. s6 ascending in [0, 1]) and while T is in [l, h], a in [e, f]:

    h   sum T <= H                              s   u <= 1 / l + 1 / h - T / (l h)
    t   u >= 2 / t - T / t^2                    c   q <= (h + 2 t) T + h t^2 u - 2 h t - t^2
    w   (T - bound) (a - bound) of one sign     v   |v| + (2 c W - c^2 q) / (2 J) <= V
    a   v1 - v0 <= s1 W0 + (1 - s2) W1 + (s2 - s1) A T + (s1^2 + (1 - s2)^2) / 2 J q
    r   s2 v0 + p W0 <= r u + (s2 - s1)^2 / 2 A T + g J q,     p = s1 s2 - s1^2 / 2, r room to a limit
    d   d u <= z v0 + p W0 + (1 - y) v1 - o W1 + (y - z) V + m A T + g J q

with the p, g, z, y, o, m of ``_distance``. For multipliers >= 0, the cost plus the weighted sum of the
rows is linear in bounded variables: its least value is a lower bound of the cost. The module
``accelerations`` narrows e and f without a sum.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from compare.check_certificate.answers import BadInput, Refused, need
from compare.check_certificate.balls import R, least, most
from compare.check_certificate.claim import Claim, index, items, number
from compare.check_certificate.families.accelerations import greatest

MOST_ROWS = 1_000_000
WIDTHS = {"h": 2, "s": 3, "t": 4, "c": 4, "w": 6, "v": 7, "a": 7, "r": 8, "d": 11, "k": 11}
Variable = tuple[Any, ...]
Inequality = tuple[dict[Variable, Any], Any]


class Relaxation:
    """Boxes of durations and accelerations, which the events narrow, and limits that every motion keeps.

    sum: the rows of the last sum, which ends the proof. From rest to rest in H,
    |v| <= min(V, A H / 2, J H^2 / 16), |a| <= min(A, sqrt(2 J V), J H / 4).
    """

    def __init__(self, claim: Claim) -> None:
        self.claim, self.H = claim, number(claim.horizon)
        need(self.H >= claim.L, "the horizon is below the bound")
        self.ks = [k for k, row in enumerate(claim.d) if not all(x == 0 for x in row)]
        self.joints = [j for j in claim.moving if any(row[j] is not None for row in claim.limits[1:])]
        self.V: dict[int, Any] = {}
        self.A: dict[int, Any] = {}
        self.J: dict[int, Any] = {}
        for j in self.joints:
            self.V[j], self.A[j], self.J[j] = self._limits(j)
        shortest = {k: self._shortest(k) for k in self.ks}
        total = sum(shortest.values(), R(0))
        self.void = bool(total > self.H)
        # a waypoint has the number of the segment that begins there; the arm rests at both ends
        self.after = dict(zip(self.ks, [*self.ks[1:], self.ks[-1] + 1], strict=True))
        self.ends = (self.ks[0], self.ks[-1] + 1)
        self.sum: list[Any] = []
        self.boxes: dict[Variable, tuple[Any, Any]] = {}
        for k, t in shortest.items():
            self.boxes["T", k] = (t.lower(), (self.H - (total - t)).upper())
        for i in [*self.ks, self.ends[1]]:
            for j in self.joints:
                free = i not in self.ends and self.J[j] is not None
                a = self.A[j].upper() if free else R(0)
                self.boxes["a", i, j] = (-a, a)

    def _limits(self, j: int) -> tuple[Any, Any, Any]:
        """Limits on velocity and acceleration that follow from H too, and on jerk (None without one)."""
        V, A, J = (row[j] for row in self.claim.limits)
        tops = [] if V is None else [V]
        steep = [] if A is None else [A]
        if A is not None:
            tops.append(A * self.H / 2)
        if J is not None:
            tops.append(J * self.H * self.H / 16)
            steep.append(J * self.H / 4)
            if V is not None:
                steep.append((2 * J * V).sqrt())
        return least(*tops), least(*steep), J

    def _shortest(self, k: int) -> Any:
        """Lower bound of a duration: displacement over top speed."""
        best = R(0)
        for j in self.claim.moving:
            V = self.V.get(j, self.claim.limits[0][j])
            need(V is not None, f"joint {j + 1} has no limit")
            best = most(best, abs(self.claim.d[k][j]) / V)
        return best

    def replay(self) -> int:
        """Verify every event; returns the number of rows with multipliers."""
        count, pending = 0, dict(self.boxes)
        for place, raw in enumerate(self.claim.events, 1):
            event, where = items(raw, 1, 6), f"event {place}"
            letter = str(event[0])
            if letter in ("R", "P"):
                if letter == "P" and self._propagate(pending):
                    return count  # nothing is left
                self.boxes = dict(pending)
                continue
            rows = items(event[-1], 0, MOST_ROWS)
            count += len(rows)
            self.sum = rows
            if letter == "N":
                key, side = self._narrowed(event)
                bound = self.least({key: R(-1 if side else 1)}, rows)
                need(bound.is_finite(), f"{where}: the box is not narrowed")
                lo, hi = pending[key]
                pending[key] = (
                    (lo, least(hi, (-bound).upper())) if side else (most(lo, bound.lower()), hi)
                )
                if pending[key][0] > pending[key][1]:
                    return count  # nothing is left
            elif letter == "F":
                total = self.least({("T", k): R(1) for k in self.ks}, rows)
                need(total > self.claim.L, f"{where}: the sum is not above the bound")
                return count
            elif letter == "E":
                need(self.least({}, rows) > 0, f"{where}: something is left")
                return count
            else:
                raise BadInput(f"{where}: unknown event {letter!r:.20}")
        raise Refused("the events end before the bound")

    def _propagate(self, boxes: dict[Variable, tuple[Any, Any]]) -> bool:
        """Narrow the accelerations from the durations; whether a box is then certainly empty."""
        limited = [j for j in self.joints if self.J[j] is not None]
        for j in limited:
            for before, after in pairwise(self.ks):
                d, e = self.claim.d[before][j], self.claim.d[after][j]
                spans = self.J[j], boxes["T", before], boxes["T", after]
                lo, hi = boxes["a", after, j]
                lo, hi = (
                    most(lo, (-greatest(-d, -e, *spans)).lower()),
                    least(hi, greatest(d, e, *spans).upper()),
                )
                boxes["a", after, j] = lo, hi
            # over a segment it changes by at most J T
            ways = [(k, self.after[k], k) for k in self.ks]
            for start, end, k in [*ways, *((end, start, k) for start, end, k in reversed(ways))]:
                change = self.J[j] * boxes["T", k][1]
                (low, high), (lo, hi) = boxes["a", start, j], boxes["a", end, j]
                lo, hi = most(lo, (low - change).lower()), least(hi, (high + change).upper())
                boxes["a", end, j] = lo, hi
        return any(bool(lo > hi) for lo, hi in boxes.values())

    def _narrowed(self, event: list[Any]) -> tuple[Variable, int]:
        """The variable that an event narrows, and from which side."""
        if event[1] == "T" and len(event) == 5:
            return ("T", self._segment(event[2])), index(event[3], 2)
        if event[1] == "a" and len(event) == 6:
            i, j = index(event[2], self.claim.n + 1), index(event[3], self.claim.dof)
            need(("a", i, j) in self.boxes, "an event is about a waypoint or joint without a box")
            return ("a", i, j), index(event[4], 2)
        raise BadInput(f"unknown event {event!r:.60}")

    def _segment(self, value: Any) -> int:
        """A segment on which something moves."""
        k = index(value, self.claim.n)
        need(("T", k) in self.boxes, f"a row is about segment {k + 1}, on which nothing moves")
        return k

    def least(self, cost: dict[Variable, Any], rows: list[Any]) -> Any:
        """Bound a linear cost from below over the boxes.

        Parameters
        ----------
        cost : dict
            Coefficients by variable.
        rows : list
            Rows with their multipliers, from the file.

        Returns
        -------
        arb
            The bound.
        """
        total, factors = R(0), dict(cost)
        for raw in rows:
            raw = items(raw, 2, 11)
            y = number(raw[-1])
            need(y >= 0, "a multiplier is negative")
            row, upper = self.row(raw)
            total -= y * upper
            for key, x in row.items():
                factors[key] = factors.get(key, R(0)) + y * x
        for key, x in factors.items():
            certainly_zero = x == 0  # a ball of 0 alone
            if not certainly_zero:
                lo, hi = self.box(key)
                total += least(x * lo, x * hi)
        return total

    def box(self, key: Variable) -> tuple[Any, Any]:
        """Find the interval of a variable.

        Parameters
        ----------
        key : tuple
            The variable: its kind, then segment or waypoint, joint, end.

        Returns
        -------
        tuple of two arb
            Its ends.
        """
        kind, k = key[0], key[1]
        if kind in ("T", "a"):
            return self.boxes[key]
        if kind in ("u", "q"):
            lo, hi = self.boxes["T", k]
            return (1 / hi, 1 / lo) if kind == "u" else (lo * lo, hi * hi)
        j = key[2]
        if kind == "v":
            V = R(0) if k in self.ends else self.V[j]
            return -V, V
        need(self.J[j] is not None, "a row needs an acceleration at a waypoint that may jump")
        lo, hi = self.boxes["a", self.after[k] if key[3] else k, j]
        reach = most(abs(lo), abs(hi)) * self.boxes["T", k][1]
        return -reach, reach

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
        if WIDTHS.get(kind) != len(raw):
            raise BadInput(f"unknown row {raw!r:.60}")
        if kind == "h":
            return {("T", k): R(1) for k in self.ks}, self.H
        if kind in ("s", "t", "c"):
            return self._of_duration(kind, self._segment(raw[1]), raw)
        j, k = index(raw[1], self.claim.dof), self._segment(raw[2])
        need(j in self.J, f"a row is about joint {j + 1}, which has no box")
        if kind == "w":
            return self._product(j, k, index(raw[3], 2), index(raw[4], 4))
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

    def _of_duration(self, kind: str, k: int, raw: list[Any]) -> Inequality:
        """Rows s, t and c."""
        T, u, q = ("T", k), ("u", k), ("q", k)
        low, high = self.boxes["T", k]
        if kind == "s":
            return {u: R(1), T: 1 / (low * high)}, 1 / low + 1 / high
        t = number(raw[2])
        need(t > 0, "a place is not positive")
        if kind == "t":
            return {T: -1 / (t * t), u: R(-1)}, -2 / t
        return {q: R(1), T: -(high + 2 * t), u: -high * t * t}, -(2 * high * t + t * t)

    def _product(self, j: int, k: int, end: int, corner: int) -> Inequality:
        """Row w: W - t a - e T + t e is not negative at corners 0, 1, not positive at 2, 3."""
        i = self.after[k] if end else k
        t, e = self.boxes["T", k][corner % 2], self.boxes["a", i, j][corner in (1, 2)]
        side = 1 if corner < 2 else -1
        return {("W", k, j, end): R(-side), ("a", i, j): side * t, ("T", k): side * e}, side * t * e

    def _peak(self, j: int, k: int, end: int, sign: int, c: Any) -> Inequality:
        """Row v."""
        J, i = self.J[j], self.after[k] if end else k
        need(J is not None, "a row needs a jerk limit where there is none")
        return {("v", i, j): R(sign), ("W", k, j, end): c / J, ("q", k): -c * c / (2 * J)}, self.V[j]

    def _moving(self, j: int, k: int, jerk: Any, steep: Any) -> dict[Variable, Any]:
        """The terms - m A T - g J q; without a jerk limit g must be 0."""
        J = self.J[j]
        need(J is not None or jerk == 0, "a row needs a jerk limit where there is none")
        return {("T", k): -steep * self.A[j], ("q", k): R(0) if J is None else -jerk * J}

    def _speed(self, j: int, k: int, sign: int, s1: Any, s2: Any) -> Inequality:
        """Row a."""
        i, e2 = self.after[k], 1 - s2
        row = self._moving(j, k, (s1 * s1 + e2 * e2) / 2, s2 - s1)
        row |= {("v", i, j): R(sign), ("v", k, j): R(-sign)}
        return row | {("W", k, j, 0): -sign * s1, ("W", k, j, 1): -sign * e2}, R(0)

    def _stop(self, j: int, k: int, end: int, sign: int, s1: Any, s2: Any) -> Inequality:
        """Row r; at the end of a segment with time reversed, towards the side that the joint comes from."""
        i = self.after[k] if end else k
        row = self._moving(j, k, s1 * s1 * s2 / 2 - s1**3 / 3, (s2 - s1) ** 2 / 2)
        towards = -sign if end else sign
        row[("u", k)] = -self.claim.room(i, j, towards)
        p = s1 * s2 - s1 * s1 / 2
        return row | {("v", i, j): sign * s2, ("W", k, j, end): (-sign if end else sign) * p}, R(0)

    def _distance(self, j: int, k: int, sign: int, s: list[Any], cruises: bool) -> Inequality:
        """Row d, or k without a piece at top speed: there the pieces of jerk -J are one, z = y its middle."""
        s1, s2, s3, s4, s5, s6 = s if cruises else [s[0], s[1], s[4], s[1], s[4], s[5]]
        z, y = (s2 + s3) / 2, (s4 + s5) / 2
        turn = ((s3 - s2) ** 3 + (s5 - s4) ** 3) / 12 if cruises else (s5 - s2) ** 3 / 12
        o, e6 = (1 - y) * (1 - s6) - (1 - s6) ** 2 / 2, 1 - s6
        m = (s2 - s1) * (s3 - s1) / 2 + (s6 - s5) * (s6 - s4) / 2
        g = z * s1 * s1 / 2 - s1**3 / 3 + (1 - y) * e6 * e6 / 2 - e6**3 / 3 + turn
        row = self._moving(j, k, g, m)
        i, d = self.after[k], self.claim.d[k][j]
        row |= {("u", k): sign * d, ("v", k, j): -sign * z, ("v", i, j): -sign * (1 - y)}
        row |= {("W", k, j, 0): -sign * (z * s1 - s1 * s1 / 2), ("W", k, j, 1): sign * o}
        return row, (y - z) * self.V[j] if cruises else R(0)
