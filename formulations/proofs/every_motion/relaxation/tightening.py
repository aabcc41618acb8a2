"""Narrower boxes for the motions that take at most the horizon, and with them a tighter relaxation.

Each bound of a duration, or of an acceleration at a waypoint, is itself the optimum of the relaxation
for another cost, certified the same way (optimality-based bound tightening, Gleixner et al. 2017). The
rows (6), (8) and (9) lose by the square of the boxes' widths.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.every_motion.relaxation.cuts import PRODUCT_AT_END, PRODUCT_AT_START
from formulations.proofs.every_motion.relaxation.program import Program, Solution
from formulations.proofs.every_motion.relaxation.task import UP

_ROUNDS, _TOLERANCE = 5, 1e-6  # of cuts for one bound: it need not be the best there is


@dataclass(frozen=True)
class Boxes:
    """durations (K, 2) [s], accelerations (K + 1, n, 2) [rad/s^2]; empty: no motion is left in them."""

    durations: Array
    accelerations: Array
    empty: bool


def tightened(
    program: Program,
    solution: Solution,
    deadline: float,
    note: Callable[[int, int, Solution], None] | None = None,
) -> Boxes:
    """Boxes that hold every motion the program's boxes do, as far as the time goes.

    Durations all, accelerations where the products (9) carry the bound of ``solution``. note(column,
    side, solution): told of every program that narrows a box.
    """
    frame = program.frame
    durations, accelerations = frame.durations.copy(), frame.accelerations.copy()
    wanted = [(int(frame.T[k]), durations[k], float(frame.typical[k])) for k in range(frame.K)]
    for k, j in _priced(program, solution):
        scale = float(frame.task.acceleration[j])
        wanted.append((int(frame.a[k, j]), accelerations[k, j], scale))
    for column, interval, unit in wanted:
        for side, sign in ((0, 1.0), (1, -1.0)):
            if time.perf_counter() > deadline:
                return Boxes(durations, accelerations, False)
            cost = np.zeros(frame.size)
            cost[column] = sign
            found = program.solve(cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
            if note is not None:
                note(column, side, found)
            if found.empty:
                return Boxes(durations, accelerations, True)
            bound = sign * found.bound * unit
            bound -= sign * (UP - 1.0) * abs(bound)
            interval[side] = max(interval[0], bound) if side == 0 else min(interval[1], bound)
        if interval[0] > interval[1]:
            return Boxes(durations, accelerations, True)
    return Boxes(durations, accelerations, False)


def _priced(program: Program, solution: Solution) -> list[tuple[int, int]]:
    """Waypoints and joints whose product rows have a multiplier."""
    cuts, y = program.cuts, solution.multipliers[program.n_fixed :]
    found = set()
    for end, kind in enumerate((PRODUCT_AT_START, PRODUCT_AT_END)):
        carries = (cuts.kind == kind) & (y > 1e-9 * np.abs(y).max(initial=0.0))
        found |= set(
            zip((cuts.segment[carries] + end).tolist(), cuts.joint[carries].tolist(), strict=True)
        )
    return sorted(found)
