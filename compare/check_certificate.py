"""``python -m compare.check_certificate FILE``: re-prove a certified bound, trusting nothing but this
file.

It shares no code with the prover. Every number is a ball of real numbers that contains the true one
(python-flint's arb, 128 bits); a comparison holds only if it holds for all of them. Intervals are pairs
of such numbers. The claim: no durations make a spline of the family through the waypoints that keeps
the limits (positions to within position_slack) and takes ``seconds`` or less. As stretching keeps
limits, it is enough that none takes exactly L = seconds.

The domain of a search is derived here from problem and L. Its events are replayed in depth-first
order, every discard is verified: multipliers >= 0 of necessary conditions g <= 0 whose weighted sum is
positive on all of a box (or of a slab of it) leave no motion there. Every box of the tree must end so.
"""

from __future__ import annotations

import argparse
import json
import sys
from bisect import bisect_left, bisect_right
from itertools import pairwise
from math import inf, isfinite
from pathlib import Path
from typing import Any

CERTIFIED, REFUSED, BAD_INPUT = 0, 1, 2
FORMAT = "timebound certificate 1"
LARGEST_FILE, MOST_EVENTS, MOST_SEGMENTS, MOST_JOINTS = 400_000_000, 3_000_000, 50, 50
MOST_ROWS, MOST_CUTS, MOST_TRIPLES, MOST_WORK = 20_000, 1_000_000, 5_000_000, 1_000_000_000
BITS = 128

R: Any = None  # flint's arb, once it is known to be there
Interval = tuple[Any, Any]


class Refused(Exception):  # noqa: N818  # an answer, not a failure
    """The proof does not hold; the message says where."""


class BadInput(Exception):  # noqa: N818
    """Not a certificate."""


def need(holds: object, reason: str) -> None:
    """Refuse unless it holds."""
    if not holds:
        raise Refused(reason)


# ---------------------------------------------------------------- intervals


def least(*numbers: Any) -> Any:
    """The least of several numbers."""
    value = numbers[0]
    for x in numbers[1:]:
        value = value.min(x)
    return value


def most(*numbers: Any) -> Any:
    """The greatest of several numbers."""
    value = numbers[0]
    for x in numbers[1:]:
        value = value.max(x)
    return value


def times(k: Any, a: Interval) -> Interval:
    """K [a, b]."""
    p, q = k * a[0], k * a[1]
    return p.min(q), p.max(q)


def plus(a: Interval, b: Interval) -> Interval:
    """[a] + [b]."""
    return a[0] + b[0], a[1] + b[1]


def product(a: Interval, b: Interval) -> Interval:
    """[a] [b]."""
    each = (a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1])
    return least(*each), most(*each)


def least_quadratic(slopes: Interval, k: Any, lo: Any, hi: Any) -> Any:
    """Least b d + k d^2 over d in [lo, hi] and b in its interval: at an end, as it is linear in b."""
    k, values = k.lower(), []
    for b in slopes:
        values += [(b + k * lo) * lo, (b + k * hi) * hi]
        if k > 0:
            place = -b / (2 * k)
            if not (place < lo or place > hi):
                values.append(-b * b / (4 * k))
    return least(*values)


def least_share(a: Interval, k: Any, nu: Any, w1: Any, w2: Any, c: Any, lo: Any, hi: Any) -> Any:
    """Lower bound of a (x - c) + k x^2 + (nu - w1)/x - w2/x^2 over x in [lo, hi], by divided
    differences.

    1/x = 1/c - e/c^2 + e^2/(c^2 x), 1/x^2 = 1/c^2 - 2e/c^3 + e^2 (2/(c^3 x) + 1/(c^2 x^2)), e = x - c.
    """
    const = k * c * c + (nu - w1) / c - w2 / (c * c)
    slope = 2 * c * k - (nu - w1) / (c * c) + 2 * w2 / (c * c * c)
    bend = (
        k + nu / (c * c * hi) - w1 / (c * c * lo) - w2 * (2 / (c * c * c * lo) + 1 / (c * c * lo * lo))
    )
    return const + least_quadratic((a[0] + slope, a[1] + slope), bend, lo - c, hi - c)


def derivative(coefficients: list[int], order: int, s: Any) -> Any:
    """A derivative in s of sum c_i s^i."""
    c = list(coefficients)
    for _ in range(order):
        c = [i * x for i, x in enumerate(c)][1:]
    value = R(0)
    for x in reversed(c):
        value = value * s + x
    return value


# ---------------------------------------------------------------- the file


def number(text: Any) -> Any:
    """The number that the hexadecimal text of a finite float stands for, exactly."""
    if not isinstance(text, str) or len(text) > 40:
        raise BadInput(f"expected a hexadecimal float, got {text!r:.40}")
    try:
        value = float.fromhex(text)
    except (ValueError, OverflowError):
        raise BadInput(f"not a hexadecimal float: {text!r:.40}") from None
    if not isfinite(value):
        raise BadInput(f"not finite: {text!r:.40}")
    return R(value)


def index(value: Any, below: int) -> int:
    """An integer in 0 .. below - 1."""
    if type(value) is not int or not 0 <= value < below:
        raise BadInput(f"expected an integer from 0 to {below - 1}, got {value!r:.40}")
    return value


def items(value: Any, least: int, most: int) -> list[Any]:
    """A list of bounded length."""
    if not isinstance(value, list) or not least <= len(value) <= most:
        raise BadInput(f"expected a list of {least} to {most} entries, got {value!r:.40}")
    return value


class Claim:
    """What a certificate claims: data as exact numbers, None for no limit."""

    def __init__(self, data: Any) -> None:
        if not isinstance(data, dict) or data.get("format") != FORMAT:
            raise BadInput(f"not a certificate: its format is not {FORMAT!r}")
        self.family = str(data.get("family"))
        rows = items(data.get("waypoints"), 2, MOST_SEGMENTS + 1)
        self.dof = len(items(rows[0], 1, MOST_JOINTS))
        self.w = [[number(x) for x in items(row, self.dof, self.dof)] for row in rows]
        self.n = len(rows) - 1
        limits = data.get("limits")
        if not isinstance(limits, dict):
            raise BadInput("limits: missing")
        keys = ("velocity", "acceleration", "jerk")
        self.limits = [
            [None if x is None else number(x) for x in items(limits.get(key), self.dof, self.dof)]
            for key in keys
        ]
        need(all(x is None or x > 0 for row in self.limits for x in row), "a limit is not positive")
        self.position = [
            [None if x is None else number(x) for x in items(pair, 2, 2)]
            for pair in items(limits.get("position"), self.dof, self.dof)
        ]
        self.slack, self.L = number(data.get("position_slack")), number(data.get("seconds"))
        need(self.slack >= 0, "position_slack is negative")
        need(self.L > 0, "the bound is not positive")
        self.short = data.get("short")
        self.events = items(data.get("events"), 0, MOST_EVENTS)
        self.d = [
            [b - a for a, b in zip(*pair, strict=True)]
            for pair in zip(self.w, self.w[1:], strict=False)
        ]
        self.moving = [j for j in range(self.dof) if not all(row[j] == 0 for row in self.d)]
        need(self.moving, "nothing moves: any motion is as fast as it likes")
        # a thousandth more, as the prover proves it too
        self.slack *= R(1001) / 1000

    def limit(self, order: int, j: int) -> Any:
        """A limit that a row may pose."""
        value = self.limits[order - 1][j]
        need(value is not None, f"a row poses a limit that joint {j + 1} does not have")
        return value

    def room(self, k: int, j: int, sign: int) -> Any:
        """From waypoint k to the position limit above (sign 1) or below (-1), as widened."""
        bound: Any = self.position[j][sign > 0]
        need(bound is not None, f"a row poses a limit that joint {j + 1} does not have")
        far = most(sign * bound, *(sign * row[j] for row in self.w))
        return far - sign * self.w[k][j] + self.slack

    def speed(self, j: int) -> Any:
        """Largest speed from rest to rest in L; None without any limit."""
        velocity, acceleration, jerk = (row[j] for row in self.limits)
        if jerk is not None:
            rising = jerk * self.L / 2
            acceleration = rising if acceleration is None else least(acceleration, rising)
        if acceleration is not None:
            rising = acceleration * self.L / 2
            velocity = rising if velocity is None else least(velocity, rising)
        return velocity

    def shortest(self) -> list[Any]:
        """Lower bounds of the durations: displacement over speed."""
        speeds = {j: self.speed(j) for j in self.moving}
        need(all(speed is not None for speed in speeds.values()), "a moving joint has no limit")
        return [most(*(abs(row[j]) / speeds[j] for j in self.moving)) for row in self.d]

    def row(self, raw: Any) -> tuple[Any, ...]:
        """A row: kind, multiplier > 0, then joint, segment, sign, order, place for pieces and jumps."""
        raw = items(raw, 2, 7)
        kind, multiplier = raw[0], number(raw[-1])
        need(multiplier > 0, "a multiplier is not positive")
        if kind in ("t", "f", "l") and len(raw) == 2:
            return kind, multiplier
        if (kind, len(raw)) not in (("p", 7), ("j", 5)):
            raise BadInput(f"unknown row {raw!r:.60}")
        j, k, sign = index(raw[1], self.dof), index(raw[2], self.n), raw[-2]
        if type(sign) is not int or sign not in (-1, 1):
            raise BadInput(f"a sign is {sign!r:.40}")
        need(j in self.moving, f"a row is about joint {j + 1}, which does not move")
        if kind == "j":
            return kind, multiplier, j, k, sign
        place = number(raw[4])
        need(0 <= place <= 1, "a row is posed outside its piece")
        return kind, multiplier, j, k, sign, index(raw[3], 4), place


# ---------------------------------------------------------------- the tree


class Node:
    """A box of the tree: ends [lo, hi] per variable (hi None: no end), what else is known there."""

    def __init__(self, box: list[list[Any]], known: Any = None, empty: bool = False) -> None:
        self.box, self.known, self.empty = [list(ends) for ends in box], known, empty
        self.reference: Any = None
        self.form: tuple[Any, Any] = (None, None)

    def half(self, k: int, end: int, value: Any) -> Node:
        """The same box with one end moved."""
        child = Node(self.box, self.known, self.empty)
        child.box[k][end] = value
        return child


class Tree:
    """Replays events; a family adds its domain, its excess and what a turn does."""

    claim: Claim
    root: Node

    def excess(self, rows: Any, node: Node, box: list[list[Any]]) -> Any:
        """A lower bound of the weighted sum of conditions over a box within the node's."""
        raise NotImplementedError

    def turn(self, node: Node) -> None:
        """Narrow a node by what follows from its box."""
        raise Refused("an event this family does not have")

    def replay(self) -> int:
        """Verify every event; returns the number of discards."""
        stack, discards, rows = [self.root], 0, None
        node: Node | None = None
        for count, raw in enumerate(self.claim.events, 1):
            event = items(raw, 1, 4)
            letter, where = str(event[0]), f"event {count}"
            if node is None:
                need(stack, f"{where}: every box has ended")
                node = stack.pop()
            has_rows = len(event) == {"L": 2, "B": 4, "A": 4}.get(letter, 0)
            if has_rows:
                rows = [self.claim.row(row) for row in items(event[-1], 0, MOST_SEGMENTS + 1)]
            if letter in ("B", "A", "S"):
                items(event, 3, 4)
                k, value = index(event[1], len(node.box)), number(event[2])
                lo, hi = node.box[k]
            if letter == "T":
                if not node.empty:
                    self.turn(node)
            elif letter == "E":
                need(node.empty, f"{where}: something is left of the box")
                node = None
            elif letter == "L":
                need(
                    node.empty or self.excess(rows, node, node.box) > 0,
                    f"{where}: the box is not discarded",
                )
                discards += 1
                node = None
            elif letter in ("B", "A"):
                if node.empty:
                    continue
                need(hi is not None, f"{where}: the box has no such end")
                slab = [value, hi] if letter == "B" else [lo, value]
                slab = [most(slab[0], lo), least(slab[1], hi)]
                if not slab[0] > slab[1]:
                    box = [slab if i == k else ends for i, ends in enumerate(node.box)]
                    need(self.excess(rows, node, box) > 0, f"{where}: the slab is not discarded")
                    discards += 1
                    # the closed slab is gone
                    node.empty = bool(value <= lo if letter == "B" else value >= hi)
                    node.box[k] = [lo, slab[0]] if letter == "B" else [slab[1], hi]
            elif letter == "S":
                if not node.empty:
                    need(
                        lo < value and (hi is None or value < hi),
                        f"{where}: the split is outside the box",
                    )
                stack += [node.half(k, 1, value), node.half(k, 0, value)]
                node = None
            else:
                raise BadInput(f"{where}: unknown event {letter!r:.20}")
        need(node is None and not stack, "the events end before every box has ended")
        return discards


class ThreeFiveThree(Tree):
    """Variables r = T2/T1, q = T2/T3; T = T2 = L / (1 + 1/r + 1/q). None where nothing moves."""

    MIDDLE = (  # what d2, d1 r, d1 r^2, d3 q, d3 q^2 bring to the middle piece
        [0, 0, 0, 10, -15, 6],
        [0, 3, 0, -18, 24, -9],
        [0, 0, 3, -9, 9, -3],
        [0, 0, 0, -12, 21, -9],
        [0, 0, 0, -3, 6, -3],
    )

    def __init__(self, claim: Claim) -> None:
        self.claim = claim
        need(claim.n == 3, "3-5-3 has three segments")
        t = claim.shortest()
        self.has = [not all(x == 0 for x in claim.d[k]) for k in (0, 2)]
        self.t = t = [self.end(0), t[1], self.end(2)]
        self.void = sum(t, R(0)) > claim.L
        if not self.void and all(x == 0 for x in claim.d[1]):
            t[1] = self.no_short_middle()
        box = []
        for x in range(2):
            end, other = t[2 * x], t[2 - 2 * x]
            ends = (
                [t[1] / (claim.L - t[1] - other), (claim.L - t[0] - t[2]) / end]
                if self.has[x]
                else [R(1)] * 2
            )
            box.append([ends[0].lower(), ends[1].upper()])
        self.root = Node(box)

    def no_short_middle(self) -> Any:
        """Verify that T2 <= tau is impossible where nothing moves on the middle segment; tau.

        Derivative k >= 1 of the middle piece times T2^(k-1) is d1/T1 (B + C r) + d3/T3 (E + F q), r in
        [0, tau/T1], q in [0, tau/T3], against at most limit tau^(k-1). An end on which nothing moves
        is left out, the rest stretched to L: T1 = 0 if it is the first, T1 in [L - tau, L] if the last.
        """
        claim, d = self.claim, self.claim.d
        if not isinstance(claim.short, dict):
            raise BadInput("nothing moves on the middle segment, and short does not say what follows")
        tau = number(claim.short.get("tau"))
        need(tau > 0, "tau is not positive")
        first, last = self.has
        least_end = (self.t[0] if last else claim.L - tau) if first else R(0)
        reached = R(0) if not first else claim.L - self.t[2] if last else claim.L
        for raw in items(claim.short.get("discards"), 1, MOST_EVENTS):
            raw = items(raw, 3, 7)
            lo, hi = most(number(raw[1]), R(0)), number(raw[2])
            need(lo <= hi and not hi < reached, "short: the intervals of T1 leave a gap")
            reached = lo
            latest = claim.L - lo
            earliest = most(self.t[2], claim.L - tau - hi) if last else R(0)
            if raw[0] == "l" and len(raw) == 3:
                need(latest < self.t[2], "short: the last segment is long enough")
                continue
            if raw[0] != "p" or len(raw) != 7:
                raise BadInput(f"unknown discard {raw!r:.60}")
            j, order, s = index(raw[3], claim.dof), index(raw[4], 4), number(raw[5])
            sign = raw[6]
            if type(sign) is not int or sign not in (-1, 1):
                raise BadInput(f"a sign is {sign!r:.40}")
            need(order >= 1 and 0 <= s <= 1, "short: a row is posed outside its piece")
            value = (R(0), R(0))
            p = [sign * derivative(c, order, s) for c in self.MIDDLE]
            for moves, k, ends in ((first, 0, (lo, hi)), (last, 2, (earliest, latest))):
                if not moves or d[k][j] == 0:
                    continue
                need(ends[0] > 0, "short: an end may take no time")
                rate = (1 / ends[1], 1 / ends[0])
                inner = plus((p[1 + k], p[1 + k]), product((p[2 + k], p[2 + k]), (R(0), tau * rate[1])))
                value = plus(value, product(times(d[k][j], inner), rate))
            need(
                value[0] > claim.limit(order, j) * tau ** (order - 1),
                "short: an interval is not discarded",
            )
        need(not reached > least_end, "short: the intervals of T1 leave a gap")
        return tau

    def end(self, k: int) -> Any:
        """A lower bound of a cube's duration: T^i limit_i >= 3|d|, 6|d|, 6|d| for i = 1, 2, 3."""
        best = R(0)
        for j in self.claim.moving:
            for order, factor in ((1, 3), (2, 6), (3, 6)):
                limit = self.claim.limits[order - 1][j]
                if limit is not None:
                    best = most(best, (factor * abs(self.claim.d[k][j]) / limit).root(order))
        return best

    def excess(self, rows: Any, node: Node, box: list[list[Any]]) -> Any:
        """Const + two quadratics with nu / x + a concave function of T, least at an end of it."""
        claim, d = self.claim, self.claim.d
        const, nu, first, second, w = R(0), R(0), [R(0)] * 2, [R(0)] * 2, [R(0)] * 4
        for kind, m, *rest in rows:
            if kind in ("f", "l"):
                x = 0 if kind == "f" else 1
                first[x] += m * self.t[2 * x]
                w[1] += m
            elif kind == "t":
                nu += m
            else:
                need(kind == "p" and rest[1] == 1, "a row this family does not have")
                j, _, sign, order, s = rest
                p = [sign * m * derivative(c, order, s) for c in self.MIDDLE]
                const += p[0] * d[1][j]
                for x in range(2):
                    first[x] += p[1 + 2 * x] * d[2 * x][j]
                    second[x] += p[2 + 2 * x] * d[2 * x][j]
                if order == 0:
                    const -= m * claim.room(1, j, sign)
                else:
                    w[order] += m * claim.limit(order, j)
        total, short, long = const + nu, R(1), R(1)
        for x, (lo, hi) in enumerate(box):
            if self.has[x]:
                c = (lo + hi) / 2
                total += first[x] * c
                total += least_share((first[x], first[x]), second[x], nu, R(0), R(0), c, lo, hi)
                short, long = short + 1 / hi, long + 1 / lo
        ends = [claim.L / long, claim.L / short]
        return total + least(*(-(w[1] + (w[2] + w[3] * t) * t) * t - nu * claim.L / t for t in ends))


class FourThreeFour(Tree):
    """Variables x_k = 1/T_k; velocities v at the inner waypoints, enclosed per joint.

    A(x) v = b(x), each knot's row the sum of a share per side: x_m (w v_i + 2 v_other - p d_m x_m), m
    the segment there; w, p = 4, 6, at the end pieces 6, 12. A segment without upper end of x is open
    (nothing moves on it): the rows of its knots are divided by its x, the other side's share becomes a
    stray interval.
    """

    PIECES = (  # what d x, v0, v1 (over x) bring: first quartic, cubic, last quartic
        ([0, 0, 0, 4, -3], [0, 0, 0, 0, 0], [0, 0, 0, -1, 1]),
        ([0, 0, 3, -2, 0], [0, 1, -2, 1, 0], [0, 0, -1, 1, 0]),
        ([0, 0, 6, -8, 3], [0, 1, -3, 3, -1], [0, 0, 0, 0, 0]),
    )

    def __init__(self, claim: Claim) -> None:
        self.claim, self.n = claim, claim.n
        need(claim.n >= 2, "4-3-4 has at least two segments")
        t = claim.shortest()
        total = sum(t, R(0))
        self.void = total > claim.L
        box = [] if self.void else [[1 / (claim.L - total + x), None if x == 0 else 1 / x] for x in t]
        zero = (R(0), R(0))
        speeds = {j: claim.speed(j) for j in claim.moving}
        inner = {j: [(-v, v)] * (self.n - 1) for j, v in speeds.items()}
        self.root = Node(box, {j: [zero, *inside, zero] for j, inside in inner.items()})

    def side(self, i: int, side: int) -> tuple[int, int, int, int]:
        """Of knot i's row, before (0) or after (1): the segment, w, p, and the other waypoint."""
        m = i - 1 + side
        end = m == (self.n - 1 if side else 0)
        return m, 6 if end else 4, 12 if end else 6, i + 2 * side - 1

    def turn(self, node: Node) -> None:
        """Cut by the total time, choose a reference, enclose the velocities twice."""
        claim, n, box = self.claim, self.n, node.box
        for _ in range(2):
            short = [R(0) if hi is None else 1 / hi for _, hi in box]
            long = [1 / lo for lo, _ in box]
            all_short, all_long = sum(short, R(0)), sum(long, R(0))
            for k, (lo, hi) in enumerate(box):
                longest, shortest = claim.L - all_short + short[k], claim.L - all_long + long[k]
                if longest <= 0:
                    node.empty = True
                    return
                lo = most(lo, 1 / longest) if longest > 0 else lo
                if shortest > 0:
                    hi = 1 / shortest if hi is None else least(hi, 1 / shortest)
                if hi is not None and lo > hi:
                    node.empty = True
                    return
                box[k] = [lo.lower(), None if hi is None else hi.upper()]
        opened = [hi is None for _, hi in box]
        # any reference will do; this is the prover's, but for rounding
        c = [R(float(lo if hi is None else (lo + hi) / 2)) for lo, hi in box]
        coefficient: dict[tuple[int, int], Any] = {}  # of x in each share at c; None: stray
        matrix = [[R(0)] * (n - 1) for _ in range(n - 1)]
        dropped = []
        for i in range(1, n):
            for side in range(2):
                m, w, _, other = self.side(i, side)
                beside = opened[i - side]
                f = None if beside else R(1) if opened[m] else c[m]
                coefficient[i, side] = f
                if f is not None:
                    matrix[i - 1][i - 1] += w * f
                    if 0 < other < n:
                        matrix[i - 1][other - 1] += 2 * f
            if opened[i - 1] and opened[i]:
                dropped.append(i)
                matrix[i - 1] = [R(int(i - 1 == k)) for k in range(n - 1)]
        rows = inverse_of(matrix)
        inverse = [[R(0)] * (n + 1), *([R(0), *row] for row in rows)]
        node.reference = (c, opened, coefficient, dropped, inverse)
        node.form = (None, None)
        node.known = dict(node.known)
        for j in claim.moving:
            for _ in range(2):
                if not node.empty:
                    self.enclose(j, node)

    def strays(self, j: int, node: Node) -> dict[int, Interval]:
        """Per divided row: T_open x_m (w v_i + 2 v_other - p d_m x_m), T_open up to 1 / its least x."""
        _, _opened, coefficient, dropped, _ = node.reference
        found = {}
        for (i, side), f in coefficient.items():
            if f is None and i not in dropped:
                m, w, p, other = self.side(i, side)
                V, x = node.known[j], (node.box[m][0], node.box[m][1])
                share = plus(times(R(w), V[i]), times(R(2), V[other]))
                share = plus(share, times(-p * self.claim.d[m][j], x))
                found[i] = product(product(share, x), (R(0), 1 / node.box[i - side][0]))
        return found

    def enclose(self, j: int, node: Node) -> None:
        """V = v_c + C [ sum_m (x_m - c_m) slopes - strays ] exactly, C = A(c)^-1, v_c = C b(c)."""
        c, opened, coefficient, dropped, inverse = node.reference
        n, V, d = self.n, node.known[j], self.claim.d
        b = [R(0)] * (n + 1)
        slopes: dict[tuple[int, int], Interval] = {}
        for (i, side), f in coefficient.items():
            m, w, p, other = self.side(i, side)
            if f is None or opened[m]:
                continue
            b[i] += p * d[m][j] * c[m] * c[m]
            q = plus(times(R(w), V[i]), times(R(2), V[other]))
            x = times(p * d[m][j], (c[m] + node.box[m][0], c[m] + node.box[m][1]))
            slopes[m, i] = (x[0] - q[1], x[1] - q[0])
        loose = {i: times(R(-1), xi) for i, xi in self.strays(j, node).items()}
        centre = [sum((row[k] * b[k] for k in range(1, n)), R(0)) for row in inverse]
        loose |= {i: (V[i][0] - centre[i], V[i][1] - centre[i]) for i in dropped}
        new = list(V)
        for i in range(1, n):
            y = (centre[i], centre[i])
            for k, interval in loose.items():
                y = plus(y, times(inverse[i][k], interval))
            for m in range(n):
                parts = [times(inverse[i][k], slopes[m, k]) for k in (m, m + 1) if (m, k) in slopes]
                if parts:
                    slope = parts[0] if len(parts) == 1 else plus(*parts)
                    y = plus(y, product(slope, (node.box[m][0] - c[m], node.box[m][1] - c[m])))
            new[i] = (most(y[0], V[i][0]).lower(), least(y[1], V[i][1]).upper())
            if new[i][0] > new[i][1]:
                node.empty = True
                return
        node.known[j] = new

    def excess(self, rows: Any, node: Node, box: list[list[Any]]) -> Any:
        """Const + a share per segment."""
        need(node.reference is not None, "rows before a turn")
        if node.form[0] is not rows:
            node.form = (rows, self.lagrangian(rows, node))
        const, alpha, kappa, nu, w = node.form[1]
        total = const
        for k, (lo, hi) in enumerate(box):
            if hi is None:  # T in [0, 1/lo]; nothing else depends on x, as nothing moves there
                total -= (w[1][k] + w[2][k] / lo) / lo
            else:
                total += least_share(
                    alpha[k], kappa[k], nu, w[1][k], w[2][k], node.reference[0][k], lo, hi
                )
        return total

    def lagrangian(self, rows: Any, node: Node) -> tuple[Any, ...]:
        """Const; alpha (interval) and kappa per segment; nu; w. x v is split as c v + (x - c) v."""
        claim, n = self.claim, self.n
        c, opened, coefficient, dropped, inverse = node.reference
        const, nu = R(0), R(0)
        alpha, kappa = [R(0)] * n, [R(0)] * n
        w = [[R(0)] * n for _ in range(3)]
        weights: dict[int, list[Any]] = {}  # of v, per joint
        jumps: dict[tuple[int, int], list[tuple[int, int, Any]]] = {}
        for kind, m, *rest in rows:
            if kind == "t":
                nu += m
                const -= m * claim.L
                continue
            need(kind in ("p", "j"), "a row this family does not have")
            j, k, sign = rest[:3]
            weight = weights.setdefault(j, [R(0)] * (n + 1))
            if kind == "j":  # |a(end) - a(start)| <= J T across an open segment
                beside = (k > 0 and opened[k - 1]) or (k + 1 < n and opened[k + 1])
                need(opened[k] and not beside, "a jump that is not across a lone open segment")
                const -= m * claim.limit(3, j) / node.box[k][0]
                knots = [(i, side, sign * m) for i, side in ((k, 0), (k + 1, 1)) if 0 < i < n]
                jumps.setdefault((j, k), []).extend(knots)
                continue
            order, s = rest[3:]
            parts = self.PIECES[0 if k == 0 else 2 if k == n - 1 else 1]
            p = [sign * m * derivative(part, order, s) for part in parts]
            alpha[k] += p[0] * claim.d[k][j]
            weight[k] += p[1]
            weight[k + 1] += p[2]
            if order == 0:
                need(not opened[k], "a position row on an open segment")
                alpha[k] -= m * claim.room(k, j, sign)
            elif order == 1:
                const -= m * claim.limit(1, j)
            else:
                w[order - 1][k] += m * claim.limit(order, j)
        const += sum((a * x for a, x in zip(alpha, c, strict=True)), R(0))
        interval = [(a, a) for a in alpha]
        for j, weight in weights.items():
            V = node.known[j]
            F: dict[tuple[int, int], Any] = {}  # factors of x_m v_i
            rest = [R(0) if i in (0, n) else x for i, x in enumerate(weight)]

            def share(i: int, side: int, mu: Any, j: int = j, F: Any = F, rest: Any = rest) -> None:
                m, a, p, other = self.side(i, side)
                for at, f in ((i, a * mu), (other, 2 * mu)):
                    F[m, at] = F.get((m, at), R(0)) + f
                    rest[at] += c[m] * f
                kappa[m] -= mu * p * claim.d[m][j]

            for (joint, _), knots in jumps.items():
                for i, side, eta in knots if joint == j else ():
                    share(i, side, eta)
            # multipliers of the knots that make the v-terms at c vanish
            mu = [-sum((rest[i] * inverse[i][k] for i in range(1, n)), R(0)) for k in range(1, n)]
            mu = [R(0), *(R(0) if k in dropped else x for k, x in enumerate(mu, 1))]
            for i, xi in self.strays(j, node).items():
                const += times(mu[i], xi)[0]
            for (i, side), f in coefficient.items():
                m, a, _, other = self.side(i, side)
                if f is not None and opened[m]:
                    rest[i] += a * mu[i]
                    rest[other] += 2 * mu[i]
                elif f is not None:
                    share(i, side, mu[i])
            for (m, i), f in F.items():
                interval[m] = plus(interval[m], times(f, V[i]))
            for i in range(1, n):
                const += times(rest[i], V[i])[0]
        return const, interval, kappa, nu, w


# ---------------------------------------------------------------- the chain


def least_on(a: Any, b: Any, c: Any, lo: Any, hi: Any) -> Any:
    """Lower bound of a x + b / x - c / x^2 over x in [lo, hi] > 0, c >= 0.

    With u = 1/x in [p, q]: u^2 <= (p + q) u - p q. What is left, a / u + b' u, is concave or monotone
    in u, and least at an end, unless a, b' > 0; then it is convex, and nowhere below 2 sqrt(a b').
    """
    a, b, c = a.lower(), b.lower(), c.upper()
    pieces = 8 if c > 0 else 1
    ends = [1 / hi + (1 / lo - 1 / hi) * i / pieces for i in range(pieces + 1)]
    values = []
    for p, q in pairwise(ends):
        slope = (b - c * (p + q)).lower()
        at_p, at_q = a / p + slope * p, a / q + slope * q
        value = least(at_p, at_q)
        if a > 0 and slope > 0:
            rising, falling = slope * p * p >= a, slope * q * q <= a
            value = at_p if rising else at_q if falling else 2 * (a * slope).sqrt()
        values.append(value + c * p * q)
    return least(*values).lower()


class Quintic:
    """Variables x_k = 1/T_k; each condition ties x_k to its two neighbours alone.

    The domains are cut into cells; a path takes a cell of each variable, and a motion lies on a path. A
    triple of cells of neighbouring variables stands for all paths through it. It is discarded if a
    condition is violated on all of it, or if a weighted sum of conditions is positive on every path
    through it. The proof holds if some variable has no triple left. Events: C cuts the cells of a
    segment, R gives rows that are tried one by one, L the rows of a sum.
    """

    PIECE = ([0, 0, 0, 10, -15, 6], [0, 1, 0, -6, 8, -3], [0, 0, 0, -4, 7, -3])

    def __init__(self, claim: Claim) -> None:
        self.claim, self.n = claim, claim.n
        t = claim.shortest()
        total = sum(t, R(0))
        self.void = total > claim.L
        # a segment on which nothing moves may vanish, and no condition depends on it
        moves = [not all(x == 0 for x in row) for row in claim.d]
        self.counts = [False, *moves, False]
        self.cells = [[(R(1), R(1))] for _ in range(self.n + 2)]
        for k, x in enumerate(t):
            if moves[k] and not self.void:
                self.cells[k + 1] = [((1 / (claim.L - total + x)).lower(), (1 / x).upper())]
        self.triples: list[list[tuple[int, ...]]] = [[(0, 0, 0)] for _ in range(self.n)]
        self.discards = self.work = 0

    def replay(self) -> int:
        """Verify every event; returns the number of discards."""
        for count, raw in enumerate(self.claim.events, 1):
            event = items(raw, 2, 3)
            need(self.work <= MOST_WORK, f"event {count}: too much work")
            if event[0] == "C" and len(event) == 3:
                edges = [number(x) for x in items(event[2], 0, MOST_CUTS)]
                self.cut(index(event[1], self.n) + 1, edges)
            elif event[0] in ("R", "L") and len(event) == 2:
                rows = [self.claim.row(row) for row in items(event[1], 0, MOST_ROWS)]
                if event[0] == "R":
                    for row in rows:
                        self.discard_row(row)
                else:
                    self.discard_sum(rows)
            else:
                raise BadInput(f"event {count}: unknown event {raw!r:.20}")
        need(not all(self.triples), "the events end before every path has ended")
        return self.discards

    def condition(self, row: Any) -> tuple[Any, ...]:
        """Segment, coefficients of x_{k-1}, x_k, x_{k+1}, limit, and the power of x_k under it."""
        need(row[0] == "p", "a row this family does not have")
        _, _, j, k, sign, order, s = row
        d = [R(0), *(each[j] for each in self.claim.d), R(0)][k : k + 3]
        here, start, end = (sign * derivative(part, order, s) for part in self.PIECE)
        before, after = ((d[1] > 0 and x > 0) or (d[1] < 0 and x < 0) for x in (d[0], d[2]))
        b, e = (start / 2 if before else R(0)), (end / 2 if after else R(0))
        own = d[1] * (here + b + e)
        if order == 0:
            return k, d[0] * b, own - self.claim.room(k, j, sign), d[2] * e, R(0), 0
        return k, d[0] * b, own, d[2] * e, self.claim.limit(order, j), order - 1

    def discard_row(self, row: Any) -> None:
        """Discard the triples on which one condition is violated.

        Linear shares, and A x - limit / x^p, which grows with x if A >= 0 and is concave if not.
        """
        k, b, a, e, limit, power = self.condition(row)
        b, a, e = b.lower(), a.lower(), e.lower()
        shares = [
            [least(*(part * x for x in ends)).lower() for ends in self.cells[k + shift]]
            for shift, part in ((0, b), (2, e))
        ]
        own = [least(*(a * x - limit / x**power for x in ends)).lower() for ends in self.cells[k + 1]]
        self.work += len(self.triples[k])
        stay = [t for t in self.triples[k] if not shares[0][t[0]] + own[t[1]] + shares[1][t[2]] > 0]
        self.discards += len(self.triples[k]) - len(stay)
        self.triples[k] = stay

    def discard_sum(self, rows: Any) -> None:
        """Discard the triples through which the weighted sum is positive on every path."""
        n = self.n
        self.work += sum(map(len, self.triples))
        const, nu = R(0), R(0)
        a, held = [R(0)] * (n + 2), [[R(0)] * (n + 2) for _ in range(3)]
        for row in rows:
            m = row[1]
            if row[0] == "t":
                const, nu = const - m * self.claim.L, nu + m
                continue
            k, *parts, limit, power = self.condition(row)
            for shift, part in enumerate(parts):
                a[k + shift] += m * part
            held[power][k + 1] += m * limit
        const -= sum(held[0], R(0))
        b = [(nu if counts else 0) - x for counts, x in zip(self.counts, held[1], strict=True)]
        phi = [
            [least_on(a[k], b[k], held[2][k], *ends) for ends in cells]
            for k, cells in enumerate(self.cells)
        ]
        ahead: list[dict[tuple[int, int], Any]] = [
            {(0, y): const + phi[0][0] + x for y, x in enumerate(phi[1])}
        ]
        for k, triples in enumerate(self.triples):
            least_sum: dict[tuple[int, int], Any] = {}
            for x, y, z in triples:
                if (x, y) in ahead[k]:
                    value = ahead[k][x, y] + phi[k + 2][z]
                    least_sum[y, z] = value.min(least_sum.get((y, z), value))
            ahead.append(least_sum)
        behind = {(y, 0): R(0) for y in range(len(phi[n]))}
        for k in range(n - 1, -1, -1):
            least_rest: dict[tuple[int, int], Any] = {}
            stay: list[tuple[int, ...]] = []
            for x, y, z in self.triples[k]:
                if (x, y) in ahead[k] and (y, z) in behind:
                    value = behind[y, z] + phi[k + 2][z]
                    least_rest[x, y] = value.min(least_rest.get((x, y), value))
                    if not ahead[k][x, y] + value > 0:
                        stay.append((x, y, z))
            behind = least_rest
            self.discards += len(self.triples[k]) - len(stay)
            self.triples[k] = stay

    def cut(self, k: int, edges: list[Any]) -> None:
        """Cut the cells of padded variable k at the edges inside them."""
        need(self.counts[k], "a cut of a segment on which nothing moves")
        edges.sort(key=float)
        places = [float(x) for x in edges]
        cells: list[Any] = []
        children: list[range] = []
        for lo, hi in self.cells[k]:
            near = edges[bisect_left(places, float(lo)) : bisect_right(places, float(hi))]
            inside = [lo, *(x for x in near if lo < x < hi), hi]
            children.append(range(len(cells), len(cells) + len(inside) - 1))
            cells += pairwise(inside)
        self.cells[k] = cells
        for middle in range(max(k - 2, 0), min(k + 1, self.n)):
            place = k - middle
            size = sum(len(children[t[place]]) for t in self.triples[middle])
            need(size <= MOST_TRIPLES, "too many cells")
            self.triples[middle] = [
                (*t[:place], child, *t[place + 1 :])
                for t in self.triples[middle]
                for child in children[t[place]]
            ]


class EveryMotion:
    """What holds for every motion from rest to rest, whatever its family.

    For m linear on each segment, mu_0 .. mu_n at the waypoints, and p linear on N cells of each,
    sum (mu_{k-1} - mu_k) d_k / T_k = int m q'' = int p q'' + int (p - m)' q'
                                    <= A sum T_k mean |p| + V sum |steps of p - m|.
    Summed over the joints, a_k / T_k <= w_k T_k + const; so the total time is no less than
    sum T_k + a_k / T_k - w_k T_k - const >= sum 2 sqrt(a_k (1 - w_k)) - const. An event per joint.
    """

    def __init__(self, claim: Claim) -> None:
        self.claim = claim
        self.void = sum(claim.shortest(), R(0)) > claim.L

    def replay(self) -> int:
        """Verify the sum; returns the number of joints in it."""
        n, joints = self.claim.n, set()
        a, w, const = [R(0)] * n, [R(0)] * n, R(0)
        for raw in self.claim.events:
            letter, joint, mu, p = items(raw, 4, 4)
            if letter != "M":
                raise BadInput(f"unknown event {letter!r:.20}")
            j = index(joint, self.claim.dof)
            need(j not in joints, f"joint {j + 1} counts twice")
            joints.add(j)
            mu = [number(x) for x in items(mu, n + 1, n + 1)]
            p = [number(x) for x in items(p, n + 1, MOST_CUTS)]
            cells = (len(p) - 1) // n
            need(len(p) == cells * n + 1, "the cells of a segment are not equal in number")
            for k in range(n):
                a[k] += (mu[k] - mu[k + 1]) * self.claim.d[k][j]
                for i in range(k * cells, (k + 1) * cells):
                    if not (p[i] == 0 and p[i + 1] == 0):
                        w[k] += self.claim.limit(2, j) * (abs(p[i]) + abs(p[i + 1])) / (2 * cells)
                    turn = p[i + 1] - p[i] - (mu[k + 1] - mu[k]) / cells
                    const += self.claim.limit(1, j) * abs(turn)
        need(all(x >= 0 for x in a), "a segment gains from taking no time")
        need(all(x <= 1 for x in w), "a segment gains from taking long")
        total = sum((2 * (x * (1 - y)).sqrt() for x, y in zip(a, w, strict=True)), R(0)) - const
        need(total > self.claim.L, "the sum is not above the bound")
        return len(joints)


# ---------------------------------------------------------------- the command


def inverse_of(rows: list[list[Any]]) -> list[list[Any]]:
    """The inverse of a square matrix."""
    from flint import arb_mat

    try:
        inverse: list[list[Any]] = arb_mat(rows).inv().tolist()
    except ZeroDivisionError:
        raise Refused("the equations of the velocities have no certain solution") from None
    return inverse


def verify(data: Any) -> str:
    """What a certificate proves, in words. Raises Refused or BadInput."""
    claim = Claim(data)
    trees: dict[str, Any] = {
        "3-5-3": ThreeFiveThree,
        "4-3-4": FourThreeFour,
        "quintic": Quintic,
        "b-spline-3": EveryMotion,
        "b-spline-5": EveryMotion,
    }
    if claim.family not in trees:
        raise BadInput(f"family: {claim.family:.40} is not one of {', '.join(trees)}")
    tree = trees[claim.family](claim)
    discards = 0 if tree.void else tree.replay()
    name = str(data.get("name"))[:60]
    return (
        f"no {claim.family} motion of {name!r} takes {float(claim.L):.12g} s or less "
        f"({len(claim.events)} events, {discards} discards)"
    )


def compare_with(data: Any, file_or_case: str) -> None:
    """Refuse a certificate of another problem. The one place that uses the project's own loader."""
    from formulations import InputError, load

    try:
        problem = load(file_or_case)
    except InputError as error:
        raise BadInput(str(error)) from None

    def same(key: str, ours: Any, theirs: Any) -> None:
        ours = [[float(x) for x in row] for row in ours]
        theirs = [[-inf if x is None else float.fromhex(x) for x in row] for row in theirs]
        ours = [[-inf if abs(x) == inf else x for x in row] for row in ours]
        need(ours == theirs, f"{key} differ from those of {file_or_case}")

    limits, claimed = problem.limits, data["limits"]
    need(data["family"] == problem.family, f"family differs from that of {file_or_case}")
    same("waypoints", problem.waypoints, data["waypoints"])
    for key in ("velocity", "acceleration", "jerk"):
        same(f"limits.{key}", [getattr(limits, key)], [claimed[key]])
    same("limits.position", limits.position, claimed["position"])
    slack = float.fromhex(data["position_slack"])
    need(slack >= problem.position_slack, "position_slack is less than the check allows")


def read(path: Path) -> Any:
    """The data in a file. Raises BadInput."""

    def no_constant(name: str) -> Any:
        raise BadInput(f"{path}: {name} in the file")

    try:
        if path.stat().st_size > LARGEST_FILE:
            raise BadInput(f"{path}: larger than {LARGEST_FILE} bytes")
        return json.loads(path.read_text("utf-8"), parse_constant=no_constant)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise BadInput(f"{path}: not valid JSON: {str(error)[:100]}") from None


def main(arguments: list[str] | None = None) -> int:
    """Check one certificate; returns the exit code."""
    global R
    parser = argparse.ArgumentParser(
        prog="python -m compare.check_certificate",
        description="Re-prove a certified bound in ball arithmetic, independently of the prover. "
        "Exit code 0: certified, 1: refused, 2: bad input.",
        epilog="example:\n  python -m compare.check_certificate sr4c.json --problem sr4c",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("file", metavar="FILE", help="a certificate, from compare.solve --certificate")
    parser.add_argument("--problem", metavar="FILE_OR_CASE", help="the problem it must be about")
    options = parser.parse_args(arguments)
    try:
        from flint import arb, ctx
    except ImportError:
        print("error: python-flint is missing: pip install 'timebound[certificate]'", file=sys.stderr)
        return BAD_INPUT
    R, ctx.prec = arb, BITS
    try:
        data = read(Path(options.file))
        words = verify(data)
        if options.problem:
            compare_with(data, options.problem)
    except Refused as reason:
        print(f"refused: {reason}")
        return REFUSED
    except BadInput as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    print(f"certified: {words}")
    return CERTIFIED


if __name__ == "__main__":
    sys.exit(main())
