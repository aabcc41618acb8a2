"""One published time vector put back into its own spline: what it asks of the joints."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from compare.audit.findings import amount, number
from compare.audit.minima import impossible, minimum, with_limits
from compare.audit.paper import Paper, Row
from compare.audit.peaks import Peaks, peaks
from compare.audit.printed import halves, values
from compare.audit.ranged import Undecided
from formulations import FAMILIES, FamilyBound, Problem, Verdict, check
from formulations.motion.trajectory import QUANTITIES, TOLERANCE
from formulations.problem.arrays import Array

ROOTS = np.array([1.0, 0.5, 1.0 / 3.0])[:, None]  # a stretch by f divides derivative k by f^k


@dataclass(frozen=True)
class Motion:
    """A row of a paper as a motion. problem: its task at the printed digits, under stated limits."""

    paper: Paper
    row: Row
    problem: Problem

    @staticmethod
    def of(paper: Paper, row: Row) -> Motion:
        """The motion of a row; Undecided if a time may be nothing for all that its digits say."""
        for k, time in enumerate(row.times):
            if time.low <= 0.0:
                raise Undecided(f"the time of segment {k + 1} is printed as {time} s")
        return Motion(paper, row, paper.problem(row.joint, row.limits))

    @property
    def stated(self) -> bool:
        """Whether the paper states the limits it was made under."""
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
        """Least and greatest total time that the digits allow [s]; a total that fits narrows it."""
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
        """Peaks that no reading of the digits avoids, (3, dof) [rad/s^k]."""
        return np.stack([p.low for p in self.peaks], axis=1)

    @cached_property
    def most(self) -> Array:
        """Peaks that no reading of the digits exceeds, (3, dof) [rad/s^k]."""
        return np.stack([p.high for p in self.peaks], axis=1)

    @cached_property
    def stretch(self) -> tuple[float, float, float]:
        """Least factor on all times that keeps the limits: at least, at the printed digits, at most."""
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
        """Whether it keeps them for every reading."""
        return self.stated and self.stretch[2] <= 1.0 + TOLERANCE

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
        """Total time once stretched until the stated limits are kept [s]."""
        return self.total * max(self.verdict.stretch, 1.0)

    @cached_property
    def implied(self) -> Array:
        """The least limits that the motion keeps at the printed digits, (3, dof) [rad/s^k].

        Infinite where the paper limits nothing or nothing moves.
        """
        printed = np.stack([p.printed for p in self.peaks], axis=1) * (1.0 + 1e-12)
        limited = np.array([[quantity in self.paper.limited] for quantity in QUANTITIES[1:]])
        return np.where(np.logical_and(limited, printed > 0.0), printed, np.inf)

    @cached_property
    def rounded(self) -> Array:
        """The same, raised to two significant digits of the paper's unit: numbers people choose."""
        return round_up(self.least, self.implied, self.paper.angle)

    @cached_property
    def implied_optimum(self) -> FamilyBound:
        """The certified optimum under the limits the motion implies."""
        return minimum(with_limits(self.problem, self.implied))

    @property
    def implied_gap(self) -> float:
        """How far above that optimum the motion is: 0 if it is the optimum of any limits at all."""
        upper = self.implied_optimum.upper
        return self.total / upper - 1.0 if upper > 0.0 else float("inf")


def round_up(least: Array, implied: Array, unit: float) -> Array:
    """Limits raised to the next two-digit number of a unit that some reading of the digits keeps."""
    shown = np.where(np.isfinite(implied), least / unit, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        step = 10.0 ** (np.floor(np.log10(shown)) - 1.0)
        raised = np.ceil(shown / step - 1e-9) * step * unit
    return np.where(np.isfinite(raised), raised, implied)


def joint_of(motion: Motion, j: int) -> int:
    """Number of a joint in its paper, from 1."""
    return (motion.row.joint if motion.row.joint is not None else j) + 1


def limits_told(motion: Motion, limits: Array) -> str:
    """Limits (3, dof) for people: velocity 55 deg/s and acceleration 60 deg/s^2."""
    told = []
    for order in range(3):
        row = [float(v) for v in limits[order] if np.isfinite(v)]
        if row:
            shown = " / ".join(number(v / motion.paper.angle) for v in row[:-1])
            last = amount(motion.paper, row[-1], order + 1)
            told.append(f"{QUANTITIES[order + 1]} {shown}{' / ' if shown else ''}{last}")
    return " and ".join(told)
