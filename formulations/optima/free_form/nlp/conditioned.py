"""The problem that the solvers see: segments that take time, joints that move, limits in force."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from formulations.problem.arrays import Array, Indices
from formulations.problem.conditions import Conditions
from formulations.problem.problem import Problem

_MARGIN = 1e-7  # limits are lowered by this share where a motion cannot be slowed down


@dataclass(frozen=True)
class ConditionedProblem:
    """A problem under conditions, without the segments and joints that cannot matter.

    Equal consecutive waypoints count as one waypoint, unless the conditions set time between them.
    Joints that never move are left out.

    Attributes
    ----------
    problem : Problem
    conditions : Conditions
    """

    problem: Problem
    conditions: Conditions

    @cached_property
    def segments(self) -> Indices:
        """Indices of the segments of the problem that are kept, (S,)."""
        problem, asked = self.problem, self.conditions
        moves = np.abs(problem.displacements).max(axis=1) > 0.0
        keep = moves.copy()
        times = {0: 0.0, **asked.times(problem)}
        rest = not asked.end_velocities(problem).any()
        k = 0
        while k < len(moves):
            if moves[k]:
                k += 1
                continue
            end = k
            while end < len(moves) and not moves[end]:
                end += 1
            group = range(k, end + 1)  # waypoints k..end are equal
            fixed = sorted({times[w] for w in group if w in times})
            bends = not rest and any(w in asked.stops for w in group)
            if len(fixed) > 1 or bends or (not rest and not moves.any()):
                keep[k:end] = [not (w in times and times[w] == times.get(w + 1)) for w in range(k, end)]
            k = end
        return np.flatnonzero(keep)

    @cached_property
    def waypoint_of(self) -> Indices:
        """Number of each waypoint of the problem among those kept, (n_waypoints,)."""
        kept = np.zeros(self.problem.n_segments, dtype=np.intp)
        kept[self.segments] = 1
        return np.asarray(np.concatenate([[0], np.cumsum(kept)]))

    @property
    def n_segments(self) -> int:
        """Number of segments kept, S."""
        return len(self.segments)

    @cached_property
    def waypoints(self) -> Array:
        """Waypoints kept, (S + 1, dof) [rad]."""
        _, first = np.unique(self.waypoint_of, return_index=True)
        return self.problem.waypoints[first]

    @property
    def displacements(self) -> Array:
        """Displacement of each segment kept, (S, dof) [rad]."""
        return np.diff(self.waypoints, axis=0)

    @cached_property
    def order(self) -> Indices:
        """Per joint the highest limited derivative: 1 velocity, 2 acceleration, 3 jerk, (dof,)."""
        limits = self.problem.limits
        return np.where(np.isfinite(limits.jerk), 3, np.where(np.isfinite(limits.acceleration), 2, 1))

    @cached_property
    def moving(self) -> list[int]:
        """Joints that move at all."""
        moves = np.ptp(self.problem.waypoints, axis=0) > 0.0
        moves |= self.ends.any(axis=0)
        return [int(j) for j in np.flatnonzero(moves)]

    def group(self, order: int) -> list[int]:
        """List the moving joints whose highest limited derivative is ``order``.

        Parameters
        ----------
        order : int
            1 velocity, 2 acceleration, 3 jerk.

        Returns
        -------
        list of int
        """
        return [j for j in self.moving if self.order[j] == order]

    @cached_property
    def limits(self) -> Array:
        """Limits in force, (3, S, dof), with an acceleration limit wherever jerk is limited.

        While the acceleration rises from zero to A at the jerk limit and falls again, the velocity
        changes by A^2 / J. It cannot change by more than 2 V, hence A <= sqrt(2 V J).
        """
        found = self.conditions.derivatives(self.problem)[:, self.segments]
        velocity, acceleration, jerk = found
        implied = np.sqrt(2.0 * velocity.max(axis=0, initial=0.0) * jerk.max(axis=0, initial=0.0))
        open_ended = np.isinf(acceleration) & np.isfinite(jerk)
        found[1] = np.where(open_ended, implied, acceleration)
        if not self.stretchable:
            # slowing down cannot correct an excess within the solver's tolerance
            found *= 1.0 - _MARGIN
            for k, given in ((0, 0), (-1, 1)):
                found[0, k] = np.maximum(found[0, k], np.abs(self.ends[given]))
        return found

    @cached_property
    def position_bounds(self) -> Array:
        """Position limits in force, (S, dof, 2) [rad]."""
        return self.conditions.position_bounds(self.problem)[self.segments]

    @cached_property
    def ends(self) -> Array:
        """Velocities at the start and the end, (2, dof) [rad/s]."""
        return self.conditions.end_velocities(self.problem)

    @cached_property
    def stops(self) -> list[int]:
        """Inner waypoints kept at which the motion stands still."""
        inner = {int(self.waypoint_of[w]) for w in self.conditions.stops}
        return sorted(inner - {0, self.n_segments})

    @cached_property
    def times(self) -> dict[int, float]:
        """Waypoints kept with a fixed time [s], that of the whole motion included."""
        found = {int(self.waypoint_of[w]): t for w, t in self.conditions.times(self.problem).items()}
        found.pop(0, None)
        return found

    @property
    def timed(self) -> bool:
        """Whether the time of the whole motion is fixed."""
        return self.n_segments in self.times

    @property
    def stretchable(self) -> bool:
        """Whether a slowed-down motion still keeps the conditions."""
        return not self.times and not self.ends.any()
