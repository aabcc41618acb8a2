"""A path timed as it is: by TOPP-RA under velocity and acceleration limits, by COPP under jerk limits too."""

from __future__ import annotations

import logging

import numpy as np

from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import check
from formulations.problem.arrays import Array
from formulations.problem.problem import Limits, Problem
from formulations.references.copp_ import Profile, profile_on
from formulations.references.toppra_library import toppra
from formulations.retiming.path import Path

RATE = 1000.0  # points per second of a motion of TOPP-RA
_NODES, _MOST_NODES = 100, 300  # pieces of the slow motion that COPP starts from: two for each point
_FINE = 1e-4  # of the path's length, to which a path has so many points
_GRIDS = (3, 6)  # intervals per piece

logging.getLogger("toppra").setLevel(logging.CRITICAL)  # its failures are reported in words


def by_toppra(path: Path, limits: Limits) -> Trajectory | str:
    """Time a path as fast as velocity and acceleration limits allow.

    Parameters
    ----------
    path : Path
    limits : Limits
        Its jerk limits are not used.

    Returns
    -------
    Trajectory or str
        The motion, sampled at 1 kHz and joined by quintics; or why there is none.

    References
    ----------
    Pham & Pham 2018, "A new approach to time-optimal path parameterization based on reachability
    analysis", IEEE Transactions on Robotics 34, pp. 645-659.
    """
    velocity, acceleration = limits.intervals
    constraints = [toppra.constraint.JointVelocityConstraint(velocity)]
    if limits.has_acceleration:
        constraints.append(toppra.constraint.JointAccelerationConstraint(acceleration))
    grid = np.linspace(0.0, path.lengths[-1], max(400, min(4 * len(path.points), 4000)))
    geometry = _Spline(path)
    algorithm = toppra.algorithm.TOPPRA(
        constraints,
        geometry,
        gridpoints=grid,
        solver_wrapper="seidel",
        parametrizer="ParametrizeSpline",
    )
    planned = algorithm.compute_trajectory()
    if planned is None:
        return "TOPP-RA: no parameterisation found"
    times = np.linspace(0.0, planned.duration, int(np.ceil(planned.duration * RATE)) + 1)
    values = [np.asarray(planned(times, order)) for order in range(3)]
    values[1][[0, -1]] = 0.0
    if limits.has_jerk:  # rest means no acceleration either
        values[2][[0, -1]] = 0.0
    return MotionPoints(times, values[0], values[1], values[2]).motion()


def by_copp(path: Path, limits: Limits) -> Trajectory | str:
    """Time a path as fast as velocity, acceleration and jerk limits allow.

    Parameters
    ----------
    path : Path
    limits : Limits
        With a jerk limit on some joint.

    Returns
    -------
    Trajectory or str
        The motion, with points at the grid of the solver, joined by quintics; or why there is none.
    """
    try:
        from copp_py import CoppError
    except ImportError:
        return "copp-py is not installed: pip install 'timebound[copp]'"
    if not limits.has_jerk:
        return "no jerk limit: TOPP-RA is the optimum on this path"
    if not limits.symmetric:
        return "COPP: knows no limits that differ between the two directions"
    ends = Problem.of(path.points[[0, -1]], Limits.of(*limits.derivatives, dof=path.points.shape[1]))
    start = slow_motion(path, ends)
    moving = np.flatnonzero(np.ptp(path.points, axis=0) > 0.0).tolist()
    profile: Profile | None = None
    try:
        for grid in _GRIDS:
            _, profile = profile_on(ends, start, grid, profile, moving)
    except CoppError as error:
        return f"COPP: {error}"
    assert profile is not None
    s, a, b, times = profile
    speed = np.sqrt(a)
    first, second = start.at(s, 1), start.at(s, 2)
    return MotionPoints(
        times, start.at(s), first * speed[:, None], second * a[:, None] + first * b[:, None]
    ).motion()


def slow_motion(path: Path, problem: Problem) -> Trajectory:
    """Run along the path from rest to rest, by one quintic of its length, slowly enough for all limits.

    Parameters
    ----------
    path : Path
    problem : Problem
        The ends of the path, and the limits.

    Returns
    -------
    Trajectory
    """
    nodes = min(max(_NODES, 2 * len(path.simplified(_FINE * path.lengths[-1]))), _MOST_NODES)
    tau = np.linspace(0.0, 1.0, nodes + 1)
    total = path.lengths[-1]
    s = total * tau**3 * (10.0 - 15.0 * tau + 6.0 * tau**2)
    speed = total * 30.0 * tau**2 * (1.0 - tau) ** 2
    gain = total * 60.0 * tau * (1.0 - tau) * (1.0 - 2.0 * tau)
    first, second = path.spline(s, 1), path.spline(s, 2)
    motion = MotionPoints(
        tau,
        path.spline(s),
        first * speed[:, None],
        second * speed[:, None] ** 2 + first * gain[:, None],
    ).motion()
    return motion.stretched(1.001 * check(problem, motion, through=False).stretch)


class _Spline(toppra.interpolator.AbstractGeometricPath):  # type: ignore[misc]  # untyped base
    """The spline of a path, as TOPP-RA asks for it."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __call__(self, path_positions: Array, order: int = 0) -> Array:
        """Values of the spline or a derivative of it, (m, dof)."""
        return np.asarray(self._path.spline(path_positions, order))

    @property
    def dof(self) -> int:
        """Number of joints."""
        return int(self._path.points.shape[1])

    @property
    def path_interval(self) -> Array:
        """Start and end of the path."""
        return np.asarray(self._path.lengths[[0, -1]])

    @property
    def waypoints(self) -> None:
        """None, because this is a path and no list of points."""
