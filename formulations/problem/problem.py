"""The problem: waypoints that a motion of the joints must pass, and the limits that it must keep."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError

POSITION_TOLERANCE = 1e-4  # rad a printed waypoint may lie outside its limit: rounding of tables

# rad per (1 + largest |waypoint|) by which a motion may leave the position limits. It covers rounding, most of
# all that of the optimisers. The check, the swarms' objective, the optimum and the bound share this number.
POSITION_SLACK = 1e-10


@dataclass(frozen=True)
class Limits:
    """Limits of each joint: symmetric ones on the derivatives, and an interval of positions.

    Make them with ``Limits.of``, which validates.

    Attributes
    ----------
    velocity : Array, shape (dof,)
        [rad/s]; always finite.
    acceleration, jerk : Array, shape (dof,)
        [rad/s^2], [rad/s^3]; infinite where unlimited.
    position : Array, shape (dof, 2)
        Least and greatest position [rad]; infinite where unlimited.
    """

    velocity: Array
    acceleration: Array
    jerk: Array
    position: Array

    @staticmethod
    def of(
        velocity: ArrayLike,
        acceleration: ArrayLike = np.inf,
        jerk: ArrayLike = np.inf,
        position: ArrayLike = (-np.inf, np.inf),
        *,
        dof: int,
    ) -> Limits:
        """Make limits from one number for all joints, or one per joint.

        Parameters
        ----------
        velocity, acceleration, jerk : array_like, shape () or (dof,)
            [rad/s, rad/s^2, rad/s^3]; the last two may be infinite.
        position : array_like, shape (2,) or (dof, 2)
            Least and greatest position [rad].
        dof : int
            Number of joints.

        Returns
        -------
        Limits

        Raises
        ------
        InputError
            For another length, NaN, a limit that is not positive, a velocity that is not finite, or an
            empty interval of positions.

        Examples
        --------
        >>> limits = Limits.of(velocity=[1.5, 2.0], acceleration=5.0, dof=2)
        >>> limits.acceleration.tolist(), limits.has_jerk
        ([5.0, 5.0], False)
        """
        speeds = _per_joint("limits.velocity", velocity, dof)
        if not np.isfinite(speeds).all():
            joint = int(np.argmin(np.isfinite(speeds)))
            raise InputError(f"limits.velocity: joint {joint + 1}: {speeds[joint]:g} is not finite")
        bounds = _rows(position, dof)
        for joint, (low, high) in enumerate(bounds):
            if not low < high:
                raise InputError(f"limits.position: joint {joint + 1}: [{low:g}, {high:g}] is empty")
        return Limits(
            velocity=speeds,
            acceleration=_per_joint("limits.acceleration", acceleration, dof),
            jerk=_per_joint("limits.jerk", jerk, dof),
            position=bounds,
        )

    @property
    def derivatives(self) -> Array:
        """Velocity, acceleration and jerk limits stacked, (3, dof)."""
        return np.stack([self.velocity, self.acceleration, self.jerk])

    @property
    def has_acceleration(self) -> bool:
        """Whether any joint has a finite acceleration limit."""
        return bool(np.isfinite(self.acceleration).any())

    @property
    def has_jerk(self) -> bool:
        """Whether any joint has a finite jerk limit."""
        return bool(np.isfinite(self.jerk).any())

    @property
    def has_position(self) -> bool:
        """Whether any joint has a finite position limit."""
        return bool(np.isfinite(self.position).any())


@dataclass(frozen=True)
class Problem:
    """Pass the waypoints in order, from rest to rest, within the limits, as fast as possible.

    Make one with ``Problem.of``, or read it with ``load``; both validate.

    Attributes
    ----------
    name : str
    waypoints : Array, shape (n_waypoints, dof)
        Joint positions [rad].
    limits : Limits
    family : str
        Key in ``FAMILIES`` of the spline family in which the problem is posed.
    title, source : str
        For reports: a name for people, and where the numbers come from.
    display_unit : str
        "rad" or "deg": the unit of angles in reports.
    """

    name: str
    waypoints: Array
    limits: Limits
    family: str
    title: str = ""
    source: str = ""
    display_unit: str = field(default="rad", compare=False)

    @staticmethod
    def of(
        waypoints: ArrayLike,
        limits: Limits,
        *,
        name: str = "problem",
        family: str | None = None,
        title: str = "",
        source: str = "",
        display_unit: str = "rad",
    ) -> Problem:
        """Make a problem from waypoints and limits.

        Parameters
        ----------
        waypoints : array_like, shape (n_waypoints, dof)
            At least two joint positions [rad].
        limits : Limits
            Of as many joints. A waypoint may lie outside the position limits by 1e-4 rad, because printed
            tables are rounded.
        name, title, source, display_unit : str
            As in ``Problem``.
        family : str, optional
            Left out, it is "3-5-3" for four waypoints and "4-3-4" otherwise.

        Returns
        -------
        Problem

        Raises
        ------
        InputError
            In one line that names the key, the joint and the value.

        Examples
        --------
        >>> problem = Problem.of([[0.0], [1.0], [0.5]], Limits.of(velocity=1.0, dof=1))
        >>> problem.n_segments, problem.family
        (2, '4-3-4')
        """
        points = _numbers("waypoints", waypoints)
        if points.ndim != 2 or points.shape[1] < 1:
            raise InputError(
                f"waypoints: expected a row per waypoint and a column per joint, "
                f"got shape {points.shape}"
            )
        if len(points) < 2:
            raise InputError(f"waypoints: at least two are needed, got {len(points)}")
        dof = points.shape[1]
        if len(limits.velocity) != dof:
            raise InputError(
                f"limits.velocity: {len(limits.velocity)} values for {dof} joints in waypoints"
            )
        if not np.isfinite(points).all():
            row, joint = np.argwhere(~np.isfinite(points))[0]
            raise InputError(
                f"waypoints: row {row + 1}, joint {joint + 1}: {points[row, joint]:g} is not finite"
            )
        outside = np.maximum(limits.position[:, 0] - points, points - limits.position[:, 1])
        if (outside > POSITION_TOLERANCE).any():
            row, joint = np.unravel_index(int(outside.argmax()), outside.shape)
            low, high = limits.position[joint]
            raise InputError(
                f"waypoints: row {row + 1}, joint {joint + 1}: {points[row, joint]:.6g} rad lies "
                f"outside limits.position [{low:.6g}, {high:.6g}] rad"
            )
        return Problem(
            name=name,
            waypoints=points,
            limits=limits,
            family=family or ("3-5-3" if len(points) == 4 else "4-3-4"),
            title=title or name,
            source=source,
            display_unit=display_unit,
        )

    @property
    def dof(self) -> int:
        """Number of joints."""
        return int(self.waypoints.shape[1])

    @property
    def n_segments(self) -> int:
        """Number of segments between waypoints."""
        return len(self.waypoints) - 1

    @property
    def displacements(self) -> Array:
        """Signed displacement of each segment and joint, (n_segments, dof) [rad]."""
        return np.diff(self.waypoints, axis=0)

    @property
    def position_bounds(self) -> Array:
        """Position limits in force, (dof, 2) [rad].

        They are widened to the waypoints. A printed waypoint can lie outside by rounding (Wang 2025,
        Table 5, joint 5), and no motion through it could keep the printed limit.
        """
        low = np.minimum(self.limits.position[:, 0], self.waypoints.min(axis=0))
        high = np.maximum(self.limits.position[:, 1], self.waypoints.max(axis=0))
        return np.stack([low, high], axis=1)

    @property
    def position_slack(self) -> float:
        """How far a motion may leave ``position_bounds`` and still count as inside [rad]."""
        return POSITION_SLACK * (1.0 + float(np.abs(self.waypoints).max()))

    def joint(self, index: int) -> Problem:
        """Pose the same problem for one joint alone, as the papers do.

        Parameters
        ----------
        index : int
            The joint; counts from 0.

        Returns
        -------
        Problem
        """
        one = slice(index, index + 1)
        limits = self.limits
        return replace(
            self,
            name=f"{self.name}[{index + 1}]",
            title=f"{self.title}, joint {index + 1} alone",
            waypoints=self.waypoints[:, one],
            limits=Limits(
                limits.velocity[one],
                limits.acceleration[one],
                limits.jerk[one],
                limits.position[one],
            ),
        )

    @property
    def moving_joints(self) -> list[int]:
        """Indices of the joints that move; the others keep every limit, whatever the durations."""
        return [j for j in range(self.dof) if np.ptp(self.waypoints[:, j]) > 0.0]


def _numbers(key: str, values: Any) -> Array:
    try:
        return np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{key}: expected numbers in rows of equal length") from None


def _per_joint(key: str, values: ArrayLike, dof: int) -> Array:
    numbers = _numbers(key, values)
    if numbers.ndim == 0:
        numbers = np.full(dof, float(numbers))
    if numbers.shape != (dof,):
        raise InputError(f"{key}: expected one number or {dof}, one per joint, got {numbers.shape}")
    for joint, value in enumerate(numbers):
        if not value > 0.0:  # also false for NaN
            raise InputError(f"{key}: joint {joint + 1}: {value:g} is not positive")
    return numbers


def _rows(values: ArrayLike, dof: int) -> Array:
    numbers = _numbers("limits.position", values)
    if numbers.shape == (2,):
        numbers = np.tile(numbers, (dof, 1))
    if numbers.shape != (dof, 2):
        raise InputError(
            f"limits.position: expected [low, high] for each of {dof} joints, got {numbers.shape}"
        )
    if np.isnan(numbers).any():
        raise InputError(f"limits.position: joint {np.argwhere(np.isnan(numbers))[0, 0] + 1}: NaN")
    return numbers
