"""Segment durations that a motion can have, near those of the relaxation.

In boxes of relative width w about some durations the relaxation is wrong by the order of w^2, so its
optimum is a motion's to that order. This solves a sequence of linear programs with a shrinking trust
region, each with valid rows in place of linearised ones.
"""

from __future__ import annotations

from formulations.deadlines import Deadline
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram, LPStatus
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame

_WIDTHS = tuple(0.5**power for power in range(11))
_ROUNDS, _TOLERANCE = 30, 1e-7


def descend(problem: Problem, durations: Array, cuts: Cuts, deadline: Deadline) -> tuple[Array, Cuts]:
    """Descend to durations close to a local optimum.

    Parameters
    ----------
    problem : Problem
    durations : Array, shape (K,) [s]
        Of the segments that move, to begin with.
    cuts : Cuts
        To begin with.
    deadline : Deadline

    Returns
    -------
    durations : Array, shape (K,) [s]
    cuts : Cuts
        Good ones for these durations.
    """
    for width in _WIDTHS:
        if deadline.over:
            break
        relaxed = RelaxedProblem.of(problem, float(durations.sum()) * (1.0 + width))
        boxes = Boxes.around(relaxed, durations / (1.0 + width), durations * (1.0 + width))
        frame = Frame(relaxed, boxes, durations)
        program = LinearProgram(frame, cuts)
        found = program.solve(frame.cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
        cuts = program.cuts
        # the boxes are empty where the durations are too short
        optimal = found.status == LPStatus.OPTIMAL
        durations = durations * (found.x[frame.T] if optimal else 1.0 + width)
    return durations, cuts
