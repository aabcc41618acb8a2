"""Conditions beyond the problem: passage times, stops, velocities at the ends, limits of single segments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.problem import Limits, Problem


@dataclass(frozen=True)
class Conditions:
    """Conditions on a motion; all are optional. Waypoints and segments count from 0.

    Parameters
    ----------
    passage : mapping of int to float
        Time from the start at which a waypoint is passed [s].
    total : float, optional
        Time of the whole motion [s]. The motion asked for is then the smoothest, not the fastest.
    stops : frozenset of int
        Waypoints at which the motion stands still: zero velocity, and zero acceleration for joints with a
        jerk limit, as at both ends.
    start_velocity, end_velocity : Array, shape (dof,), optional
        Velocities in place of rest [rad/s; m/s for a prismatic joint].
    segment_limits : mapping of int to Limits
        Limits that replace the problem's on a segment.

    Examples
    --------
    >>> import formulations as f
    >>> slow_middle = f.Limits.of(velocity=0.5, acceleration=2.0, dof=6)
    >>> asked = f.Conditions(passage={1: 2.5}, stops=frozenset({2}), segment_limits={1: slow_middle})
    >>> asked.times(f.load("sr4c"))
    {1: 2.5}
    """

    passage: Mapping[int, float] = field(default_factory=dict)
    total: float | None = None
    stops: frozenset[int] = frozenset()
    start_velocity: Array | None = None
    end_velocity: Array | None = None
    segment_limits: Mapping[int, Limits] = field(default_factory=dict)

    @property
    def none(self) -> bool:
        """Whether nothing is asked for."""
        given = (self.total, self.start_velocity, self.end_velocity)
        return not (self.passage or self.stops or self.segment_limits) and all(v is None for v in given)

    def without_total(self, problem: Problem) -> Conditions:
        """Drop what fixes the total time, so that the fastest motion under the others can be asked for.

        Parameters
        ----------
        problem : Problem
            Its number of segments gives the last waypoint.

        Returns
        -------
        Conditions
        """
        passage = {k: time for k, time in self.passage.items() if k != problem.n_segments}
        return replace(self, total=None, passage=passage)

    def validate(self, problem: Problem) -> None:
        """Refuse conditions that do not fit a problem.

        Parameters
        ----------
        problem : Problem
            The problem that they are to be added to.

        Raises
        ------
        InputError
            In one line with key and value.
        """
        last = problem.n_segments
        for key, waypoints in (("passage", self.passage), ("stops", self.stops)):
            for waypoint in waypoints:
                _require_index(f"conditions.{key}: waypoint", waypoint, last)
        for segment, limits in self.segment_limits.items():
            _require_index("conditions.segment_limits: segment", segment, last - 1)
            self._validate_limits(problem, segment, limits)
        self._validate_times(problem)
        for key, velocity, segment, waypoint in (
            ("start_velocity", self.start_velocity, 0, 0),
            ("end_velocity", self.end_velocity, last - 1, last),
        ):
            if velocity is None:
                continue
            found = np.asarray(velocity, dtype=np.float64)
            if found.shape != (problem.dof,):
                raise InputError(f"conditions.{key}: expected {problem.dof} values, got {found.shape}")
            for joint, (value, limit) in enumerate(
                zip(found, self.limits(problem)[segment].velocity, strict=True)
            ):
                if not abs(value) <= limit:  # also true for NaN
                    raise InputError(
                        f"conditions.{key}: {problem.joint_name(joint)}: "
                        f"{problem.amount(value, joint, 1)} is over the limit "
                        f"{problem.amount(limit, joint, 1)}"
                    )
            if waypoint in self.stops and found.any():
                raise InputError(f"conditions.{key}: {found} at waypoint {waypoint}, which is a stop")

    def _validate_times(self, problem: Problem) -> None:
        if self.total is not None and not (np.isfinite(self.total) and self.total > 0.0):
            raise InputError(f"conditions.total: {self.total:g} s is not a positive time")
        before, earlier = 0, 0.0
        for waypoint, time in sorted(self.passage.items()):
            if not (np.isfinite(time) and time >= 0.0):
                raise InputError(f"conditions.passage: waypoint {waypoint}: {time:g} s is no time")
            if waypoint == 0 and time != 0.0:
                raise InputError(f"conditions.passage: waypoint 0: {time:g} s, not the start, 0 s")
            moves = np.ptp(problem.waypoints[before : waypoint + 1], axis=0).any()
            if time < earlier or (moves and time <= earlier):
                raise InputError(
                    f"conditions.passage: waypoint {waypoint}: {time:g} s is not after waypoint "
                    f"{before} at {earlier:g} s"
                )
            before, earlier = waypoint, time
        end = self.passage.get(problem.n_segments)
        if self.total is not None and end is not None and end != self.total:
            raise InputError(
                f"conditions.total: {self.total:g} s, but conditions.passage puts the last waypoint "
                f"at {end:g} s"
            )
        if self.total is not None and earlier > self.total:
            raise InputError(
                f"conditions.passage: waypoint {before}: {earlier:g} s is after conditions.total, "
                f"{self.total:g} s"
            )

    def _validate_limits(self, problem: Problem, segment: int, limits: Limits) -> None:
        where = f"conditions.segment_limits: segment {segment}"
        try:
            Problem(
                problem.waypoints[segment : segment + 2],
                limits,
                names=problem.names,
                units=problem.units,
            )
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
        for key in ("acceleration", "jerk"):
            mine, whole = getattr(limits, key), getattr(problem.limits, key)
            differs = np.isfinite(mine) != np.isfinite(whole)
            if differs.any():
                joint = int(differs.argmax())
                raise InputError(
                    f"{where}: {key} of {problem.joint_name(joint)} is {mine[joint]:g}, the problem's is "
                    f"{whole[joint]:g}: both must be finite or neither"
                )

    def limits(self, problem: Problem) -> list[Limits]:
        """Return the limits in force on each segment.

        Parameters
        ----------
        problem : Problem
            Its limits hold where no others are given.

        Returns
        -------
        list of Limits
            One per segment.
        """
        return [self.segment_limits.get(k, problem.limits) for k in range(problem.n_segments)]

    def derivatives(self, problem: Problem) -> Array:
        """Return the velocity, acceleration and jerk limits in force.

        Parameters
        ----------
        problem : Problem
            Its limits hold where no others are given.

        Returns
        -------
        Array, shape (3, n_segments, dof)
            [rad/s, rad/s^2, rad/s^3].
        """
        return np.stack([limits.derivatives for limits in self.limits(problem)], axis=1)

    def position_bounds(self, problem: Problem) -> Array:
        """Return the position limits in force.

        Limits of a segment are widened to its two waypoints, as the problem's are to all waypoints.

        Parameters
        ----------
        problem : Problem
            Its limits hold where no others are given.

        Returns
        -------
        Array, shape (n_segments, dof, 2)
            Least and greatest position [rad].
        """
        bounds = np.tile(problem.position_bounds, (problem.n_segments, 1, 1))
        for k, limits in self.segment_limits.items():
            ends = problem.waypoints[k : k + 2]
            bounds[k, :, 0] = np.minimum(limits.position[:, 0], ends.min(axis=0))
            bounds[k, :, 1] = np.maximum(limits.position[:, 1], ends.max(axis=0))
        return bounds

    def end_velocities(self, problem: Problem) -> Array:
        """Return the velocities at the start and at the end.

        Parameters
        ----------
        problem : Problem
            Its joints are at rest where no velocity is given.

        Returns
        -------
        Array, shape (2, dof)
            [rad/s].
        """
        still = np.zeros(problem.dof)
        ends = (self.start_velocity, self.end_velocity)
        return np.stack([still if v is None else np.asarray(v, dtype=np.float64) for v in ends])

    def times(self, problem: Problem) -> dict[int, float]:
        """Return the waypoints whose time is fixed, the last one if the total time is.

        Parameters
        ----------
        problem : Problem
            Its number of segments gives the last waypoint.

        Returns
        -------
        dict of int to float
            Times from the start [s]; waypoint 0 is left out.
        """
        fixed = {waypoint: float(time) for waypoint, time in self.passage.items() if waypoint > 0}
        return fixed if self.total is None else {**fixed, problem.n_segments: float(self.total)}


def _require_index(what: str, index: int, last: int) -> None:
    if isinstance(index, bool) or not isinstance(index, int | np.integer) or not 0 <= index <= last:
        raise InputError(f"{what} {index!r} is not there: 0 to {last}")
