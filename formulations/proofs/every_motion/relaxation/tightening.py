"""Narrower boxes for the motions that take at most the horizon, and with them a tighter relaxation.

Each bound of a duration, or of an acceleration at a waypoint, is itself the optimum of the relaxation
for another cost, and it is certified in the same way (optimality-based bound tightening). What the rows
(6), (8) and (9) lose is proportional to the product of two boxes' widths. So every box that has become
narrower is used at once, in the rows of the next program.

References
----------
Gleixner, Berthold, Mueller & Weltge 2017, "Three enhancements for optimization-based bound tightening",
Journal of Global Optimization 67, pp. 731-757.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from formulations.deadlines import Deadline
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import PRODUCTS, Cuts
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram, LPSolution
from formulations.proofs.every_motion.relaxation.propagation import propagate
from formulations.proofs.every_motion.relaxation.relaxed_problem import UP

FEW, MANY = 3, 15  # rounds of cuts for one bound: to begin with, and where few gain nothing
_TOLERANCE = 1e-6


class Record(Protocol):
    """What writes a proof down while boxes are narrowed."""

    def narrowed(self, program: LinearProgram, column: int, side: int, found: LPSolution) -> None:
        """Note the program that narrows the box of a column from one side, or proves it empty."""

    def renewed(self) -> None:
        """Note that the rows are from now on those of the narrowed boxes, after ``propagate``."""


def tighten(
    program: LinearProgram,
    solution: LPSolution,
    deadline: Deadline,
    record: Record | None = None,
    rounds: int = FEW,
) -> tuple[Boxes, Cuts]:
    """Narrow the boxes of a program without losing a motion, as far as the time goes.

    All durations are narrowed, and those accelerations whose products (9) have a multiplier.

    Parameters
    ----------
    program : LinearProgram
    solution : LPSolution
        Of the total time.
    deadline : Deadline
    record : Record, optional
    rounds : int
        Of cuts for one bound.

    Returns
    -------
    boxes : Boxes
    cuts : Cuts
        Of the last program.
    """
    frame = program.frame
    wanted = [(0, k, 0) for k in range(frame.K)]
    wanted += [(1, k, j) for k, j in _with_multiplier(program, solution)]
    for of_acceleration, k, j in wanted:
        frame, boxes = program.frame, program.frame.boxes
        durations, accelerations = boxes.durations.copy(), boxes.accelerations.copy()
        if of_acceleration:
            column, interval = int(frame.a[k, j]), accelerations[k, j]
            unit = float(frame.relaxed.acceleration[j])
        else:
            column, interval, unit = int(frame.T[k]), durations[k], float(frame.typical[k])
        for side, sign in ((0, 1.0), (1, -1.0)):
            if deadline.over:
                return boxes, program.cuts
            cost = np.zeros(frame.size)
            cost[column] = sign
            found = program.solve(cost, rounds=rounds, tolerance=_TOLERANCE, deadline=deadline)
            if record is not None:
                record.narrowed(program, column, side, found)
            if found.empty:
                return Boxes(durations, accelerations, empty=True), program.cuts
            bound = sign * found.bound * unit
            bound -= sign * (UP - 1.0) * abs(bound)
            interval[side] = max(interval[0], bound) if side == 0 else min(interval[1], bound)
        empty = bool(interval[0] > interval[1])
        boxes = propagate(frame.relaxed, Boxes(durations, accelerations, empty))
        if record is not None:
            record.renewed()
        if boxes.empty:
            return boxes, program.cuts
        program = program.renewed(boxes)
    return program.frame.boxes, program.cuts


def _with_multiplier(program: LinearProgram, solution: LPSolution) -> list[tuple[int, int]]:
    """Waypoints and joints whose product rows have a multiplier."""
    cuts, y = program.cuts, solution.multipliers[program.n_fixed :]
    found = set()
    for kind in PRODUCTS:
        carries = (cuts.kind == kind) & (y > 1e-9 * np.abs(y).max(initial=0.0))
        waypoints = (cuts.segment[carries] + kind.end).tolist()
        found |= set(zip(waypoints, cuts.joint[carries].tolist(), strict=True))
    return sorted(found)
