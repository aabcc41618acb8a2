"""Exchange method: solve the program, pose its constraints again at the extremes of the solution, repeat.

The limits hold at every instant, so the program is a semi-infinite one (``program`` states it). The
exchange replaces them by constraints at finitely many places, and moves the places until they no longer
change. A trust region in log T keeps each step near the spline whose extremes are posed.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from formulations.deadlines import NEVER, Deadline
from formulations.families import Family
from formulations.optima.family.program import NO_RADIUS, PosedProgram, touches
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

_FIXED_EXCHANGES = 3  # exchanges before the posed places follow their extremes
_EXCHANGES = 40  # exchanges before a start is given up as not converged
_LEAST_RADIUS = 1e-9  # of the trust region, in log T: below it no step is left
_CONVERGED = 1e-10  # relative excess of the exact peaks over the posed ones


class StartStatus(StrEnum):
    """How the local solver ended from one start."""

    OK = "ok"  # a local optimum
    ACCEPTED = "accepted"  # the places stay where they are, but IPOPT missed its tolerance
    NOT_CONVERGED = "not converged"  # the number of exchanges is used up
    NOT_FINITE = "not finite"  # the start or the solution leaves the range of floats
    STEP_VANISHED = "step vanished"  # the trust region has shrunk to nothing
    STOPPED = "stopped at the deadline"
    STILL = "nothing moves"


@dataclass(frozen=True)
class Start:
    """One start of the local solver.

    Attributes
    ----------
    durations : Array, shape (n_segments,) [s]
        The best durations found, stretched to feasibility.
    seconds : float [s]
        Their total; infinite if they leave the position limits.
    status : StartStatus
        How the solver ended.
    exchanges : int
        Number of programs solved.
    reason : str
        IPOPT's or CasADi's own word, if there is one.
    """

    durations: Array
    seconds: float
    status: StartStatus
    exchanges: int
    reason: str = ""


class ConstraintExchange:
    """The exchange method for one problem and family; it keeps the compiled programs between starts."""

    def __init__(self, problem: Problem, family: Family, deadline: Deadline = NEVER) -> None:
        self.problem, self.family, self.deadline = problem, family, deadline
        self._programs: dict[tuple[int, ...], PosedProgram] = {}
        # joints whose position limits are posed: few joints come near theirs, and these constraints
        # cost the most
        self._bounded = {j for j in problem.moving_joints if _rests_on_a_limit(problem, j)}

    def solve(self, guess: Array) -> Start:
        """Find the local optimum from one start.

        Each iterate is stretched to feasibility. An iterate that is not faster is rejected and the
        trust region shrinks, because constraints posed at the extremes of one spline say little about
        splines far away. No failure of the solver raises: it is a status.

        Parameters
        ----------
        guess : Array, shape (n_segments,) [s]
            Positive durations of any shape.

        Returns
        -------
        Start
            The best durations found, and how the solver ended.
        """
        with np.errstate(all="ignore"):  # what overflows is not finite, and that is a status
            return self._solve(guess)

    def _solve(self, guess: Array) -> Start:
        centre = self._stretched(guess)
        if not _usable(centre):
            reason = "no stretch of the start keeps the limits"
            return Start(guess, np.inf, StartStatus.NOT_FINITE, 0, reason)
        shortest = self._seconds(centre)
        radius, follow = NO_RADIUS, False
        status, reason = StartStatus.NOT_CONVERGED, ""
        for exchange in range(1, _EXCHANGES + 1):
            solved, outcome = self._program(centre).solve(centre, radius, follow, self.deadline)
            if not np.isfinite(solved).all():
                return Start(centre, shortest, StartStatus.NOT_FINITE, exchange, outcome)
            step = float(np.abs(np.log(solved / centre)).max())
            found = self._stretched(solved)
            if leaving := self._leaving(found) - self._bounded:
                self._bounded |= leaving
                self._programs.clear()
                continue
            seconds = self._seconds(found)
            # the posed constraints were all that matter, and the trust region did not bind
            exact = abs(found.sum() / solved.sum() - 1.0) <= _CONVERGED and step < 0.999 * radius
            exact = exact and self.family.pattern(solved) == self.family.pattern(centre)
            settled = exact and seconds <= shortest * (1.0 + _CONVERGED) and np.isfinite(seconds)
            if seconds < shortest or not np.isfinite(shortest):
                centre, shortest = found, seconds
                radius = min(2.0 * radius, NO_RADIUS)
            elif not settled:
                radius, follow = 0.25 * min(radius, step), True
            if self.deadline.over:
                status, reason = StartStatus.STOPPED, outcome
                break
            if settled:
                solver_converged = outcome == "Solve_Succeeded"
                status = StartStatus.OK if solver_converged else StartStatus.ACCEPTED
                reason = "" if solver_converged else outcome
                break
            if radius < _LEAST_RADIUS:
                status, reason = StartStatus.STEP_VANISHED, outcome
                break
            follow = follow or exchange >= _FIXED_EXCHANGES
        return Start(centre, shortest, status, exchange, reason)

    def _seconds(self, durations: Array) -> float:
        """Total time [s]; infinite if the spline leaves the position limits."""
        excess = self.family.position_excess(self.problem, durations[None])[0]
        return float(durations.sum()) if excess <= self.problem.position_slack else np.inf

    def _leaving(self, durations: Array) -> set[int]:
        """Joints that leave their position limits."""
        excess = self.family.position_excess(self.problem, durations[None])[0]
        if excess <= 0.0 or not _usable(durations):
            return set()
        try:
            positions = self.family.trajectory(self.problem, durations).extremes(0)
        except np.linalg.LinAlgError:  # the coefficients leave the range of floats
            return set()
        low, high = self.problem.position_bounds.T
        outside = (positions.low.min(axis=0) < low) | (positions.high.max(axis=0) > high)
        return set(np.flatnonzero(outside).tolist())

    def _stretched(self, durations: Array) -> Array:
        """Durations times the least factor that keeps the derivative limits."""
        return np.asarray(durations * self.family.stretch(self.problem, durations[None])[0])

    def _program(self, durations: Array) -> PosedProgram:
        """The program of the knot pattern that the durations have."""
        pattern = self.family.pattern(durations)
        if pattern not in self._programs:
            self._programs[pattern] = PosedProgram(self.problem, self.family, durations, self._bounded)
        return self._programs[pattern]


def _usable(durations: Array) -> bool:
    """Whether all durations and their total are positive and finite."""
    return bool((durations > 0.0).all() and np.isfinite(durations.sum()))


def _rests_on_a_limit(problem: Problem, j: int) -> bool:
    """Whether a joint starts or ends on a position limit."""
    ends = problem.waypoints[[0, -1], j].tolist()
    return any(touches(x, bound) for x in ends for bound in problem.position_bounds[j].tolist())
