"""The displacement bound: no motion is faster than its displacements at top speed.

    T >= sum over the segments k of max over the joints j of |d_kj| / V_j

Each segment has to be crossed, and the crossing takes at least that long. With velocity limits alone the
sum is also the infimum over all motions. The sum is exact (rational numbers); only the result is rounded,
and always down.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from itertools import pairwise
from math import isfinite, nextafter

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

# A certificate states that no motion takes L seconds or less. The checker proves sum > L in arithmetic
# of its own, so L lies this far below the sum (relative).
_STRICTLY = 1e-13


def displacement_bound(problem: Problem) -> float:
    """Largest float that no motion's total time is below [s]; 0 if nothing moves.

    Parameters
    ----------
    problem : Problem
        Its waypoints and velocity limits are taken as the exact numbers that the floats are.

    Returns
    -------
    float
        The displacement sum, rounded down [s].
    """
    return rounded_down(sum(_segments(problem), Fraction(0)))


def displacement_durations(problem: Problem) -> Array:
    """Least duration of each segment at top speed, each one rounded down.

    Parameters
    ----------
    problem : Problem
        As for ``displacement_bound``.

    Returns
    -------
    Array, shape (n_segments,) [s]
    """
    return np.array([rounded_down(segment) for segment in _segments(problem)])


def exceeded_time(problem: Problem) -> float:
    """Time that the displacement sum exceeds by a margin that a checker can see [s].

    Parameters
    ----------
    problem : Problem
        As for ``displacement_bound``.

    Returns
    -------
    float
        ``displacement_bound`` less a relative 1e-13; 0 if nothing moves.
    """
    return displacement_bound(problem) * (1.0 - _STRICTLY)


def rounded_down(value: Fraction) -> float:
    """Largest float that is not above an exact number.

    Parameters
    ----------
    value : Fraction
        Not negative.

    Returns
    -------
    float
        Finite, whatever the value.
    """
    try:
        nearest = float(value)
    except OverflowError:
        return sys.float_info.max
    return nearest if Fraction(nearest) <= value else nextafter(nearest, 0.0)


def _segments(problem: Problem) -> list[Fraction]:
    """Exact least duration of each segment [s]."""
    # slowness [s/rad]; 0 for a joint without a velocity limit
    slowness = [
        1 / Fraction(v) if isfinite(v) else Fraction(0) for v in problem.limits.velocity.tolist()
    ]
    rows = [[Fraction(x) for x in row] for row in problem.waypoints.tolist()]
    return [
        max(abs(end - start) * s for start, end, s in zip(a, b, slowness, strict=True))
        for a, b in pairwise(rows)
    ]
