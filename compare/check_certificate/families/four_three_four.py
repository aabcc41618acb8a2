"""4-3-...-3-4 splines: inverse durations, and velocities at the inner waypoints."""

from __future__ import annotations

from typing import Any

from compare.check_certificate.answers import need
from compare.check_certificate.balls import (
    Interval,
    R,
    derivative,
    inverse_of,
    least,
    least_share,
    most,
    plus,
    product,
    times,
)
from compare.check_certificate.claim import Claim
from compare.check_certificate.families.tree import Node, Tree


class FourThreeFour(Tree):
    """Variables x_k = 1/T_k; velocities v at the inner waypoints, enclosed per joint.

    A(x) v = b(x): the equation of each knot is the sum of a share per side, x_m (w v_i + 2 v_other -
    p d_m x_m), where m is the segment there; w, p = 4, 6, and 6, 12 at the end pieces. A segment without
    upper end of x is open (nothing moves on it): the equations of its knots are divided by its x, and
    the share of the other side becomes a stray interval.
    """

    PIECES = (  # what multiplies d x, v0, v1 (over x): first quartic, cubic, last quartic
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

    def _side(self, i: int, side: int) -> tuple[int, int, int, int]:
        """Knot i's share before (0) or after (1) it: the segment, w, p, and the other waypoint."""
        m = i - 1 + side
        end = m == (self.n - 1 if side else 0)
        return m, 6 if end else 4, 12 if end else 6, i + 2 * side - 1

    def _turn(self, node: Node) -> None:
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
        # any reference will do; this is the prover's up to rounding
        c = [R(float(lo if hi is None else (lo + hi) / 2)) for lo, hi in box]
        coefficient: dict[tuple[int, int], Any] = {}  # of x in each share at c; None: stray
        matrix = [[R(0)] * (n - 1) for _ in range(n - 1)]
        dropped = []
        for i in range(1, n):
            for side in range(2):
                m, w, _, other = self._side(i, side)
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
                    self._enclose(j, node)

    def _strays(self, j: int, node: Node) -> dict[int, Interval]:
        """Per divided row: T_open x_m (w v_i + 2 v_other - p d_m x_m), T_open up to 1 / its least x."""
        _, _opened, coefficient, dropped, _ = node.reference
        found = {}
        for (i, side), f in coefficient.items():
            if f is None and i not in dropped:
                m, w, p, other = self._side(i, side)
                V, x = node.known[j], (node.box[m][0], node.box[m][1])
                share = plus(times(R(w), V[i]), times(R(2), V[other]))
                share = plus(share, times(-p * self.claim.d[m][j], x))
                found[i] = product(product(share, x), (R(0), 1 / node.box[i - side][0]))
        return found

    def _enclose(self, j: int, node: Node) -> None:
        """V = v_c + C [ sum_m (x_m - c_m) slopes - strays ] exactly, C = A(c)^-1, v_c = C b(c)."""
        c, opened, coefficient, dropped, inverse = node.reference
        n, V, d = self.n, node.known[j], self.claim.d
        b = [R(0)] * (n + 1)
        slopes: dict[tuple[int, int], Interval] = {}
        for (i, side), f in coefficient.items():
            m, w, p, other = self._side(i, side)
            if f is None or opened[m]:
                continue
            b[i] += p * d[m][j] * c[m] * c[m]
            q = plus(times(R(w), V[i]), times(R(2), V[other]))
            x = times(p * d[m][j], (c[m] + node.box[m][0], c[m] + node.box[m][1]))
            slopes[m, i] = (x[0] - q[1], x[1] - q[0])
        loose = {i: times(R(-1), xi) for i, xi in self._strays(j, node).items()}
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

    def _excess(self, rows: Any, node: Node, box: list[list[Any]]) -> Any:
        """A constant and a share per segment."""
        need(node.reference is not None, "rows before a turn")
        if node.form[0] is not rows:
            node.form = (rows, self._lagrangian(rows, node))
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

    def _lagrangian(self, rows: Any, node: Node) -> tuple[Any, ...]:
        """Constant, alpha (interval) and kappa per segment, nu, w; x v is split as c v + (x - c) v."""
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
                m, a, p, other = self._side(i, side)
                for at, f in ((i, a * mu), (other, 2 * mu)):
                    F[m, at] = F.get((m, at), R(0)) + f
                    rest[at] += c[m] * f
                kappa[m] -= mu * p * claim.d[m][j]

            for (joint, _), knots in jumps.items():
                for i, side, eta in knots if joint == j else ():
                    share(i, side, eta)
            # multipliers of the knot equations that make the v-terms at c vanish
            mu = [-sum((rest[i] * inverse[i][k] for i in range(1, n)), R(0)) for k in range(1, n)]
            mu = [R(0), *(R(0) if k in dropped else x for k, x in enumerate(mu, 1))]
            for i, xi in self._strays(j, node).items():
                const += times(mu[i], xi)[0]
            for (i, side), f in coefficient.items():
                m, a, _, other = self._side(i, side)
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
