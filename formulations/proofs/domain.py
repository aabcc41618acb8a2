"""What both provers start from: displacements, limits and speeds, rounded outward."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

# relative rounding of the few operations behind a number, taken off or put on
LESS, MORE = 1.0 - 4e-15, 1.0 + 4e-15


@dataclass(frozen=True)
class Data:
    """The moving joints alone. d, d_lo, d_hi: displacements and enclosures, (n_segments, dof) [rad].

    derivatives: limits (3, dof). room_above, room_below: from each segment's start to the position
    limits widened by ``problem.position_slack``, rounded up, (n_segments, dof) [rad].
    """

    d: Array
    d_lo: Array
    d_hi: Array
    derivatives: Array
    room_above: Array
    room_below: Array

    @property
    def least(self) -> Array:
        """Lower bounds of |d|, (n_segments, dof) [rad]."""
        apart = np.sign(self.d_lo) * np.sign(self.d_hi) > 0.0
        return np.where(apart, np.minimum(abs(self.d_lo), abs(self.d_hi)), 0.0)

    def speed(self, L: float) -> Array:
        """Upper bound on each joint's speed in L seconds from rest to rest, (dof,) [rad/s].

        Speed rises from 0 and falls to 0 again, so it stays below A L / 2; in these families the
        acceleration does likewise, so it stays below J L / 2.
        """
        velocity, acceleration, jerk = self.derivatives
        acceleration = np.minimum(acceleration, jerk * L * 0.5 * MORE)
        return np.asarray(np.minimum(velocity, acceleration * L * 0.5 * MORE))

    def shortest(self, L: float) -> Array:
        """Lower bounds of the durations from displacement and speed, (n_segments,) [s]."""
        return np.asarray((self.least / self.speed(L)).max(axis=1) * LESS)


def data_of(problem: Problem, blur: Array | None = None) -> Data:
    """The data of a problem in which something moves.

    blur: (n_segments, dof) [rad] by which each displacement may differ: the bound then holds for every
    such problem, if on each segment some joint is sure to move or none can.
    """
    moving = problem.moving_joints
    w = np.ascontiguousarray(problem.waypoints[:, moving])
    d = np.ascontiguousarray(np.diff(w, axis=0))
    around = np.zeros_like(d) if blur is None else blur[:, moving]
    # a difference of floats is zero only if it is exactly zero
    known = (d == 0.0) & (around == 0.0)
    d_lo = np.where(known, 0.0, np.nextafter(np.nextafter(d, -inf) - around, -inf))
    d_hi = np.where(known, 0.0, np.nextafter(np.nextafter(d, inf) + around, inf))
    around = around.max(axis=0)
    low, high = problem.position_bounds[moving].T
    slack = problem.position_slack * 1.001  # the thousandth covers rounding, here and in the judges
    return Data(
        d=d,
        d_lo=d_lo,
        d_hi=d_hi,
        derivatives=np.ascontiguousarray(problem.limits.derivatives[:, moving]),
        room_above=high - w[:-1] + slack + around,
        room_below=w[:-1] - low + slack + around,
    )
