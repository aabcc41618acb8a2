"""States at the waypoints with which the segments can take given durations.

With durations fixed everything else is convex: the program with boxes of no width. Limits are shrunk by
``_MARGIN``, for what the solver's tolerance leaves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.program import Program
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.task import Task

_MARGIN = 1e-7
_ROUNDS, _TOLERANCE = 60, 1e-9


@dataclass(frozen=True)
class States:
    """Velocities [rad/s] and accelerations [rad/s^2] at the waypoints of a task, (K + 1, n)."""

    task: Task
    velocities: Array
    accelerations: Array


def states_at(
    problem: Problem, durations: Array, cuts: Cuts, deadline: float = math.inf
) -> States | None:
    """States for durations (K,) [s] of the segments that move; None if there seem to be none.

    cuts: good ones for a start. deadline: of ``time.perf_counter``.
    """
    limits = problem.limits
    v, a, j = limits.derivatives * (1.0 - _MARGIN)
    shrunk = replace(problem, limits=replace(limits, velocity=v, acceleration=a, jerk=j))
    horizon = float(durations.sum()) * (1.0 + _MARGIN)
    task = Task.of(shrunk, horizon, 0.0)
    limit = np.broadcast_to(task.acceleration, (len(durations) + 1, len(task.joints)))
    box = np.stack([durations, durations], axis=1)
    frame = Frame(task, box, np.stack([-limit, limit], axis=-1), durations)
    program = Program(frame, cuts)
    any_cost = np.zeros(frame.size)
    point = program.solve(any_cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
    if not point.converged:
        return None
    cost, box = _calmer(problem, frame, durations, point.x)
    program.confine(box)
    calmer = program.solve(cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
    x = calmer.x if calmer.converged else point.x
    v, a = x[frame.v] * task.velocity, x[frame.a] * task.acceleration
    return States(Task.of(problem, horizon), v, a)


def _calmer(problem: Problem, frame: Frame, durations: Array, x: Array) -> tuple[Array, Array]:
    """Cost and boxes that draw x, as far as the rows allow, to the speeds of a monotone interpolant.

    Between x and the value wanted the distance to it is linear.
    """
    task = frame.task
    wanted = np.zeros(frame.size)
    if frame.K > 1:
        times = np.concatenate([[0.0], np.cumsum(durations)])
        passed = np.append(task.segments, task.segments[-1] + 1)
        path = PchipInterpolator(times, problem.waypoints[np.ix_(passed, task.joints)])
        speeds = path.derivative()(times[1:-1]) / task.velocity
        wanted[frame.v[1:-1]] = speeds.clip(-1.0, 1.0)
    cost, box = np.zeros(frame.size), frame.box.copy()
    for columns in (frame.v, frame.a):
        box[columns] = np.sort(np.stack([x[columns], wanted[columns]], axis=-1), axis=-1)
        cost[columns] = np.sign(x[columns] - wanted[columns])
    return cost, box
