"""The optimum of a spline family: its exact nonlinear program from many starts.

Two plain starts, the best of many random shapes as the compiled kernel sees them, and random ones
(``exchange`` solves each). A local solver proves nothing: the best of its starts is an upper bound.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from formulations.families import FAMILIES, Family
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.family.nlp import SHORTEST, Exchange, Start, shortest_segments
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, NoFeasibleMotion
from formulations.problem.problem import Problem

_SAMPLE, _NICHES, _APART = 8192, 4, 0.7  # shapes looked at, starts made of them, their log distance
_AGREEING = 3  # starts that end alike and make more of a dear family needless


@dataclass(frozen=True)
class FamilyOptimum:
    """The best of all starts, judged by the independent check. durations: (n_segments,) [s]."""

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
        """What the independent check says of it."""
        return check(self.problem, self.trajectory)

    @property
    def agreeing_starts(self) -> int:
        """Number of starts that ended within 1e-7 of the best."""
        return sum(start.seconds <= self.seconds * (1.0 + 1e-7) for start in self.starts)


def family_optimum(
    problem: Problem,
    *,
    family: str | None = None,
    random_starts: int | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> FamilyOptimum:
    """Shortest total time of a family's splines for durations shared by all joints.

    family: the problem's own if left out. random_starts: beside the two plain and four promising ones;
    8 if left out, none for B-splines. Raises UnsupportedProblem where the family has no spline,
    NoFeasibleMotion if no start ends feasible (position limits only; all others yield to a stretch).
    """
    chosen = FAMILIES[family or problem.family]
    chosen.require(problem)
    if not problem.moving_joints:
        durations = np.full(problem.n_segments, SHORTEST)
        still = Start(durations, float(durations.sum()), "nothing moves", 0)
        return FamilyOptimum(problem, chosen.name, durations, (still,))
    exchange = Exchange(problem, chosen)
    starts = []
    dear = bool(chosen.pattern(np.ones(problem.n_segments)))
    if random_starts is None:
        # a program per pattern of knots is dear, and starts far away have patterns of their own
        random_starts = 0 if dear else 8
    guesses = _guesses(problem, chosen, random_starts, seed)
    for index, guess in enumerate(guesses):
        starts.append(exchange.solve(guess))
        if progress is not None:
            progress((index + 1) / len(guesses))
        times = np.array([start.seconds for start in starts])
        if dear and len(starts) == _AGREEING and np.ptp(times) <= 1e-7 * times.min():
            break
    best = min(starts, key=lambda start: start.seconds)
    if not np.isfinite(best.seconds):
        raise NoFeasibleMotion(
            f"none of {len(starts)} starts ended in a {chosen.name} spline that keeps the position "
            f"limits; last status: {starts[-1].status}"
        )
    return FamilyOptimum(problem, chosen.name, best.durations, tuple(starts))


def polished(problem: Problem, guess: Array, *, family: str | None = None) -> Start:
    """The local optimum from one start, durations (n_segments,) [s] of any shape."""
    return Exchange(problem, FAMILIES[family or problem.family]).solve(guess)


def each_joint_alone(
    problem: Problem, *, random_starts: int | None = None, seed: int = 0
) -> tuple[FamilyOptimum | None, ...]:
    """The optimum of every joint by itself, as the papers plan; None for joints that do not move."""
    return tuple(
        family_optimum(problem.joint(j), random_starts=random_starts, seed=seed)
        if j in problem.moving_joints
        else None
        for j in range(problem.dof)
    )


@dataclass(frozen=True)
class LongestSegment:
    """The papers' rule (000 sec. 2.2; 001 sec. 3; 002 sec. 5.2): longest time per segment.

    claimed: (n_segments,) [s], the durations the rule gives. stretch: the least factor on them that
    keeps the limits; above 1 the rule's own motion breaks them. position_excess: rad outside the
    position limits, which no stretch mends.
    """

    claimed: Array
    stretch: float
    position_excess: float

    @property
    def durations(self) -> Array:
        """Durations stretched to feasibility, as claimed if they are feasible, (n_segments,) [s]."""
        return self.claimed * max(self.stretch, 1.0)


def longest_segment(problem: Problem, per_joint: list[Array]) -> LongestSegment:
    """Apply the rule to the durations of single joints, each (n_segments,) [s]."""
    if not per_joint:
        raise InputError("longest_segment: no joint moves")
    claimed = np.max(per_joint, axis=0)
    chosen = FAMILIES[problem.family]
    return LongestSegment(
        claimed=claimed,
        stretch=float(chosen.stretch(problem, claimed[None])[0]),
        position_excess=float(chosen.position_excess(problem, claimed[None])[0]),
    )


def _guesses(problem: Problem, family: Family, random_starts: int, seed: int) -> list[Array]:
    """Starts: displacement times, their geometric mean with the longest, random ratios, and the best
    shapes among many: a narrow basin is seen by the compiled kernel for next to nothing.
    """
    shortest = shortest_segments(problem)
    scale = np.maximum(shortest, 1e-2 * shortest.max())
    rng = np.random.default_rng(seed)
    ratios = rng.uniform(np.log(0.1), np.log(10.0), (random_starts, len(scale)))
    plain = [scale, np.sqrt(scale * scale.max()), *(scale * np.exp(row) for row in ratios)]
    promising = _promising(problem, family, plain[0], rng)
    return [plain[0], *promising[:1], *plain[1:], *promising[1:]]


def _promising(problem: Problem, family: Family, first: Array, rng: np.random.Generator) -> list[Array]:
    """The best shapes of a random sample, at most ``_NICHES``, each in a neighbourhood of its own."""
    upper = float(first.sum() * family.stretch(problem, first[None])[0])
    lower = np.maximum(shortest_segments(problem), 1e-7 * upper)
    span = np.log(upper / np.minimum(lower, 0.5 * upper))
    shapes = upper * np.exp(-span * rng.random((_SAMPLE, problem.n_segments)))
    # half of the sample halves in size round by round about the best of what is known
    for radius in (1.0, 0.3, 0.1):
        best = shapes[_ranked(problem, family, shapes)[: 2 * _NICHES]]
        if not len(best):
            return []
        near = best[rng.integers(len(best), size=_SAMPLE // 4)]
        steps = np.exp(radius * rng.normal(size=near.shape))
        shapes = np.concatenate([shapes, near * steps])
    niches: list[Array] = []
    for shape in shapes[_ranked(problem, family, shapes)]:
        ratios = np.log(shape / shape.sum())
        if all(np.abs(ratios - np.log(n / n.sum())).max() > _APART for n in niches):
            niches.append(shape)
            if len(niches) == _NICHES:
                break
    return niches


def _ranked(problem: Problem, family: Family, shapes: Array) -> NDArray[np.intp]:
    """Indices of the feasible shapes, best first."""
    seconds = shapes.sum(axis=1) * family.stretch(problem, shapes)
    seconds[family.position_excess(problem, shapes) > 0.0] = np.inf
    order = np.argsort(seconds, kind="stable")
    return np.asarray(order[np.isfinite(seconds[order])])
