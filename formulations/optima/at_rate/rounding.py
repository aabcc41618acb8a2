"""What the rounding of positions and time stamps in a file may take of each limit."""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

NANOSECOND = 1e-9  # time stamps of a file are whole nanoseconds
_LEAST_MARGIN = 1e-7  # relative; covers the tolerance of the linear program
# 10 s^3 - 15 s^4 + 6 s^5 has derivatives of at most 1.875, 5.78 and 60 on [0, 1]; two ends
_FACTORS = 2.0 * np.array([[1.875], [5.78], [60.0]])
_ORDERS = np.arange(1, 4)[:, None]


def _rounding(problem: Problem, seconds: float) -> Array:
    """Errors of a position in a file, (dof,) [rad]: its own rounding, and that of its time stamp."""
    largest = np.abs(problem.waypoints).max(axis=0)
    late = 0.5 * seconds * problem.limits.velocity
    return np.asarray(np.finfo(float).eps * (2.0 * largest + late))


def margins(problem: Problem, seconds: float, distance: float) -> Array:
    """Bound the shares of velocity, acceleration and jerk limits that rounding takes.

    A Hermite quintic over a time h turns an error e of the position at one end into errors of its
    derivatives of at most 1.875 e / h, 5.78 e / h^2 and 60 e / h^3.

    Parameters
    ----------
    problem : Problem
        Sizes of the positions, and the limits.
    seconds : float [s]
        Time of the whole motion: the rounding of time stamps grows with it.
    distance : float [s]
        Least distance of two points.

    Returns
    -------
    Array, shape (3, dof)
        Shares of the limits, 1e-7 and more; 1e-7 where there is no limit.
    """
    error = _rounding(problem, seconds)
    return np.asarray(_LEAST_MARGIN + _FACTORS * error / distance**_ORDERS / problem.limits.derivatives)


def least_distance(problem: Problem, seconds: float, margin: float) -> float:
    """Find the distance of points at which rounding takes a given share of a limit at most.

    Parameters
    ----------
    problem : Problem
        Sizes of the positions, and the limits.
    seconds : float [s]
        Time of the whole motion.
    margin : float
        Share of any limit of a moving joint.

    Returns
    -------
    float [s]
        The least distance.
    """
    error = _rounding(problem, seconds)
    limits = problem.limits.derivatives
    distances = (_FACTORS * error / (limits * margin)) ** (1.0 / _ORDERS)
    return float(distances[:, problem.moving_joints].max(initial=NANOSECOND))
