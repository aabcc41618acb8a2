"""The least total time of a long chain, by an interior point method in place of the simplex method.

But for the horizon, each row is about one segment and the waypoints at its ends. So the variables stand in a
narrow band if they are ordered along the motion, and a solve takes a time proportional to their number. Its
point lies inside the optimal face: the rows that cut it off cut deeper than those of a vertex, and fewer
rounds are needed (Goffin & Vial 2002). The horizon's row is left out, since the optimum is compared with the
horizon. Its multipliers are certified like any others.

References
----------
Goffin & Vial 2002, "Convex nondifferentiable optimization: a survey focused on the analytic center cutting
plane method", Optimization Methods and Software 17, pp. 805-867.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from formulations.deadlines import NEVER, Deadline
from formulations.problem.arrays import Array, Indices
from formulations.proofs.every_motion.interior_point import minimise_in_band
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram, LPSolution
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.separation import separate

_LOOSE, _TIGHT = 1e-4, 1e-8  # of the solves between two rounds of cuts, and of the last one
_FAILURES = 3  # solves in a row that rounding or the deadline ended
_FEW = 8  # segments of a chain that is not long
_SHARE = 0.03  # of the way to the ceiling
_FIRST = 8  # rounds in any case
_LAG, _LITTLE = 2, 0.1  # rounds, and the least share of the way to the ceiling that they have to gain
_FAR = 1e3  # multipliers: rows with more slack are dropped where there are many
_ACTIVE = (1.0, 1e-2, 1e-4, 0.0)  # slacks, tried in turn: rows with smaller multipliers are left out
_LOST = 1e-2  # of the way to the ceiling: what rows that are left out may cost besides
_TRUSTED = 1e-7  # of the optimum: the greatest difference between point and multipliers


def long_chain(frame: Frame) -> bool:
    """Say whether each row but the horizon is about one segment, and segments are many.

    Parameters
    ----------
    frame : Frame

    Returns
    -------
    bool
        Not on a cycle, nor where a segment may take no time, or legs over several segments have rows.
    """
    other = frame.relaxed.cyclic or frame.L > frame.K or bool(frame.short.any())
    return frame.K > _FEW and not other


def least_time(
    program: LinearProgram,
    *,
    rounds: int,
    tolerance: float,
    deadline: Deadline = NEVER,
    ceiling: float = np.inf,
) -> LPSolution:
    """Minimise the total time, in a band where that is possible, else by HiGHS.

    Parameters
    ----------
    program : LinearProgram
    rounds : int
        Greatest number of solves.
    tolerance : float
        The point has converged if it violates no row by more.
    deadline : Deadline
    ceiling : float [s]
        On a long chain, rounds that close little of the way to it are the last ones.

    Returns
    -------
    LPSolution
    """
    frame, found = program.frame, None
    if long_chain(frame) and not frame.bounded_sums:
        found = _solve_in_band(program, rounds, tolerance, deadline, ceiling)
    if found is not None:
        return found
    return program.solve(frame.cost, rounds=rounds, tolerance=tolerance, deadline=deadline)


def _solve_in_band(
    program: LinearProgram, rounds: int, tolerance: float, deadline: Deadline, ceiling: float
) -> LPSolution | None:
    """None where rounding or the deadline left no answer, or no point may be in the boxes."""
    frame = program.frame
    columns = _along_the_motion(frame)
    values: list[float] = []
    failures = 0
    last, accuracy = rounds == 1, _LOOSE
    while True:
        x, y, converged = _solved(program, columns, _TIGHT if last else accuracy, deadline)
        values.append(float(frame.cost @ x))
        failures = 0 if converged else failures + 1
        if last or failures == _FAILURES:
            break
        accuracy = float(np.clip(_SHARE * (ceiling / values[-1] - 1.0), _TIGHT, _LOOSE))
        stalled = len(values) >= _FIRST and np.isfinite(ceiling)
        stalled = stalled and values[-1] - values[-1 - _LAG] < _LITTLE * (ceiling - values[-1])
        cuts = separate(frame, x, tolerance)
        last = stalled or not len(cuts) or len(values) >= rounds - 1 or values[-1] > ceiling
        if len(cuts):
            if program.crowded:
                program.drop((program.rows.slacks(x) > _FAR * y)[program.n_fixed :])
            program.add(cuts)
    slacks, least = program.rows.slacks(x), values[-1] - _TRUSTED * abs(values[-1])
    if np.isfinite(ceiling):
        least = min(least, values[-1] - _LOST * (ceiling - values[-1]))
    for share in _ACTIVE:
        solution = program.proved(frame.cost, x, np.where(y > share * slacks, y, 0.0))
        if solution.bound > least:
            return solution
    return None


def _along_the_motion(frame: Frame) -> Indices:
    """The columns that can move, in the order of the waypoints and segments that they are about."""
    place, k, i = np.zeros(frame.size), np.arange(frame.K), np.arange(frame.K + 1)[:, None]
    place[frame.T] = place[frame.inverse] = place[frame.square] = k + 0.5
    place[frame.W] = k[:, None, None] + 0.5
    place[frame.v] = place[frame.a] = i
    there, at_ends = frame.e >= 0, frame.p >= 0
    place[frame.e[there]] = np.broadcast_to(i, frame.e.shape)[there]
    place[frame.p[at_ends]] = np.broadcast_to(k[:, None, None] + 0.5, frame.p.shape)[at_ends]
    order = np.argsort(place, kind="stable")
    return order[frame.box[order, 0] < frame.box[order, 1]]


def _solved(
    program: LinearProgram, columns: Indices, tolerance: float, deadline: Deadline
) -> tuple[Array, Array, bool]:
    """A point (size,), multipliers (n_rows,), and whether the solve converged."""
    frame, x = program.frame, program.frame.box[:, 0].copy()
    x[columns] = 0.0
    matrix = program.rows.matrix[1:]  # without the horizon
    mine = csr_array(matrix[:, columns])
    mine.sort_indices()
    there = np.diff(mine.indptr) > 0
    upper = program.rows.upper[1:] - matrix @ x
    found = minimise_in_band(
        frame.cost[columns],
        mine[there],
        upper[there],
        frame.box[columns],
        tolerance=tolerance,
        deadline=deadline,
    )
    x[columns] = found.x
    y = np.zeros(len(program.rows))
    y[1:][there] = found.multipliers
    return x, y, found.converged
