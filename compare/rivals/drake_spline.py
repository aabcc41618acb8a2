"""Drake's KinematicTrajectoryOptimization: one cubic B-spline whose total time is free.

The shares of the time at which the waypoints are passed are not free. They are those of stop and go (of
top speed where there is no acceleration limit), and are then searched by the method of Nelder and Mead for as
long as there is time.
"""

from __future__ import annotations

import time

import numpy as np
from scipy.optimize import minimize

from compare.rivals.pieces import from_derivatives
from compare.rivals.rival import RivalAnswer
from formulations import REFERENCES, Trajectory
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.displacement import displacement_durations

_DEGREE = 3  # the jerk is constant on each piece, as that of the fastest motion is
_PER_SEGMENT = 10  # control points
_SHARE = 0.7  # of the time, after which no further spline is begun


def drake_spline(problem: Problem, seconds: float) -> RivalAnswer:
    """Find the fastest spline, over shares of the time too.

    Parameters
    ----------
    problem : Problem
    seconds : float
        Time that it may take [s].

    Returns
    -------
    RivalAnswer
    """
    over = time.perf_counter() + _SHARE * seconds
    stopping = REFERENCES["ruckig_stop_and_go"](problem).durations
    lengths = np.maximum(displacement_durations(problem) if stopping is None else stopping, 1e-6)
    best: list[Trajectory] = []
    tried = 0

    def total(logs: Array) -> float:
        nonlocal tried
        ends = np.cumsum(np.exp(np.append(0.0, logs)))
        found = spline(problem, np.append(0.0, ends / ends[-1]))
        tried += 1
        if found is not None and (not best or found.seconds < best[0].seconds):
            best[:] = [found]
        if time.perf_counter() > over:
            raise StopIteration
        return 1e3 * float(lengths.sum()) if found is None else found.seconds

    try:
        first = np.log(lengths[1:] / lengths[0])
        if len(first):
            minimize(total, first, method="Nelder-Mead", options={"xatol": 1e-4})
        else:
            total(first)
    except StopIteration:
        pass
    note = f"{tried} spline{'' if tried == 1 else 's'} of {_PER_SEGMENT * problem.n_segments} control points"
    return (
        RivalAnswer(best[0], best[0].seconds, note=note)
        if best
        else RivalAnswer(None, note=f"none of {note}")
    )


def spline(problem: Problem, shares: Array) -> Trajectory | None:
    """Find the fastest B-spline that passes the waypoints at given shares of its time, by SNOPT.

    Parameters
    ----------
    problem : Problem
    shares : Array, shape (n_waypoints,)
        Passage times over the total time [1].

    Returns
    -------
    Trajectory or None
        None if SNOPT found none.
    """
    from pydrake.planning import KinematicTrajectoryOptimization
    from pydrake.solvers import SnoptSolver
    from pydrake.trajectories import BsplineTrajectory

    limits, still = problem.limits, np.zeros(problem.dof)
    points = max(_PER_SEGMENT * problem.n_segments, 2 * (_DEGREE + 1))
    scale = float((np.abs(problem.displacements) / limits.velocity).max(axis=1).sum())
    program = KinematicTrajectoryOptimization(problem.dof, points, _DEGREE + 1, 2.0 * scale)
    program.AddVelocityBounds(-limits.velocity, limits.velocity)
    if limits.has_acceleration:
        program.AddAccelerationBounds(-limits.acceleration, limits.acceleration)
    if limits.has_jerk:
        program.AddJerkBounds(-limits.jerk, limits.jerk)
    if limits.has_position:
        low, high = problem.position_bounds.T
        program.AddPositionBounds(low, high)
    for share, waypoint in zip(shares, problem.waypoints, strict=True):
        program.AddPathPositionConstraint(waypoint, waypoint, float(share))
    for end in (0.0, 1.0):
        program.AddPathVelocityConstraint(still, still, end)
        if limits.has_jerk:
            program.AddPathAccelerationConstraint(still, still, end)
    program.AddDurationCost(1.0)
    program.AddDurationConstraint(0.5 * scale, 100.0 * scale)
    at = np.linspace(0.0, 1.0, points)
    guess = np.stack([np.interp(at, shares, row) for row in problem.waypoints.T], axis=1)
    program.SetInitialGuess(BsplineTrajectory(program.basis(), [row[:, None] for row in guess]))
    result = SnoptSolver().Solve(program.prog())
    if not result.is_success():
        return None
    found = program.ReconstructTrajectory(result)
    derivatives = [found.MakeDerivative(k) if k else found for k in range(_DEGREE + 1)]
    knots = np.unique(np.asarray(found.basis().knots()))
    return from_derivatives(lambda t, k: derivatives[k].value(t), knots, _DEGREE)
