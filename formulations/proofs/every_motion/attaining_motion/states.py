"""Waypoint states with which a motion can have given durations.

With fixed durations everything else is convex: it is the linear program with duration boxes of zero
width. Limits are lowered by ``MARGIN``, to cover the solver's tolerance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from formulations.deadlines import NEVER, Deadline
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame

MARGIN = 1e-7
_ROUNDS, _TOLERANCE = 60, 1e-9


@dataclass(frozen=True)
class WaypointStates:
    """States at the waypoints of a relaxed problem.

    Attributes
    ----------
    relaxed : RelaxedProblem
    velocities : Array, shape (K + 1, n) [rad/s]
    accelerations : Array, shape (K + 1, n) [rad/s^2]
    """

    relaxed: RelaxedProblem
    velocities: Array
    accelerations: Array


def find_states(
    problem: Problem, durations: Array, cuts: Cuts, deadline: Deadline = NEVER
) -> WaypointStates | None:
    """Find waypoint states for given durations.

    Parameters
    ----------
    problem : Problem
    durations : Array, shape (K,) [s]
        Of the segments that move.
    cuts : Cuts
        To begin with.
    deadline : Deadline

    Returns
    -------
    WaypointStates or None
        None where none were found.
    """
    limits = problem.limits
    v, a, j = limits.derivatives * (1.0 - MARGIN)
    lowered = replace(problem, limits=replace(limits, velocity=v, acceleration=a, jerk=j))
    horizon = float(durations.sum()) * (1.0 + MARGIN)
    relaxed = RelaxedProblem.of(lowered, horizon, 0.0)
    frame = Frame(relaxed, Boxes.around(relaxed, durations, durations), durations)
    program = LinearProgram(frame, cuts)
    any_cost = np.zeros(frame.size)
    point = program.solve(any_cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
    if not point.converged:
        return None
    cost, box = _toward_interpolant(problem, frame, durations, point.x)
    program.confine(box)
    calmer = program.solve(cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
    x = calmer.x if calmer.converged else point.x
    v, a = x[frame.v] * relaxed.velocity, x[frame.a] * relaxed.acceleration
    return WaypointStates(RelaxedProblem.of(problem, horizon), v, a)


def _toward_interpolant(
    problem: Problem, frame: Frame, durations: Array, x: Array
) -> tuple[Array, Array]:
    """Cost and boxes that draw x to the speeds of a monotone interpolant, as far as the rows allow.

    In a box between x and the speed wanted, the distance to it is linear.
    """
    relaxed = frame.relaxed
    wanted = np.zeros(frame.size)
    if frame.K > 1:
        times = np.concatenate([[0.0], np.cumsum(durations)])
        passed = np.append(relaxed.segments, relaxed.segments[-1] + 1)
        path = PchipInterpolator(times, problem.waypoints[np.ix_(passed, relaxed.joints)])
        speeds = path.derivative()(times[1:-1]) / relaxed.velocity
        wanted[frame.v[1:-1]] = speeds.clip(-1.0, 1.0)
    cost, box = np.zeros(frame.size), frame.box.copy()
    for columns in (frame.v, frame.a):
        box[columns] = np.sort(np.stack([x[columns], wanted[columns]], axis=-1), axis=-1)
        cost[columns] = np.sign(x[columns] - wanted[columns])
    return cost, box
