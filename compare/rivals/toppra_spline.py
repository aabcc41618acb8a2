"""toppra on the cubic spline through the waypoints, at constant path acceleration between grid points.

The rungs ``toppra_cubic`` and ``toppra_family_path`` state times alone. Here the motion itself is
judged, as a controller would be given it.
"""

from __future__ import annotations

import numpy as np

from compare.rivals.pieces import along
from compare.rivals.rival import RivalAnswer
from compare.rivals.spline_path import as_pieces, grid_of, spline_path
from formulations import Trajectory
from formulations.problem.problem import Problem


def toppra_spline(problem: Problem, seconds: float) -> RivalAnswer:
    """Time the spline as fast as velocity and acceleration limits allow.

    Parameters
    ----------
    problem : Problem
        Its jerk and position limits cannot be asked for.
    seconds : float
        Not used: it takes milliseconds.

    Returns
    -------
    RivalAnswer
    """
    import toppra

    limits, path = problem.limits, spline_path(problem)
    constraints = [
        toppra.constraint.JointVelocityConstraint(np.stack([-limits.velocity, limits.velocity], axis=1))
    ]
    if limits.has_acceleration:
        bounds = np.stack([-limits.acceleration, limits.acceleration], axis=1)
        constraints.append(toppra.constraint.JointAccelerationConstraint(bounds))
    given = toppra.SplineInterpolator(path.x, path(path.x), bc_type="natural")
    grid = grid_of(path)
    algorithm = toppra.algorithm.TOPPRA(constraints, given, gridpoints=grid, solver_wrapper="seidel")
    _, speeds, _ = algorithm.compute_parameterization(0.0, 0.0)
    if speeds is None or not np.isfinite(speeds).all():
        return RivalAnswer(None, note="no parameterisation found")
    durations = 2.0 * np.diff(grid) / (speeds[1:] + speeds[:-1])
    if not np.isfinite(durations).all():
        return RivalAnswer(None, note="the speed vanishes inside the path")
    series = np.stack([grid[:-1], speeds[:-1], np.diff(speeds) / (2.0 * durations)], axis=1)
    motion = along(as_pieces(path), Trajectory(durations, series[:, None, :]))
    return RivalAnswer(motion, float(durations.sum()), note=f"{len(grid)} grid points")
