"""The optimum of a spline family: its exact nonlinear program, solved from many starts.

``starts`` chooses the starts and ``exchange`` solves each. A local solver proves nothing: the best of
its solutions, once it has passed the independent check, is an upper bound.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

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
from formulations.problem.errors import NoFeasibleMotion, NotFoundInTime
from formulations.problem.problem import Problem

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
    def agreeing_starts(self) -> int:
        """Number of starts that ended within 1e-7 of the best, relatively."""
        return sum(start.seconds <= self.seconds * (1.0 + 1e-7) for start in self.starts)

    def __repr__(self) -> str:
        return f"FamilyOptimum({self.problem.name!r}: {self.seconds:.9g} s, family {self.family})"


def family_optimum(
    problem: Problem,
    *,
    family: str | None = None,
    random_starts: int | None = None,
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
    random_starts : int, optional
        Starts with random ratios of the durations, beside two plain starts and four from a random
        sample. The default is 8, and none for B-splines.
    seed : int
        Seed of the random starts: the same seed gives the same answer.
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
    NoFeasibleMotion
        If no start ends within the position limits (a stretch mends all other limits).
    NotFoundInTime
        If none has done so when the time is over.
    """
    deadline = Deadline(time_limit, stop)
    chosen = FAMILIES[family or problem.family]
    chosen.require(problem)
    if not problem.moving_joints:
        durations = np.full(problem.n_segments, SHORTEST)
        still = Start(durations, float(durations.sum()), StartStatus.STILL, 0)
        return FamilyOptimum(problem, chosen.name, durations, (still,))
    exchange = ConstraintExchange(problem, chosen, deadline)
    starts: list[Start] = []
    # each knot pattern of a B-spline needs a program of its own, and distant starts have other patterns
    costly = bool(chosen.pattern(np.ones(problem.n_segments)))
    if random_starts is None:
        random_starts = 0 if costly else 8
    guesses = starting_durations(problem, chosen, random_starts, seed)
    for index, guess in enumerate(guesses):
        starts.append(exchange.solve(guess))
        if progress is not None:
            progress((index + 1) / len(guesses))
        if deadline.over:
            break
        times = np.array([start.seconds for start in starts])
        if costly and len(starts) == _AGREEING and np.ptp(times) <= 1e-7 * times.min():
            break
    best = min(starts, key=lambda start: start.seconds)
    if not np.isfinite(best.seconds):
        last = starts[-1]
        if deadline.over:
            raise NotFoundInTime(
                f"no {chosen.name} spline within the position limits was found in time"
            )
        raise NoFeasibleMotion(
            f"none of {len(starts)} starts ended in a {chosen.name} spline that keeps the position "
            f"limits; last status: {last.status}{f' ({last.reason})' if last.reason else ''}"
        )
    return FamilyOptimum(problem, chosen.name, best.durations, tuple(starts))


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


def each_joint_alone(
    problem: Problem,
    *,
    random_starts: int | None = None,
    seed: int = 0,
    time_limit: float | None = None,
    stop: Stop | None = None,
) -> tuple[FamilyOptimum | None, ...]:
    """Find the optimum of every joint by itself, as the papers plan.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits of all joints.
    random_starts, seed : int
        As in ``family_optimum``.
    time_limit, stop : optional
        As in ``family_optimum``, for all joints together.

    Returns
    -------
    tuple of (FamilyOptimum or None), length dof
        None for a joint that does not move.
    """
    deadline = Deadline(time_limit, stop)
    return tuple(
        family_optimum(
            problem.joint(j),
            random_starts=random_starts,
            seed=seed,
            time_limit=deadline.left,
            stop=stop,
        )
        if j in problem.moving_joints
        else None
        for j in range(problem.dof)
    )
