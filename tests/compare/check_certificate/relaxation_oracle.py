"""The rows of the relaxation under demands once more, in floats."""

from __future__ import annotations

from typing import Any

import numpy as np
from box_oracle import PRODUCTS, BoxOracle, Key

Row = tuple[dict[Key, float], float]
TIED = {"w": "W", "m": "p", "g": "g", "x": "X"}
KINDS = "hblstcwmvardkSTCgxVRDKje"


class Oracle(BoxOracle):
    """Rows in the boxes of demands."""

    def row(self, raw: list[Any]) -> Row:
        """Coefficients and right-hand side of a row as the certificate names it, without multiplier."""
        kind, found = raw[0], {}

        def add(key: Key, value: float) -> None:
            found[key] = found.get(key, 0.0) + value

        if kind in "hbl":
            before = [p for p in self.ks if kind == "h" or p < raw[1]]
            for p in before:
                add(("T", p), -1.0 if kind == "b" else 1.0)
            if kind == "h":
                return found, self.budget
            wait = sum(self.waits[p] for p in before)
            early, late = self.demands["passages"][raw[1]]
            return (found, wait - early) if kind == "b" else (found, late - wait)
        if kind in "stcSTC":
            return self._of_duration(kind, raw[1], raw[-1])
        if kind == "e":
            return {("T", raw[1]): raw[2]} | {("T", k): -raw[2] for k in self.parts(raw[1])}, 0.0
        j, p = raw[1], raw[2]
        if kind == "V":
            sign, f = raw[3:5]
            found_limits = self.peak(p, j, f > 0.0)
            assert found_limits is not None
            V, J = found_limits
            row = {self.key("v", p, j): float(sign), self.key("a", p, j): sign * f / J}
            return row, V[int(sign > 0)] + f * f / (2 * J)
        first, i = self.start[p], self.after[p]
        if kind in TIED:
            end, corner = raw[3:5]
            of, by = PRODUCTS[TIED[kind]]
            at = self.key(of, i if end else first, j)
            f, e = self.box[by, p][corner % 2], self.box[at][corner in (1, 2)]
            side = 1.0 if corner < 2 else -1.0
            return {(TIED[kind], p, j, end): -side, at: side * f, (by, p): side * e}, side * f * e
        J = self.J[p][j] if self.jerky[j] else 0.0
        if kind == "v":
            end, sign, c = raw[3:6]
            found_limits = self.peak(i if end else first, j, sign * c > 0.0)
            assert found_limits is not None
            V, J = found_limits
            v = self.key("v", i if end else first, j)
            row = {v: float(sign), ("W", p, j, end): c / J, ("q", p): -c * c / (2 * J)}
            return row, V[int(sign > 0)]
        if kind in "rR":
            end, sign, s1, s2 = raw[3:7]
            at, towards = (i if end else first), (-sign if end else sign)
            room = towards * (self.bounds[p][j, int(towards > 0)] - self.c[at, j])
            away = abs(self.A[p][j, int(towards < 0)])
            x = towards * (s1 * s2 - s1**2 / 2)
            m, g = away * (s2 - s1) ** 2 / 2, J * (s1**2 * s2 / 2 - s1**3 / 3)
            if kind == "R":
                add(("g", p, j, end), sign * s2)
                add(("X", p, j, end), x)
                add(self.key("e", at, j), float(towards))
                add(("q", p), -m)
                add(("r", p), -g)
                return found, room
            add(self.key("v", at, j), sign * s2)
            add(("W", p, j, end), x)
            add(("u", p), -room)
            add(("p", p, j, end), float(towards))
            add(("T", p), -m)
            add(("q", p), -g)
            return found, 0.0
        sign = raw[3]
        if kind == "j":
            add(self.key("a", i, j), sign)
            add(self.key("a", first, j), -sign)
            add(("T", p), -J)
            return found, 0.0
        forth, back = abs(self.A[p][j, int(sign > 0)]), abs(self.A[p][j, int(sign < 0)])
        if kind == "a":
            s1, s2 = raw[4:6]
            add(self.key("v", i, j), sign)
            add(self.key("v", first, j), -sign)
            add(("W", p, j, 0), -sign * s1)
            add(("W", p, j, 1), -sign * (1 - s2))
            add(("T", p), -(s2 - s1) * forth)
            add(("q", p), -J * (s1**2 + (1 - s2) ** 2) / 2)
            return found, 0.0
        s1, s2, s3, s4, s5, s6 = raw[4:10]
        if kind in "kK":
            z = y = (s2 + s5) / 2
            g, m = (s5 - s2) ** 3 / 12, [(s2 - s1) * (s5 - s1) / 2, (s6 - s5) * (s6 - s2) / 2]
        else:
            z, y = (s2 + s3) / 2, (s4 + s5) / 2
            g = ((s3 - s2) ** 3 + (s5 - s4) ** 3) / 12
            m = [(s2 - s1) * (s3 - s1) / 2, (s6 - s5) * (s6 - s4) / 2]
        f, r = 1 - y, 1 - s6
        g += z * s1**2 / 2 - s1**3 / 3 + f * r**2 / 2 - r**3 / 3
        way, top = sign * (self.c[i, j] - self.c[first, j]), (y - z) * abs(self.V[p][j, int(sign > 0)])
        steep = sum(x * limit for x, limit in zip(m, (forth, back), strict=True) if x)
        turns = -sign * (z * s1 - s1**2 / 2), sign * (f * r - r**2 / 2)
        speeds = -sign * z, -sign * f
        if kind in "DK":
            for end, at in ((0, first), (1, i)):
                add(self.key("e", at, j), sign if end else -sign)
                add(("g", p, j, end), speeds[end])
                add(("X", p, j, end), turns[end])
            add(("T", p), -top)
            add(("q", p), -steep)
            add(("r", p), -J * g)
            return found, -way
        add(("u", p), way)
        for end, at in ((0, first), (1, i)):
            add(("p", p, j, end), sign if end else -sign)
            add(self.key("v", at, j), speeds[end])
            add(("W", p, j, end), turns[end])
        add(("T", p), -steep)
        add(("q", p), -J * g)
        return found, top

    def _of_duration(self, kind: str, p: Any, t: Any) -> Row:
        """Rows of one duration alone."""
        T, u, q, r = ("T", p), ("u", p), ("q", p), ("r", p)
        low, high = self.box[T]
        if kind == "s":
            return {u: 1.0, T: 1 / (low * high)}, 1 / low + 1 / high
        if kind == "S":
            return {q: 1.0, T: -low - high}, -low * high
        if kind == "t":
            return {T: -1 / t**2, u: -1.0}, -2 / t
        if kind == "T":
            return {T: 2 * t, q: -1.0}, t * t
        if kind == "c":
            return {q: 1.0, T: -high - 2 * t, u: -high * t * t}, -2 * high * t - t * t
        return {r: 1.0, q: -high - 2 * t, T: 2 * high * t + t * t}, high * t * t

    def random_row(self, rng: np.random.Generator) -> list[Any] | None:
        """A row of a random kind at a random place; None where the one drawn is not posed."""
        kind = str(rng.choice(list(KINDS)))
        p, j = list(self.after)[rng.integers(len(self.after))], int(rng.integers(self.dof))
        sign, end = int(rng.choice([-1, 1])), int(rng.integers(2))
        i = int(rng.choice(self.kept))
        at = self.after[p] if end else self.start[p]
        lo, hi = self.box["T", p]
        if lo == 0.0 and kind in "stcmrdk":
            return None
        if not self.moves[j] and kind in "gardkRK":
            return None
        if not self.jerky[j] and kind in "wxvVj":
            return None
        if kind == "e" and p in self.ks:
            return None
        c = float(rng.normal() * 10.0 ** rng.uniform(-1.0, 1.5))
        if kind == "v" and self.peak(at, j, sign * c > 0.0) is None:
            return None
        if kind == "V" and self.peak(i, j, c > 0.0) is None:
            return None
        if kind == "l" and not np.isfinite(self.demands["passages"][i][1]):
            return None
        towards = -sign if end else sign
        if kind in "rR" and not np.isfinite(self.bounds[p][j, int(towards > 0)]):
            return None
        if kind == "m" and self.w[at, j] == 0.0:
            return None
        s = np.sort(rng.random(6) ** rng.choice([0.2, 1.0, 5.0]))
        if not self.jerky[j]:
            late = s[3] if kind in "dD" else s[1]
            s = np.array([0.0, s[1], s[1], late, late, 1.0])
        if not self.moves[j]:
            s = np.array([0.0] * 3 + [1.0] * 3)
        places = [float(x) for x in s]
        t = float(lo + rng.random() ** 3 * (hi - lo))
        corner = int(rng.integers(4))
        shapes: dict[str, list[Any]] = {
            "h": [], "bl": [i], "sS": [p], "tcTC": [p, t], "wmgx": [j, p, end, corner],
            "j": [j, p, sign], "e": [p, sign], "v": [j, p, end, sign, c], "V": [j, i, sign, c],
            "a": [j, p, sign, *(places[:2] if self.jerky[j] else [0.0, 1.0])],
            "rR": [j, p, end, sign, *places[:2]], "dkDK": [j, p, sign, *places],
        }  # fmt: skip
        return [kind, *next(rest for kinds, rest in shapes.items() if kind in kinds)]

    def excess(self, raw: list[Any], values: dict[Key, float]) -> float:
        """By how much a motion violates a row, relative to the row's terms."""
        row, upper = self.row(raw)
        terms = [c * values[key] for key, c in row.items() if c]
        return (sum(terms) - upper) / (sum(map(abs, terms)) + abs(upper) + 1e-4)
