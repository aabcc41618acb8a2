"""Lower bounds in closed form, which need no solver.

The bounds from the displacements and from end to end are in ``proofs.displacement`` and
``proofs.rest_to_rest``. Segment: each segment by itself, the first from rest, the last to rest, the
others at top speed.

Each formula is a few sums and products of positive numbers, with a relative rounding error of at most
1e-14, and is continuous across its cases. ``SAFE`` is far larger.
"""

from __future__ import annotations

import math

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.relaxation.legs import down
from formulations.proofs.every_motion.relaxation.relaxed_problem import DOWN, RelaxedProblem
from formulations.proofs.rest_to_rest import end_to_end_bound, rest_to_rest

SAFE = 1e-12


def least_durations(problem: Problem) -> Array:
    """Compute what each segment takes at least, by itself.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    Array, shape (n_segments,) [s]
    """
    each = (np.abs(problem.displacements) / problem.limits.velocity).max(axis=1)
    if problem.n_segments == 1:
        return np.array([end_to_end_bound(problem)])
    for k in {0, problem.n_segments - 1}:
        for j, d in enumerate(np.abs(problem.displacements[k])):
            each[k] = max(each[k], _from_rest(problem, j, float(d)))
    return np.asarray(each * (1.0 - SAFE))


def stop_and_go_durations(problem: Problem) -> Array:
    """Compute the time from rest to rest on each segment, rounded up.

    This is a motion's time, unless a joint has a velocity limit only.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    Array, shape (n_segments,) [s]
    """
    each = [
        max(_rest_to_rest(problem, j, float(d)) for j, d in enumerate(row))
        for row in np.abs(problem.displacements)
    ]
    return np.array(each) * (1.0 + SAFE)


def bound_at_top_speed(relaxed: RelaxedProblem) -> tuple[float, int]:
    """Bound the time of a motion by displacement at top speed, and by the times that are asked for.

    Parameters
    ----------
    relaxed : RelaxedProblem

    Returns
    -------
    bound : float [s]
        No motion takes less, waits included, rounded down.
    waypoint : int
        Among those kept: the one whose earliest arrival counts, or 0.
    """
    least = np.maximum(relaxed.least, DOWN * relaxed.at_top_speed)[: relaxed.n_segments]
    after = np.concatenate([np.cumsum(least[::-1])[::-1], [0.0]]) * down(len(least) + 1)
    sooner = np.maximum(relaxed.arrivals[:, 0], 0.0)  # no motion passes a waypoint before
    whole = np.where(after > 0.0, (sooner + after) * DOWN, sooner)
    latest, most = int(whole.argmax()), float(whole.max())
    return (most + relaxed.waits) * DOWN if relaxed.waits else most, latest


def typical_durations(relaxed: RelaxedProblem) -> Array:
    """Compute the time from rest to rest between the middles of the zones, about.

    Parameters
    ----------
    relaxed : RelaxedProblem

    Returns
    -------
    Array, shape (K,) [s]
        A scale for the durations, and no bound.
    """
    jerk = np.where(relaxed.has_jerk, relaxed.jerk, np.inf)
    limits = list(zip(relaxed.velocity, relaxed.acceleration, jerk, strict=True))
    each = [
        max(
            (rest_to_rest(float(d), *map(float, of)) for d, of in zip(row, limits, strict=True)),
            default=0.0,
        )
        for row in np.abs(relaxed.displacements[: relaxed.n_segments])
    ]
    return np.maximum(each, np.maximum(relaxed.least, relaxed.at_top_speed)[: relaxed.n_segments])


def _rest_to_rest(problem: Problem, j: int, distance: float) -> float:
    V, A, J = problem.limits.derivatives[:, j]
    if distance == 0.0 or (np.isinf(A) and np.isinf(J)):
        return float(distance / V)
    return rest_to_rest(distance, float(V), float(A), float(J))


def _from_rest(problem: Problem, j: int, distance: float) -> float:
    """Least time in which a joint can be ``distance`` away from where it rested [s]: by bisection."""
    V, A, J = (float(limit) for limit in problem.limits.derivatives[:, j])
    low, high = 0.0, _rest_to_rest(problem, j, distance)
    while high - low > SAFE * high:
        middle = 0.5 * (low + high)
        if _farthest_from_rest(middle, V, A, J) < distance * (1.0 - SAFE):
            low = middle
        else:
            high = middle
    return low


def _farthest_from_rest(t: float, V: float, A: float, J: float) -> float:
    """How far a joint gets from rest in t seconds [rad]: jerk J, acceleration A, jerk -J, speed V."""
    if math.isinf(J):
        rise = V / A
        return A * t**2 / 2.0 if t <= rise else V * (t - rise / 2.0)
    rise = min(A / J, math.sqrt(V / J))
    steepest = J * rise
    hold = max(V / steepest - rise, 0.0)
    if t <= rise:
        return J * t**3 / 6.0
    if t <= rise + hold:
        s = t - rise
        return J * rise**3 / 6.0 + s * (steepest * rise / 2.0 + s * steepest / 2.0)
    left = 2.0 * rise + hold - t  # before top speed
    if left > 0.0:
        return V * (2.0 * rise + hold) / 2.0 - V * left + J * left**3 / 6.0
    return V * (t - (2.0 * rise + hold) / 2.0)
