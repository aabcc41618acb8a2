"""Narrower boxes for the motions that take at most the horizon, and with them a tighter relaxation.

Each bound of a duration, or of an acceleration at a waypoint, is itself the optimum of the relaxation
for another cost, and it is certified in the same way (optimality-based bound tightening). What the rows
(6), (8) and (9) lose is proportional to the square of the boxes' widths.

References
----------
Gleixner, Berthold, Mueller & Weltge 2017, "Three enhancements for optimization-based bound tightening",
Journal of Global Optimization 67, pp. 731-757.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from formulations.deadlines import Deadline
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import PRODUCTS
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram, LPSolution
from formulations.proofs.every_motion.relaxation.relaxed_problem import UP

_ROUNDS, _TOLERANCE = 5, 1e-6  # of cuts for one bound, which need not be the best one


def tighten(
    program: LinearProgram,
    solution: LPSolution,
    deadline: Deadline,
    note: Callable[[int, int, LPSolution], None] | None = None,
) -> Boxes:
    """Narrow the boxes of a program without losing a motion, as far as the time goes.

    All durations are narrowed, and those accelerations whose products (9) have a multiplier.

    Parameters
    ----------
    program : LinearProgram
    solution : LPSolution
        Of the total time.
    deadline : Deadline
    note : callable, optional
        Called as ``note(column, side, solution)`` for every program that narrows a box.

    Returns
    -------
    Boxes
    """
    frame = program.frame
    durations, accelerations = frame.boxes.durations.copy(), frame.boxes.accelerations.copy()
    wanted = [(int(frame.T[k]), durations[k], float(frame.typical[k])) for k in range(frame.K)]
    for k, j in _with_multiplier(program, solution):
        scale = float(frame.relaxed.acceleration[j])
        wanted.append((int(frame.a[k, j]), accelerations[k, j], scale))
    for column, interval, unit in wanted:
        for side, sign in ((0, 1.0), (1, -1.0)):
            if deadline.over:
                return Boxes(durations, accelerations)
            cost = np.zeros(frame.size)
            cost[column] = sign
            found = program.solve(cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
            if note is not None:
                note(column, side, found)
            if found.empty:
                return Boxes(durations, accelerations, empty=True)
            bound = sign * found.bound * unit
            bound -= sign * (UP - 1.0) * abs(bound)
            interval[side] = max(interval[0], bound) if side == 0 else min(interval[1], bound)
        if interval[0] > interval[1]:
            return Boxes(durations, accelerations, empty=True)
    return Boxes(durations, accelerations)


def _with_multiplier(program: LinearProgram, solution: LPSolution) -> list[tuple[int, int]]:
    """Waypoints and joints whose product rows have a multiplier."""
    cuts, y = program.cuts, solution.multipliers[program.n_fixed :]
    found = set()
    for kind in PRODUCTS:
        carries = (cuts.kind == kind) & (y > 1e-9 * np.abs(y).max(initial=0.0))
        waypoints = (cuts.segment[carries] + kind.end).tolist()
        found |= set(zip(waypoints, cuts.joint[carries].tolist(), strict=True))
    return sorted(found)
