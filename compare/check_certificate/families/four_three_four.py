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
from compare.check_certificate.reading import index, items, number


class FourThreeFour(Tree):
    """Variables x_k = 1/T_k; velocities v at the inner waypoints, enclosed per joint.

    A(x) v = b(x): the equation of each knot is the sum of a share per side, x_m (w v_i + 2 v_other -
    p d_m x_m), where m is the segment there; w, p = 4, 6, and 6, 12 at the end pieces. A segment without
    upper end of x is open (nothing moves on it): the equations of its knots are divided by its x, and
    the share of the other side becomes a stray interval.

    Parts. ["W", start, end, b, H] begins a tree about segments start .. end - 1 alone: they take more than
    b seconds in every motion that takes at most H >= L. Suppose they take no more. Stretched in time to b
    they still keep every limit inside them and the equations of the knots between them, and no velocity
    at their waypoints is above the bound of the speed in H seconds. So the tree may assume that they take
    b. The velocities at ends that are not the motion's own are free: there is no equation there, and
    their enclosures are split by ["V", joint, end, value]. All the whole uses of a part is b.
    """

    PIECES = (  # what multiplies d x, v0, v1 (over x): first quartic, cubic, last quartic
        ([0, 0, 0, 4, -3], [0, 0, 0, 0, 0], [0, 0, 0, -1, 1]),
        ([0, 0, 3, -2, 0], [0, 1, -2, 1, 0], [0, 0, -1, 1, 0]),
        ([0, 0, 6, -8, 3], [0, 1, -3, 3, -1], [0, 0, 0, 0, 0]),
    )

    def __init__(self, claim: Claim) -> None:
        self.claim = claim
        need(claim.n >= 2, "4-3-4 has at least two segments")
        self.parts: dict[tuple[int, int], Any] = {}  # least times that are proved
        self._begin(0, claim.n, claim.L, claim.L)

    def _begin(self, start: int, end: int, L: Any, H: Any) -> None:
        """Begin the tree of a part, or of the whole."""
        claim = self.claim
        self.start, self.n, self.L = start, end - start, L
        self.rests = (start == 0, end == claim.n)  # at its start and end
        self.free = [i for i, rest in zip((0, self.n), self.rests, strict=True) if not rest]
        self.d = claim.d[start:end]
        self.known = {
            (a - start, b - start): least
            for (a, b), least in self.parts.items()
            if start <= a and b <= end
        }
        t = claim.shortest(H)[start:end]
        total = sum(t, R(0))
        self.void = total > L
        box = [] if self.void else [[1 / (L - total + x), None if x == 0 else 1 / x] for x in t]
        speeds = {j: claim.speed(j, H) for j in claim.moving}
        self.root = Node(box, {j: [(-v, v)] * (self.n + 1) for j, v in speeds.items()})
        for V in self.root.known.values():
            for i, rest in zip((0, self.n), self.rests, strict=True):
                if rest:
                    V[i] = (R(0), R(0))

    def replay(self) -> int:
        """Verify the trees of all parts, then the whole's; returns the number of discards."""
        events = self.claim.events
        heads = [i for i, event in enumerate(events) if isinstance(event, list) and event[:1] == ["W"]]
        if not heads:
            return super().replay()
        need(heads[0] == 0, "events before the first part")
        discards = 0
        for at, until in zip(heads, [*heads[1:], len(events)], strict=True):
            _, start, end, L, H = items(events[at], 5, 5)
            start, end = index(start, self.claim.n), index(end, self.claim.n + 1)
            L, H = number(L), number(H)
            need(start < end, "a part without a segment")
            need(H >= self.claim.L, "a part that is proved for shorter motions only")
            need(L > 0, "the bound of a part is not positive")
            self._begin(start, end, L, H)
            if self.void:
                need(at + 1 == until, "events of a part that needs none")
            else:
                discards += self._replay_tree(events[at + 1 : until], at + 2, start)
            self.parts[start, end] = L
        need((start, end) == (0, self.claim.n), "the last part is not the whole")
        need(L >= self.claim.L, "less is proved than claimed")
        return discards

    def _velocity_halves(self, event: list[Any], node: Node) -> list[Node]:
        """Split the velocity of a joint at a free end; the upper half comes first."""
        _, j, end, value = items(event, 4, 4)
        j, i, value = index(j, self.claim.dof), (0, self.n)[index(end, 2)], number(value)
        need(j in self.claim.moving and i in self.free, "a split of a velocity that is known")
        halves = []
        lo, hi = node.known[j][i]
        for ends in ((lo, least(hi, value)), (most(lo, value), hi)):
            half = Node(node.box, dict(node.known), node.empty or bool(ends[0] > ends[1]))
            half.known[j] = [*node.known[j][:i], ends, *node.known[j][i + 1 :]]
            halves.append(half)
        return halves

    def _kind(self, k: int) -> int:
        """Which piece a segment has: 0 first quartic, 1 cubic, 2 last quartic."""
        if k == 0 and self.rests[0]:
            return 0
        return 2 if k == self.n - 1 and self.rests[1] else 1

    def _inner(self) -> list[int]:
        """Knots whose velocity is not known to be zero."""
        return [i for i in range(self.n + 1) if 0 < i < self.n or i in self.free]

    def _side(self, i: int, side: int) -> tuple[int, int, int, int]:
        """Knot i's share before (0) or after (1) it: the segment, w, p, and the other waypoint."""
        m = i - 1 + side
        end = self._kind(m) == (2 if side else 0)
        return m, 6 if end else 4, 12 if end else 6, i + 2 * side - 1

    def _turn(self, node: Node) -> None:
        """Cut by the total time, choose a reference, enclose the velocities twice."""
        claim, n, box = self.claim, self.n, node.box
        for _ in range(2):
            short = [R(0) if hi is None else 1 / hi for _, hi in box]
            long = [1 / lo for lo, _ in box]
            all_long = sum(long, R(0))
            before, after = self._least_times(short)
            for k, (lo, hi) in enumerate(box):
                longest = self.L - before[k] - after[k + 1]
                shortest = self.L - all_long + long[k]
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
        matrix = [[R(0)] * (n + 1) for _ in range(n + 1)]
        dropped = [0, n]
        inner = self._inner()
        for i in range(1, n):
            for side in range(2):
                m, w, _, other = self._side(i, side)
                beside = opened[i - side]
                f = None if beside else R(1) if opened[m] else c[m]
                coefficient[i, side] = f
                if f is not None:
                    matrix[i][i] += w * f
                    if other in inner:
                        matrix[i][other] += 2 * f
            if opened[i - 1] and opened[i]:
                dropped.append(i)
        for i in dropped:
            matrix[i] = [R(int(i == k)) for k in range(n + 1)]
        inverse = inverse_of(matrix)
        node.reference = (c, opened, coefficient, dropped, inverse)
        node.form = (None, None)
        node.known = dict(node.known)
        for j in claim.moving:
            for _ in range(2):
                if not node.empty:
                    self._enclose(j, node)

    def _least_times(self, short: list[Any]) -> tuple[list[Any], list[Any]]:
        """Least times before and after each knot, by the ends of x and the parts side by side."""
        n = self.n
        before, after = [R(0)] * (n + 1), [R(0)] * (n + 1)
        for k in range(n):
            known = [before[a] + least for (a, b), least in self.known.items() if b == k + 1]
            before[k + 1] = most(before[k] + short[k], *known)
        for k in reversed(range(n)):
            known = [after[b] + least for (a, b), least in self.known.items() if a == k]
            after[k] = most(after[k + 1] + short[k], *known)
        return before, after

    def _strays(self, j: int, node: Node) -> dict[int, Interval]:
        """Per divided row: T_open x_m (w v_i + 2 v_other - p d_m x_m), T_open up to 1 / its least x."""
        _, _opened, coefficient, dropped, _ = node.reference
        found = {}
        for (i, side), f in coefficient.items():
            if f is None and i not in dropped:
                m, w, p, other = self._side(i, side)
                V, x = node.known[j], (node.box[m][0], node.box[m][1])
                share = plus(times(R(w), V[i]), times(R(2), V[other]))
                share = plus(share, times(-p * self.d[m][j], x))
                found[i] = product(product(share, x), (R(0), 1 / node.box[i - side][0]))
        return found

    def _enclose(self, j: int, node: Node) -> None:
        """V = v_c + C [ sum_m (x_m - c_m) slopes - strays ] exactly, C = A(c)^-1, v_c = C b(c)."""
        c, opened, coefficient, dropped, inverse = node.reference
        n, V, d = self.n, node.known[j], self.d
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
        for i in self.free:
            b[i] = (V[i][0] + V[i][1]) / 2  # any centre will do
        centre = [sum((row[k] * b[k] for k in range(n + 1)), R(0)) for row in inverse]
        loose |= {i: (V[i][0] - centre[i], V[i][1] - centre[i]) for i in dropped}
        new = list(V)
        for i in self._inner():
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
        inner = self._inner()
        alpha, kappa = [R(0)] * n, [R(0)] * n
        w = [[R(0)] * n for _ in range(3)]
        weights: dict[int, list[Any]] = {}  # of v, per joint
        jumps: dict[tuple[int, int], list[tuple[int, int, Any]]] = {}
        for kind, m, *rest in rows:
            if kind == "t":
                nu += m
                const -= m * self.L
                continue
            if kind == "w":
                a, b = rest[0] - self.start, rest[1] - self.start
                need((a, b) in self.known, "a row about a part that is not proved")
                const += m * self.known[a, b]
                for k in range(a, b):
                    w[1][k] += m
                continue
            need(kind in ("p", "j"), "a row this family does not have")
            j, k, sign = rest[0], rest[1] - self.start, rest[2]
            need(0 <= k < n, "a row about a segment that is not in the part")
            weight = weights.setdefault(j, [R(0)] * (n + 1))
            if kind == "j":  # |a(end) - a(start)| <= J T across an open segment
                beside = (k > 0 and opened[k - 1]) or (k + 1 < n and opened[k + 1])
                need(opened[k] and not beside, "a jump that is not across a lone open segment")
                need(k not in self.free and k + 1 not in self.free, "a jump at a free end")
                const -= m * claim.limit(3, j) / node.box[k][0]
                knots = [(i, side, sign * m) for i, side in ((k, 0), (k + 1, 1)) if 0 < i < n]
                jumps.setdefault((j, k), []).extend(knots)
                continue
            order, s = rest[3:]
            parts = self.PIECES[self._kind(k)]
            p = [sign * m * derivative(part, order, s) for part in parts]
            alpha[k] += p[0] * self.d[k][j]
            weight[k] += p[1]
            weight[k + 1] += p[2]
            if order == 0:
                need(not opened[k], "a position row on an open segment")
                alpha[k] -= m * claim.room(self.start + k, j, sign)
            elif order == 1:
                const -= m * claim.limit(1, j)
            else:
                w[order - 1][k] += m * claim.limit(order, j)
        const += sum((a * x for a, x in zip(alpha, c, strict=True)), R(0))
        interval = [(a, a) for a in alpha]
        for j, weight in weights.items():
            V = node.known[j]
            F: dict[tuple[int, int], Any] = {}  # factors of x_m v_i
            rest = [x if i in inner else R(0) for i, x in enumerate(weight)]

            def share(i: int, side: int, mu: Any, j: int = j, F: Any = F, rest: Any = rest) -> None:
                m, a, p, other = self._side(i, side)
                for at, f in ((i, a * mu), (other, 2 * mu)):
                    F[m, at] = F.get((m, at), R(0)) + f
                    rest[at] += c[m] * f
                kappa[m] -= mu * p * self.d[m][j]

            for (joint, _), knots in jumps.items():
                for i, side, eta in knots if joint == j else ():
                    share(i, side, eta)
            # multipliers of the knot equations that make the v-terms at c vanish
            mu = [-sum((rest[i] * inverse[i][k] for i in inner), R(0)) for k in range(n + 1)]
            mu = [R(0) if k in dropped else x for k, x in enumerate(mu)]
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
            for i in inner:
                const += times(rest[i], V[i])[0]
        return const, interval, kappa, nu, w
