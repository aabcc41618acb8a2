"""Narrower boxes by small linear programs: a window of a few segments in place of the whole motion.

What narrows a box is mostly near it. A program over the whole motion costs much more than one over a window
of neighbouring segments, and there are as many boxes as segments times joints. Rows that reach out of the
window are not dropped: with the multipliers y of the total time they become one row, so that the horizon and
the states at the window's ends keep their price,

    (c + y A) x  <=  H + y b        over all rows A x <= b outside, where c x is the total time,

in which what is outside the window is replaced by its best value in its box. The multipliers of a window's
program are, with this row's multiplier times y, multipliers of the whole program. There they are certified
like any others: no bound depends on the window.
"""

from __future__ import annotations

import highspy
import numpy as np

from formulations.deadlines import Deadline
from formulations.problem.arrays import Array, Indices
from formulations.proofs.every_motion.relaxation.linear_program import (
    OPTIONS,
    LinearProgram,
    LPSolution,
)
from formulations.proofs.every_motion.relaxation.separation import separate

HALF = 2  # segments to either side of the one in the middle
_ITERATIONS = 1500  # of the simplex method, which may cycle: such a box stays as it is
# Devex prices on numbers as they are: 20 % faster than the defaults, by measurement
_QUICK = {"simplex_dual_edge_weight_strategy": 1, "simplex_scale_strategy": 0}
_TOLERANCE = 1e-6
_SMALL = 1e-9  # coefficients that the window's row leaves out


class Window:
    """The program of the segments around one, within a program of the whole motion."""

    def __init__(self, program: LinearProgram, prices: Array, middle: int) -> None:
        """Pose the program.

        Parameters
        ----------
        program : LinearProgram
        prices : Array, shape (n_rows,)
            Multipliers of the total time; those of later rows are 0.
        middle : int
            Number of the segment.
        """
        self.program, frame = program, program.frame
        self.first, self.end = max(middle - HALF, 0), min(middle + HALF + 1, frame.K)
        k, at = slice(self.first, self.end), slice(self.first, self.end + 1)
        inside = [frame.T[k], frame.inverse[k], frame.square[k], frame.v[at], frame.a[at], frame.W[k]]
        inside += [frame.e[at], frame.p[k]]
        columns = np.unique(np.concatenate([block.ravel() for block in inside]))
        self.columns = columns[columns >= 0]  # where there is no zone, there is no column
        self.place = np.full(frame.size, -1)
        self.place[self.columns] = np.arange(len(self.columns))
        self.rows = np.concatenate(
            [1 + np.arange(self.first, self.end), program.n_fixed + self._mine(program.cuts.segment)]
        )
        self.highs = highspy.Highs()
        for option, value in OPTIONS.items():
            self.highs.setOptionValue(option, value)
        self.highs.setOptionValue("simplex_iteration_limit", _ITERATIONS)
        for option, value in _QUICK.items():
            self.highs.setOptionValue(option, value)
        low, high = frame.box[self.columns].T
        self.highs.addVars(len(self.columns), low.copy(), high.copy())
        self._add_what_is_outside(prices)
        self._add(self.rows)

    def _mine(self, segments: Indices) -> Indices:
        return np.flatnonzero((segments >= self.first) & (segments < self.end))

    def _add_what_is_outside(self, prices: Array) -> None:
        program, frame = self.program, self.program.frame
        matrix = program.rows.matrix
        self.prices = np.maximum(prices, 0.0)
        self.prices[self.rows] = 0.0
        # row 0 is the horizon: the sum of the durations in units of H
        self.prices[0] = frame.typical[0] / matrix[[0]].toarray()[0, frame.T[0]]
        row, upper = matrix.T @ self.prices, float(self.prices @ program.rows.upper)
        outside = self.place < 0
        upper -= float(np.minimum(*(row[outside] * side for side in frame.box[outside].T)).sum())
        mine = row[self.columns]
        there = np.flatnonzero(np.abs(mine) > _SMALL)
        self.highs.addRow(-np.inf, upper, len(there), there.astype(np.int32), mine[there])

    def _add(self, rows: Indices) -> None:
        part, upper = self.program.rows.matrix[rows], self.program.rows.upper[rows]
        columns = self.place[part.indices].astype(np.int32)
        starts = part.indptr[:-1].astype(np.int32)
        self.highs.addRows(
            len(rows), np.full(len(rows), -np.inf), upper, part.nnz, starts, columns, part.data
        )

    def take(self, new: Indices) -> None:
        """Add those new rows of the program that are about the window's segments.

        Parameters
        ----------
        new : Indices
            Numbers of cuts.
        """
        mine = self.program.n_fixed + new[self._mine(self.program.cuts.segment[new])]
        self.rows = np.concatenate([self.rows, mine])
        self._add(mine)

    def solve(self, cost: Array) -> tuple[Array, Array] | None:
        """Minimise a cost in the window.

        Parameters
        ----------
        cost : Array, shape (size,)
            Of the whole program's columns.

        Returns
        -------
        x : Array, shape (len(columns),)
        multipliers : Array, shape (n_rows,)
            Of the whole program. None in place of both where there is no answer.
        """
        mine = cost[self.columns]
        self.highs.changeColsCost(len(mine), np.arange(len(mine), dtype=np.int32), mine)
        self.highs.run()
        if self.highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
            self.highs.clearSolver()
            return None
        point = self.highs.getSolution()
        y = np.maximum(-np.array(point.row_dual), 0.0)
        whole = np.zeros(len(self.program.rows))
        whole[: len(self.prices)] = y[0] * self.prices
        whole[self.rows] = y[1:]
        return np.array(point.col_value), whole


def solve_in_windows(
    program: LinearProgram,
    windows: list[Window],
    costs: list[Array],
    x: Array,
    rounds: int,
    deadline: Deadline,
) -> list[LPSolution | None]:
    """Minimise a cost in each of several windows that do not overlap.

    Parameters
    ----------
    program : LinearProgram
        It gets the rows that cut the windows' points off.
    windows : list of Window
    costs : list of Array, shape (size,)
    x : Array, shape (size,)
        A point of the whole program, for what is outside.
    rounds : int
        Of cuts.
    deadline : Deadline

    Returns
    -------
    list of LPSolution or None
        With multipliers and certified bounds of the whole program; None where there is no answer.
    """
    found: list[tuple[Array, Array] | None] = [None] * len(windows)
    for turn in range(rounds):
        point = x.copy()
        for i, (window, cost) in enumerate(zip(windows, costs, strict=True)):
            found[i] = answer = None if deadline.over else window.solve(cost)
            if answer is not None:
                point[window.columns] = answer[0]
        cuts = separate(program.frame, point, _TOLERANCE)
        covered = np.zeros(program.frame.K, dtype=bool)
        for window in windows:
            covered[window.first : window.end] = True
        cuts = cuts[covered[cuts.segment]]
        if turn == rounds - 1 or not len(cuts) or deadline.over:
            break
        before = len(program.cuts)
        program.add(cuts)
        for window in windows:
            window.take(np.arange(before, len(program.cuts)))
    return [
        None if answer is None else program.proved(cost, x, answer[1])
        for cost, answer in zip(costs, found, strict=True)
    ]
