"""Limits as a paper states them, and the loosest and the tightest limits that print alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations import Limits, Problem
from formulations.problem.arrays import Array

UNREACHED = 1e9
"""Velocity limit [rad/s] that no motion reaches: a problem must have one."""


@dataclass(frozen=True)
class StatedLimits:
    """The limits of one table.

    Attributes
    ----------
    name : str
        The table, as the paper calls it.
    joint : int or None
        The joint that they hold for, from 0; None for all of them.
    derivatives : Array, shape (3, dof or 1) [rad/s, rad/s^2, rad/s^3]
        Velocity, acceleration, jerk; inf where there is no limit.
    position : Array, shape (dof or 1, 2) [rad]
        Lower and upper limits.
    derivative_halves, position_halves : Array, of the same shapes
        Half a unit of the last printed digit; 0 where a number is exact.
    unit : str
        Of the angles, as printed: rad or deg.
    """

    name: str
    joint: int | None
    derivatives: Array
    position: Array
    derivative_halves: Array
    position_halves: Array
    unit: str = "rad"

    def of_joint(self, joint: int | None) -> StatedLimits:
        """Select the limits of one joint of the arm.

        Parameters
        ----------
        joint : int or None
            From 0; None for all joints.

        Returns
        -------
        StatedLimits
        """
        if joint is None or self.joint is not None:
            return self
        one = slice(joint, joint + 1)
        return StatedLimits(
            self.name,
            joint,
            self.derivatives[:, one],
            self.position[one],
            self.derivative_halves[:, one],
            self.position_halves[one],
            self.unit,
        )

    def loosest(self, problem: Problem) -> Problem:
        """Raise the limits of a task to the highest ones that print alike.

        A motion that breaks these breaks the stated limits for every reading of their digits.

        Parameters
        ----------
        problem : Problem
            A task under these limits at the printed digits.

        Returns
        -------
        Problem
        """
        position = problem.limits.position + self.position_halves * [-1.0, 1.0]
        return with_limits(problem, problem.limits.derivatives + self.derivative_halves, position)

    def tightest(self, problem: Problem) -> Problem:
        """Lower the velocity, acceleration and jerk limits of a task to the lowest that print alike.

        A motion that keeps these keeps the stated ones for every reading of their digits.

        Parameters
        ----------
        problem : Problem
            A task under these limits at the printed digits.

        Returns
        -------
        Problem
        """
        return with_limits(problem, problem.limits.derivatives - self.derivative_halves)


def with_limits(problem: Problem, derivatives: Array, position: Array | None = None) -> Problem:
    """Pose the same task under other limits.

    Parameters
    ----------
    problem : Problem
        The task.
    derivatives : Array, shape (3, dof) [rad/s, rad/s^2, rad/s^3]
        Velocity, acceleration, jerk; inf where there is no limit.
    position : Array, shape (dof, 2), optional [rad]
        Without it the problem's own limits of position stay.

    Returns
    -------
    Problem
    """
    problem.require_plain("the audit")
    velocity, acceleration, jerk = derivatives
    velocity = np.where(np.isfinite(velocity), velocity, UNREACHED)
    bounds = problem.limits.position if position is None else position
    limits = Limits.of(velocity, acceleration, jerk, bounds, dof=problem.dof)
    return Problem.of(
        problem.waypoints, limits, name=problem.name, family=problem.family,
        title=problem.title, display_unit=problem.display_unit,
    )  # fmt: skip
