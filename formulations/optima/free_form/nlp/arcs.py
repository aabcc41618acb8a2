"""A motion as arcs: each joint crosses each segment on its own arcs of constant jerk.

For a joint without a jerk limit the arcs have constant acceleration. Arcs can represent the free-form
optimum exactly, since it is bang-bang wherever it is unique.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from formulations.problem.arrays import Array


@dataclass(frozen=True)
class Arcs:
    """The motion of one joint, M arcs on each of S segments.

    Attributes
    ----------
    order : int
        3, or 2 for a joint without a jerk limit.
    durations : Array, shape (S, M) [s]
    tops : Array, shape (S, M)
        The jerk of each arc [rad/s^3], or of order 2 the acceleration [rad/s^2].
    states : Array, shape (S + 1, 2)
        Velocity and acceleration at the waypoints; of order 2 the acceleration is 0 and not used.
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
        """Displacement over the arcs of each segment, (S,) [rad]."""
        v, a = self.nodes
        h, top = self.durations, self.tops
        if self.order == 2:
            return np.asarray((h * (v[:, :-1] + 0.5 * h * top)).sum(axis=1))
        return np.asarray((h * (v[:, :-1] + h * (a[:, :-1] / 2.0 + h * top / 6.0))).sum(axis=1))

    def stretched(self, factor: float) -> Arcs:
        """Stretch time: the same path, every time multiplied by ``factor``.

        Parameters
        ----------
        factor : float

        Returns
        -------
        Arcs
        """
        states = self.states / np.array([factor, factor**2])
        tops = self.tops / factor**self.order
        return replace(self, durations=self.durations * factor, tops=tops, states=states)

    def split(self) -> Arcs:
        """The same motion on twice as many arcs."""
        halves = np.repeat(self.durations / 2.0, 2, axis=1)
        return replace(self, durations=halves, tops=np.repeat(self.tops, 2, axis=1))

    def fitted(self, n: int, floor: float) -> Arcs:
        """Change the number of arcs per segment: merge the shortest, split the longest.

        Merging changes the motion, so that the result is a start for a solver and not an answer.

        Parameters
        ----------
        n : int
            Number of arcs per segment.
        floor : float
            Least duration of an arc, as a share of the mean arc of its segment.

        Returns
        -------
        Arcs
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
        """Correct the tops so that displacements and states are met exactly, with the least change.

        A solver fulfils these equations to its tolerance only.

        Parameters
        ----------
        displacements : Array, shape (S,) [rad]

        Returns
        -------
        Arcs
        """
        h = self.durations
        seconds = h.sum(axis=1, keepdims=True)
        left = seconds - np.cumsum(h, axis=1)
        # effect of each top on position, velocity (and acceleration) at the end of its segment
        powers = np.arange(self.order, 0, -1)
        before, after = ((left + h) / seconds)[:, None], (left / seconds)[:, None]
        whole = before ** powers[:, None] - after ** powers[:, None]
        rows = whole / np.array([1.0, 1.0, 2.0, 6.0])[powers][:, None]
        if not np.isfinite(rows).all():
            return self  # the numbers overflow, and the check refuses the motion
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
class ArcMotion:
    """The motion of all joints that have arcs.

    Attributes
    ----------
    times : Array, shape (S,) [s]
        Segment times.
    joints : dict of int to Arcs
    places : Array, shape (S + 1, dof) [rad]
        Positions of all joints at the waypoints.
    """

    times: Array
    joints: dict[int, Arcs]
    places: Array

    @property
    def displacements(self) -> Array:
        """Displacement of each segment, (S, dof) [rad]."""
        return np.diff(self.places, axis=0)

    def stretched(self, factor: float) -> ArcMotion:
        """Stretch time: the same path, every time multiplied by ``factor``.

        Parameters
        ----------
        factor : float

        Returns
        -------
        ArcMotion
        """
        return ArcMotion(
            self.times * factor, {j: a.stretched(factor) for j, a in self.joints.items()}, self.places
        )

    def split(self) -> ArcMotion:
        """The same motion on twice as many arcs."""
        return replace(self, joints={j: a.split() for j, a in self.joints.items()})

    def with_waits(self, waits: Array) -> ArcMotion:
        """The same motion that stands still at waypoints, for which each wait becomes a segment.

        Parameters
        ----------
        waits : Array, shape (S + 1,) [s]
            How long at each waypoint, where the motion is at rest; 0 at both ends.

        Returns
        -------
        ArcMotion
        """
        at = np.flatnonzero(waits)
        joints = {}
        for j, arcs in self.joints.items():
            still = np.repeat(
                waits[at, None] / arcs.durations.shape[1], arcs.durations.shape[1], axis=1
            )
            joints[j] = replace(
                arcs,
                durations=np.insert(arcs.durations, at, still, axis=0),
                tops=np.insert(arcs.tops, at, 0.0, axis=0),
                states=np.insert(arcs.states, at, arcs.states[at], axis=0),
            )
        return ArcMotion(
            np.insert(self.times, at, waits[at]),
            joints,
            np.insert(self.places, at, self.places[at], axis=0),
        )
