"""Least times of single joints that the tests of the references compare with."""

from __future__ import annotations

import math
from itertools import pairwise

from conftest import Array, powers_of_ten

from formulations import Problem
from formulations.proofs.rest_to_rest import rest_to_rest

SIZE = powers_of_ten(-1.5, 1.5)


def trapezoid(distance: float, velocity: float, acceleration: float) -> float:
    """Least time of one joint from rest to rest without a jerk limit."""
    if distance >= velocity**2 / acceleration:
        return distance / velocity + velocity / acceleration
    return 2.0 * math.sqrt(distance / acceleration)


def legs(problem: Problem, points: Array) -> list[float]:
    """Closed form of each leg: the slowest joint."""
    limits = problem.limits.derivatives
    return [
        max(rest_to_rest(abs(d), *limits[:, j]) for j, d in enumerate(b - a))
        for a, b in pairwise(points)
    ]
