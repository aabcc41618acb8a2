"""3-5-3 splines: two ratios of durations."""

from __future__ import annotations

from typing import Any

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import (
    R,
    derivative,
    least,
    least_share,
    most,
    plus,
    product,
    times,
)
from compare.check_certificate.claim import MOST_EVENTS, Claim
from compare.check_certificate.families.tree import Node, Tree
from compare.check_certificate.reading import index, items, number


class ThreeFiveThree(Tree):
    """Variables r = T2/T1, q = T2/T3; T = T2 = L / (1 + 1/r + 1/q).

    A variable is fixed to 1 and dropped where nothing moves on its end segment.
    """

    MIDDLE = (  # what multiplies d2, d1 r, d1 r^2, d3 q, d3 q^2 in the middle piece
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
        self.t = t = [self._end(0), t[1], self._end(2)]
        self.void = sum(t, R(0)) > claim.L
        if not self.void and all(x == 0 for x in claim.d[1]):
            t[1] = self._no_short_middle()
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

    def _no_short_middle(self) -> Any:
        """Verify that T2 <= tau is impossible where nothing moves on the middle segment; returns tau.

        Derivative k >= 1 of the middle piece times T2^(k-1) is d1/T1 (B + C r) + d3/T3 (E + F q), r in
        [0, tau/T1], q in [0, tau/T3]; a limit allows it at most limit tau^(k-1). An end segment on which
        nothing moves is left out and the rest is stretched to L: T1 = 0 if that is the first segment,
        T1 in [L - tau, L] if it is the last.
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

    def _end(self, k: int) -> Any:
        """Lower bound of a cubic's duration: T^i limit_i >= 3|d|, 6|d|, 6|d| for i = 1, 2, 3."""
        best = R(0)
        for j in self.claim.moving:
            for order, factor in ((1, 3), (2, 6), (3, 6)):
                limit = self.claim.limits[order - 1][j]
                if limit is not None:
                    best = most(best, (factor * abs(self.claim.d[k][j]) / limit).root(order))
        return best

    def _excess(self, rows: Any, node: Node, box: list[list[Any]]) -> Any:
        """A constant, two quadratics with nu / x, and a concave function of T, least at an end of T."""
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
