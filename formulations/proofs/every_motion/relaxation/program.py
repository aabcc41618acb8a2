"""The linear program in a frame, solved by HiGHS, its rows found as they are needed (Kelley 1960)."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import highspy
import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.rows import Frame, Rows
from formulations.proofs.every_motion.relaxation.safe_dual import safe_bound
from formulations.proofs.every_motion.relaxation.separation import separate

_OPTIONS = {
    "output_flag": False,
    "threads": 1,
    "small_matrix_value": 1e-12,  # it would drop coefficients
    "primal_feasibility_tolerance": 1e-10,  # HiGHS's least: the bound does not rest on it, the cuts do
    "dual_feasibility_tolerance": 1e-10,
}
_ANSWERS = (
    highspy.HighsModelStatus.kOptimal,
    highspy.HighsModelStatus.kInfeasible,
    highspy.HighsModelStatus.kTimeLimit,
)
_PLAIN = {"presolve": "choose", "simplex_scale_strategy": 2, "solver": "choose"}
# what is tried in turn until there is an answer, each but the first from scratch
_ATTEMPTS: tuple[dict[str, str | int], ...] = (
    {},
    {},
    {"presolve": "off", "simplex_scale_strategy": 0},
    {"presolve": "on", "simplex_scale_strategy": 4, "solver": "ipm"},
)
_SLACK = 1e-7  # a row this far from the point is not missed
_CROWD = 3.0  # rows per variable, above which those are dropped


@dataclass(frozen=True)
class Solution:
    """Point (size,) and multipliers (n_rows,) of one solve; bound: certified, of the cost asked for.

    status: HiGHS's word. converged: no row cuts the point off any more. empty: certified that no motion
    of at most ``task.horizon`` seconds is in the boxes.
    """

    status: str
    x: Array
    multipliers: Array
    bound: float
    converged: bool
    empty: bool


class Program:
    """min cost x over the frame's rows and those of the cuts found so far."""

    def __init__(self, frame: Frame, cuts: Cuts) -> None:
        self.frame = frame
        self.highs = highspy.Highs()
        for option, value in _OPTIONS.items():
            self.highs.setOptionValue(option, value)
        self.refused = False  # whether HiGHS did not take a variable or a row
        self._note(self.highs.addVars(frame.size, frame.box[:, 0].copy(), frame.box[:, 1].copy()))
        self.rows = frame.fixed()
        self.n_fixed = len(self.rows)
        self.cuts = cuts[:0]
        self._pass(self.rows)
        self.add(cuts)

    def add(self, cuts: Cuts) -> None:
        """Pose more rows."""
        if len(cuts):
            rows = self.frame.of(cuts)
            kept = rows.finite
            rows = rows[kept]
            self._pass(rows)
            self.rows = Rows.joined([self.rows, rows])
            self.cuts = Cuts.joined([self.cuts, cuts[kept]])

    def _note(self, status: highspy.HighsStatus) -> None:
        self.refused |= status == highspy.HighsStatus.kError

    def _pass(self, rows: Rows) -> None:
        matrix = rows.matrix.copy()
        matrix.eliminate_zeros()
        status = self.highs.addRows(
            len(rows),
            np.full(len(rows), -np.inf),
            rows.upper,
            matrix.nnz,
            matrix.indptr[:-1].astype(np.int32),
            matrix.indices.astype(np.int32),
            matrix.data,
        )
        self._note(status)

    def confine(self, box: Array) -> None:
        """Look only in a box (size, 2): for a point, not for a bound, which stays that of the frame."""
        columns = np.arange(len(box), dtype=np.int32)
        self.highs.changeColsBounds(len(box), columns, box[:, 0].copy(), box[:, 1].copy())

    def thin_out(self) -> None:
        """Drop the cuts that do not touch the last point, when there are many."""
        if len(self.rows) < _CROWD * self.frame.size:
            return
        x = np.array(self.highs.getSolution().col_value)
        far = self.rows.upper - self.rows.matrix @ x > _SLACK
        far[: self.n_fixed] = False
        gone = np.flatnonzero(far).astype(np.int32)
        self.highs.deleteRows(len(gone), gone)
        self.rows = self.rows[~far]
        self.cuts = self.cuts[~far[self.n_fixed :]]

    def solve(
        self, cost: Array, *, rounds: int, tolerance: float, deadline: float = math.inf
    ) -> Solution:
        """Solve, cut the point off, solve again: at most ``rounds`` times, until no row is violated
        by more than ``tolerance`` or the clock is past ``deadline``. cost: (size,).
        """
        self.highs.changeColsCost(len(cost), np.arange(len(cost), dtype=np.int32), cost)
        converged = False
        for turn in range(rounds):
            if self._run(deadline) != highspy.HighsModelStatus.kOptimal:
                break
            x = np.array(self.highs.getSolution().col_value)
            cuts = separate(self.frame, x, tolerance)
            converged = not len(cuts)
            if converged or turn == rounds - 1:
                break
            self.thin_out()
            self.add(cuts)
        return self._solution(cost, converged)

    def _run(self, deadline: float) -> highspy.HighsModelStatus:
        """Solve from the last basis; where no answer comes of it, from scratch, in other ways."""
        status = highspy.HighsModelStatus.kNotset
        if self.refused:
            return status
        for attempt in _ATTEMPTS:
            for option, value in attempt.items():
                self.highs.setOptionValue(option, value)
            left = max(deadline - time.perf_counter(), 1e-3)
            self.highs.setOptionValue("time_limit", self.highs.getRunTime() + left)
            self.highs.run()
            status = self.highs.getModelStatus()
            if status in _ANSWERS and self._answers(status):
                break
            self.highs.clearSolver()
        for option, value in _PLAIN.items():
            self.highs.setOptionValue(option, value)
        return status

    def _answers(self, status: highspy.HighsModelStatus) -> bool:
        """Whether the multipliers that a status promises are there."""
        if status == highspy.HighsModelStatus.kOptimal:
            return len(self.highs.getSolution().row_dual) == len(self.rows)
        return status != highspy.HighsModelStatus.kInfeasible or self._ray() is not None

    def _ray(self) -> Array | None:
        """Multipliers that prove the rows contradictory, (n_rows,); None if HiGHS has none."""
        _, known, ray = self.highs.getDualRay()
        return -np.array(ray) if known and len(ray) == len(self.rows) else None

    def _solution(self, cost: Array, converged: bool) -> Solution:
        status = self.highs.getModelStatus()
        solution = self.highs.getSolution()
        x, y = np.array(solution.col_value), -np.array(solution.row_dual)
        if len(y) != len(self.rows):  # HiGHS gave up before it had any
            x, y = self.frame.box.mean(axis=1), np.zeros(len(self.rows))
        empty = False
        if status == highspy.HighsModelStatus.kInfeasible:
            ray = self._ray()
            if ray is not None:
                y = ray
                empty = self.certify(0.0 * cost, y) > 0.0
        bound = np.inf if empty else self.certify(cost, y)
        name = "numbers out of range" if self.refused else self.highs.modelStatusToString(status)
        return Solution(name, x, y, bound, converged, empty)

    def certify(self, cost: Array, multipliers: Array) -> float:
        """Safe lower bound of cost x from any multipliers (n_rows,)."""
        rows = self.rows
        return safe_bound(cost, rows.matrix, rows.upper, self.frame.box, multipliers)
