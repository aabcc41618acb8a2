"""The boxes of the relaxation under demands once more, in floats."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from demanded_motions import Scenario

Array = np.ndarray
Key = tuple[Any, ...]
PRODUCTS = {"W": ("a", "T"), "p": ("e", "u"), "g": ("v", "T"), "X": ("a", "q")}


class BoxOracle:
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
        unbounded = ~np.isfinite(self.steep) | ((L == 0.0) & ~np.isfinite(A) & ~self.fades.all(axis=0))
        self.jerky &= ~unbounded
        self.moves &= ~unbounded
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
