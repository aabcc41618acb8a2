"""A paper as data: waypoints, limits, time vectors, totals, claims and points, as printed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from compare.audit.minima import UNREACHED, with_limits
from compare.audit.printed import Printed
from formulations import InputError, Limits, Problem
from formulations.problem.arrays import Array

UNITS = {"rad": 1.0, "deg": math.pi / 180.0}
RULES = ("sum", "difference", "mean", "reduction")


@dataclass(frozen=True)
class Stated:
    """Limits as a table states them. joint: from 0, None for all. derivatives: (3, dof or 1), inf where
    unlimited; position: (dof or 1, 2); in rad. The halves are the half units of their last digits, 0
    where a number is exact.
    """

    name: str
    joint: int | None
    derivatives: Array
    position: Array
    derivative_halves: Array
    position_halves: Array

    def of_joint(self, joint: int | None) -> Stated:
        """The same for one joint of the arm alone, or for all of them."""
        if joint is None or self.joint is not None:
            return self
        one = slice(joint, joint + 1)
        return Stated(
            self.name,
            joint,
            self.derivatives[:, one],
            self.position[one],
            self.derivative_halves[:, one],
            self.position_halves[one],
        )


@dataclass(frozen=True)
class Row:
    """A time vector. joint: from 0, None for all joints. of: the rows it was made of, if by the rule
    of the longest time per segment.
    """

    where: str
    by: str
    joint: int | None
    times: tuple[Printed, ...]
    total: Printed | None
    limits: str | None
    of: tuple[Row, ...] = ()


@dataclass(frozen=True)
class Total:
    """A total time whose vector is not printed."""

    where: str
    by: str
    joint: int | None
    value: Printed
    limits: str | None

    @property
    def table(self) -> str:
        """Where it stands, and whose it is."""
        return f"{self.where}, {self.by}".rstrip(", ")


@dataclass(frozen=True)
class Claim:
    """Arithmetic that a paper claims: rule (of RULES) applied to ``of`` equals ``equals``."""

    where: str
    says: str
    rule: str
    of: tuple[Printed, ...]
    equals: Printed


@dataclass(frozen=True)
class Point:
    """A Cartesian waypoint [m, rad]. waypoint: from 0."""

    where: str
    waypoint: int
    position: tuple[Printed, ...]
    rpy: tuple[Printed, ...] | None
    metre: float


@dataclass(frozen=True)
class Paper:
    """Everything of a paper that can be checked.

    waypoints, halves: (n, dof) [rad], None if not printed. limited: the derivatives the paper
    limits. unit: of angles, for people.
    """

    name: str
    title: str
    source: str
    notes: str
    family: str
    arm: str | None
    limited: tuple[str, ...]
    unit: str
    n_waypoints: int
    waypoints: Array | None
    halves: Array | None
    stated: dict[str, Stated]
    rows: tuple[Row, ...]
    totals: tuple[Total, ...]
    claims: tuple[Claim, ...]
    points: tuple[Point, ...]

    @property
    def angle(self) -> float:
        """Rad per unit of angle shown to people."""
        return UNITS[self.unit]

    def problem(
        self, joint: int | None, limits: str | None, derivatives: Array | None = None
    ) -> Problem:
        """The task at the printed digits, of one joint or of all, under stated or other limits.

        derivatives: (3, dof or 1), in place of the stated ones. Without either, nothing is limited but
        by a speed that nothing reaches.
        """
        if self.waypoints is None:
            raise InputError(f"{self.name}: prints no waypoints")
        w = self.waypoints if joint is None else self.waypoints[:, joint : joint + 1]
        dof = w.shape[1]
        bounds: Array = np.tile([-np.inf, np.inf], (dof, 1))
        if limits is not None:
            stated = self.stated[limits].of_joint(joint)
            bounds = stated.position
            if derivatives is None:
                derivatives = stated.derivatives
        if derivatives is None:
            derivatives = np.tile([[UNREACHED], [np.inf], [np.inf]], dof)
        velocity, acceleration, jerk = derivatives
        return Problem.of(
            w,
            Limits.of(velocity, acceleration, jerk, bounds, dof=dof),
            name=self.name,
            family=self.family,
            display_unit=self.unit,
        )

    def loosest(self, problem: Problem, joint: int | None, limits: str | None) -> Problem:
        """The same task under the highest limits that print like the stated ones.

        What breaks these breaks the stated limits for every reading of their digits.
        """
        if limits is None:
            return problem
        stated = self.stated[limits].of_joint(joint)
        position = problem.limits.position + stated.position_halves * [-1.0, 1.0]
        return with_limits(problem, problem.limits.derivatives + stated.derivative_halves, position)

    def tightest(self, problem: Problem, joint: int | None, limits: str | None) -> Problem:
        """The same task under the lowest limits of velocity, acceleration and jerk that print like the
        stated ones.

        What keeps these keeps the stated limits for every reading of their digits.
        """
        if limits is None:
            return problem
        stated = self.stated[limits].of_joint(joint)
        derivatives = problem.limits.derivatives - stated.derivative_halves
        return with_limits(problem, derivatives)

    def halves_of(self, joint: int | None) -> Array:
        """Half units of the waypoints of one joint or of all, (n, dof or 1) [rad]."""
        assert self.halves is not None
        return self.halves if joint is None else self.halves[:, joint : joint + 1]
