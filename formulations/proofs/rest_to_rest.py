"""Least time of one joint from rest to rest, in closed form, and the same number as a proved bound.

The fastest motion is the symmetric S-curve (Biagiotti & Melchiorri 2008, sec. 3.4). Its time has square
and cube roots in it, but whether a given T is below that time is a question of rational numbers: the
joint gets farthest in T seconds with the same S-curve, and how far follows from + - * / alone.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.problem import Problem
from formulations.proofs.displacement import distance_between, rounded_down


def rest_to_rest(distance: float, velocity: float, acceleration: float, jerk: float) -> float:
    """Least time of one joint from rest to rest, to within a few roundings.

    Parameters
    ----------
    distance : float [rad]
        Not negative.
    velocity, acceleration, jerk : float [rad/s, rad/s^2, rad/s^3]
        Positive limits; each may be infinite.

    Returns
    -------
    float
        Time [s].
    """
    if math.isinf(acceleration) and math.isinf(jerk):
        return distance / velocity
    # time to reach top speed from rest, with and without a phase of constant acceleration
    if velocity / acceleration >= acceleration / jerk:  # false for infinities over each other
        ramp = velocity / acceleration + acceleration / jerk
    else:
        ramp = 2.0 * math.sqrt(velocity / jerk)
    if distance >= velocity * ramp:
        return distance / velocity + ramp
    rise = acceleration / jerk
    if distance >= 2.0 * acceleration * rise * rise:
        return rise + math.sqrt(rise * rise + 4.0 * distance / acceleration)
    return 4.0 * math.cbrt(distance / (2.0 * jerk))


def rest_to_rest_bound(distance: Fraction, velocity: float, acceleration: float, jerk: float) -> float:
    """Largest float that no motion of one joint from rest to rest is faster than.

    Parameters
    ----------
    distance : Fraction [rad]
        Exact, not negative.
    velocity, acceleration, jerk : float [rad/s, rad/s^2, rad/s^3]
        Positive limits; each may be infinite.

    Returns
    -------
    float
        Proved lower bound [s].
    """
    if distance == 0:
        return 0.0
    if math.isinf(acceleration) and math.isinf(jerk):
        return 0.0 if math.isinf(velocity) else rounded_down(distance / Fraction(velocity))
    seconds = rest_to_rest(float(distance), velocity, acceleration, jerk)
    step = 1
    while not _takes_at_least(seconds, distance, velocity, acceleration, jerk):
        seconds = _floats_away(seconds, -step)
        step *= 2
    while _takes_at_least(above := _floats_away(seconds, 1), distance, velocity, acceleration, jerk):
        seconds = above
    return seconds


def end_to_end_bound(problem: Problem, conditions: Conditions | None = None) -> float:
    """Proved lower bound on every motion: rest to rest from the first waypoint to the last.

    Parameters
    ----------
    problem : Problem
        Its inner waypoints are ignored, which makes the motions more, and so are all conditions but zones and
        the states at the ends. Where an end is not at rest, displacement over top speed bounds the motions.
    conditions : Conditions, optional
        In place of the problem's own.

    Returns
    -------
    float
        Bound of the slowest joint, rounded down [s].
    """
    demands = Demands.of(problem, conditions)
    asked, boxes = demands.conditions, demands.waypoints[[0, -1]]
    # a limit that is lower in one direction, or on one segment, is taken as if it were nowhere lower
    limits = asked.derivatives(problem).max(axis=1)
    ends = np.stack([asked.end_velocities(problem), asked.end_accelerations(problem)])
    limits[1:, ends.any(axis=(0, 1))] = np.inf  # NaN, which stands for a free state, counts as true
    return max(
        rest_to_rest_bound(distance_between(*boxes[:, j]), *map(float, limits[:, j]))
        for j in range(problem.dof)
    )


def _takes_at_least(
    seconds: float, distance: Fraction, velocity: float, acceleration: float, jerk: float
) -> bool:
    """Whether ``distance`` is as far as a joint gets from rest to rest in ``seconds``, or farther."""
    T = Fraction(seconds)
    V = None if math.isinf(velocity) else Fraction(velocity)
    A = None if math.isinf(acceleration) else Fraction(acceleration)
    J = None if math.isinf(jerk) else Fraction(jerk)
    half = T / 2
    # speed reached halfway if top speed were no limit: jerk J, acceleration A, jerk -J
    if J is None:
        assert A is not None
        speed = A * half
    elif A is None or half * J <= 2 * A:
        speed = J * half * half / 4
    else:
        speed = A * (half - A / J)
    if V is None or speed <= V:
        return speed * half <= distance
    # top speed is held; either ramp covers half of its time times V, so the distance is V (T - ramp)
    cruise = T - distance / V
    if J is None:
        assert A is not None
        return cruise <= V / A
    if A is not None and V / A >= A / J:
        return cruise <= V / A + A / J
    return cruise <= 0 or cruise * cruise <= 4 * V / J  # ramp = 2 sqrt(V / J)


def _floats_away(x: float, steps: int) -> float:
    """The float that lies so many floats above x (below, if negative); x is not negative."""
    return max(x + steps * math.ulp(x), 0.0)
