"""Everything of a paper that can be checked, as printed: time vectors, totals, claims, points."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from compare.audit.paper.dh import PrintedDH
from compare.audit.paper.digits import Printed
from compare.audit.paper.limits import UNREACHED, StatedLimits
from formulations import InputError, Limits, Problem
from formulations.arms import Arm
from formulations.problem.arrays import Array
from formulations.problem.joint_words import UNITS
from formulations.problem.problem import POSITION_TOLERANCE

RULES = ("sum", "difference", "mean", "reduction")


@dataclass(frozen=True)
class PrintedTimes:
    """A printed time vector [s].

    Attributes
    ----------
    where, by : str
        The place in the paper; the method it belongs to.
    joint : int or None
        From 0; None for all joints together.
    times : tuple of Printed
        One per segment.
    total : Printed or None
        As printed beside them.
    limits : str or None
        Name of the stated limits that it was made under.
    of : tuple of PrintedTimes
        The vectors of the single joints, if this one holds the longest time per segment of them.
    """

    where: str
    by: str
    joint: int | None
    times: tuple[Printed, ...]
    total: Printed | None
    limits: str | None
    of: tuple[PrintedTimes, ...] = ()


@dataclass(frozen=True)
class Total:
    """A total time [s] whose vector is not printed; joint from 0, None for all joints."""

    where: str
    by: str
    joint: int | None
    value: Printed
    limits: str | None

    @property
    def table(self) -> str:
        """The place in the paper, and the method."""
        return f"{self.where}, {self.by}".rstrip(", ")


@dataclass(frozen=True)
class ArithmeticClaim:
    """A claim that a rule (of ``RULES``), applied to the numbers ``of``, gives the number ``equals``."""

    where: str
    says: str
    rule: str
    of: tuple[Printed, ...]
    equals: Printed


@dataclass(frozen=True)
class Point:
    """A Cartesian waypoint; waypoint from 0, metre and radian: m and rad per printed unit."""

    where: str
    waypoint: int
    position: tuple[Printed, ...]
    rpy: tuple[Printed, ...] | None
    metre: float
    radian: float = 1.0


@dataclass(frozen=True)
class LeftOut:
    """A table, figure or equation that the chapter does not make again; both in words for its reader."""

    where: str
    what: str
    why: str


@dataclass(frozen=True)
class Paper:
    """Everything of a paper that can be checked.

    Attributes
    ----------
    name : str
        Of the case with the same task, or of the file.
    arm : Arm or None
        A shipped one, or that of the printed DH table.
    limited : tuple of str
        The derivatives that the paper limits.
    unit, waypoint_unit : str
        Of angles, for people; of the waypoints, as printed.
    waypoints, halves : Array, shape (n_waypoints, dof) [rad], or None
        The joint angles and half units of their last digits; None if they are not printed.
    stated : dict
        Limits by the name of their table.
    rows, totals, claims, points : tuple
        Time vectors, totals without one, claimed arithmetic, Cartesian waypoints.
    dh : PrintedDH or None
        The DH table, if the file prints it.
    settings : dict
        What the tables and figures need beside the audit, by name (``settings_format.SETTINGS``).
    left_out : tuple of LeftOut
        What the chapter does not make again.
    """

    name: str
    title: str
    source: str
    notes: str
    family: str
    arm: Arm | None
    limited: tuple[str, ...]
    unit: str
    n_waypoints: int
    waypoints: Array | None
    halves: Array | None
    stated: dict[str, StatedLimits]
    rows: tuple[PrintedTimes, ...]
    totals: tuple[Total, ...]
    claims: tuple[ArithmeticClaim, ...]
    points: tuple[Point, ...]
    dh: PrintedDH | None = None
    waypoint_unit: str = "rad"
    settings: dict[str, dict[str, Any]] = field(default_factory=dict)
    left_out: tuple[LeftOut, ...] = ()

    @property
    def author_year(self) -> str:
        """How people name it: Wang 2025, what its title begins with."""
        return self.title.partition(":")[0]

    @property
    def angle(self) -> float:
        """Rad per unit of angle shown to people."""
        return UNITS[self.unit]

    def problem(self, joint: int | None, limits: str | None) -> Problem:
        """Pose the task at the printed digits.

        Parameters
        ----------
        joint : int or None
            One joint, from 0, or all of them.
        limits : str or None
            Name of stated limits. Without them only the velocity is limited, by a value that nothing
            reaches. Limits of position are widened to waypoints beyond them: those are a fault of their own.

        Returns
        -------
        Problem

        Raises
        ------
        InputError
            If the paper prints no waypoints.
        """
        if self.waypoints is None:
            raise InputError(f"{self.name}: prints no waypoints")
        w = self.waypoints if joint is None else self.waypoints[:, joint : joint + 1]
        dof = w.shape[1]
        if limits is None:
            allowed = Limits.of(UNREACHED, dof=dof)
        else:
            stated = self.stated[limits].of_joint(joint)
            velocity, acceleration, jerk = stated.derivatives
            position = _around(stated.position, w)
            allowed = Limits.of(velocity, acceleration, jerk, position, dof=dof)
        return Problem.of(w, allowed, name=self.name, family=self.family, display_unit=self.unit)

    def loosest(self, problem: Problem, joint: int | None, limits: str | None) -> Problem:
        """Pose a task under the highest limits that print like the stated ones.

        Parameters
        ----------
        problem : Problem
            The task at the printed digits.
        joint : int or None
            As for ``problem``.
        limits : str or None
            As for ``problem``.

        Returns
        -------
        Problem
        """
        return problem if limits is None else self.stated[limits].of_joint(joint).loosest(problem)

    def tightest(self, problem: Problem, joint: int | None, limits: str | None) -> Problem:
        """Pose a task under the lowest limits that print like the stated ones.

        Parameters
        ----------
        problem : Problem
            The task at the printed digits.
        joint : int or None
            As for ``problem``.
        limits : str or None
            As for ``problem``.

        Returns
        -------
        Problem
        """
        return problem if limits is None else self.stated[limits].of_joint(joint).tightest(problem)

    def halves_of(self, joint: int | None) -> Array:
        """Half units of the waypoints' last digits.

        Parameters
        ----------
        joint : int or None
            One joint, from 0, or all of them.

        Returns
        -------
        Array, shape (n_waypoints, 1 or dof) [rad]
        """
        assert self.halves is not None
        return self.halves if joint is None else self.halves[:, joint : joint + 1]


def _around(position: Array, waypoints: Array) -> Array:
    """Widen limits of position (dof, 2) to the waypoints that lie beyond them by more than rounding."""
    low, high = position.T
    least, most = waypoints.min(axis=0), waypoints.max(axis=0)
    return np.stack(
        [
            np.where(low - least > POSITION_TOLERANCE, least, low),
            np.where(most - high > POSITION_TOLERANCE, most, high),
        ],
        axis=1,
    )
