"""What an instance is like: numbers beside which the success of a swarm can be read."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from compare.benchmark.objective import Objective, search_box
from formulations import FamilyOptimum, Problem, Trajectory
from formulations.optima.family.exchange import StartStatus
from formulations.problem.arrays import Array

_ACTIVE = 1e-6  # relative distance from a limit at which it is reached
_SAME_TIME, _SAME_SHAPE = 1e-6, 1e-3  # relative; two starts end in one basin
_LEVEL = 1e-2  # relative height of the level set above the optimum
_DIRECTIONS, _ROUNDS, _HALVINGS = 64, 12, 30


@dataclass(frozen=True, slots=True)
class Features:
    """What an instance is like.

    Attributes
    ----------
    dimension : int
        Number of segments, the coordinates of a search.
    joints : int
        Number of joints that move.
    active : int
        Number of limits that the optimum reaches: pairs of a piece and a joint's limit.
    basins : int
        Number of distinct local optima that the local solver found.
    starts : int
        Number of starts that ended in a local optimum.
    conditioning : float or None
        Logarithm to base 10 of the condition number of the set of candidates within 1 % of the
        optimum, in the stretched coding, across the ray of equal shapes. None in one dimension.
    """

    dimension: int
    joints: int
    active: int
    basins: int
    starts: int
    conditioning: float | None


def features_of(problem: Problem, optimum: FamilyOptimum) -> Features:
    """Compute the features of an instance.

    Parameters
    ----------
    problem : Problem
    optimum : FamilyOptimum
        With all of its starts.

    Returns
    -------
    Features
    """
    good = [s for s in optimum.starts if s.status in (StartStatus.OK, StartStatus.ACCEPTED)]
    return Features(
        dimension=problem.n_segments,
        joints=len(problem.moving_joints),
        active=active_limits(problem, optimum.trajectory),
        basins=count_basins([start.durations for start in good if np.isfinite(start.seconds)]),
        starts=len(good),
        conditioning=conditioning(problem, optimum.durations),
    )


def active_limits(problem: Problem, motion: Trajectory) -> int:
    """Count the limits that a motion reaches, piece by piece and joint by joint.

    Parameters
    ----------
    problem : Problem
    motion : Trajectory

    Returns
    -------
    int
        A position limit on which a waypoint lies does not count in the pieces that end there.
    """
    found = 0
    for order, limit in enumerate(problem.limits.derivatives, 1):
        extremes = motion.extremes(order)
        found += int((np.maximum(-extremes.low, extremes.high) >= limit * (1.0 - _ACTIVE)).sum())
    extremes, bounds = motion.extremes(0), problem.position_bounds
    ends = motion.at(motion.breaks)
    near = _ACTIVE * np.ptp(problem.waypoints, axis=0)
    for side, extreme, sign in ((0, extremes.low, 1.0), (1, extremes.high, -1.0)):
        reached = sign * (extreme - bounds[:, side]) <= near
        at_ends = sign * (ends - bounds[:, side]) <= near
        found += int((reached & ~at_ends[:-1] & ~at_ends[1:]).sum())
    return found


def count_basins(optima: list[Array]) -> int:
    """Count distinct local optima.

    Parameters
    ----------
    optima : list of Array, shape (n_segments,) [s]
        Durations at which the starts ended.

    Returns
    -------
    int
    """
    distinct: list[Array] = []
    for durations in optima:
        total = durations.sum()
        if not any(
            abs(total / other.sum() - 1.0) <= _SAME_TIME
            and np.abs(durations - other).max() <= _SAME_SHAPE * total
            for other in distinct
        ):
            distinct.append(durations)
    return len(distinct)


def conditioning(problem: Problem, optimum: Array) -> float | None:
    """Measure how stretched the set of good candidates is.

    The set has corners, so it has no Hessian. Points on its rim are found along random directions, an
    ellipsoid is fitted to them, and the directions are drawn again in the ellipsoid's own axes until
    both have one shape, as in the rounding of convex bodies.

    Parameters
    ----------
    problem : Problem
    optimum : Array, shape (n_segments,) [s]

    Returns
    -------
    float or None
        Logarithm to base 10 of the ratio of the greatest to the least squared half-axis.
    """
    n = problem.n_segments
    if n < 2:
        return None
    objective = Objective(problem, stretch=True)
    least, most = search_box(problem)[0], optimum.sum()
    # the stretched time is the same along a ray, so only directions across it count
    across = np.linalg.svd(optimum[None])[2][1:]
    level = float(objective(optimum[None].repeat(2, axis=0))[0]) * (1.0 + _LEVEL)
    rng, axes = np.random.default_rng(0), np.eye(n - 1) * most
    for _ in range(_ROUNDS):
        directions = rng.standard_normal((_DIRECTIONS * n, n - 1))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        steps = directions @ axes.T
        low, high = np.zeros(len(steps)), np.full(len(steps), 2.0)
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            x = np.maximum(optimum + (middle[:, None] * steps) @ across, least)
            inside = objective(x) <= level
            low, high = np.where(inside, middle, low), np.where(inside, high, middle)
        rim = low[:, None] * steps
        values, vectors = np.linalg.eigh(rim.T @ rim / len(rim))
        axes = vectors * np.sqrt(np.maximum(values * (n - 1), 1e-30))
    values = np.square(np.linalg.norm(axes, axis=0))
    return round(float(np.log10(values.max() / values.min())), 2)
