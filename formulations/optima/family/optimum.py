"""The optimum of a spline family: its exact nonlinear program, solved from one start or many.

``starts`` chooses the starts and ``exchange`` solves each. A local solver proves nothing: the best of
its solutions, once it has passed the independent check, is an upper bound.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice

import numpy as np

from formulations.deadlines import NEVER, Deadline
from formulations.deadlines.deadline import Stop
from formulations.families import FAMILIES
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.family.exchange import ConstraintExchange, Start, StartStatus
from formulations.optima.family.program import SHORTEST
from formulations.optima.family.starts import starting_durations
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, NoFeasibleMotion, NotFoundInTime
from formulations.problem.problem import Problem

MANY_STARTS, _COSTLY_STARTS = 14, 6  # by default; the second for B-splines
_AGREEING = 3  # starts that must agree before the rest of a B-spline's starts is left out


@dataclass(frozen=True)
class FamilyOptimum:
    """The best motion of all starts, judged by the independent check.

    Attributes
    ----------
    problem : Problem
        The problem that was solved.
    family : str
        Name of the spline family.
    durations : Array, shape (n_segments,) [s]
        The best durations.
    starts : tuple of Start
        How each start ended.
    """

    problem: Problem
    family: str
    durations: Array
    starts: tuple[Start, ...]

    @property
    def seconds(self) -> float:
        """Total time [s]."""
        return float(self.durations.sum())

    @cached_property
    def trajectory(self) -> Trajectory:
        """The motion itself."""
        return FAMILIES[self.family].trajectory(self.problem, self.durations)

    @cached_property
    def verdict(self) -> Verdict:
        """The verdict of the independent check."""
        return check(self.problem, self.trajectory)

    @property
    def stopped(self) -> bool:
        """Whether the time was over before all starts had ended."""
        return any(start.status is StartStatus.STOPPED for start in self.starts)

    @property
    def settled(self) -> bool:
        """Whether the best start ended in a local optimum, rather than for another reason."""
        best = min(self.starts, key=lambda start: start.seconds)
        return best.status is StartStatus.OK

    @property
    def agreeing_starts(self) -> int:
        """Number of starts that ended within 1e-7 of the best, relatively."""
        return sum(start.seconds <= self.seconds * (1.0 + 1e-7) for start in self.starts)

    @property
    def agreement(self) -> str:
        """How many starts there were and how many ended at the optimum, in words."""
        if len(self.starts) == 1:
            return "one start"
        return f"{self.agreeing_starts} of {len(self.starts)} starts agree"

    def __repr__(self) -> str:
        return f"FamilyOptimum({self.problem.name!r}: {self.seconds:.9g} s, family {self.family})"


def family_optimum(
    problem: Problem,
    *,
    family: str | None = None,
    starts: int | None = None,
    seed: int = 0,
    time_limit: float | None = None,
    stop: Stop | None = None,
    progress: Callable[[float], None] | None = None,
) -> FamilyOptimum:
    """Find the shortest total time of a family's splines, with durations shared by all joints.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    family : str, optional
        Name of the spline family; the problem's own by default.
    starts : int, optional
        Number of starts: the best of a random sample, two plain ones, at most three more from the
        sample, then random ratios of the durations. The default is 14, and 6 for B-splines.
    seed : int
        Seed of the sample and of the random ratios: the same seed gives the same answer.
    time_limit : float, optional [s]
        No start is begun after this time, and the one at hand ends with its best durations so far.
    stop : callable, optional
        Asked again and again whether to end now.
    progress : callable, optional
        Is called with the share of the starts that are done, in (0, 1].

    Returns
    -------
    FamilyOptimum
        The best motion found: an upper bound, not a proof.

    Raises
    ------
    UnsupportedProblem
        If the family has no spline for this problem.
    InputError
        If the number of starts is not positive.
    NoFeasibleMotion
        If no start ends within the position limits (a stretch mends all other limits).
    NotFoundInTime
        If none has done so when the time is over.
    """
    deadline = Deadline(time_limit, stop)
    if starts is not None and not starts >= 1:
        raise InputError(f"starts: {starts!r} is not a positive number of starts")
    chosen = FAMILIES[family or problem.family]
    chosen.require(problem)
    if not problem.moving_joints:
        durations = np.full(problem.n_segments, SHORTEST)
        still = Start(durations, float(durations.sum()), StartStatus.STILL, 0)
        return FamilyOptimum(problem, chosen.name, durations, (still,))
    exchange = ConstraintExchange(problem, chosen, deadline)
    # each knot pattern of a B-spline needs a program of its own, and distant starts have other patterns
    costly = bool(chosen.pattern(np.ones(problem.n_segments)))
    count = starts or (_COSTLY_STARTS if costly else MANY_STARTS)
    ended: list[Start] = []
    for guess in islice(starting_durations(problem, chosen, seed), count):
        ended.append(exchange.solve(guess))
        if progress is not None:
            progress(len(ended) / count)
        if deadline.over:
            break
        times = np.array([start.seconds for start in ended])
        agreeing = len(ended) == _AGREEING and times.max() <= times.min() * (1.0 + 1e-7)
        if costly and agreeing and np.isfinite(times).all():
            break
    best = min(ended, key=lambda start: start.seconds)
    if not np.isfinite(best.seconds):
        last = ended[-1]
        if deadline.over:
            raise NotFoundInTime(
                f"no {chosen.name} spline within the position limits was found in time"
            )
        raise NoFeasibleMotion(
            f"none of {len(ended)} starts ended in a {chosen.name} spline that keeps the position "
            f"limits; last status: {last.status}{f' ({last.reason})' if last.reason else ''}"
        )
    return best_of(problem, ended, family=chosen.name)


def best_of(problem: Problem, starts: Sequence[Start], *, family: str | None = None) -> FamilyOptimum:
    """Return the best of some starts.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    starts : sequence of Start
        How each ended; at least one.
    family : str, optional
        Name of the spline family; the problem's own by default.

    Returns
    -------
    FamilyOptimum
        Its durations are those of the shortest start.
    """
    best = min(starts, key=lambda start: start.seconds)
    return FamilyOptimum(problem, family or problem.family, best.durations, tuple(starts))


def local_optimum(
    problem: Problem, guess: Array, *, family: str | None = None, deadline: Deadline = NEVER
) -> Start:
    """Find the local optimum from one start.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    guess : Array, shape (n_segments,) [s]
        Positive durations of any shape.
    family : str, optional
        Name of the spline family; the problem's own by default.
    deadline : Deadline
        The solve ends with its best durations when it is over.

    Returns
    -------
    Start
        The best durations found, and how the solver ended.
    """
    return ConstraintExchange(problem, FAMILIES[family or problem.family], deadline).solve(guess)
