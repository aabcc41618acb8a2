"""The displacement bound: no motion is faster than its displacements at top speed.

    T >= sum over the segments k of max over the joints j of |d_kj| / V_j

Each segment has to be crossed, and the crossing takes at least that long. With velocity limits alone the
sum is also the infimum over all motions. The sum is exact (rational numbers); only the result is rounded,
and always down.

Under conditions d is the distance between the zones of the two waypoints, V the limit of the segment in that
direction, and a segment takes at least the time that is asked for. Waits are added, and a waypoint whose window
opens later is passed later. All other conditions, such as states at the ends, can only make motions slower
than what is left here.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from math import isfinite, nextafter

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.problem import Problem

# A certificate states that no motion takes L seconds or less. The checker proves sum > L in arithmetic
# of its own, so L lies this far below the sum (relative).
_STRICTLY = 1e-13


def displacement_bound(problem: Problem, conditions: Conditions | None = None) -> float:
    """Largest float that no motion's total time is below [s]; 0 if nothing moves and no time is asked for.

    Parameters
    ----------
    problem : Problem
        Its waypoints and velocity limits are taken as the exact numbers that the floats are.
    conditions : Conditions, optional
        In place of the problem's own.

    Returns
    -------
    float
        The displacement sum, rounded down [s].
    """
    demands = Demands.of(problem, conditions)
    passed = Fraction(0)
    waits, earliest = demands.waits.tolist(), demands.passages[1:, 0].tolist()
    for wait, least, opens in zip(waits, _segments(demands), earliest, strict=False):
        passed = max(passed + Fraction(wait) + least, Fraction(opens))
    return rounded_down(passed)


def displacement_durations(problem: Problem, conditions: Conditions | None = None) -> Array:
    """Least duration of each segment at top speed, each one rounded down.

    Parameters
    ----------
    problem : Problem
    conditions : Conditions, optional
        As for ``displacement_bound``.

    Returns
    -------
    Array, shape (n_segments,) [s]
    """
    return np.array([rounded_down(segment) for segment in _segments(Demands.of(problem, conditions))])


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


def distance_between(one: Array, other: Array) -> Fraction:
    """Exact distance between two intervals of positions of a joint.

    Parameters
    ----------
    one, other : Array, shape (2,)
        Least and greatest position [rad].

    Returns
    -------
    Fraction
        Of the nearest two positions [rad]; 0 where the intervals meet.
    """
    (low, high), (other_low, other_high) = one.tolist(), other.tolist()
    gaps = Fraction(other_low) - Fraction(high), Fraction(low) - Fraction(other_high)
    return max(*gaps, Fraction(0))


def _segments(demands: Demands) -> list[Fraction]:
    """Exact least duration of each segment [s]."""
    return [
        max(
            Fraction(least),
            *(
                _crossing(before, after, speeds)
                for before, after, speeds in zip(start, end, limits, strict=True)
            ),
        )
        for start, end, limits, least in zip(
            demands.waypoints[:-1],
            demands.waypoints[1:],
            demands.velocity,
            demands.durations[:, 0].tolist(),
            strict=True,
        )
    ]


def _crossing(before: Array, after: Array, speeds: Array) -> Fraction:
    """Least time of a joint between two zones, with a velocity limit in each direction [s]."""
    down, up = speeds.tolist()
    speed = up if after[0] > before[1] else -down
    return distance_between(before, after) / Fraction(speed) if isfinite(speed) else Fraction(0)
