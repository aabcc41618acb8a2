"""Other planners behind one face: a problem in, a judged motion out.

Drake's KinematicTrajectoryOptimization optimises one B-spline of cubic pieces. Its total time is free,
but the shares of it at which the waypoints are passed are not. These are found outside, by the method
of Nelder and Mead from the shares of stop and go; in a row of its own, Drake is given the shares of the
free-form motion. pyroboplan's CubicTrajectoryOptimization has one cubic per segment, velocity limits at
samples, and free accelerations at the ends. Every answer is turned into exact pieces, slowed down by
the least factor that keeps its limits, and judged by the same check as ours; its faults stand in the
note.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize

from formulations import REFERENCES, Problem, Trajectory, check, free_form
from formulations.motion.verdict import TOLERANCE
from formulations.problem.arrays import Array

_DEGREE = 3  # of Drake's splines: their jerk is constant on each piece, as that of the optimum is


@dataclass(frozen=True)
class RivalRun:
    """One planner on one problem: judged time [s], or why there is none, and the time it took [s]."""

    problem: str
    planner: str
    seconds: float | None
    note: str
    runtime: float


def judged(problem: Problem, planner: str, motion: Trajectory | None, runtime: float) -> RivalRun:
    """Judge a motion, after it was slowed down where it broke its limits.

    Parameters
    ----------
    problem : Problem
        The task.
    planner : str
        Whose motion it is.
    motion : Trajectory or None
        The motion; None if the planner found none.
    runtime : float
        Time the planner took [s].

    Returns
    -------
    RivalRun
        Its verified time; other faults stand in the note.
    """
    if motion is None:
        return RivalRun(problem.name, planner, None, "no solution", runtime)
    verdict, note = check(problem, motion), ""
    if not verdict.feasible and 1.0 < verdict.stretch < 2.0:
        note = f"slowed down by {verdict.stretch - 1.0:.1e}"
        motion = motion.stretched(verdict.stretch * (1.0 + TOLERANCE))
        verdict = check(problem, motion)
    if not verdict.feasible:
        note = f"refused: {verdict.faults[0]}"
    return RivalRun(problem.name, planner, verdict.seconds, note, runtime)


def ours(problem: Problem) -> tuple[RivalRun, Trajectory]:
    """Find the free-form motion, and judge it.

    Parameters
    ----------
    problem : Problem
        The task.

    Returns
    -------
    run : RivalRun
        Its row.
    motion : Trajectory
        The motion.
    """
    started = time.perf_counter()
    motion = free_form(problem).trajectory
    assert motion is not None  # every problem here moves
    return judged(problem, "free form", motion, time.perf_counter() - started), motion


def drake(problem: Problem, per_segment: int, evaluations: int, motion: Trajectory) -> list[RivalRun]:
    """Run Drake, with shares of the time handed to it, and with shares found outside.

    Parameters
    ----------
    problem : Problem
        The task.
    per_segment : int
        Control points per segment.
    evaluations : int
        Splines that the search of the shares may try.
    motion : Trajectory
        The free-form motion, whose shares are handed over.

    Returns
    -------
    list of RivalRun
        Two rows; one for a single segment, which has nothing to share.
    """
    points = per_segment * problem.n_segments
    given = motion.passage_times / motion.seconds
    started = time.perf_counter()
    with_ours = drake_spline(problem, points, given)
    lines = [judged(problem, f"Drake {points}, our shares", with_ours, time.perf_counter() - started)]
    if problem.n_segments == 1:
        return lines
    stopping = REFERENCES["ruckig_stop_and_go"](problem).durations
    assert stopping is not None  # every problem here has an acceleration limit
    best: list[Trajectory] = []

    def seconds(logs: Array) -> float:
        ends = np.cumsum(np.exp(np.append(0.0, logs)))
        found = drake_spline(problem, points, np.append(0.0, ends / ends[-1]))
        if found is None:
            return 1e3 * motion.seconds
        if not best or found.seconds < best[0].seconds:
            best[:] = [found]
        return found.seconds

    started = time.perf_counter()
    first = np.log(stopping[1:] / stopping[0])
    minimize(seconds, first, method="Nelder-Mead", options={"maxfev": evaluations, "xatol": 1e-4})
    runtime = time.perf_counter() - started
    lines.append(judged(problem, f"Drake {points}", best[0] if best else None, runtime))
    return lines


def drake_spline(problem: Problem, points: int, shares: Array) -> Trajectory | None:
    """Find the fastest B-spline that passes the waypoints at given shares of its time, by SNOPT.

    Parameters
    ----------
    problem : Problem
        The task.
    points : int
        Control points.
    shares : Array, shape (n_waypoints,)
        Passage times over the total time [1].

    Returns
    -------
    Trajectory or None
        Its exact pieces; None if SNOPT found none.
    """
    from pydrake.planning import KinematicTrajectoryOptimization
    from pydrake.solvers import SnoptSolver
    from pydrake.trajectories import BsplineTrajectory

    limits, still = problem.limits, np.zeros(problem.dof)
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
    return _pieces(program.ReconstructTrajectory(result), shares)


def _pieces(spline: Any, shares: Array) -> Trajectory:
    """A Drake B-spline as exact pieces."""
    knots = np.unique(np.asarray(spline.basis().knots()))
    middles = 0.5 * (knots[:-1] + knots[1:])
    durations = np.diff(knots)
    # Taylor's series about the middle of each piece, then moved to its start
    derivatives = [spline.MakeDerivative(k) if k else spline for k in range(_DEGREE + 1)]
    values = np.stack([np.stack([d.value(t).ravel() for t in middles]) for d in derivatives], axis=-1)
    back = -0.5 * durations[:, None]
    x, v, a, j = np.moveaxis(values, -1, 0)
    coefficients = np.stack(
        [
            x + back * (v + back * (a / 2.0 + back * j / 6.0)),
            v + back * (a + back * j / 2.0),
            (a + back * j) / 2.0,
            j / 6.0,
        ],
        axis=-1,
    )
    return Trajectory(durations, coefficients, shares * float(durations.sum()))


def pyroboplan(problem: Problem, motion: Trajectory) -> list[RivalRun]:
    """Run pyroboplan's cubics between the waypoints.

    Parameters
    ----------
    problem : Problem
        The task.
    motion : Trajectory
        The free-form motion: no segment may take more than four times its total time.

    Returns
    -------
    list of RivalRun
        One row.
    """
    import pinocchio
    from pyroboplan.trajectory.trajectory_optimization import (
        CubicTrajectoryOptimization,
        CubicTrajectoryOptimizationOptions,
    )

    limits = problem.limits
    model = pinocchio.Model()
    parent = 0
    for j in range(problem.dof):
        parent = model.addJoint(
            parent, pinocchio.JointModelRZ(), pinocchio.SE3.Identity(), f"joint{j + 1}"
        )
    low, high = problem.position_bounds.T
    model.lowerPositionLimit, model.upperPositionLimit = np.maximum(low, -1e3), np.minimum(high, 1e3)
    longest = 4.0 * float(motion.seconds)
    options = CubicTrajectoryOptimizationOptions(
        num_waypoints=len(problem.waypoints),
        min_segment_time=1e-3,
        max_segment_time=longest,
        min_vel=-limits.velocity,
        max_vel=limits.velocity,
        min_accel=-limits.acceleration,
        max_accel=limits.acceleration,
        min_jerk=-limits.jerk,
        max_jerk=limits.jerk,
    )
    started = time.perf_counter()
    planner = CubicTrajectoryOptimization(model, pinocchio.GeometryModel(), options)
    found = planner.plan(list(problem.waypoints))
    runtime = time.perf_counter() - started
    if found is None:
        return [judged(problem, "pyroboplan", None, runtime)]
    durations = np.array([end - start for start, end in found.segment_times])
    # highest power first, a list per joint
    coefficients = np.moveaxis(np.array(found.coeffs), 0, 1)[..., ::-1]
    return [judged(problem, "pyroboplan", Trajectory(durations, coefficients.copy()), runtime)]
