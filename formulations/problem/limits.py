"""Limits of the joints: on velocity, acceleration and jerk, and an interval of positions."""

from __future__ import annotations

from collections.abc import Iterable
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

LIMITED = ("velocity", "acceleration", "jerk", "position")


@dataclass(frozen=True)
class Limits:
    """Limits of each joint: symmetric ones on the derivatives, and an interval of positions.

    Make them with ``Limits.of``, which validates.

    Attributes
    ----------
    velocity : Array, shape (dof,)
        [rad/s, or m/s for a prismatic joint]; always finite.
    acceleration, jerk : Array, shape (dof,)
        [rad/s^2], [rad/s^3]; infinite where unlimited.
    position : Array, shape (dof, 2)
        Least and greatest position [rad]; infinite where unlimited.
    units : tuple of str
        "rad" or "m" per joint: what a position is in. Empty stands for rad.
    """

    velocity: Array
    acceleration: Array
    jerk: Array
    position: Array
    units: tuple[str, ...] = ()

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
            [unit/s, unit/s^2, unit/s^3]; the last two may be infinite.
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
        speeds = read.per_joint(1, velocity)
        if not np.isfinite(speeds).all():
            joint = int(np.argmin(np.isfinite(speeds)))
            raise InputError(f"limits.velocity: {read.label(joint)}: {speeds[joint]:g} is not finite")
        return Limits(
            velocity=speeds,
            acceleration=read.per_joint(2, acceleration),
            jerk=read.per_joint(3, jerk),
            position=read.positions(position),
            units=read.units,
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Limits):
            return NotImplemented
        rad = ("rad",) * len(self.velocity)
        return (self.units or rad) == (other.units or rad) and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in LIMITED
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
