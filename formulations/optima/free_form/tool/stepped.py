"""A motion on steps that all joints share: sampled from a trajectory, and assembled to one."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.optima.free_form.nlp.arcs import Arcs
from formulations.problem.arrays import Array, Truths


@dataclass(frozen=True)
class Stepped:
    """Positions, velocities and accelerations at the nodes between steps.

    Attributes
    ----------
    third : Truths, shape (dof,)
        Joints with a jerk limit: their jerk is constant on a step; the acceleration of the others is.
    h : Array, shape (S N,) [s]
        Steps, N per segment.
    q, v, a : Array, shape (S N + 1, dof)
        [rad or m, s].
    """

    third: Truths
    h: Array
    q: Array
    v: Array
    a: Array

    def stretched(self, factor: float) -> Stepped:
        """The same path, every time multiplied by a factor.

        Parameters
        ----------
        factor : float

        Returns
        -------
        Stepped
        """
        return replace(self, h=self.h * factor, v=self.v / factor, a=self.a / factor**2)

    def split(self) -> Stepped:
        """The same motion on twice as many steps."""
        h = self.h[:, None]
        (q, v, a), (v1, a1) = (x[:-1] for x in (self.q, self.v, self.a)), (self.v[1:], self.a[1:])
        third = self.third
        rate = np.where(third, a1 - a, 0.0)
        a = np.where(third, a, (v1 - v) / h)
        half = (
            q + h / 2 * (v + h / 4 * (a + rate / 6)),
            v + h / 2 * (a + rate / 4),
            np.where(third, a + rate / 2, 0.0),
        )
        nodes = []
        for old, new in zip((self.q, self.v, self.a), half, strict=True):
            both = np.empty((2 * len(new) + 1, old.shape[1]))
            both[::2], both[1::2] = old, new
            nodes.append(both)
        return Stepped(third, np.repeat(self.h / 2.0, 2), *nodes)

    @staticmethod
    def sampled(trajectory: Trajectory, third: Truths, steps: int, waits: Array) -> Stepped:
        """Sample a motion at even steps of each segment, from leaving a waypoint to arriving at the next.

        Parameters
        ----------
        trajectory : Trajectory
            With a passage time for each waypoint.
        third : Truths, shape (dof,)
        steps : int
            Per segment.
        waits : Array, shape (n_waypoints,)
            How long the motion stands still at the waypoints [s].

        Returns
        -------
        Stepped
        """
        arrive = trajectory.passage_times
        leave = np.minimum(arrive + waits, np.append(arrive[1:], np.inf))
        spans = np.maximum(arrive[1:] - leave[:-1], 1e-6 * trajectory.seconds)
        shares = np.arange(steps) / steps
        times = np.append((leave[:-1, None] + spans[:, None] * shares).ravel(), arrive[-1])
        times = np.minimum(times, trajectory.seconds)
        q, v, a = (trajectory.at(times, order) for order in range(3))
        return Stepped(third, np.repeat(spans / steps, steps), q, v, np.where(third, a, 0.0))

    def assembled(self, waits: Array, fixed: Array) -> Trajectory:
        """Assemble the motion; positions at the waypoints and states there are met to rounding.

        Parameters
        ----------
        waits : Array, shape (S + 1,)
            How long it stands still at the waypoints [s].
        fixed : Array, shape (S + 1, dof, 2)
            Least and greatest position at each waypoint.

        Returns
        -------
        Trajectory
        """
        S = len(waits) - 1
        N, dof = len(self.h) // S, self.q.shape[1]
        grid = 2.0 ** (np.ceil(np.log2(self.h.sum() + waits.sum())) - 52)
        h = np.maximum(np.round(self.h / grid), 1.0) * grid
        wait = np.round(waits / grid) * grid
        points = np.clip(self.q[::N], fixed[..., 0], fixed[..., 1])
        coefficients = np.zeros((S, N, dof, 4))
        for j in range(dof):
            steps = h.reshape(S, N)
            order = 3 if self.third[j] else 2
            part = self.a[:, j] if order == 3 else self.v[:, j]
            tops = np.diff(part).reshape(S, N) / steps
            states = np.column_stack([self.v[::N, j], self.a[::N, j]])
            exact = Arcs(order, steps, tops, states).projected(np.diff(points[:, j]))
            v, a = exact.nodes[:, :, :-1]
            jerk = exact.tops if order == 3 else np.zeros_like(steps)
            a = a if order == 3 else exact.tops
            moved = steps * (v + steps * (a / 2.0 + steps * jerk / 6.0))
            x = points[:-1, [j]] + np.cumsum(moved, axis=1) - moved
            coefficients[:, :, j] = np.stack([x, v, a / 2.0, jerk / 6.0], axis=-1)
        durations, rows, passages = [], [], [0.0]
        ends = np.cumsum(h).reshape(S, N)[:, -1]
        for k in range(S):
            durations += [*h[k * N : (k + 1) * N]]
            rows += [*coefficients[k]]
            passages.append(float(ends[k] + wait[: k + 1].sum()))
            if wait[k + 1] > 0.0 and k + 1 < S:
                still = np.zeros((dof, 4))
                still[:, 0] = points[k + 1]
                durations.append(wait[k + 1])
                rows.append(still)
        return Trajectory(np.array(durations), np.stack(rows), np.array(passages))
