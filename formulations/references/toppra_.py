"""TOPP-RA (Pham & Pham 2018): the fastest motion along a fixed path, with velocity and acceleration limits.

The path is that of the family optimum, or the clamped cubic through the waypoints. At both ends their
derivative by their own parameter is zero (a 3-5-3 spline starts as t^3), and TOPP-RA cannot start there.
Therefore the path is parameterised by its arc length, in joint space scaled by the velocity limits. The
result is discretised: the grid is doubled until the time changes little, and the last change is stated.
"""

from __future__ import annotations

import logging
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.displacement import displacement_durations
from formulations.references.reference import Outcome, Rung, RungKind, Takes
from formulations.references.toppra_library import toppra

_GRIDS = (100, 200, 400, 800, 1600)  # intervals per path piece, coarse to fine
_GRID_ERROR = 2e-4  # refine until doubling the grid changes the duration by less

logging.getLogger("toppra").setLevel(logging.CRITICAL)  # its failures are reported as statuses


def toppra_on(problem: Problem, path: Trajectory) -> Outcome:
    """Time the path of a motion as fast as velocity and acceleration limits allow.

    Parameters
    ----------
    problem : Problem
        Its jerk and position limits are not used.
    path : Trajectory
        A motion through the waypoints, from rest to rest.

    Returns
    -------
    Outcome
        Its note states the grid and the grid error.
    """
    problem.require_plain("TOPP-RA")
    if not problem.moving_joints:
        return Outcome.ok(0.0, note="nothing moves")
    results: list[tuple[int, float]] = []
    reason = ""
    for grid in _GRIDS:
        answer = _time(problem, _ArcLength(problem, path, grid))
        if isinstance(answer, str):
            reason = f"{answer} at {grid} intervals per piece"
            continue
        results.append((grid, answer))
        if len(results) >= 2 and abs(results[-1][1] / results[-2][1] - 1.0) < _GRID_ERROR:
            break
    if len(results) < 2:
        return Outcome.failed(f"TOPP-RA: {reason}")
    (_, coarse), (grid, seconds) = results[-2:]
    change = abs(seconds / coarse - 1.0)
    note = f"{grid} grid intervals per piece; grid error {change:.1e}; no jerk limit"
    if reason:
        note += f"; failed: {reason}"
    return Outcome.ok(seconds, note=note)


def toppra_cubic(problem: Problem) -> Outcome:
    """Time the clamped cubic spline through the waypoints, whose knots are at displacement times.

    Parameters
    ----------
    problem : Problem
        Its jerk and position limits are not used.

    Returns
    -------
    Outcome
        Its note states the grid and the grid error.
    """
    problem.require_plain("TOPP-RA")
    if not problem.moving_joints:
        return Outcome.ok(0.0, note="nothing moves")
    times = displacement_durations(problem)
    moves = times > 0.0
    knots = np.concatenate([[0.0], np.cumsum(times[moves])])
    points = problem.waypoints[np.concatenate([[True], moves])]
    spline = CubicSpline(knots, points, bc_type="clamped")
    path = Trajectory(np.diff(knots), np.moveaxis(spline.c[::-1], 0, -1))
    return toppra_on(problem, path)


class _ArcLength(toppra.interpolator.AbstractGeometricPath):  # type: ignore[misc]  # untyped base
    """A motion's path by arc length; it can be evaluated at the points of its grid only.

    With u(t) = q'(t) / |q'(t)|, the first derivative by arc length is u and the second one u'/|q'|. At an end
    where q' = 0 both are limits. The first is taken from a point just inside. The second is set to 0: the
    path speed is 0 there, so that its value has no weight.
    """

    def __init__(self, problem: Problem, path: Trajectory, grid: int) -> None:
        self._scale = 1.0 / problem.limits.velocity
        t = np.append(
            np.concatenate([self._nodes(path, piece, grid) for piece in range(len(path.durations))]),
            path.seconds,
        )
        first, second = path.at(t, 1) * self._scale, path.at(t, 2) * self._scale
        for end, inside in ((0, 1e-6), (-1, 1.0 - 1e-6)):
            first[end] = path.at(path.seconds * inside, 1) * self._scale
        speed = np.linalg.norm(first, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = first / speed[:, None]
            along = np.sum(second * u, axis=1)[:, None]
            bend = (second - along * u) / speed[:, None] ** 2
        bend[[0, -1]] = 0.0
        lengths = self._lengths(path, t)
        keep = np.append(lengths > 1e-12 * lengths.sum(), True)
        self.grid = np.concatenate([[0.0], np.cumsum(lengths)])[keep]
        self._derivatives = (path.at(t)[keep], u[keep] / self._scale, bend[keep] / self._scale)
        directions = u[keep]
        self.fault = ""
        if not np.isfinite(directions).all():
            self.fault = "the path stands still inside"
        elif (np.sum(directions[1:] * directions[:-1], axis=1) < 0.0).any():
            # the path has no direction there, and TOPP-RA cannot be told to stop at a point
            self.fault = "the path turns back inside"

    def _lengths(self, path: Trajectory, t: Array) -> Array:
        """Arc length between consecutive times, by Gauss-Legendre."""
        x, w = np.polynomial.legendre.leggauss(5)
        h = np.diff(t)
        inner = t[:-1, None] + h[:, None] * (x + 1.0) / 2.0
        return np.asarray((np.linalg.norm(path.at(inner, 1) * self._scale, axis=2) @ w) * h / 2.0)

    def _nodes(self, path: Trajectory, piece: int, grid: int) -> Array:
        """Choose times of one piece, the last excluded, whose arc lengths near its ends grow as (i/n)^2.

        A motion that starts from rest passes them in even steps of time.
        """
        start, duration = path.breaks[piece], path.durations[piece]
        fine = start + duration * np.linspace(0.0, 1.0, 8 * grid + 1)
        length = np.concatenate([[0.0], np.cumsum(self._lengths(path, fine))])
        wanted = length[-1] * (0.5 - 0.5 * np.cos(np.pi * np.arange(grid) / grid))
        return np.asarray(np.interp(wanted, length, fine))

    def __call__(self, path_positions: Any, order: int = 0) -> Array:
        """Return values at grid points, (m, dof), or (dof,) for a single one."""
        middles = 0.5 * (self.grid[1:] + self.grid[:-1])
        return np.asarray(self._derivatives[order][np.searchsorted(middles, path_positions)])

    @property
    def dof(self) -> int:
        """Number of joints."""
        return len(self._scale)

    @property
    def path_interval(self) -> Array:
        """Start and end of the path."""
        return np.asarray(self.grid[[0, -1]])

    @property
    def waypoints(self) -> None:
        """None, because this is a path and no list of points."""


def _time(problem: Problem, path: _ArcLength) -> float | str:
    """Duration on one grid [s], or what went wrong."""
    if path.fault:
        return path.fault
    constraints = [toppra.constraint.JointVelocityConstraint(_symmetric(problem.limits.velocity))]
    if problem.limits.has_acceleration:
        constraints.append(
            toppra.constraint.JointAccelerationConstraint(_symmetric(problem.limits.acceleration))
        )
    algorithm = toppra.algorithm.TOPPRA(
        constraints, path, gridpoints=path.grid, solver_wrapper="seidel"
    )
    _, speeds, _ = algorithm.compute_parameterization(0.0, 0.0)
    if speeds is None or not np.isfinite(speeds).all():
        return "no parameterisation found"
    means = 0.5 * (speeds[1:] + speeds[:-1])
    if not (means > 0.0).all():
        return "the speed vanishes inside the path"
    return float((np.diff(path.grid) / means).sum())


def _symmetric(limit: Array) -> Array:
    return np.stack([-limit, limit], axis=1)


TOPPRA_FAMILY_PATH = Rung(
    key="toppra_family_path",
    kind=RungKind.REFERENCE,
    name="TOPP-RA, path of the optimum (no jerk limit)",
    meaning="TOPP-RA on the family optimum's path, no jerk limit",
    find=toppra_on,
    takes=Takes.PATH,
    after=("family",),
    needs=("family",),
)
TOPPRA_CUBIC = Rung(
    key="toppra_cubic",
    kind=RungKind.REFERENCE,
    name="TOPP-RA, clamped cubic (no jerk limit)",
    meaning="TOPP-RA on the clamped cubic, no jerk limit",
    find=toppra_cubic,
)
