"""What a point of durations and waypoint states violates, to first and second order, in every segment.

A motion with durations T, velocities v and accelerations a at the waypoints exists exactly if every joint
gets as far as each displacement, in both directions, and gains as much speed: (1) and (2) of ``reach`` at
their own switches, and |v| + a^2 / (2 J) <= V. With W = T a these rows are functions of T, v, a and the
displacement d. By the envelope theorem their slopes are those at fixed switches. All states are in units of
their limits here, positions and displacements in seconds at top speed, and a change of T in units of T.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.problem.arrays import Array, Indices, Truths
from formulations.proofs.every_motion.attaining_motion.chain_task import ChainTask
from formulations.proofs.every_motion.relaxation.reach import distance_coefficients, speed_coefficients
from formulations.proofs.every_motion.relaxation.switches import (
    farthest,
    farthest_without_jerk,
    fastest,
)

_STEP = 1e-6  # of the difference quotients


@dataclass(frozen=True)
class ChainPoint:
    """Durations and waypoint states.

    Attributes
    ----------
    T : Array, shape (K,) [s]
    v, a : Array, shape (K + 1, n)
        In units of the limits.
    e : Array, shape (K + 1, n) [s]
        Positions in the zones, from their middles, in seconds at top speed.
    """

    T: Array
    v: Array
    a: Array
    e: Array

    def slower(self, factor: float) -> ChainPoint:
        """The states of the same motion with its time stretched.

        Parameters
        ----------
        factor : float

        Returns
        -------
        ChainPoint
        """
        return ChainPoint(self.T * factor, self.v / factor, self.a / factor**2, self.e)

    def towards(self, other: ChainPoint, share: float) -> ChainPoint:
        """Go a share of the way to another point.

        Parameters
        ----------
        other : ChainPoint
        share : float

        Returns
        -------
        ChainPoint
        """
        if share == 1.0:
            return other
        mine, its = vars(self).values(), vars(other).values()
        return ChainPoint(*(a + share * (b - a) for a, b in zip(mine, its, strict=True)))


@dataclass(frozen=True)
class ReachRows:
    """The rows of a task: one for each segment, joint, direction and kind.

    Attributes
    ----------
    task : ChainTask
    segment, joint : Indices, shape (m,)
    sign : Array, shape (m,)
        Direction, 1 or -1.
    far : Truths, shape (m,)
        Whether the row is about the distance (1), or the speed (2).
    """

    task: ChainTask
    segment: Indices
    joint: Indices
    sign: Array
    far: Truths

    @staticmethod
    def of(task: ChainTask) -> ReachRows:
        """List all rows.

        Parameters
        ----------
        task : ChainTask

        Returns
        -------
        ReachRows
        """
        K, n = task.displacements.shape
        k, j, way, kind = (index.ravel() for index in np.indices((K, n, 2, 2)))
        return ReachRows(task, k, j, 1.0 - 2.0 * way, kind == 0)

    def __getitem__(self, which: Indices | Truths) -> ReachRows:
        k, j = self.segment[which], self.joint[which]
        return ReachRows(self.task, k, j, self.sign[which], self.far[which])

    def states(self, point: ChainPoint) -> tuple[Array, ...]:
        """Duration, states at both ends and displacement of each row's segment.

        Parameters
        ----------
        point : ChainPoint

        Returns
        -------
        tuple of Array, shape (m,)
            T, v0, a0, v1, a1, d.
        """
        k, j, task = self.segment, self.joint, self.task
        d = task.displacements / task.velocity + np.diff(point.e, axis=0)
        ends = point.v[k, j], point.a[k, j], point.v[k + 1, j], point.a[k + 1, j]
        return point.T[k], *ends, d[k, j]

    def units(self, states: tuple[Array, ...]) -> Array:
        """Compute what full acceleration or full jerk gains in each row's segment.

        On a dense path that is far below top speed, and the rows leave little room: what they miss means
        something in this unit only.

        Parameters
        ----------
        states : tuple of Array, shape (m,)

        Returns
        -------
        Array, shape (m,)
            In units of the top speed, at most 1.
        """
        _, ramp, bend, _ = self._scales(states[0])
        jerky = self.task.has_jerk[self.joint]
        return np.minimum(np.minimum(ramp, np.where(jerky, bend, np.inf)), 1.0)

    def _scales(self, T: Array) -> tuple[Array, Array, Array, Array]:
        """Speed gained at the unit of acceleration, at full acceleration and at full jerk; top speed.

        All in units of the joint's greatest velocity limit.
        """
        task, k, j = self.task, self.segment, self.joint
        unit = task.velocity[j]
        ramp, bend = T * task.accelerations[k, j] / unit, T**2 * task.jerks[k, j] / unit
        return T * task.acceleration[j] / unit, ramp, bend, task.velocities[k, j] / unit

    def coefficients(self, states: tuple[Array, ...]) -> Array:
        """Compute the rows' coefficients at the switches that are best for these states.

        Parameters
        ----------
        states : tuple of Array, shape (m,)
            T, v0, a0, v1, a1, d.

        Returns
        -------
        Array, shape (m, 7)
            Of v0, W0, v1, W1, V, A T and J T^2, as ``distance_coefficients`` has them.
        """
        T, v0, a0, v1, a1, _ = states
        unit, ramp, bend, V = self._scales(T)
        v0, v1, W0, W1 = self.sign * v0, self.sign * v1, self.sign * a0 * unit, self.sign * a1 * unit
        most = np.maximum(ramp, np.maximum(np.abs(W0), np.abs(W1)))
        found = np.empty((len(T), 7))
        jerky = self.task.has_jerk[self.joint]
        for limited in (True, False):
            row = np.flatnonzero(self.far & (jerky == limited))
            if len(row):
                top = V[row]
                if limited:
                    six, cruises = farthest(
                        v0[row], W0[row], v1[row], W1[row], top, most[row], bend[row]
                    )
                else:
                    six, cruises = farthest_without_jerk(v0[row], v1[row], top, ramp[row])
                both = (np.stack(distance_coefficients(six, which)) for which in (True, False))
                found[row] = np.where(cruises, *both).T
            row = np.flatnonzero(~self.far & (jerky == limited))
            one, zero = np.ones(len(row)), np.zeros(len(row))
            if limited:
                c_W0, c_W1, c_A, c_J = speed_coefficients(
                    fastest(W0[row], W1[row], most[row], bend[row])
                )
            else:
                c_W0, c_W1, c_A, c_J = zero, zero, one, zero
            found[row] = np.stack([one, c_W0, -one, c_W1, zero, c_A, c_J], axis=1)
        return found

    def linearised(self, c: Array, states: tuple[Array, ...]) -> tuple[Array, Array]:
        """Linearise the rows with given coefficients.

        Parameters
        ----------
        c : Array, shape (m, 7)
        states : tuple of Array, shape (m,)

        Returns
        -------
        slopes : Array, shape (m, 6)
            Change of what is missing with T, v0, a0, v1, a1, d.
        slack : Array, shape (m,)
            Negative where the row is violated.
        """
        T, v0, a0, v1, a1, d = states
        unit, ramp, bend, V = self._scales(T)
        sign = self.sign
        towards = self.far * sign / T
        wanted = towards * d
        pull = sign * unit * (c[:, 1] * a0 + c[:, 3] * a1)
        slack = sign * (c[:, 0] * v0 + c[:, 2] * v1) + pull
        slack += c[:, 4] * V + c[:, 5] * ramp + c[:, 6] * bend - wanted
        by_T = -wanted - pull - c[:, 5] * ramp - 2.0 * c[:, 6] * bend
        by_states = -sign * np.stack([c[:, 0], c[:, 1] * unit, c[:, 2], c[:, 3] * unit])
        return np.stack([by_T, *by_states, towards], axis=1), slack

    def curvature(self, states: tuple[Array, ...], weights: Array) -> Array:
        """Sum the rows' second derivatives per segment and joint, made positive semidefinite.

        Parameters
        ----------
        states : tuple of Array, shape (m,)
        weights : Array, shape (m,)
            Multipliers.

        Returns
        -------
        Array, shape (K, n, 6, 6)
            Or (K, n, 5, 5) where no position is free, so that d is fixed.
        """
        size = 6 if self.task.in_zones else 5
        bends = np.empty((len(weights), size, size))
        for i in range(size):
            step = _STEP * (states[0] if i in (0, 5) else np.ones(len(weights)))
            slopes = []
            for side in (1.0, -1.0):
                near = tuple(value + side * step * (i == q) for q, value in enumerate(states))
                slope = self.linearised(self.coefficients(near), near)[0]
                slope[:, 0] *= states[0] / near[0]  # in units of the same T
                slopes.append(slope)
            by = step if i == 5 else np.full(len(step), _STEP)
            bends[:, i] = ((slopes[0] - slopes[1]) / (2.0 * by[:, None]))[:, :size]
        K, n = self.task.displacements.shape
        total = np.zeros((K * n, size, size))
        np.add.at(total, self.segment * n + self.joint, weights[:, None, None] * bends)
        values, vectors = np.linalg.eigh(total + total.transpose(0, 2, 1))
        kept = np.clip(0.5 * values, 0.0, None)
        found = (vectors * kept[:, None, :]) @ vectors.transpose(0, 2, 1)
        return np.asarray(found).reshape(K, n, size, size)
