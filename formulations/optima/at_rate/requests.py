"""What can be asked of a file of points, before anything is computed and after."""

from __future__ import annotations

import numpy as np

from formulations.optima.at_rate.rounding import least_distance
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem

MOST_POINTS = 5_000_000
_LARGEST_MARGIN = 0.02  # a file at a higher rate would be more rounding than motion


def require_exportable(problem: Problem, seconds: float, rate: float | None) -> None:
    """Refuse files that no controller can run, or that would hold more rounding than motion.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    seconds : float [s]
        Time of the motion, or a lower bound of it.
    rate : float or None [1/s]
        Points per second; None where points lie at the switching times.

    Raises
    ------
    InputError
        The rate is not positive, asks for more than 5,000,000 points, or is so high that the rounding of
        positions hides the jerk; or a moving joint has no acceleration limit.
    """
    for joint in problem.moving_joints:
        if not np.isfinite(problem.limits.acceleration[joint]):
            raise InputError(
                f"limits.acceleration: {problem.joint_name(joint)} has none; a controller cannot follow a "
                "motion whose velocity jumps, so give a limit for this joint"
            )
    if rate is None:
        return
    if not (np.isfinite(rate) and rate > 0.0):
        raise InputError(f"rate: {rate:g} points per second; a positive number is needed")
    if seconds * rate > MOST_POINTS:
        raise InputError(
            f"rate: {rate:g} points per second over {seconds:.4g} s are {seconds * rate:.3g} points; "
            f"at most {MOST_POINTS} are written"
        )
    least = least_distance(problem, seconds, _LARGEST_MARGIN)
    if rate * least > 1.0:
        raise InputError(
            f"rate: {rate:g} points per second; beyond {1.0 / least:.4g} the rounding of positions to "
            "double precision takes more than 2 % of the jerk limit"
        )


def check_request(problem: Problem, rate: float | None, conditions: Conditions | None = None) -> None:
    """Refuse before a motion is computed what would be refused after.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    rate : float or None [1/s]
        Points per second.
    conditions : Conditions, optional
        What else is asked of the motion.

    Raises
    ------
    InputError
        As ``require_exportable``, for the shortest time that the velocity limits allow; or a passage time
        that is asked for lies between two points.
    """
    shares = np.abs(problem.displacements) / problem.limits.velocity
    require_exportable(problem, float(shares.max(axis=1).sum()), rate)
    asked = problem.conditions if conditions is None else conditions
    asked.validate(problem)
    if rate is None:
        return
    for waypoint, time in sorted(asked.times(problem).items()):
        require_point(waypoint, time, rate)


def require_kept(asked: Conditions) -> None:
    """Refuse what motions with points at a rate, or at the switching times, cannot keep.

    Parameters
    ----------
    asked : Conditions

    Raises
    ------
    InputError
        The motion has to wait.
    """
    for waypoint in asked.waits:
        raise InputError(
            f"conditions.waits: a file of points cannot hold the wait at waypoint {waypoint + 1}; write exact "
            "pieces (.pieces.json)"
        )


def require_point(waypoint: int, time: float, rate: float) -> int:
    """Find the point that lies at a passage time.

    Parameters
    ----------
    waypoint : int
        Counts from 0.
    time : float [s]
        When it is passed.
    rate : float [1/s]
        Points per second.

    Returns
    -------
    int
        The number of the point.

    Raises
    ------
    InputError
        The time lies between two points.
    """
    nearest = round(time * rate)
    if abs(nearest / rate - time) > 1e-9 * time:
        raise InputError(
            f"rate: waypoint {waypoint + 1} is asked for at {time:.9g} s, between two points at "
            f"{rate:g} points per second; {nearest / rate:.9g} s is the time of a point"
        )
    return nearest
