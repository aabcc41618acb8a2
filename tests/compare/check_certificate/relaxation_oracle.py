"""The relaxation under demands once more, in floats: boxes and rows."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from demanded_motions import Scenario

Array = np.ndarray
Key = tuple[Any, ...]
Row = tuple[dict[Key, float], float]


class Oracle:
    """Kept waypoints, limits, boxes and rows of demands, for motions of at most a horizon.

    ``without``: inner waypoints left out besides. ``none``: nothing forces time between the ends, so there is
    no relaxation. ``wrong_peaks``: poses peak rows that are wrong, "free": where an acceleration need not fade
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
        self.kept = self._kept()
        self.ks = self.kept[:-1]
        self.after = dict(pairwise(self.kept))
        self.waits = {i: float(demands["waits"][i]) for i in self.kept}
        self.budget = horizon - sum(self.waits.values())
        self.jerky = np.isfinite(demands["jerk"][0])
        self.stops = np.array(demands["stops"]) | (np.array(demands["waits"]) > 0.0)
        self.none = self._together(0, self.n) if len(self.kept) == 2 else False
        if not self.none:
            self._limits(horizon)
            self._boxes()

    def _together(self, p: int, i: int) -> bool:
        """Whether a motion may be at p and at i at one time."""
        x, d = self.x, self.demands
        return bool(
            (x[p, :, 0] <= x[i, :, 1]).all()
            and (x[i, :, 0] <= x[p, :, 1]).all()
            and not np.any(d["durations"][p:i, 0])
            and not np.any(d["waits"][p + 1 : i])
        )

    def _kept(self) -> list[int]:
        kept = [0]
        for i in range(1, self.n):
            if i not in self.without and not self._together(kept[-1], i):
                kept.append(i)
        while len(kept) > 1 and self._together(kept[-1], self.n):
            kept.pop()
        return [*kept, self.n]

    def _limits(self, horizon: float) -> None:
        d = self.demands
        self.V, self.A, self.J, self.bounds, self.times = {}, {}, {}, {}, {}
        for p, i in self.after.items():
            part = slice(p, i)
            for name, found in (
                ("velocity", self.V),
                ("acceleration", self.A),
                ("position", self.bounds),
            ):
                found[p] = np.stack(
                    [d[name][part, :, 0].min(axis=0), d[name][part, :, 1].max(axis=0)], axis=1
                )
            self.J[p] = d["jerk"][part].max(axis=0)
            inner = sum(d["waits"][p + 1 : i])
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
        least = np.minimum(max(L, 1e-9), 4.0 * np.sqrt(V / np.where(self.jerky, J, 1.0)))
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
        for p in self.ks:
            self.V[p] = np.clip(self.V[p], -self.top[:, None], self.top[:, None])
            self.A[p] = np.clip(self.A[p], -self.steep[:, None], self.steep[:, None])
        self.J_most = J

    def _at_top_speed(self, p: int) -> float:
        i, x, V = self.after[p], self.x, self.V[p]
        up, down = x[i, :, 0] - x[p, :, 1], x[p, :, 0] - x[i, :, 1]
        return float(max((up / V[:, 1]).max(), (-down / V[:, 0]).max(), 0.0))

    def _boxes(self) -> None:
        self.box: dict[Key, tuple[float, float]] = {}
        least = {p: max(self.times[p][0], self._at_top_speed(p)) for p in self.ks}
        total = sum(least.values())
        for p in self.ks:
            lo, hi = least[p], min(self.times[p][1], self.budget - total + least[p])
            self.box["T", p], self.box["u", p], self.box["q", p] = (
                (lo, hi),
                (1 / hi, 1 / lo),
                (lo**2, hi**2),
            )
        ends = {0: 0, self.n: 1}
        beside: dict[int, list[int]] = {i: [] for i in self.kept}
        for p, i in self.after.items():
            beside[p].append(p)
            beside[i].append(p)
        if self.cyclic:
            beside[0] = beside[self.n] = [self.ks[0], self.ks[-1]]
        for i in self.kept:
            for j in range(self.dof):
                for letter, limits, name in (("v", self.V, "velocity"), ("a", self.A, "acceleration")):
                    lo = max(limits[p][j, 0] for p in beside[i])
                    hi = min(limits[p][j, 1] for p in beside[i])
                    if i in ends and not self.cyclic:
                        given = self.demands[f"end_{name}"][ends[i]][j]
                        lo, hi = max(lo, given[0]), min(hi, given[1])
                    still = any(self.stops[[0, -1]]) if self.cyclic and i in ends else self.stops[i]
                    if still or (letter == "a" and not self.jerky[j]):
                        lo = hi = 0.0
                    self.box[self.key(letter, i, j)] = (lo, hi)
                self.box[self.key("e", i, j)] = (-self.w[i, j], self.w[i, j])
        self._products()

    def _products(self) -> None:
        for p, i in self.after.items():
            for j in range(self.dof):
                for end, at in ((0, p), (1, i)):
                    for letter, of, by in (("W", "a", "T"), ("p", "e", "u")):
                        corners = np.outer(self.box[self.key(of, at, j)], self.box[by, p])
                        self.box[letter, p, j, end] = (corners.min(), corners.max())

    def narrow(self, box: dict[Key, tuple[float, float]]) -> None:
        """Take narrower boxes of T, a and e."""
        self.box |= box
        for p in self.ks:
            lo, hi = self.box["T", p]
            self.box["u", p], self.box["q", p] = (1 / hi, 1 / lo), (lo**2, hi**2)
        self._products()

    def key(self, letter: str, i: int, j: int) -> Key:
        """A variable at a waypoint; the last one of a cycle is the first."""
        return (letter, 0 if self.cyclic and i == self.n else i, j)

    def values(self, made: Scenario) -> dict[Key, float]:
        """The variables of a motion."""
        found: dict[Key, float] = {}
        for i in self.kept:
            for j in range(self.dof):
                found[self.key("v", i, j)] = made.states[i, j, 1]
                found[self.key("a", i, j)] = made.states[i, j, 2] if self.jerky[j] else 0.0
                found[self.key("e", i, j)] = made.states[i, j, 0] - self.c[i, j]
        for p, i in self.after.items():
            T = made.arrivals[i] - made.leavings[p]
            found |= {("T", p): T, ("u", p): 1.0 / T, ("q", p): T * T}
            for j in range(self.dof):
                for end, at in ((0, p), (1, i)):
                    found["W", p, j, end] = T * found[self.key("a", at, j)]
                    found["p", p, j, end] = found[self.key("e", at, j)] / T
        return found

    def peak(self, i: int, j: int, later: bool) -> tuple[Array, float] | None:
        """Limits of velocity and jerk of a peak row at a waypoint; None where it is wrong.

        The acceleration fades on the segment beside it, or elsewhere within the motion.
        """
        if not self.jerky[j]:
            return None
        steepest = max(map(abs, self.box[self.key("a", i, j)])) * (1.0 + 1e-9)
        beside = [p for p, end in self.after.items() if (p if later else end) == i]
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
        if kind in "stc":
            p = raw[1]
            low, high = self.box["T", p]
            if kind == "s":
                return {("u", p): 1.0, ("T", p): 1 / (low * high)}, 1 / low + 1 / high
            t = raw[2]
            if kind == "t":
                return {("T", p): -1 / t**2, ("u", p): -1.0}, -2 / t
            return {
                ("q", p): 1.0,
                ("T", p): -high - 2 * t,
                ("u", p): -high * t * t,
            }, -2 * high * t - t * t
        j, p = raw[1], raw[2]
        i = self.after[p]
        if kind in "wm":
            end, corner = raw[3:5]
            at = self.key("a" if kind == "w" else "e", i if end else p, j)
            by = ("T" if kind == "w" else "u", p)
            f, e = self.box[by][corner % 2], self.box[at][corner in (1, 2)]
            side = 1.0 if corner < 2 else -1.0
            product = ("W" if kind == "w" else "p", p, j, end)
            return {product: -side, at: side * f, by: side * e}, side * f * e
        J = self.J[p][j] if self.jerky[j] else 0.0
        if kind == "v":
            end, sign, c = raw[3:6]
            found_limits = self.peak(i if end else p, j, sign * c > 0.0)
            assert found_limits is not None
            V, J = found_limits
            v = self.key("v", i if end else p, j)
            row = {v: float(sign), ("W", p, j, end): c / J, ("q", p): -c * c / (2 * J)}
            return row, V[int(sign > 0)]
        if kind == "r":
            end, sign, s1, s2 = raw[3:7]
            at, towards = (i if end else p), (-sign if end else sign)
            bound = self.bounds[p][j, int(towards > 0)]
            away = abs(self.A[p][j, int(towards < 0)])
            add(self.key("v", at, j), sign * s2)
            add(("W", p, j, end), towards * (s1 * s2 - s1**2 / 2))
            add(("u", p), -towards * (bound - self.c[at, j]))
            add(("p", p, j, end), float(towards))
            add(("T", p), -away * (s2 - s1) ** 2 / 2)
            add(("q", p), -J * (s1**2 * s2 / 2 - s1**3 / 3))
            return found, 0.0
        sign = raw[3]
        forth, back = abs(self.A[p][j, int(sign > 0)]), abs(self.A[p][j, int(sign < 0)])
        if kind == "a":
            s1, s2 = raw[4:6]
            add(self.key("v", i, j), sign)
            add(self.key("v", p, j), -sign)
            add(("W", p, j, 0), -sign * s1)
            add(("W", p, j, 1), -sign * (1 - s2))
            add(("T", p), -(s2 - s1) * forth)
            add(("q", p), -J * (s1**2 + (1 - s2) ** 2) / 2)
            return found, 0.0
        s1, s2, s3, s4, s5, s6 = raw[4:10]
        if kind == "k":
            z = y = (s2 + s5) / 2
            g, m = (s5 - s2) ** 3 / 12, [(s2 - s1) * (s5 - s1) / 2, (s6 - s5) * (s6 - s2) / 2]
        else:
            z, y = (s2 + s3) / 2, (s4 + s5) / 2
            g = ((s3 - s2) ** 3 + (s5 - s4) ** 3) / 12
            m = [(s2 - s1) * (s3 - s1) / 2, (s6 - s5) * (s6 - s4) / 2]
        f, r = 1 - y, 1 - s6
        g += z * s1**2 / 2 - s1**3 / 3 + f * r**2 / 2 - r**3 / 3
        add(("u", p), sign * (self.c[i, j] - self.c[p, j]))
        add(("p", p, j, 1), sign)
        add(("p", p, j, 0), -sign)
        add(self.key("v", p, j), -sign * z)
        add(self.key("v", i, j), -sign * f)
        add(("W", p, j, 0), -sign * (z * s1 - s1**2 / 2))
        add(("W", p, j, 1), sign * (f * r - r**2 / 2))
        add(("T", p), -m[0] * forth - m[1] * back)
        add(("q", p), -J * g)
        return found, (y - z) * abs(self.V[p][j, int(sign > 0)])

    def random_row(self, rng: np.random.Generator) -> list[Any] | None:
        """A row of a random kind at a random place; None where the one drawn is not posed."""
        kind = str(rng.choice(list("hblstcwmvardk")))
        p, j = int(rng.choice(self.ks)), int(rng.integers(self.dof))
        sign, end = int(rng.choice([-1, 1])), int(rng.integers(2))
        i = int(rng.choice(self.kept))
        at = self.after[p] if end else p
        lo, hi = self.box["T", p]
        if not self.jerky[j] and (
            kind in "wv" or (kind in "ardk" and not np.isfinite(self.A[p][j]).all())
        ):
            return None
        c = float(rng.normal() * 10.0 ** rng.uniform(-1.0, 1.5))
        if kind == "v" and self.peak(at, j, sign * c > 0.0) is None:
            return None
        if kind == "l" and not np.isfinite(self.demands["passages"][i][1]):
            return None
        towards = -sign if end else sign
        if kind == "r" and not np.isfinite(self.bounds[p][j, int(towards > 0)]):
            return None
        if kind == "m" and self.w[at, j] == 0.0:
            return None
        s = np.sort(rng.random(6) ** rng.choice([0.2, 1.0, 5.0]))
        if not self.jerky[j]:
            late = s[3] if kind == "d" else s[1]
            s = np.array([0.0, s[1], s[1], late, late, 1.0])
        places = [float(x) for x in s]
        t = float(lo + rng.random() ** 3 * (hi - lo))
        return {
            "h": ["h"], "b": ["b", i], "l": ["l", i], "s": ["s", p], "t": ["t", p, t], "c": ["c", p, t],
            "w": ["w", j, p, end, int(rng.integers(4))], "m": ["m", j, p, end, int(rng.integers(4))],
            "v": ["v", j, p, end, sign, c],
            "a": ["a", j, p, sign, *(places[:2] if self.jerky[j] else [0.0, 1.0])],
            "r": ["r", j, p, end, sign, *places[:2]],
            "d": ["d", j, p, sign, *places], "k": ["k", j, p, sign, *places],
        }[kind]  # fmt: skip

    def excess(self, raw: list[Any], values: dict[Key, float]) -> float:
        """By how much a motion violates a row, relative to the row's terms."""
        row, upper = self.row(raw)
        terms = [c * values[key] for key, c in row.items()]
        return (sum(terms) - upper) / (sum(map(abs, terms)) + abs(upper) + 1e-4)
