"""The path that the timers of paths are given: the cubic spline through the waypoints."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from compare.rivals.rival import moving_waypoints
from formulations import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

_GRID = 200  # intervals per segment


def spline_path(problem: Problem) -> CubicSpline:
    """Return the natural cubic spline through the waypoints.

    Its knots lie at the times that the velocity limits alone ask for. It is natural, not clamped, because a
    timer of paths cannot start where the path's derivative is zero.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    CubicSpline
        Of the path parameter, from 0.
    """
    points = moving_waypoints(problem)
    steps = (np.abs(np.diff(points, axis=0)) / problem.limits.velocity).max(axis=1)
    return CubicSpline(np.append(0.0, np.cumsum(steps)), points, bc_type="natural")


def as_pieces(path: CubicSpline) -> Trajectory:
    """Return the same path as exact pieces.

    Parameters
    ----------
    path : CubicSpline

    Returns
    -------
    Trajectory
        Its time is the path parameter.
    """
    return Trajectory(np.diff(path.x), np.moveaxis(path.c[::-1], 0, -1).copy())


def grid_of(path: CubicSpline) -> Array:
    """Divide every segment of a path evenly.

    Parameters
    ----------
    path : CubicSpline

    Returns
    -------
    Array
        Path parameters at which a timer chooses its speed, each once.
    """
    knots = zip(path.x[:-1], path.x[1:], strict=True)
    return np.unique(np.concatenate([np.linspace(a, b, _GRID + 1) for a, b in knots]))
