"""The problem that the solvers see: segments that take time, joints that move, demands in force."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from formulations.optima.free_form.nlp.passed_at_once import passed_at_once
from formulations.problem.arrays import Array, Indices, Truths
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.problem import Problem

POSITION_MARGIN = 1e-9  # rad per (1 + |waypoints|) that solutions stay inside the position limits
_MARGIN = 1e-7  # limits are lowered by this share where a motion cannot be slowed down


@dataclass(frozen=True)
class ConditionedProblem:
    """A problem under conditions, without the segments and joints that cannot matter.

    Consecutive waypoints that can be passed at one time count as one waypoint. Joints that need not
    move are left out.

    Attributes
    ----------
    problem : Problem
    conditions : Conditions
    vanishing : frozenset of int
        Segments of the problem that take no time although they could: their zones overlap, and a motion
        found so far passes both waypoints at once.
    """

    problem: Problem
    conditions: Conditions
    vanishing: frozenset[int] = frozenset()

    @cached_property
    def demands(self) -> Demands:
        """All that is asked for, per waypoint and segment of the problem."""
        return Demands.of(self.problem, self.conditions)

    @cached_property
    def segments(self) -> Indices:
        """Indices of the segments of the problem that are kept, (S,)."""
        return np.flatnonzero(~passed_at_once(self.demands, self.vanishing))

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

    @property
    def margin(self) -> float:
        """How far solutions stay inside the position limits [rad]."""
        return POSITION_MARGIN * (1.0 + float(np.abs(self.problem.waypoints).max()))

    @cached_property
    def boxes(self) -> Array:
        """Least and greatest position at the waypoints kept, (S + 1, dof, 2) [rad].

        Zones are drawn in by the margin where they reach a position limit.
        """
        whole, at, n = self.demands.waypoints, self.waypoint_of, self.n_segments
        low = np.full((n + 1, self.problem.dof), -np.inf)
        high = -low
        np.maximum.at(low, at, whole[..., 0])
        np.minimum.at(high, at, whole[..., 1])
        if not n:
            return np.stack([low, high], axis=-1)
        limits, sides = self.position_bounds, (np.r_[0, :n], np.r_[:n, n - 1])
        lowest = np.maximum(*(limits[side, :, 0] for side in sides)) + self.margin
        highest = np.minimum(*(limits[side, :, 1] for side in sides)) - self.margin
        wide = high - low > 4.0 * self.margin
        return np.stack(
            [
                np.where(wide, np.maximum(low, lowest), low),
                np.where(wide, np.minimum(high, highest), high),
            ],
            axis=-1,
        )

    @cached_property
    def zones(self) -> Truths:
        """Where the position of a moving joint at a waypoint kept is free within a box, (S + 1, dof)."""
        found = self.boxes[..., 1] > self.boxes[..., 0]
        found[:, [j for j in range(self.problem.dof) if j not in self.moving]] = False
        return np.asarray(found)

    @cached_property
    def waypoints(self) -> Array:
        """Waypoints kept, (S + 1, dof) [rad]; within their zones."""
        _, first = np.unique(self.waypoint_of, return_index=True)
        return np.clip(self.problem.waypoints[first], self.boxes[..., 0], self.boxes[..., 1])

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
        """Joints that have to move."""
        moves = np.ptp(self.problem.waypoints, axis=0) > 0.0
        moves |= np.nan_to_num(self._given).any(axis=(0, 1))
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
    def _given(self) -> Array:
        """Velocities and accelerations given at both ends, (2 orders, 2 ends, dof); NaN where they are free."""
        ends = np.stack([self.demands.end_velocity, self.demands.end_acceleration])
        found = np.where(ends[..., 0] == ends[..., 1], ends[..., 0], np.nan)
        for end, waypoint in ((0, 0), (1, self.n_segments)):
            if self.demands.stops[self.waypoint_of == waypoint].any():
                found[:, end] = 0.0
        return found

    @property
    def ends(self) -> Array:
        """Velocities given at the start and the end, (2, dof) [rad/s]; NaN where they are free."""
        return np.asarray(self._given[0])

    @property
    def end_accelerations(self) -> Array:
        """Accelerations given at the start and the end, (2, dof) [rad/s^2]; NaN where they are free."""
        return np.asarray(self._given[1])

    @cached_property
    def intervals(self) -> tuple[Array, Array]:
        """Least and greatest velocity and acceleration, (S, dof, 2) each [rad/s, rad/s^2].

        There is an acceleration limit wherever jerk is limited. While the acceleration rises from zero to
        A at the jerk limit and falls again, the velocity changes by A^2 / J. It cannot change by more than
        the width W of its interval, hence A <= sqrt(W J); at an end with an acceleration it falls only,
        hence A <= sqrt(2 W J).
        """
        velocity, acceleration = (
            values[self.segments] for values in (self.demands.velocity, self.demands.acceleration)
        )
        jerk = self.demands.jerk[self.segments].max(axis=0, initial=0.0)
        width = velocity[..., 1].max(axis=0, initial=0.0) - velocity[..., 0].min(axis=0, initial=0.0)
        steep = (self.end_accelerations != 0.0).any(axis=0)  # also where they are free
        implied = np.sqrt(width * jerk * np.where(steep, 2.0, 1.0))[:, None] * np.array([-1.0, 1.0])
        open_ended = np.isinf(acceleration) & np.isfinite(jerk)[:, None]
        found = np.stack([velocity, np.where(open_ended, implied, acceleration)])
        if not self.stretchable:
            # slowing down cannot correct an excess within the solver's tolerance
            found *= 1.0 - _MARGIN
            for k in (0, -1):
                found[:, k, :, 0] = np.fmin(found[:, k, :, 0], self._given[:, k])
                found[:, k, :, 1] = np.fmax(found[:, k, :, 1], self._given[:, k])
        return found[0], found[1]

    @cached_property
    def limits(self) -> Array:
        """Greatest moduli of velocity, acceleration and jerk, (3, S, dof)."""
        jerk = self.demands.jerk[self.segments]
        if not self.stretchable:
            jerk = jerk * (1.0 - _MARGIN)
        return np.stack([*(np.abs(both).max(axis=2) for both in self.intervals), jerk])

    @cached_property
    def position_bounds(self) -> Array:
        """Position limits in force, (S, dof, 2) [rad]."""
        return np.asarray(self.demands.position[self.segments])

    @cached_property
    def stops(self) -> list[int]:
        """Inner waypoints kept at which the motion stands still."""
        inner = {int(w) for w in self.waypoint_of[self.demands.stops]}
        return sorted(inner - {0, self.n_segments})

    @cached_property
    def waits(self) -> Array:
        """How long the motion stands still at the waypoints kept, (S + 1,) [s]."""
        found = np.zeros(self.n_segments + 1)
        np.add.at(found, self.waypoint_of, self.demands.waits)
        return found

    @cached_property
    def waited(self) -> Array:
        """How long it has stood still before it arrives at the waypoints kept, (S + 1,) [s]."""
        return np.concatenate([[0.0], np.cumsum(self.waits)[:-1]])

    @cached_property
    def durations(self) -> Array:
        """Least and greatest time of the segments kept, (S, 2) [s]."""
        return np.asarray(self.demands.durations[self.segments])

    @cached_property
    def windows(self) -> dict[int, tuple[float, float]]:
        """Least and greatest sum of the segment times before a waypoint kept, where one is asked for [s]."""
        found = {}
        for waypoint in range(1, self.n_segments + 1):
            mine = self.demands.passages[self.waypoint_of == waypoint]
            low, high = float(mine[:, 0].max()), float(mine[:, 1].min())
            if low > 0.0 or np.isfinite(high):
                found[waypoint] = low - self.waited[waypoint], high - self.waited[waypoint]
        return found

    @property
    def timed(self) -> bool:
        """Whether the time of the whole motion is fixed."""
        low, high = self.demands.passages[-1]
        return bool(low == high)

    @property
    def hurried(self) -> bool:
        """Whether something has to be done within a time."""
        return bool(
            np.isfinite(self.demands.passages[1:, 1]).any()
            or np.isfinite(self.demands.durations[:, 1]).any()
        )

    @property
    def paced(self) -> bool:
        """Whether any times are asked for."""
        return bool(self.windows) or self.hurried or bool(self.demands.durations[:, 0].any())

    @property
    def stretchable(self) -> bool:
        """Whether a slowed-down motion still keeps the conditions."""
        return not self.hurried and not np.nan_to_num(self._given).any()

    @property
    def is_open(self) -> bool:
        """Whether stop and go in closed form leaves something to choose."""
        arcs = bool(self.group(2) or self.group(3))
        return arcs or self.hurried or bool(self.zones.any())

    def unhurried(self) -> ConditionedProblem:
        """The same task, in which nothing has to be done at or within a time."""
        asked = self.conditions
        least = {k: (low, np.inf) for k, (low, _) in asked.segment_times.items()}
        free = replace(asked, total=None, passage={}, windows={}, segment_times=least)
        return replace(self, conditions=free)
