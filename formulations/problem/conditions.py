"""Conditions beyond waypoints and limits: zones, times, stops, waits, states at the ends, other limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.condition_checks import require_fitting
from formulations.problem.condition_values import EndState, end_state, same_value
from formulations.problem.limits import Limits
from formulations.problem.torque import TorqueLimits

if TYPE_CHECKING:
    from formulations.problem.problem import Problem

Interval: TypeAlias = tuple[float, float]

TOOL_ZONE_TOLERANCE = 0.1  # rad, or m: of a joint at a zone of the tool where no tolerance is given


@dataclass(frozen=True, eq=False)
class Conditions:
    """Conditions on a motion; all are optional. Waypoints and segments count from 0.

    Parameters
    ----------
    tolerance : mapping of int to Array, shape (dof,)
        Zones: how far from a waypoint each joint may pass it [rad; m for a prismatic joint].
    passage : mapping of int to float
        Time from the start at which a waypoint is passed [s].
    windows : mapping of int to (float, float)
        Earliest and latest time from the start at which a waypoint is passed [s]; the latest may be infinite.
    segment_times : mapping of int to (float, float)
        Least and greatest time between a waypoint and the next one [s]; the greatest may be infinite. A wait
        at the waypoint counts as time before the segment.
    total : float, optional
        Time of the whole motion [s]. The motion asked for is then the smoothest, not the fastest.
    stops : frozenset of int
        Waypoints at which the motion stands still: zero velocity, and zero acceleration for joints with a
        jerk limit, as at both ends.
    waits : mapping of int to float
        How long the motion stands still at an inner waypoint [s]. It is passed when the arm arrives there.
    start_velocity, end_velocity : Array, shape (dof,), or "free", optional
        Velocities in place of rest [rad/s].
    start_acceleration, end_acceleration : Array, shape (dof,), or "free", optional
        Accelerations in place of 0 [rad/s^2]. Joints without a jerk limit have none to be given.
    cyclic : bool
        The motion is one turn of a cycle: it ends where it starts, with the velocity and the acceleration of
        its start, which are free.
    segment_limits : mapping of int to Limits
        Limits that replace the problem's on a segment.
    tool_speed : float, optional
        Greatest speed of the tool point along the whole motion [m/s].
    segment_tool_speed : mapping of int to float
        The greatest speed of the tool point on a segment, in place of that of the whole motion [m/s].
    tool_zones : mapping of int to float
        Radius of the ball around the tool point of a waypoint in which the tool passes it [m]. The joints
        pass it within ``tolerance`` too; where none is given there, within ``TOOL_ZONE_TOLERANCE``.
    torque : TorqueLimits, optional
        Limits on the torques of the motors, with the arm whose dynamics tell them.

    Examples
    --------
    >>> import formulations as f
    >>> slow_middle = f.Limits.of(velocity=0.5, acceleration=2.0, dof=6)
    >>> asked = f.Conditions(passage={1: 2.5}, stops=frozenset({2}), segment_limits={1: slow_middle})
    >>> asked.times(f.load("sr4c"))
    {1: 2.5}
    """

    tolerance: Mapping[int, Array] = field(default_factory=dict)
    passage: Mapping[int, float] = field(default_factory=dict)
    windows: Mapping[int, Interval] = field(default_factory=dict)
    segment_times: Mapping[int, Interval] = field(default_factory=dict)
    total: float | None = None
    stops: frozenset[int] = frozenset()
    waits: Mapping[int, float] = field(default_factory=dict)
    start_velocity: EndState = None
    end_velocity: EndState = None
    start_acceleration: EndState = None
    end_acceleration: EndState = None
    cyclic: bool = False
    segment_limits: Mapping[int, Limits] = field(default_factory=dict)
    tool_speed: float | None = None
    segment_tool_speed: Mapping[int, float] = field(default_factory=dict)
    tool_zones: Mapping[int, float] = field(default_factory=dict)
    torque: TorqueLimits | None = None

    @property
    def asked(self) -> tuple[str, ...]:
        """Names of the conditions that are given."""
        found = []
        for one in fields(self):
            value = getattr(self, one.name)
            given = value is not None if one.name.startswith(("start_", "end_")) else bool(value)
            if given or (one.name in ("total", "tool_speed") and value is not None):
                found.append(one.name)
        return tuple(found)

    @property
    def none(self) -> bool:
        """Whether nothing is asked for."""
        return not self.asked

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Conditions):
            return NotImplemented
        return all(
            same_value(getattr(self, one.name), getattr(other, one.name)) for one in fields(self)
        )

    __hash__ = None  # type: ignore[assignment]  # holds arrays

    @property
    def on_tool(self) -> bool:
        """Whether the tool point is limited in speed or place."""
        return self.tool_speed is not None or bool(self.segment_tool_speed or self.tool_zones)

    @property
    def ties_joints(self) -> bool:
        """Whether limits tie the joints together at each time: those on the tool, and torque limits."""
        return self.on_tool or self.torque is not None

    def boxes(self, dof: int) -> dict[int, Array]:
        """How far each joint may pass a waypoint, those with a zone of the tool included.

        Parameters
        ----------
        dof : int
            Number of joints.

        Returns
        -------
        dict of int to Array, shape (dof,)
            [rad, or m].
        """
        around = {k: np.full(dof, TOOL_ZONE_TOLERANCE) for k in self.tool_zones}
        return {**around, **{k: np.asarray(zone) for k, zone in self.tolerance.items()}}

    def without_tool(self, dof: int) -> Conditions:
        """All but the limits on the tool, whose zones remain as boxes of the joints: a relaxation.

        Parameters
        ----------
        dof : int
            Number of joints.

        Returns
        -------
        Conditions
        """
        return replace(
            self, tolerance=self.boxes(dof), tool_speed=None, segment_tool_speed={}, tool_zones={}
        )

    def tool_speeds(self, n_segments: int) -> Array:
        """Return the greatest speed of the tool point on each segment.

        Parameters
        ----------
        n_segments : int

        Returns
        -------
        Array, shape (n_segments,)
            [m/s]; infinite where none is given.
        """
        found = np.full(n_segments, np.inf if self.tool_speed is None else self.tool_speed)
        for k, speed in self.segment_tool_speed.items():
            found[k] = speed
        return found

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

    def without_torque(self) -> Conditions:
        """Drop the torque limits: what every motion that keeps them keeps too.

        Returns
        -------
        Conditions
        """
        return replace(self, torque=None)

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
        require_fitting(self, problem)

    def of_joint(self, joint: int) -> Conditions:
        """Return the conditions on one joint alone, without those on the tool and on torques.

        They tie the joints together.

        Parameters
        ----------
        joint : int
            Counts from 0.

        Returns
        -------
        Conditions
        """
        whole = self.without_tool(joint + 1)
        one = slice(joint, joint + 1)

        def mine(value: EndState) -> EndState:
            return value[one] if isinstance(value, np.ndarray) else value

        return replace(
            whole,
            tolerance={k: zone[one] for k, zone in whole.tolerance.items()},
            start_velocity=mine(self.start_velocity),
            end_velocity=mine(self.end_velocity),
            start_acceleration=mine(self.start_acceleration),
            end_acceleration=mine(self.end_acceleration),
            segment_limits={k: limits.of_joint(joint) for k, limits in self.segment_limits.items()},
            torque=None,
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
            Greatest moduli [rad/s, rad/s^2, rad/s^3].
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
            [rad/s]; NaN where they are free.
        """
        ends = [end_state(value, problem.dof) for value in (self.start_velocity, self.end_velocity)]
        return np.full((2, problem.dof), np.nan) if self.cyclic else np.stack(ends)

    def end_accelerations(self, problem: Problem) -> Array:
        """Return the accelerations at the start and at the end.

        Parameters
        ----------
        problem : Problem
            Its number of joints counts.

        Returns
        -------
        Array, shape (2, dof)
            [rad/s^2]; NaN where they are free.
        """
        ends = [
            end_state(value, problem.dof) for value in (self.start_acceleration, self.end_acceleration)
        ]
        return np.full((2, problem.dof), np.nan) if self.cyclic else np.stack(ends)

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
