"""The points of a file: where the jerk of its motion may switch, and which of them are waypoints."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from math import ceil

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.optima.at_rate.requests import require_point
from formulations.optima.at_rate.rounding import least_distance
from formulations.problem.arrays import Array, Indices
from formulations.problem.conditions import Conditions
from formulations.problem.problem import Problem

_EVEN_CELLS = 200  # cells are never longer than the motion over this
_MERGED_MARGIN = 1e-6  # margin that sets the least distance of points without a rate


@dataclass(frozen=True)
class SwitchPoints:
    """Points that the jerk may switch at.

    Attributes
    ----------
    stamps : Indices, shape (n_points,) [ns]
        Whole nanoseconds, increasing from 0.
    waypoints : Indices, shape (n_waypoints,)
        The point at which each waypoint is passed.
    """

    stamps: Indices
    waypoints: Indices

    @property
    def times(self) -> Array:
        """Times of the points, (n_points,) [s]."""
        return np.asarray(self.stamps / 1e9)  # correctly rounded, as a reader of the decimal gets it

    @staticmethod
    def at_rate(
        problem: Problem, trajectory: Trajectory, rate: float, extra: int, asked: Conditions
    ) -> SwitchPoints:
        """Lay even points; each segment takes a whole number of periods, rounded up.

        Parameters
        ----------
        problem : Problem
            Waypoints and limits.
        trajectory : Trajectory
            The motion whose passage times are the starting point.
        rate : float [1/s]
            Points per second.
        extra : int
            Further periods for each segment.
        asked : Conditions
            Passage times that were asked for.

        Returns
        -------
        SwitchPoints
            Points and waypoints.
        """
        exact = np.diff(trajectory.passage_times) * rate
        periods = np.ceil(exact - 1e-6).astype(np.intp)
        periods += np.where(problem.displacements.any(axis=1), extra, 0)
        waypoints = np.concatenate([[0], np.cumsum(periods)])
        for waypoint, time in sorted(asked.times(problem).items()):
            nearest = require_point(waypoint, time, rate)
            waypoints[: waypoint + 1] = np.minimum(waypoints[: waypoint + 1], nearest)
            waypoints[waypoint:] += nearest - waypoints[waypoint]
        stamps = np.rint(np.arange(waypoints[-1] + 1) * (1e9 / rate)).astype(np.intp)
        return SwitchPoints(stamps, waypoints)

    @staticmethod
    def at_switches(
        problem: Problem, trajectory: Trajectory, stretch: float, asked: Conditions
    ) -> SwitchPoints:
        """Lay points where the jerk switches, none too close to the next, and further ones between.

        Parameters
        ----------
        problem : Problem
            Waypoints and limits.
        trajectory : Trajectory
            The motion whose passage times are the starting point.
        stretch : float
            Share of time that the whole motion may take longer.
        asked : Conditions
            Passage times that were asked for.

        Returns
        -------
        SwitchPoints
            Points and waypoints.
        """
        fixed = asked.times(problem)
        factor = 1.0 if problem.n_segments in fixed else 1.0 + stretch
        passed = trajectory.passage_times * factor
        for waypoint, time in fixed.items():
            passed[waypoint] = time
        distance = least_distance(problem, trajectory.seconds, _MERGED_MARGIN)
        warped = np.interp(trajectory.breaks, trajectory.passage_times, passed)
        kept = [0.0]
        for start, end in itertools.pairwise(passed):
            inside = warped[(warped > start) & (warped < end)]
            even = np.linspace(start, end, max(2, ceil((end - start) / passed[-1] * _EVEN_CELLS)))
            for time in np.sort(np.concatenate([inside, even[1:-1]])):
                if time - kept[-1] >= distance and end - time >= distance:
                    kept.append(float(time))
            if end > kept[-1]:
                kept.append(float(end))
        stamps = np.unique(np.rint(np.array(kept) * 1e9).astype(np.intp))
        waypoints = np.searchsorted(stamps, np.rint(passed * 1e9).astype(np.intp))
        return SwitchPoints(stamps, waypoints)

    def cells(self, switches: Array, passed: Array) -> Indices:
        """Choose the cells of one joint: narrow near its switching times, wide elsewhere.

        Parameters
        ----------
        switches : Array, shape (n_switches,) [s]
            Times at which the jerk of the given motion switches.
        passed : Array, shape (n_waypoints,) [s]
            Passage times of the given motion.

        Returns
        -------
        Indices, shape (n_cells + 1,)
            The points at the ends of the cells.
        """
        images = np.interp(switches, passed, self.times[self.waypoints])
        below = np.searchsorted(self.times, images)[:, None] + np.arange(-2, 2)
        last = len(self.stamps) - 1
        chosen = np.unique(np.concatenate([below.clip(0, last).ravel(), self.waypoints]))
        longest = max(1, ceil(last / _EVEN_CELLS))
        parts = np.maximum(1, -(-np.diff(chosen) // longest))
        inner = [
            np.rint(np.linspace(start, end, count + 1)[:-1])
            for start, end, count in zip(chosen[:-1], chosen[1:], parts, strict=True)
        ]
        return np.unique(np.concatenate([*inner, [last]]).astype(np.intp))
