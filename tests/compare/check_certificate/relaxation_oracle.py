"""The relaxation under demands once more, in floats: boxes and rows."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from demanded_motions import Scenario

Array = np.ndarray
Key = tuple[Any, ...]
Row = tuple[dict[Key, float], float]
PRODUCTS = {"W": ("a", "T"), "p": ("e", "u"), "g": ("v", "T"), "X": ("a", "q")}
TIED = {"w": "W", "m": "p", "g": "g", "x": "X"}
KINDS = "hblstcwmvardkSTCgxVRDKje"


class Oracle:
    """Kept waypoints, limits, boxes and rows of demands, for motions of at most a horizon.

    ``without``: inner waypoints left out. ``moves``: joints whose velocities are variables; the others may
    jump. ``wrong_peaks``: poses peak rows that are wrong, "free": where an acceleration need not fade
    within the motion, "short": with the limits of a segment within which it need not fade.
    """

    def __init__(
        self,
        demands: dict[str, Any],
        horizon: float,
        *,
        without: frozenset[int] = frozenset(),
        wrong_peaks: str = "",
    ) -> None:
        self.demands, self.without, self.wrong_peaks = demands, without, wrong_peaks
        self.cyclic = demands["cyclic"]
        x = self.x = np.array(demands["waypoints"])
        if self.cyclic:
            x[[0, -1], :, 0], x[[0, -1], :, 1] = (
                x[[0, -1], :, 0].max(axis=0),
                x[[0, -1], :, 1].min(axis=0),
            )
        self.n, self.dof = len(x) - 1, x.shape[1]
        self.c, self.w = x.mean(axis=2), (x[..., 1] - x[..., 0]) / 2
        self.kept = [i for i in range(self.n + 1) if i not in without]
        self.ks = self.kept[:-1]
        self.after: dict[Any, int] = dict(pairwise(self.kept))
        self.after |= {span: span[1] for span in self._spans()}
        self.start = {p: p[0] if isinstance(p, tuple) else p for p in self.after}
        self.waits = {i: float(demands["waits"][i]) for i in self.kept}
        self.budget = horizon - sum(self.waits.values())
        self.jerky = np.isfinite(demands["jerk"][0])
        self.moves = self.jerky | np.isfinite(demands["acceleration"]).all(axis=(0, 2))
        self.stops = np.array(demands["stops"]) | (np.array(demands["waits"]) > 0.0)
        self._limits(horizon)
        self._boxes()

    def _spans(self) -> list[tuple[int, int]]:
        """Legs over several others, without a wait on them."""
        found = []
        for a, start in enumerate(self.kept):
            for b in range(a + 2, len(self.kept)):
                if any(self.demands["waits"][i] for i in self.kept[a + 1 : b]):
                    break
                found.append((start, self.kept[b]))
        return found

    def parts(self, p: Any) -> list[int]:
        """Segments of a leg."""
        return [k for k in self.ks if self.start[p] <= k < self.after[p]]

    def _limits(self, horizon: float) -> None:
        d = self.demands
        self.V, self.A, self.J, self.bounds, self.times = {}, {}, {}, {}, {}
        for p, i in self.after.items():
            part = slice(self.start[p], i)
            for name, found in (
                ("velocity", self.V),
                ("acceleration", self.A),
                ("position", self.bounds),
            ):
                found[p] = np.stack(
                    [d[name][part, :, 0].min(axis=0), d[name][part, :, 1].max(axis=0)], axis=1
                )
            self.J[p] = d["jerk"][part].max(axis=0)
            inner = sum(d["waits"][part][1:])
            most = np.inf if inner else sum(d["durations"][part, 1])
            self.times[p] = [sum(d["durations"][part, 0]) + inner, most]
        gaps = {p: self._at_top_speed(p) for p in self.ks}
        L = sum(max(gaps[p], self.times[p][0]) for p in self.ks) + sum(self.waits.values())
        V = np.abs(d["velocity"]).max(axis=(0, 2))
        A = np.abs(d["acceleration"]).max(axis=(0, 2))
        J = d["jerk"].max(axis=0)
        dv, da = np.array(d["end_velocity"]), np.array(d["end_acceleration"])
        fixed_a = ((da == 0.0).all(axis=2) | self.stops[[0, -1], None]) & self.jerky
        rest_v = (dv == 0.0).all(axis=2) | self.stops[[0, -1], None]
        self.fades = fixed_a if not self.cyclic else np.ones_like(fixed_a)
        least = np.minimum(max(L, 1e-12), 4.0 * np.sqrt(V / np.where(self.jerky, J, 1.0)))
        self.top, self.steep = V.copy(), A.copy()
        for j in range(self.dof):
            rest = (rest_v[:, j] & (fixed_a[:, j] | ~self.jerky[j])).all()
            if rest:
                self.top[j] = min(self.top[j], A[j] * horizon / 2.0)
            if self.jerky[j]:
                if rest:
                    self.top[j] = min(self.top[j], J[j] * horizon**2 / 16.0)
                    self.steep[j] = min(self.steep[j], J[j] * horizon / 4.0)
                if fixed_a[:, j].all() or self.cyclic:
                    self.steep[j] = min(self.steep[j], np.sqrt(2.0 * J[j] * V[j]))
                self.steep[j] = min(self.steep[j], 4.0 * V[j] / least[j] + J[j] * least[j] / 4.0)
        self.largest = np.minimum(np.abs(d["velocity"] * [-1.0, 1.0]).max(axis=0), self.top[:, None])
        for p in self.after:
            self.V[p] = np.clip(self.V[p], -self.top[:, None], self.top[:, None])
            self.A[p] = np.clip(self.A[p], -self.steep[:, None], self.steep[:, None])
        self.J_most = J

    def _at_top_speed(self, p: int) -> float:
        (there, here), V = (self.x[at] for at in (self.after[p], self.start[p])), self.V[p]
        up, down = there[:, 0] - here[:, 1], here[:, 0] - there[:, 1]
        return float(max((up / V[:, 1]).max(), (-down / V[:, 0]).max(), 0.0))

    def _boxes(self) -> None:
        self.box: dict[Key, tuple[float, float]] = {}
        least: dict[Any, float] = {p: max(self.times[p][0], self._at_top_speed(p)) for p in self.ks}
        total = sum(least.values())
        for p in self.ks:
            lo, hi = least[p], min(self.times[p][1], self.budget - total + least[p])
            self.box["T", p] = (lo, hi)
        ends = {0: 0, self.n: 1}
        beside: dict[int, list[int]] = {i: [] for i in self.kept}
        for p, i in self.after.items():
            if p in self.ks:
                beside[p].append(p)
                beside[i].append(p)
        if self.cyclic:
            beside[0] = beside[self.n] = [self.ks[0], self.ks[-1]]
        for i in self.kept:
            for j in range(self.dof):
                self.box[self.key("e", i, j)] = (-self.w[i, j], self.w[i, j])
                for letter, limits, name in (("v", self.V, "velocity"), ("a", self.A, "acceleration")):
                    if not (self.moves if letter == "v" else self.jerky)[j]:
                        continue
                    lo = max(limits[p][j, 0] for p in beside[i])
                    hi = min(limits[p][j, 1] for p in beside[i])
                    if i in ends and not self.cyclic:
                        given = self.demands[f"end_{name}"][ends[i]][j]
                        lo, hi = max(lo, given[0]), min(hi, given[1])
                    still = any(self.stops[[0, -1]]) if self.cyclic and i in ends else self.stops[i]
                    if still:
                        lo = hi = 0.0
                    self.box[self.key(letter, i, j)] = (lo, hi)
        for p in self.after:
            self.box.setdefault(
                ("T", p), (max(self.times[p][0], self._at_top_speed(p)), self.times[p][1])
            )
        self._products()

    def _products(self) -> None:
        for p in self.after:
            if p not in self.ks:
                inside, (lo, hi) = [self.box["T", k] for k in self.parts(p)], self.box["T", p]
                low, high = sum(lo for lo, _ in inside), sum(hi for _, hi in inside)
                rest = sum(self.box["T", k][0] for k in self.ks) - low
                self.box["T", p] = (max(lo, low), min(hi, high, self.budget - rest))
        for p, i in self.after.items():
            lo, hi = self.box["T", p]
            self.box["q", p], self.box["r", p] = (lo**2, hi**2), (lo**3, hi**3)
            if lo > 0.0:
                self.box["u", p] = (1 / hi, 1 / lo)
            for j in range(self.dof):
                for end, at in ((0, self.start[p]), (1, i)):
                    for letter, (of, by) in PRODUCTS.items():
                        if (by, p) in self.box and self.key(of, at, j) in self.box:
                            corners = np.outer(self.box[self.key(of, at, j)], self.box[by, p])
                            self.box[letter, p, j, end] = (corners.min(), corners.max())

    def narrow(self, box: dict[Key, tuple[float, float]]) -> None:
        """Take narrower boxes of T, v, a and e."""
        self.box |= box
        self._products()

    def key(self, letter: str, i: int, j: int) -> Key:
        """A variable at a waypoint; the last one of a cycle is the first."""
        return (letter, 0 if self.cyclic and i == self.n else i, j)

    def values(self, made: Scenario) -> dict[Key, float]:
        """The variables of a motion."""
        found: dict[Key, float] = {}
        for i in self.kept:
            for j in range(self.dof):
                x, v, a = made.states[i, j]
                for letter, value in (("v", v), ("a", a), ("e", x - self.c[i, j])):
                    found[self.key(letter, i, j)] = value
        for p, i in self.after.items():
            T = made.arrivals[i] - made.leavings[self.start[p]]
            found |= {("T", p): T, ("q", p): T**2, ("r", p): T**3}
            if T > 0.0:
                found["u", p] = 1.0 / T
            for j in range(self.dof):
                for end, at in ((0, self.start[p]), (1, i)):
                    for letter, (of, by) in PRODUCTS.items():
                        if (by, p) in found:
                            found[letter, p, j, end] = found[by, p] * found[self.key(of, at, j)]
        return {key: value for key, value in found.items() if key in self.box}

    def peak(self, i: int, j: int, later: bool) -> tuple[Array, float] | None:
        """Limits of velocity and jerk of a peak row at a waypoint; None where it is wrong.

        The acceleration fades on the segment beside it, or elsewhere within the motion.
        """
        if not self.jerky[j]:
            return None
        steepest = max(map(abs, self.box[self.key("a", i, j)])) * (1.0 + 1e-9)
        beside = [p for p in self.ks if (p if later else self.after[p]) == i]
        for p in beside:
            if self.box["T", p][0] >= steepest / self.J[p][j] or self.wrong_peaks == "short":
                return np.abs(self.V[p][j]), self.J[p][j]
        time = sum(self.box["T", p][0] for p in self.ks if (p >= i) == later)
        sound = self.fades[int(later), j] or time >= steepest / self.J_most[j]
        return (self.largest[j], self.J_most[j]) if sound or self.wrong_peaks == "free" else None

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
