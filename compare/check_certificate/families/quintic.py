"""Quintic splines: a chain of cells."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from itertools import pairwise
from typing import Any

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import R, derivative, least
from compare.check_certificate.claim import Claim
from compare.check_certificate.reading import index, items, number

MOST_ROWS, MOST_CUTS, MOST_TRIPLES, MOST_WORK = 20_000, 1_000_000, 5_000_000, 1_000_000_000


def _least_on(a: Any, b: Any, c: Any, lo: Any, hi: Any) -> Any:
    """Bound a x + b / x - c / x^2 from below over x in [lo, hi] > 0, c >= 0.

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

    The domains are cut into cells. A path takes a cell of each variable, and every motion lies on a
    path. A triple of cells of neighbouring variables stands for all paths through it. It is discarded if
    a condition is violated on all of it, or if a weighted sum of conditions is positive on every path
    through it. The proof holds if some variable has no triple left. Events: C cuts the cells of a
    segment, R gives conditions that are tried one by one, L gives those of a sum.
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
                self._cut(index(event[1], self.n) + 1, edges)
            elif event[0] in ("R", "L") and len(event) == 2:
                rows = [self.claim.row(row) for row in items(event[1], 0, MOST_ROWS)]
                if event[0] == "R":
                    for row in rows:
                        self._discard_row(row)
                else:
                    self._discard_sum(rows)
            else:
                raise BadInput(f"event {count}: unknown event {raw!r:.20}")
        need(not all(self.triples), "the events end before every path has ended")
        return self.discards

    def _condition(self, row: Any) -> tuple[Any, ...]:
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

    def _discard_row(self, row: Any) -> None:
        """Discard the triples on which one condition is violated.

        Linear shares, and A x - limit / x^p, which grows with x if A >= 0 and is concave if not.
        """
        k, b, a, e, limit, power = self._condition(row)
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

    def _discard_sum(self, rows: Any) -> None:
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
            k, *parts, limit, power = self._condition(row)
            for shift, part in enumerate(parts):
                a[k + shift] += m * part
            held[power][k + 1] += m * limit
        const -= sum(held[0], R(0))
        b = [(nu if counts else 0) - x for counts, x in zip(self.counts, held[1], strict=True)]
        phi = [
            [_least_on(a[k], b[k], held[2][k], *ends) for ends in cells]
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

    def _cut(self, k: int, edges: list[Any]) -> None:
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
