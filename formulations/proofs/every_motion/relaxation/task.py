"""What the relaxation is posed for: the segments and joints that matter, and limits on every motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

UP, DOWN = 1.0 + 2.0**-50, 1.0 - 2.0**-50  # cover the rounding of two operations


@dataclass(frozen=True)
class Task:
    """A problem without segments in which nothing moves and without joints that rows say nothing of.

    A segment of equal waypoints is passed in no time by the fastest motion, and dropping a waypoint
    asks less of it. A joint that never moves can stand still; one whose velocity alone is limited gives
    T >= |d| / V and no more.

    least: (K,) [s], no duration is below it: what the joints left out ask for. displacements: (K, n)
    [rad], each rounded once. room: (K + 1, n, 2) [rad], from each waypoint down
    and up to the position limits, infinite without one. velocity, acceleration, jerk: (n,), limits
    that every motion of at most ``horizon`` seconds keeps, jerk 0 where unlimited. segments (K,),
    joints (n,): their numbers in the problem.
    """

    least: Array
    displacements: Array
    room: Array
    velocity: Array
    acceleration: Array
    jerk: Array
    horizon: float
    segments: NDArray[np.intp]
    joints: NDArray[np.intp]

    @staticmethod
    def of(problem: Problem, horizon: float, slack: float | None = None) -> Task:
        """The task of finding all motions of at most ``horizon`` seconds.

        From rest to rest, and with an acceleration that starts and ends at 0 if jerk is limited,

            |v| <= min(V, A H / 2, J H^2 / 16),   |a| <= min(A, sqrt(2 J V), J H / 4).

        What is gained must be lost: the greatest speed v in v / A at least, and from a = 0 to a = 0 in
        2 sqrt(v / J). While an acceleration a comes and goes, in 2 a / J at least, the velocity changes
        by a^2 / J, which is 2 V at most and takes 2 a / J to be undone.

        slack: how far outside the position limits still counts as inside [rad]; the problem's if None.
        """
        slack = problem.position_slack if slack is None else slack
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
        return Task(
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
    def has_jerk(self) -> NDArray[np.bool_]:
        """Which joints have a limited jerk, (n,)."""
        return self.jerk > 0.0
