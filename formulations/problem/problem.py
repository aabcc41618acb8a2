"""The problem: waypoints that a motion of the joints must pass, and the limits that it must keep."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError, UnsupportedProblem
from formulations.problem.hints import hints_of
from formulations.problem.joint_words import (
    factors,
    joint_label,
    read_angle_unit,
    read_names,
    read_units,
    shown_unit,
)
from formulations.problem.limits import Limits, limits_of, numbers
from formulations.problem.toml_file.toml_values import read_choice, read_text

__all__ = ["POSITION_SLACK", "POSITION_TOLERANCE", "Limits", "Problem"]

POSITION_TOLERANCE = 1e-4  # rad a printed waypoint may lie outside its limit: rounding of tables
LARGEST_WAYPOINT = 1e6  # rad or m; beyond, ten digits after the point are no longer kept

# rad per (1 + largest |waypoint|) by which a motion may leave the position limits. It covers rounding, most of
# all that of the optimisers. The check, the swarms' objective, the optimum and the bound share this number.
POSITION_SLACK = 1e-10


@dataclass(frozen=True, init=False)
class Problem:
    """Pass the waypoints in order, from rest to rest, within the limits, as fast as possible.

    Parameters
    ----------
    waypoints : array_like, shape (n_waypoints, dof)
        At least two joint positions [unit; m for a prismatic joint].
    limits : Limits, or mapping of str to array_like
        Of as many joints. ``Limits`` are in rad and m; a mapping holds the arguments of ``Limits.of``
        (velocity, acceleration, jerk, position), in ``unit``. A waypoint may lie outside the position
        limits by 1e-4 rad, because printed tables are rounded.
    name, title, source : str
        For reports: a short name, a name for people, and where the numbers come from.
    family : str, optional
        Key in ``FAMILIES`` of the spline family in which the problem is posed. Left out, it is "3-5-3"
        for four waypoints and "4-3-4" otherwise.
    display_unit : {"rad", "deg"}, optional
        Unit of angles in messages and reports; ``unit`` if left out.
    names : iterable of str, optional
        Names of the joints. Without, they are called joint 1, joint 2, ...
    units : iterable of str, optional
        "rad" or "m" per joint; those of the limits if left out.
    unit : {"rad", "deg"}
        Unit of the angles that are given.
    conditions : Conditions, optional
        What is asked for beyond: zones, times, stops, states at the ends, limits of segments [rad, s].

    Attributes
    ----------
    waypoints : Array, shape (n_waypoints, dof)
        Joint positions [rad, or m].
    limits : Limits
    name, title, source, family, display_unit : str
    names, units : tuple of str
    conditions : Conditions

    Raises
    ------
    InputError
        In one line that names the argument, the joint and the value.

    Examples
    --------
    >>> problem = Problem([[0, 10], [90, 20], [0, 0]], {"velocity": 90, "acceleration": 300}, unit="deg")
    >>> problem.n_segments, problem.family, problem.limits.velocity.round(4).tolist()
    (2, '4-3-4', [1.5708, 1.5708])
    """

    waypoints: Array
    limits: Limits
    name: str
    family: str
    title: str
    source: str
    display_unit: str = field(compare=False)
    names: tuple[str, ...]
    units: tuple[str, ...]
    conditions: Conditions

    def __init__(
        self,
        waypoints: ArrayLike,
        limits: Limits | Mapping[str, ArrayLike],
        *,
        name: str = "problem",
        family: str | None = None,
        title: str = "",
        source: str = "",
        display_unit: str | None = None,
        names: Iterable[str] = (),
        units: Iterable[str] = (),
        unit: str = "rad",
        conditions: Conditions | None = None,
    ) -> None:
        points = numbers("waypoints", waypoints)
        if points.ndim != 2 or points.shape[1] < 1:
            raise InputError(
                f"waypoints: expected a row per waypoint and a column per joint, "
                f"got shape {points.shape}"
            )
        if len(points) < 2:
            raise InputError(f"waypoints: at least two are needed, got {len(points)}")
        if family is not None:
            from formulations.families import FAMILIES  # they are about problems themselves

            read_choice("family", family, FAMILIES)
        dof = points.shape[1]
        angle = read_angle_unit("unit", unit)
        values: dict[str, Any] = {
            "name": read_text("name", name),
            "family": family or ("3-5-3" if len(points) == 4 else "4-3-4"),
            "title": title or name,
            "source": source,
            "display_unit": read_angle_unit("display_unit", display_unit or angle),
            "names": read_names(names, dof),
        }
        own = read_units(units or (limits.units if isinstance(limits, Limits) else ()), dof)
        values["units"] = own
        values["limits"] = limits_of(limits, dof, angle, own, values["names"])
        values["waypoints"] = points * factors(own, angle)
        values["conditions"] = conditions or Conditions()
        for key, value in values.items():
            object.__setattr__(self, key, value)
        self._require_inside(points, angle)
        self.conditions.validate(self)

    @staticmethod
    def of(waypoints: ArrayLike, limits: Limits | Mapping[str, ArrayLike], **others: Any) -> Problem:
        """Make a problem: the same as ``Problem(waypoints, limits, ...)``.

        Parameters
        ----------
        waypoints : array_like, shape (n_waypoints, dof)
            At least two joint positions.
        limits : Limits or mapping
            Of as many joints.
        **others
            As in ``Problem``.

        Returns
        -------
        Problem

        Examples
        --------
        >>> problem = Problem.of([[0.0], [1.0], [0.5]], Limits.of(velocity=1.0, dof=1))
        >>> problem.n_segments, problem.family
        (2, '4-3-4')
        """
        return Problem(waypoints, limits, **others)

    def _require_inside(self, given: Array, angle: str) -> None:
        """Refuse waypoints that are not finite or lie outside; given: as written, angles in ``angle``."""
        points, limits = self.waypoints, self.limits

        def at(row: Any, joint: Any) -> str:
            return f"waypoints: row {row + 1}, {self.joint_name(joint)}: {given[row, joint]:.6g}"

        if not np.isfinite(points).all():
            row, joint = np.argwhere(~np.isfinite(points))[0]
            raise InputError(f"{at(row, joint)} is not finite")
        if (np.abs(points) > LARGEST_WAYPOINT).any():
            row, joint = np.argwhere(np.abs(points) > LARGEST_WAYPOINT)[0]
            unit, most = self.units[joint], LARGEST_WAYPOINT / factors(self.units, angle)[joint]
            raise InputError(
                f"{at(row, joint)} {shown_unit(unit, angle)} is beyond {most:.3g}, the largest allowed"
            )
        outside = np.maximum(limits.position[:, 0] - points, points - limits.position[:, 1])
        if not (outside > POSITION_TOLERANCE).any():
            return
        row, joint = np.unravel_index(int(outside.argmax()), outside.shape)
        low, high = limits.position[joint] / factors(self.units, angle)[joint]
        unit = shown_unit(self.units[joint], angle)
        turned = points * factors(self.units, "deg")
        fits = ((turned >= limits.position[:, 0]) & (turned <= limits.position[:, 1])).all()
        hint = '; in degrees all would be inside: unit = "deg"?' if fits and unit == "rad" else ""
        raise InputError(
            f"{at(row, joint)} {unit} lies outside limits.position [{low:.6g}, {high:.6g}] {unit}{hint}"
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Problem):
            return NotImplemented
        words = ("name", "family", "title", "source", "names", "units", "limits", "conditions")
        return np.array_equal(self.waypoints, other.waypoints) and all(
            getattr(self, key) == getattr(other, key) for key in words
        )

    def __repr__(self) -> str:
        return (
            f"Problem({self.name!r}: {len(self.waypoints)} waypoints of {self.dof} joints, "
            f"family {self.family})"
        )

    def joint_name(self, joint: int) -> str:
        """Say which joint is meant: ``joint elbow``, or ``joint 2`` where joints have no names.

        Parameters
        ----------
        joint : int
            Counts from 0.

        Returns
        -------
        str
        """
        return joint_label(self.names, joint)

    def amount(self, value: float, joint: int, order: int = 0, *, digits: int = 6) -> str:
        """Show a value of a joint with its unit, in ``display_unit``.

        Parameters
        ----------
        value : float
            [rad/s^order, or m/s^order].
        joint : int
            Counts from 0.
        order : int
            Order of the derivative; 0 is the position.
        digits : int
            Significant digits.

        Returns
        -------
        str
            ``90 deg/s``, say.
        """
        scale = float(factors(self.units, self.display_unit)[joint])
        return f"{value / scale:.{digits}g} {shown_unit(self.units[joint], self.display_unit, order)}"

    @property
    def hints(self) -> tuple[str, ...]:
        """What is legal but was probably not meant, a line each (``problem.hints``)."""
        return hints_of(self)

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
        return replace(
            self,
            name=f"{self.name}[{index + 1}]",
            title=f"{self.title}, {self.joint_name(index)} alone",
            waypoints=self.waypoints[:, one],
            names=self.names[one],
            units=self.units[one],
            limits=self.limits.of_joint(index),
            conditions=self.conditions.of_joint(index),
        )

    @property
    def plain(self) -> bool:
        """Whether nothing is asked for but waypoints, and limits are the same in both directions."""
        return self.conditions.none and self.limits.symmetric

    def require_plain(self, who: str) -> None:
        """Refuse a problem that asks for more than a method knows.

        Parameters
        ----------
        who : str
            The method, at the start of the message.

        Raises
        ------
        UnsupportedProblem
            The problem has conditions, or limits that differ between the directions.
        """
        if not self.conditions.none:
            named = ", ".join(f"conditions.{key}" for key in self.conditions.asked)
            raise UnsupportedProblem(f"{who}: knows no conditions, the problem has {named}")
        if not self.limits.symmetric:
            raise UnsupportedProblem(f"{who}: knows no limits that differ between the two directions")

    @property
    def moving_joints(self) -> list[int]:
        """Indices of the joints that move; the others keep every limit, whatever the durations."""
        return [j for j in range(self.dof) if np.ptp(self.waypoints[:, j]) > 0.0]
