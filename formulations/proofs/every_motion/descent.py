"""Durations of a motion near those of the relaxation: boxes about the last ones, ever narrower.

In a box of relative width w the relaxation is wrong by the order of w^2, so the durations it ends with
are those of a motion to that order: a sequence of linear programs with a shrinking trust region, each
posed with valid rows instead of linearised ones.
"""

from __future__ import annotations

import time

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.program import Program
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.task import Task

_WIDTHS = tuple(0.5**power for power in range(11))
_ROUNDS, _TOLERANCE = 30, 1e-7


def descended(problem: Problem, durations: Array, cuts: Cuts, deadline: float) -> tuple[Array, Cuts]:
    """Durations [s] of the segments that move, close to a local optimum, and good cuts for them."""
    for width in _WIDTHS:
        if time.perf_counter() > deadline:
            break
        task = Task.of(problem, float(durations.sum()) * (1.0 + width))
        limit = np.broadcast_to(task.acceleration, (len(durations) + 1, len(task.joints)))
        box = np.stack([durations / (1.0 + width), durations * (1.0 + width)], axis=1)
        frame = Frame(task, box, np.stack([-limit, limit], axis=-1), durations)
        program = Program(frame, cuts)
        found = program.solve(frame.cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
        cuts = program.cuts
        # an empty box is one of durations that are too short
        durations = durations * (found.x[frame.T] if found.status == "Optimal" else 1.0 + width)
    return durations, cuts
