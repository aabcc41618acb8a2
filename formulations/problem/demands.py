"""A problem and its conditions as arrays: what programs, relaxations and checks read."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.problem.arrays import Array, Truths
from formulations.problem.conditions import Conditions
from formulations.problem.problem import Problem


@dataclass(frozen=True)
class Demands:
    """All that a motion has to keep, per waypoint and per segment. Equal entries mean a fixed value.

    Attributes
    ----------
    problem : Problem
    conditions : Conditions
        Those in force.
    waypoints : Array, shape (n_segments + 1, dof, 2)
        Least and greatest position at each waypoint [rad].
    velocity, acceleration : Array, shape (n_segments, dof, 2)
        Least and greatest value on each segment [rad/s, rad/s^2].
    jerk : Array, shape (n_segments, dof)
        Greatest modulus on each segment [rad/s^3].
    position : Array, shape (n_segments, dof, 2)
        Least and greatest position on each segment, widened to the waypoints [rad].
    end_velocity, end_acceleration : Array, shape (2, dof, 2)
        Least and greatest value at the start and at the end.
    stops : Truths, shape (n_segments + 1,)
        Where the motion stands still; both ends are, where nothing else is asked for.
    waits : Array, shape (n_segments + 1,)
        How long it stands still at a waypoint after it has arrived there [s].
    durations : Array, shape (n_segments, 2)
        Least and greatest time between leaving a waypoint and arriving at the next [s].
    passages : Array, shape (n_segments + 1, 2)
        Earliest and latest time of arrival at each waypoint [s].
    cyclic : bool
        Whether positions, velocities and accelerations are the same at both ends.
    """

    problem: Problem
    conditions: Conditions
    waypoints: Array
    velocity: Array
    acceleration: Array
    jerk: Array
    position: Array
    end_velocity: Array
    end_acceleration: Array
    stops: Truths
    waits: Array
    durations: Array
    passages: Array
    cyclic: bool

    @property
    def plain(self) -> bool:
        """Whether only waypoints are asked for, from rest to rest, under limits equal in both directions."""
        return self.conditions.none and self.problem.limits.symmetric

    @staticmethod
    def of(problem: Problem, conditions: Conditions | None = None) -> Demands:
        """Collect what a problem asks for.

        Parameters
        ----------
        problem : Problem
        conditions : Conditions, optional
            In place of the problem's own.

        Returns
        -------
        Demands

        Raises
        ------
        InputError
            The conditions do not fit the problem.
        """
        asked = problem.conditions if conditions is None else conditions
        asked.validate(problem)
        n, dof = problem.n_segments, problem.dof
        zones = np.zeros((n + 1, dof))
        for k, zone in asked.tolerance.items():
            zones[k] = zone
        limits = asked.limits(problem)
        intervals = [one.intervals for one in limits]
        velocity, acceleration = (np.stack([pair[i] for pair in intervals]) for i in (0, 1))
        waypoints = _inside(problem.waypoints, zones, asked.position_bounds(problem))
        if asked.cyclic:  # both ends are one waypoint
            waypoints[[0, -1], :, 0] = waypoints[[0, -1], :, 0].max(axis=0)
            waypoints[[0, -1], :, 1] = waypoints[[0, -1], :, 1].min(axis=0)
        ends = [asked.end_velocities(problem), asked.end_accelerations(problem)]
        end_velocity, end_acceleration = (
            np.where(np.isnan(given)[..., None], whole[[0, -1]], given[..., None])
            for given, whole in zip(ends, (velocity, acceleration), strict=True)
        )
        waits = np.zeros(n + 1)
        waits[list(asked.waits)] = list(asked.waits.values())
        stops = waits > 0.0
        stops[list(asked.stops)] = True
        if not asked.cyclic:
            stops[[0, -1]] |= [not (end_velocity[i].any() or end_acceleration[i].any()) for i in (0, 1)]
        return Demands(
            problem,
            asked,
            waypoints,
            velocity,
            acceleration,
            np.stack([one.jerk for one in limits]),
            asked.position_bounds(problem),
            end_velocity,
            end_acceleration,
            stops,
            waits,
            _intervals(n, asked.segment_times),
            _passages(problem, asked),
            asked.cyclic,
        )


def _inside(points: Array, zones: Array, bounds: Array) -> Array:
    """Boxes around the waypoints, (n + 1, dof, 2): as far as the position limits of both segments allow."""
    n = len(bounds)
    low = np.maximum(bounds[np.r_[0, :n], :, 0], bounds[np.r_[:n, n - 1], :, 0])
    high = np.minimum(bounds[np.r_[0, :n], :, 1], bounds[np.r_[:n, n - 1], :, 1])
    # a waypoint itself is always allowed, as position limits are widened to it
    return np.stack(
        [
            np.minimum(np.maximum(points - zones, low), points),
            np.maximum(np.minimum(points + zones, high), points),
        ],
        axis=-1,
    )


def _intervals(n: int, given: object) -> Array:
    found = np.tile((0.0, np.inf), (n, 1))
    for k, interval in given.items():  # type: ignore[attr-defined]
        found[k] = interval
    return found


def _passages(problem: Problem, asked: Conditions) -> Array:
    found = _intervals(problem.n_segments + 1, asked.windows)
    found[0] = 0.0
    for waypoint, time in asked.times(problem).items():
        found[waypoint] = time
    return found
