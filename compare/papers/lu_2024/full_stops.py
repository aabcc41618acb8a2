"""The second reading of Lu 2024's rival: a quintic from rest to rest on each segment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations import Problem, Trajectory
from formulations.problem.arrays import Array

# x0 + d (10 u^3 - 15 u^4 + 6 u^5), u from 0 to 1: the one quintic at rest at both ends
_POWERS = np.array([0.0, 0.0, 0.0, 10.0, -15.0, 6.0])
_VELOCITY, _ACCELERATION = 15.0 / 8.0, 10.0 / np.sqrt(3.0)  # its peaks for d = 1 in 1 s


@dataclass(frozen=True)
class FullStops:
    """Quintics that stop at each waypoint, under velocity and acceleration limits; a candidate for a swarm.

    No segment depends on another one, and none leaves the positions of its two waypoints.
    """

    problem: Problem

    @property
    def least(self) -> Array:
        """Shortest durations, each by itself, shape (n_segments,) [s]."""
        d = np.abs(np.diff(self.problem.waypoints, axis=0))
        velocity, acceleration, _ = self.problem.limits.derivatives
        needed = np.maximum(_VELOCITY * d / velocity, np.sqrt(_ACCELERATION * d / acceleration))
        return np.asarray(needed.max(axis=1))

    def __call__(self, durations: Array) -> Array:
        """Total times of a population [s]; infinite where a segment breaks a limit."""
        kept = (durations >= self.least).all(axis=1)
        return np.where(kept, durations.sum(axis=1), np.inf)

    def trajectory(self, durations: Array) -> Trajectory:
        """Compute the motion of one candidate.

        Parameters
        ----------
        durations : Array, shape (n_segments,) [s]
            Of the segments.

        Returns
        -------
        Trajectory
        """
        t, x = np.asarray(durations), self.problem.waypoints
        c = np.diff(x, axis=0)[:, :, None] * _POWERS / t[:, None, None] ** np.arange(6)
        c[:, :, 0] = x[:-1]
        return Trajectory(t, c)
