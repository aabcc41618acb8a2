"""What all provers start from: displacements, limits, speeds and the domain of the durations.

Every number is rounded outward, so that the domain holds every feasible motion of total time L.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

# factors that take off, or put on, the relative rounding of the few operations behind a number
LESS, MORE = 1.0 - 4e-15, 1.0 + 4e-15


@dataclass(frozen=True)
class ProblemData:
    """Displacements and limits of the moving joints alone.

    Attributes
    ----------
    d, d_lo, d_hi : Array, shape (n_segments, dof) [rad]
        Displacements and their enclosures.
    derivatives : Array, shape (3, dof)
        Limits on velocity, acceleration and jerk.
    room_above, room_below : Array, shape (n_segments, dof) [rad]
        From the start of each segment to the position limits, which are widened by
        ``problem.position_slack``; rounded up.
    """

    d: Array
    d_lo: Array
    d_hi: Array
    derivatives: Array
    room_above: Array
    room_below: Array

    @property
    def least(self) -> Array:
        """Lower bounds of |d|, shape (n_segments, dof) [rad]."""
        apart = np.sign(self.d_lo) * np.sign(self.d_hi) > 0.0
        return np.where(apart, np.minimum(abs(self.d_lo), abs(self.d_hi)), 0.0)

    def speed(self, L: float) -> Array:
        """Bound each joint's speed in a motion of L seconds from rest to rest.

        The speed rises from 0 and falls to 0 again, so it stays below A L / 2. In these families the
        acceleration does likewise, so it stays below J L / 2.

        Parameters
        ----------
        L : float [s]
            The total time.

        Returns
        -------
        Array, shape (dof,) [rad/s]
            Upper bounds.
        """
        velocity, acceleration, jerk = self.derivatives
        acceleration = np.minimum(acceleration, jerk * L * 0.5 * MORE)
        return np.asarray(np.minimum(velocity, acceleration * L * 0.5 * MORE))

    def shortest(self, L: float) -> Array:
        """Bound the durations from below by displacement over speed.

        Parameters
        ----------
        L : float [s]
            The total time.

        Returns
        -------
        Array, shape (n_segments,) [s]
            Lower bounds; 0 where nothing moves for sure.
        """
        return np.asarray((self.least / self.speed(L)).max(axis=1) * LESS)


@dataclass(frozen=True)
class DurationDomain:
    """Where the durations of a feasible motion of total time L lie.

    Attributes
    ----------
    shortest, longest : Array, shape (n_segments,) [s]
        Lower and upper bounds.
    empty : bool
        Whether the lower bounds add up to more than L, which proves L at once.
    """

    shortest: Array
    longest: Array
    empty: bool


def data_of(problem: Problem, blur: Array | None = None) -> ProblemData:
    """Enclose displacements and limits of a problem in which something moves.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    blur : Array, shape (n_segments, dof) [rad], optional
        By how much each displacement may differ. A bound then holds for every such problem, if on each
        segment some joint is sure to move or none can.

    Returns
    -------
    ProblemData
        Of the moving joints.
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
    slack = problem.position_slack * 1.001  # the thousandth covers rounding, here and in the checks
    return ProblemData(
        d=d,
        d_lo=d_lo,
        d_hi=d_hi,
        derivatives=np.ascontiguousarray(problem.limits.derivatives[:, moving]),
        room_above=high - w[:-1] + slack + around,
        room_below=w[:-1] - low + slack + around,
    )


def duration_domain(shortest: Array, L: float) -> DurationDomain:
    """Bound the durations from above: each is at most L minus the least durations of the others.

    Parameters
    ----------
    shortest : Array, shape (n_segments,) [s]
        Lower bounds.
    L : float [s]
        The total time.

    Returns
    -------
    DurationDomain
        Both bounds.
    """
    longest = (L - (shortest.sum() - shortest)) * (1.0 + 1e-13) + 1e-14 * L
    return DurationDomain(shortest, longest, bool(shortest.sum() > L * (1.0 + 1e-13)))
