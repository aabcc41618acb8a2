"""A printed time vector put back into the paper's own spline: its peaks, and whether they keep the limits."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np

from compare.audit.motion.minima import impossible, minimum
from compare.audit.motion.peaks import Peaks, peaks
from compare.audit.motion.ranged import Undecided
from compare.audit.paper import Paper, PrintedTimes, with_limits
from compare.audit.paper.digits import halves, values
from compare.audit.paper.words import amount, number
from formulations import FAMILIES, FamilyBound, Problem, Verdict, check
from formulations.motion.verdict import QUANTITIES, TOLERANCE
from formulations.problem.arrays import Array


class Kept(StrEnum):
    """Whether a motion keeps its stated limits; the value is the word that people read."""

    YES = "yes"
    NO = "no"
    WITHIN_ROUNDING = "within rounding"
    NO_LIMITS = "no limits"


ROOTS = np.array([1.0, 0.5, 1.0 / 3.0])[:, None]  # a stretch by f divides derivative k by f^k


@dataclass(frozen=True)
class PrintedMotion:
    """A printed time vector as a motion.

    Attributes
    ----------
    paper : Paper
    row : PrintedTimes
        The time vector.
    problem : Problem
        The task at the printed digits, under the stated limits.
    """

    paper: Paper
    row: PrintedTimes
    problem: Problem

    @staticmethod
    def of(paper: Paper, row: PrintedTimes) -> PrintedMotion:
        """Make the motion of a time vector.

        Parameters
        ----------
        paper : Paper
            What the paper prints.
        row : PrintedTimes
            The time vector.

        Returns
        -------
        PrintedMotion

        Raises
        ------
        Undecided
            If the digits of a time do not exclude zero.
        """
        for k, time in enumerate(row.times):
            if time.low <= 0.0:
                raise Undecided(f"the time of segment {k + 1} is printed as {time} s")
        return PrintedMotion(paper, row, paper.problem(row.joint, row.limits))

    @property
    def stated(self) -> bool:
        """Whether the paper states limits for this vector."""
        return self.row.limits is not None

    @cached_property
    def loosest(self) -> Problem:
        """The task under the highest limits that print like the stated ones."""
        return self.paper.loosest(self.problem, self.row.joint, self.row.limits)

    @cached_property
    def tightest(self) -> Problem:
        """The task under the lowest limits that print like the stated ones."""
        return self.paper.tightest(self.problem, self.row.joint, self.row.limits)

    @cached_property
    def times(self) -> Array:
        """Durations as printed, (n_segments,) [s]."""
        return values(self.row.times)

    @property
    def halves(self) -> Array:
        """Half units of the waypoints, (n_waypoints, dof) [rad]."""
        return self.paper.halves_of(self.row.joint)

    @cached_property
    def seconds(self) -> tuple[float, float]:
        """Least and greatest total time that the digits allow [s]. A printed total that fits narrows them."""
        low, high = sum(t.low for t in self.row.times), sum(t.high for t in self.row.times)
        total = self.row.total
        if total is not None and max(low, total.low) <= min(high, total.high):
            low, high = max(low, total.low), min(high, total.high)
        return low, high

    @property
    def total(self) -> float:
        """Sum of the durations as printed [s]."""
        return float(self.times.sum())

    @cached_property
    def verdict(self) -> Verdict:
        """What the independent check says at the printed digits."""
        return check(self.problem, FAMILIES[self.problem.family].trajectory(self.problem, self.times))

    @cached_property
    def peaks(self) -> list[Peaks]:
        """Peaks of every joint, at the printed digits and over every reading of them."""
        time_halves = halves(self.row.times)
        return [
            peaks(self.problem, j, self.halves, self.times, time_halves)
            for j in range(self.problem.dof)
        ]

    @cached_property
    def least(self) -> Array:
        """Least peak over all readings of the digits, (3, dof) [rad/s^k]."""
        return np.stack([p.low for p in self.peaks], axis=1)

    @cached_property
    def most(self) -> Array:
        """Greatest peak over all readings of the digits, (3, dof) [rad/s^k]."""
        return np.stack([p.high for p in self.peaks], axis=1)

    @cached_property
    def stretch(self) -> tuple[float, float, float]:
        """Least factor on all times that keeps the limits: its lowest, printed and highest reading."""
        high, low = self.loosest.limits.derivatives, self.tightest.limits.derivatives
        least = float(((self.least / high) ** ROOTS).max())
        return least, self.verdict.stretch, float(((self.most / low) ** ROOTS).max())

    @property
    def breaks(self) -> bool:
        """Whether the motion breaks the stated limits for every reading of the digits."""
        if not self.stated or self.verdict.stretch <= 1.0 + TOLERANCE:
            return False
        return self.stretch[0] > 1.0 + TOLERANCE

    @property
    def keeps(self) -> bool:
        """Whether it keeps the stated limits for every reading of the digits."""
        return self.stated and self.stretch[2] <= 1.0 + TOLERANCE

    @property
    def kept(self) -> Kept:
        """Whether it keeps the stated limits: for every reading, for some, for none."""
        if not self.stated:
            return Kept.NO_LIMITS
        if self.breaks:
            return Kept.NO
        return Kept.YES if self.keeps else Kept.WITHIN_ROUNDING

    @cached_property
    def impossible(self) -> bool:
        """Whether it is proved that no durations of this total keep the stated limits."""
        return self.breaks and impossible(self.loosest, self.halves, self.seconds[1])

    @cached_property
    def optimum(self) -> FamilyBound | None:
        """The certified optimum under the stated limits."""
        return minimum(self.problem) if self.stated else None

    @property
    def honest(self) -> float:
        """Total time after the motion is slowed down until it keeps the stated limits [s]."""
        return self.total * max(self.verdict.stretch, 1.0)

    @cached_property
    def implied(self) -> Array:
        """Lowest limits that the motion keeps at the printed digits, (3, dof) [rad/s^k].

        They are infinite for a derivative that the paper does not limit, and for a joint that rests.
        """
        printed = np.stack([p.printed for p in self.peaks], axis=1) * (1.0 + 1e-12)
        limited = np.array([[quantity in self.paper.limited] for quantity in QUANTITIES[1:]])
        return np.where(np.logical_and(limited, printed > 0.0), printed, np.inf)

    @cached_property
    def rounded(self) -> Array:
        """The same, raised to two significant digits of the paper's unit, as people choose limits."""
        return _rounded_up(self.least, self.implied, self.paper.angle)

    @cached_property
    def implied_optimum(self) -> FamilyBound:
        """The certified optimum under the limits ``implied``."""
        return minimum(with_limits(self.problem, self.implied))

    @property
    def implied_gap(self) -> float:
        """Total time over that optimum, minus 1: 0 if the motion is the optimum of any limits at all."""
        upper = self.implied_optimum.upper
        return self.total / upper - 1.0 if upper > 0.0 else float("inf")


def _rounded_up(least: Array, implied: Array, unit: float) -> Array:
    """Raise limits to the next number of two digits that some reading of the print keeps."""
    shown = np.where(np.isfinite(implied), least / unit, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        step = 10.0 ** (np.floor(np.log10(shown)) - 1.0)
        raised = np.ceil(shown / step - 1e-9) * step * unit
    return np.where(np.isfinite(raised), raised, implied)


def joint_of(motion: PrintedMotion, j: int) -> int:
    """Number of a joint in the paper.

    Parameters
    ----------
    motion : PrintedMotion
        The motion to judge.
    j : int
        The joint within the motion, from 0.

    Returns
    -------
    int
        From 1.
    """
    return (motion.row.joint if motion.row.joint is not None else j) + 1


def limits_told(motion: PrintedMotion, limits: Array) -> str:
    """Write limits for people: velocity 55 deg/s and acceleration 60 deg/s^2.

    Parameters
    ----------
    motion : PrintedMotion
        Gives the unit.
    limits : Array, shape (3, dof) [rad/s, rad/s^2, rad/s^3]
        Velocity, acceleration, jerk.

    Returns
    -------
    str
    """
    told = []
    for order in range(3):
        row = [float(v) for v in limits[order] if np.isfinite(v)]
        if row:
            shown = " / ".join(number(v / motion.paper.angle) for v in row[:-1])
            last = amount(motion.paper, row[-1], order + 1)
            told.append(f"{QUANTITIES[order + 1]} {shown}{' / ' if shown else ''}{last}")
    return " and ".join(told)
