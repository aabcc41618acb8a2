"""The problem that the relaxation is posed for: the segments and joints that count, and their limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.problem.arrays import Array, Indices, Truths
from formulations.problem.problem import Problem

UP, DOWN = 1.0 + 2.0**-50, 1.0 - 2.0**-50  # cover the rounding of two operations
_WIDER = (
    1.001  # position slack that is proved, per slack allowed: covers rounding, and checkers ask for it
)


@dataclass(frozen=True)
class RelaxedProblem:
    """A problem without the segments and joints that have no row, and with limits for one horizon.

    A segment between equal waypoints is left out: the fastest motion passes it in no time, and a
    waypoint less can only make a motion faster. A joint that never moves is left out, since it can
    stand still. A joint with a velocity limit only is left out of the rows: all that it implies is
    T >= |d| / V, which ``least`` holds.

    Attributes
    ----------
    least : Array, shape (K,) [s]
        Lower bound on each duration set by the joints that have a velocity limit only.
    displacements : Array, shape (K, n) [rad]
        Of the joints in the rows, each rounded once.
    room : Array, shape (K + 1, n, 2) [rad]
        Distance from each waypoint to the lower and to the upper position limit, infinite without one.
    velocity, acceleration, jerk : Array, shape (n,)
        Limits that every motion of at most ``horizon`` seconds keeps; jerk is 0 where unlimited.
    horizon : float [s]
        The motions considered take at most this long.
    segments : Indices, shape (K,)
        The problem's number of each segment kept.
    joints : Indices, shape (n,)
        The problem's number of each joint kept.
    """

    least: Array
    displacements: Array
    room: Array
    velocity: Array
    acceleration: Array
    jerk: Array
    horizon: float
    segments: Indices
    joints: Indices

    @staticmethod
    def of(problem: Problem, horizon: float, slack: float | None = None) -> RelaxedProblem:
        """Relax a problem for all motions of at most ``horizon`` seconds.

        From rest to rest, and with an acceleration that starts and ends at 0 if jerk is limited,

            |v| <= min(V, A H / 2, J H^2 / 16),   |a| <= min(A, sqrt(2 J V), J H / 4).

        A speed v that is gained must be lost again: either takes at least v / A, and at least
        2 sqrt(v / J) where the acceleration starts and ends at 0. An acceleration a takes a / J to
        rise and a / J to fall. Meanwhile the velocity changes by a^2 / J, which is at most 2 V; a
        change of the opposite sign takes at least 2 a / J more.

        Parameters
        ----------
        problem : Problem
        horizon : float [s]
            The time H.
        slack : float, optional [rad]
            Distance outside the position limits that still counts as inside; by default a thousandth
            more than the problem's.

        Returns
        -------
        RelaxedProblem
        """
        slack = problem.position_slack * _WIDER if slack is None else slack
        limits = problem.limits
        moves = (problem.displacements != 0.0).any(axis=0)
        limited = np.isfinite(limits.acceleration) | np.isfinite(limits.jerk)
        joints = np.flatnonzero(moves & limited)
        segments = np.flatnonzero((problem.displacements != 0.0).any(axis=1))
        V, A, J = limits.velocity[joints], limits.acceleration[joints], limits.jerk[joints]
        top = np.minimum(V, UP * np.minimum(A * horizon / 2.0, J * horizon**2 / 16.0))
        steepest = np.minimum(A, UP * np.minimum(np.sqrt(2.0 * J * V), J * horizon / 4.0))
        others = np.flatnonzero(moves & ~limited)
        ways = np.abs(problem.displacements[np.ix_(segments, others)])
        passed = np.append(segments, segments[-1:] + 1)
        x = problem.waypoints[np.ix_(passed, joints)][..., None]
        bounds = problem.position_bounds[joints]
        return RelaxedProblem(
            least=DOWN * (ways / limits.velocity[others]).max(axis=1, initial=0.0),
            room=np.maximum((bounds - x) * (-1.0, 1.0), 0.0) + slack,
            displacements=problem.displacements[np.ix_(segments, joints)],
            velocity=top,
            acceleration=steepest,
            jerk=np.where(np.isfinite(J), J, 0.0),
            horizon=horizon,
            segments=segments,
            joints=joints,
        )

    @property
    def has_jerk(self) -> Truths:
        """Which joints have a jerk limit, (n,)."""
        return self.jerk > 0.0

    @property
    def at_top_speed(self) -> Array:
        """Displacement over top speed of the slowest joint of each segment, (K,) [s]."""
        return np.asarray((np.abs(self.displacements) / self.velocity).max(axis=1))
