"""Limits of the joints: on velocity, acceleration and jerk, and an interval of positions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.joint_words import (
    factors,
    joint_label,
    read_angle_unit,
    read_names,
    read_units,
    shown_unit,
)
from formulations.problem.toml_file.toml_values import known_keys

LIMITED = ("velocity", "acceleration", "jerk", "position")


@dataclass(frozen=True)
class Limits:
    """Limits of each joint on its velocity, acceleration and jerk, and an interval of positions.

    Make them with ``Limits.of``, which validates.

    Attributes
    ----------
    velocity : Array, shape (dof,)
        Greatest speed in either direction [rad/s, or m/s for a prismatic joint]; always finite.
    acceleration, jerk : Array, shape (dof,)
        The same of acceleration and jerk [rad/s^2], [rad/s^3]; infinite where unlimited.
    position : Array, shape (dof, 2)
        Least and greatest position [rad]; infinite where unlimited.
    units : tuple of str
        "rad" or "m" per joint: what a position is in. Empty stands for rad.
    velocity_interval, acceleration_interval : Array or None, shape (dof, 2)
        Least (negative) and greatest (positive) value, where the two directions have different limits.
    """

    velocity: Array
    acceleration: Array
    jerk: Array
    position: Array
    units: tuple[str, ...] = ()
    velocity_interval: Array | None = None
    acceleration_interval: Array | None = None

    @staticmethod
    def of(
        velocity: ArrayLike,
        acceleration: ArrayLike = np.inf,
        jerk: ArrayLike = np.inf,
        position: ArrayLike = (-np.inf, np.inf),
        *,
        dof: int,
        unit: str = "rad",
        units: Iterable[str] = (),
        names: Iterable[str] = (),
    ) -> Limits:
        """Make limits from one number for all joints, or one per joint.

        Parameters
        ----------
        velocity, acceleration, jerk : array_like, shape () or (dof,)
            [unit/s, unit/s^2, unit/s^3]; the last two may be infinite. Velocity and acceleration may also
            be pairs, shape (dof, 2): least (negative) and greatest (positive) value of each joint.
        position : array_like, shape (2,) or (dof, 2)
            Least and greatest position [unit].
        dof : int
            Number of joints.
        unit : {"rad", "deg"}
            Unit of angles in these numbers. Messages speak in it too.
        units : iterable of str, optional
            "rad" or "m" per joint; the numbers of a prismatic joint are in m.
        names : iterable of str, optional
            Names of the joints, for messages.

        Returns
        -------
        Limits
            In rad and m.

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
        read = _Reader(
            dof, read_angle_unit("unit", unit), read_units(units, dof), read_names(names, dof)
        )
        speeds, speed_interval = read.both_ways(1, velocity)
        steepest, acceleration_interval = read.both_ways(2, acceleration)
        if not np.isfinite(speeds).all():
            joint = int(np.argmin(np.isfinite(speeds)))
            raise InputError(f"limits.velocity: {read.label(joint)}: {speeds[joint]:g} is not finite")
        return Limits(
            velocity=speeds,
            acceleration=steepest,
            jerk=read.per_joint(3, jerk),
            position=read.positions(position),
            units=read.units,
            velocity_interval=speed_interval,
            acceleration_interval=acceleration_interval,
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Limits):
            return NotImplemented
        rad = ("rad",) * len(self.velocity)
        return (
            (self.units or rad) == (other.units or rad)
            and all(np.array_equal(getattr(self, name), getattr(other, name)) for name in LIMITED)
            and all(
                np.array_equal(mine, its)
                for mine, its in zip(self.intervals, other.intervals, strict=True)
            )
        )

    @property
    def symmetric(self) -> bool:
        """Whether every joint has the same limits in both directions."""
        return self.velocity_interval is None and self.acceleration_interval is None

    @property
    def intervals(self) -> tuple[Array, Array]:
        """Least and greatest velocity and acceleration, (dof, 2) each [rad/s, rad/s^2]."""
        found = (
            (self.velocity, self.velocity_interval),
            (self.acceleration, self.acceleration_interval),
        )
        velocity, acceleration = (
            np.stack([-both, both], axis=1) if interval is None else interval
            for both, interval in found
        )
        return velocity, acceleration

    @property
    def ranges(self) -> Array:
        """Least and greatest velocity, acceleration and jerk, (3, dof, 2)."""
        return np.stack([*self.intervals, np.stack([-self.jerk, self.jerk], axis=1)])

    def of_joint(self, joint: int) -> Limits:
        """Return the limits of one joint alone.

        Parameters
        ----------
        joint : int
            Counts from 0.

        Returns
        -------
        Limits
        """
        one = slice(joint, joint + 1)
        speeds, steepest = (
            None if interval is None else interval[one]
            for interval in (self.velocity_interval, self.acceleration_interval)
        )
        return Limits(
            self.velocity[one],
            self.acceleration[one],
            self.jerk[one],
            self.position[one],
            self.units[one],
            speeds,
            steepest,
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


def numbers(key: str, values: Any) -> Array:
    """Read an array of numbers.

    Parameters
    ----------
    key : str
        Name of the argument, for the message.
    values : array_like
        The numbers.

    Returns
    -------
    Array

    Raises
    ------
    InputError
        They are no numbers, or rows have different lengths.
    """
    try:
        return np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{key}: expected numbers in rows of equal length") from None


@dataclass(frozen=True)
class _Reader:
    """Reads the numbers of one robot's limits, in the unit that a person wrote."""

    dof: int
    angle: str
    units: tuple[str, ...]
    names: tuple[str, ...]

    def label(self, joint: int) -> str:
        return joint_label(self.names, joint)

    def per_joint(self, order: int, values: ArrayLike) -> Array:
        """A limit on a derivative, (dof,) [rad/s^order or m/s^order]."""
        key = f"limits.{LIMITED[order - 1]}"
        given = numbers(key, values)
        if given.ndim == 0:
            given = np.full(self.dof, float(given))
        if given.shape != (self.dof,):
            raise InputError(
                f"{key}: expected one number or {self.dof}, one per joint, got {given.shape}"
            )
        found = given * factors(self.units, self.angle)
        for joint in range(self.dof):
            if not found[joint] > 0.0:  # also false for NaN, and for what rounds to zero
                unit = shown_unit(self.units[joint], self.angle, order)
                raise InputError(f"{key}: {self.label(joint)}: {given[joint]:g} {unit} is not positive")
        return found

    def both_ways(self, order: int, values: ArrayLike) -> tuple[Array, Array | None]:
        """The greatest modulus of a derivative, (dof,), and its intervals where pairs were given, (dof, 2)."""
        key = f"limits.{LIMITED[order - 1]}"
        given = numbers(key, values)
        if given.ndim < 2:
            return self.per_joint(order, given), None
        if given.shape != (self.dof, 2):
            raise InputError(
                f"{key}: expected one number, {self.dof} numbers, or [least, greatest] for each of "
                f"{self.dof} joints, got {given.shape}"
            )
        for joint, (low, high) in enumerate(given):
            if not low < 0.0 < high:  # also true for NaN
                unit = shown_unit(self.units[joint], self.angle, order)
                raise InputError(
                    f"{key}: {self.label(joint)}: [{low:g}, {high:g}] {unit} does not hold 0 inside"
                )
        moduli = self.per_joint(order, np.abs(given).max(axis=1))
        if (given[:, 0] == -given[:, 1]).all():
            return moduli, None
        return moduli, np.asarray(given * factors(self.units, self.angle)[:, None])

    def positions(self, values: ArrayLike) -> Array:
        """Intervals of positions, (dof, 2) [rad or m]."""
        key = "limits.position"
        given = numbers(key, values)
        if given.shape == (2,):
            given = np.tile(given, (self.dof, 1))
        if given.shape != (self.dof, 2):
            raise InputError(
                f"{key}: expected [low, high] for each of {self.dof} joints, got {given.shape}"
            )
        for joint, (low, high) in enumerate(given):
            if np.isnan(low) or np.isnan(high):
                raise InputError(f"{key}: {self.label(joint)}: NaN")
            if not low < high:
                unit = shown_unit(self.units[joint], self.angle)
                raise InputError(f"{key}: {self.label(joint)}: [{low:g}, {high:g}] {unit} is empty")
        return np.asarray(given * factors(self.units, self.angle)[:, None])


def limits_of(
    given: Limits | Mapping[str, ArrayLike],
    dof: int,
    angle: str,
    units: tuple[str, ...],
    names: tuple[str, ...],
) -> Limits:
    """Read the limits of a problem.

    Parameters
    ----------
    given : Limits, or mapping of str to array_like
        Limits are taken as they are; a mapping holds the arguments of ``Limits.of``.
    dof : int
        Number of joints.
    angle : {"rad", "deg"}
        Unit of the angles in a mapping.
    units, names : tuple of str
        Of the joints.

    Returns
    -------
    Limits

    Raises
    ------
    InputError
        In one line.
    """
    if isinstance(given, Limits):
        if len(given.velocity) != dof:
            raise InputError(
                f"limits.velocity: {len(given.velocity)} values for {dof} joints in waypoints"
            )
        return given
    if not isinstance(given, Mapping):
        raise InputError(
            f"limits: expected Limits or a mapping of {', '.join(LIMITED)}, got {given!r:.50}"
        )
    known_keys("limits", dict(given), LIMITED)
    if "velocity" not in given:
        raise InputError("limits.velocity: missing")
    return Limits.of(**given, dof=dof, unit=angle, units=units, names=names)
