"""What each limit costs: the derivative of the bound, from the multipliers.

With the point held fixed in SI units, a row's multiplier times the derivative of the row by the
logarithm of a limit is the derivative of the bound. So ``savings`` are the seconds saved per relative
increase of a limit, to first order: 10 % more of it saves a tenth of that. Since stretching time by s
divides the limits by s, s^2 and s^3, a bound on which the boxes have no influence obeys

    sum of savings by velocity + 2 by acceleration + 3 by jerk = bound.                        (12)
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.relaxation.cuts import (
    CRUISE,
    DISTANCE,
    PEAK_AT_END,
    PEAK_AT_START,
    PRODUCT_AT_END,
    PRODUCT_AT_START,
    SPEED,
    STOP_AT_END,
    STOP_AT_START,
    Cuts,
)
from formulations.proofs.every_motion.relaxation.program import Program, Solution
from formulations.proofs.every_motion.relaxation.reach import (
    distance_coefficients,
    speed_coefficients,
    stop_coefficients,
)
from formulations.proofs.every_motion.relaxation.rows import Frame


def savings(problem: Problem, program: Program, solution: Solution) -> Array:
    """Seconds saved per relative increase of velocity, acceleration, jerk limits, (3, K, n).

    A limit at a waypoint counts half to each of the segments that meet there. Limits that the horizon
    sets count for nothing.
    """
    frame, x = program.frame, solution.x
    found = np.zeros((3, frame.K, frame.n))
    y = np.maximum(solution.multipliers[program.n_fixed :], 0.0)
    for kind in np.unique(program.cuts.kind[y > 0.0]):
        which = (program.cuts.kind == kind) & (y > 0.0)
        cuts = program.cuts[which]
        for quantity, share in enumerate(_shares(frame, int(kind), cuts, x)):
            np.add.at(found[quantity], (cuts.segment, cuts.joint), y[which] * share)
    reduced = frame.cost + program.rows.matrix.T @ np.maximum(solution.multipliers, 0.0)
    for quantity, columns in ((0, frame.v), (1, frame.a)):
        bound = np.abs(x[columns]) > 1.0 - 1e-9
        price = np.where(bound, -reduced[columns] * x[columns], 0.0)[1:-1]
        found[quantity, :-1] += 0.5 * price
        found[quantity, 1:] += 0.5 * price
    return _attributed(problem, frame, found)


def _attributed(problem: Problem, frame: Frame, found: Array) -> Array:
    """Prices of the limits in force as those of the problem's own: see ``Task.of``."""
    task = frame.task
    V, A, J = problem.limits.derivatives[:, task.joints]
    own = task.acceleration >= A
    by_both = ~own & np.isclose(task.acceleration, np.sqrt(2.0 * J * V), rtol=1e-12)
    shared = np.where(by_both, 0.5 * found[1], 0.0)
    velocity = np.where(task.velocity >= V, found[0], 0.0) + shared
    return np.stack([velocity, np.where(own, found[1], 0.0), found[2] + shared])


def _shares(frame: Frame, kind: int, cuts: Cuts, x: Array) -> tuple[Array, Array, Array]:
    """Minus the derivative of each row by the logarithm of the three limits, at x: each (m,)."""
    k, j = cuts.segment, cuts.joint
    none = np.zeros(len(k))
    if kind in (DISTANCE, CRUISE, SPEED, STOP_AT_START, STOP_AT_END):
        A, J = frame.ramp[k, j] * x[frame.T[k]], frame.bend[k, j] * x[frame.square[k]]
        if kind in (STOP_AT_START, STOP_AT_END):
            c_A, c_J = stop_coefficients(cuts.at[:, :2])[2:]
            return none, c_A * A, c_J * J
        if kind == SPEED:
            c_A, c_J = speed_coefficients(cuts.at[:, :2])[2:]
            return none, c_A * A, c_J * J
        c_V, c_A, c_J = distance_coefficients(cuts.at, kind == CRUISE)[4:]
        return c_V, c_A * A, c_J * J
    if kind in (PEAK_AT_START, PEAK_AT_END):
        end = int(kind == PEAK_AT_END)
        return none + 1.0, none, 1.0 - cuts.sign * x[frame.v[k + end, j]]
    if kind in (PRODUCT_AT_START, PRODUCT_AT_END):
        t, e, side = frame.corner(cuts, int(kind == PRODUCT_AT_END))
        return none, np.where(np.abs(e) >= 1.0, side * e * (t - x[frame.T[k]]), 0.0), none
    return none, none, none
