"""A motion as arcs: each joint crosses each segment on arcs of its own, of constant jerk.

(For a joint without a jerk limit: of constant acceleration.) Arcs hold the free-form optimum exactly,
since it is bang-bang wherever it is unique.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from formulations.problem.arrays import Array


@dataclass(frozen=True)
class Arcs:
    """One joint. durations: (S, M) [s]. tops: (S, M), the jerk or, of order 2, the acceleration.

    order: 3 or 2. states: (S + 1, 2), velocity and acceleration at the waypoints; of order 2 the latter
    is 0 and means nothing.
    """

    order: int
    durations: Array
    tops: Array
    states: Array

    @property
    def nodes(self) -> Array:
        """Velocity and acceleration at the ends of each segment's arcs, (2, S, M + 1)."""
        h, top = self.durations, self.tops
        if self.order == 2:
            v = _summed(self.states[:-1, 0], h * top)
            return np.stack([v, np.zeros_like(v)])
        a = _summed(self.states[:-1, 1], h * top)
        v = _summed(self.states[:-1, 0], h * (a[:, :-1] + 0.5 * h * top))
        return np.stack([v, a])

    @property
    def displacements(self) -> Array:
        """What the arcs of each segment add up to, (S,) [rad]."""
        v, a = self.nodes
        h, top = self.durations, self.tops
        if self.order == 2:
            return np.asarray((h * (v[:, :-1] + 0.5 * h * top)).sum(axis=1))
        return np.asarray((h * (v[:, :-1] + h * (a[:, :-1] / 2.0 + h * top / 6.0))).sum(axis=1))

    def stretched(self, factor: float) -> Arcs:
        """The same path, every time multiplied by ``factor``."""
        states = self.states / np.array([factor, factor**2])
        tops = self.tops / factor**self.order
        return replace(self, durations=self.durations * factor, tops=tops, states=states)

    def split(self) -> Arcs:
        """The same motion on twice as many arcs."""
        halves = np.repeat(self.durations / 2.0, 2, axis=1)
        return replace(self, durations=halves, tops=np.repeat(self.tops, 2, axis=1))

    def fitted(self, n: int, floor: float) -> Arcs:
        """On exactly n arcs: the shortest merged, the longest split, none below a share of its segment.

        Changes the motion by what it merges: a start for a solver, not an answer.
        """
        h, top = self.durations, self.tops
        while h.shape[1] > n:
            h, top = _shortest_merged(h, top)
        while h.shape[1] < n:
            h, top = _longest_split(h, top)
        total = h.sum(axis=1, keepdims=True)
        if floor > 0.0:
            h = np.maximum(h, floor * total / n)
        return replace(self, durations=h * total / h.sum(axis=1, keepdims=True), tops=top)

    def projected(self, displacements: Array) -> Arcs:
        """The nearest tops that meet displacements (S,) and states exactly.

        A solver leaves these equations true to its tolerance only.
        """
        h = self.durations
        seconds = h.sum(axis=1, keepdims=True)
        left = seconds - np.cumsum(h, axis=1)
        # effect of each top on position, velocity (and acceleration) at the end of its segment
        powers = np.arange(self.order, 0, -1)
        whole = (left + h)[:, None] ** powers[:, None] - left[:, None] ** powers[:, None]
        rows = (
            whole
            / np.array([1.0, 1.0, 2.0, 6.0])[powers][:, None]
            / seconds[:, None] ** powers[:, None]
        )
        inverse = np.linalg.pinv(rows, rcond=1e-14)
        exact = self
        for _ in range(2):
            v, a = exact.nodes
            ends = np.stack([exact.displacements, v[:, -1], a[:, -1]], axis=1)
            wanted = np.column_stack([displacements, exact.states[1:]])
            missing = (wanted - ends)[:, : self.order] / seconds**powers
            exact = replace(exact, tops=exact.tops + np.einsum("smr,sr->sm", inverse, missing))
        return exact


def _summed(start: Array, steps: Array) -> Array:
    sums = np.concatenate([np.zeros((len(steps), 1)), np.cumsum(steps, axis=1)], axis=1)
    return np.asarray(start[:, None] + sums)


def _shortest_merged(h: Array, top: Array) -> tuple[Array, Array]:
    rows, gone = np.arange(len(h)), h.argmin(axis=1)
    into = np.where(gone + 1 < h.shape[1], gone + 1, gone - 1)
    h = h.copy()
    h[rows, into] += h[rows, gone]
    keep = np.arange(h.shape[1]) != gone[:, None]
    return h[keep].reshape(len(h), -1), top[keep].reshape(len(h), -1)


def _longest_split(h: Array, top: Array) -> tuple[Array, Array]:
    longest = h.argmax(axis=1)[:, None]
    index = np.arange(h.shape[1] + 1)
    index = index - (index > longest)
    wide = np.take_along_axis(h, index, 1)
    for half in (longest, longest + 1):
        np.put_along_axis(wide, half, np.take_along_axis(h, longest, 1) / 2.0, 1)
    return wide, np.take_along_axis(top, index, 1)


@dataclass(frozen=True)
class Motion:
    """Segment times (S,) [s] and the arcs of each joint that has any, by joint."""

    times: Array
    joints: dict[int, Arcs]

    def stretched(self, factor: float) -> Motion:
        """The same path, every time multiplied by ``factor``."""
        return Motion(self.times * factor, {j: a.stretched(factor) for j, a in self.joints.items()})

    def split(self) -> Motion:
        """The same motion on twice as many arcs."""
        return Motion(self.times, {j: a.split() for j, a in self.joints.items()})
