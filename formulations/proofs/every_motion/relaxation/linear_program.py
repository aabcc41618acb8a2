"""The linear program in a frame, solved by HiGHS; its rows are found as they are needed.

References
----------
Kelley 1960, "The cutting-plane method for solving convex programs", Journal of the Society for
Industrial and Applied Mathematics 8, pp. 703-712.
Huangfu & Hall 2018, "Parallelizing the dual revised simplex method", Mathematical Programming
Computation 10, pp. 119-142 (HiGHS).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

import highspy
import numpy as np

from formulations.deadlines import NEVER, Deadline
from formulations.problem.arrays import Array, Truths
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.inequalities import Rows
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.safe_dual import safe_bound
from formulations.proofs.every_motion.relaxation.separation import separate

OPTIONS = {
    "output_flag": False,
    "threads": 1,
    "small_matrix_value": 1e-12,  # HiGHS drops coefficients below this
    "primal_feasibility_tolerance": 1e-10,  # HiGHS's least: the cuts need it, the bound does not
    "dual_feasibility_tolerance": 1e-10,
}
_DEFAULTS: dict[str, str | int] = {
    "presolve": "choose",
    "simplex_scale_strategy": 2,
    "solver": "choose",
}
# tried in turn until there is an answer, each but the first from scratch
_ATTEMPTS: tuple[dict[str, str | int], ...] = (
    {},
    {},
    {"presolve": "off", "simplex_scale_strategy": 0},
    {"presolve": "on", "simplex_scale_strategy": 4, "solver": "ipm"},
)
_LEAST = 1e-13  # multipliers below this share of the largest are not written down
_CHECKERS_ROUNDING = 1e-13  # of the sum of all terms' moduli
_FAR = 1e-7  # a row with more slack than this may be dropped
_CROWD = 3.0  # rows per variable above which rows are dropped


class LPStatus(StrEnum):
    """How a solve ended."""

    OPTIMAL = "optimal"
    INFEASIBLE = "infeasible"
    TIME_LIMIT = "time limit"
    REFUSED = "numbers out of range"  # HiGHS did not take a variable or a row
    FAILED = "failed"


_STATUS = {
    highspy.HighsModelStatus.kOptimal: LPStatus.OPTIMAL,
    highspy.HighsModelStatus.kInfeasible: LPStatus.INFEASIBLE,
    highspy.HighsModelStatus.kTimeLimit: LPStatus.TIME_LIMIT,
}


@dataclass(frozen=True)
class LPSolution:
    """What one solve of a linear program gave.

    Attributes
    ----------
    status : LPStatus
    reason : str
        The status in HiGHS's own words.
    x : Array, shape (size,)
        The point; the middle of the boxes where HiGHS gave none.
    multipliers : Array, shape (n_rows,)
        At least 0 up to rounding; all 0 where HiGHS gave none.
    bound : float
        Certified lower bound of the cost asked for, whatever the status; infinite if ``empty``.
    converged : bool
        Whether no row cuts the point off any more.
    empty : bool
        Whether it is certified that no motion of at most ``horizon`` seconds is in the boxes.
    """

    status: LPStatus
    reason: str
    x: Array
    multipliers: Array
    bound: float
    converged: bool
    empty: bool


class LinearProgram:
    """Minimise cost x over the frame's rows and those of the cuts found so far.

    Attributes
    ----------
    rows : Rows
        All rows, the ``n_fixed`` without a cut first.
    cuts : Cuts
        Of the other rows, in their order.
    """

    def __init__(self, frame: Frame, cuts: Cuts, *, for_checker: bool = False) -> None:
        """Pose the program.

        Parameters
        ----------
        frame : Frame
        cuts : Cuts
            The rows to begin with, besides those that the frame always has.
        for_checker : bool
            Whether the bounds must hold in the rounding of an independent checker too: tiny multipliers
            are then left out, and each bound is lowered by more than the checker's rounding.
        """
        self.frame, self._for_checker = frame, for_checker
        self.highs = highspy.Highs()
        for option, value in OPTIONS.items():
            self.highs.setOptionValue(option, value)
        # the simplex method may cycle from an old basis: then the next attempt starts from scratch
        self.highs.setOptionValue("simplex_iteration_limit", 5_000 + 50 * frame.size)
        self._refused = False
        self._note(self.highs.addVars(frame.size, frame.box[:, 0].copy(), frame.box[:, 1].copy()))
        self.rows = frame.fixed()
        self.n_fixed = len(self.rows)
        self.cuts = cuts[:0]
        self._pass(self.rows)
        self.add(cuts)

    def add(self, cuts: Cuts) -> None:
        """Add the rows of more cuts, except those that overflow in this frame.

        Parameters
        ----------
        cuts : Cuts
        """
        if len(cuts):
            rows = self.frame.of(cuts)
            kept = rows.finite
            rows = rows[kept]
            self._pass(rows)
            self.rows = Rows.joined([self.rows, rows])
            self.cuts = Cuts.joined([self.cuts, cuts[kept]])

    def renewed(self, boxes: Boxes, kept: Truths | slice = slice(None)) -> LinearProgram:
        """Pose the same program in other boxes.

        Parameters
        ----------
        boxes : Boxes
        kept : Truths, shape (n_cuts,), optional
            The cuts that it keeps.

        Returns
        -------
        LinearProgram
        """
        frame = Frame(self.frame.relaxed, boxes, self.frame.typical)
        return LinearProgram(frame, self.cuts[kept], for_checker=self._for_checker)

    def _note(self, status: highspy.HighsStatus) -> None:
        """Remember a refusal: HiGHS then holds fewer rows than this object."""
        self._refused |= status == highspy.HighsStatus.kError

    def _pass(self, rows: Rows) -> None:
        matrix = rows.matrix
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
        """Look for points in a smaller box; certified bounds stay those of the frame's box.

        Parameters
        ----------
        box : Array, shape (size, 2)
        """
        columns = np.arange(len(box), dtype=np.int32)
        self._note(self.highs.changeColsBounds(len(box), columns, box[:, 0].copy(), box[:, 1].copy()))

    @property
    def crowded(self) -> bool:
        """Whether some rows should go."""
        return len(self.rows) > _CROWD * self.frame.size

    def drop(self, cuts: Truths) -> None:
        """Drop rows.

        Parameters
        ----------
        cuts : Truths, shape (n_cuts,)
            Which.
        """
        gone = (self.n_fixed + np.flatnonzero(cuts)).astype(np.int32)
        self.highs.deleteRows(len(gone), gone)
        self.rows = self.rows[np.concatenate([np.ones(self.n_fixed, dtype=bool), ~cuts])]
        self.cuts = self.cuts[~cuts]

    def solve(
        self, cost: Array, *, rounds: int, tolerance: float, deadline: Deadline = NEVER
    ) -> LPSolution:
        """Solve, cut the point off, and solve again.

        Parameters
        ----------
        cost : Array, shape (size,)
        rounds : int
            Greatest number of solves.
        tolerance : float
            The point has converged if it violates no row by more.
        deadline : Deadline

        Returns
        -------
        LPSolution
        """
        self.highs.changeColsCost(len(cost), np.arange(len(cost), dtype=np.int32), cost)
        converged, proved = False, None
        for turn in range(rounds):
            if self._run(deadline) != LPStatus.OPTIMAL:
                break
            point = self.highs.getSolution()
            x, proved = np.array(point.col_value), (self.rows, -np.array(point.row_dual))
            cuts = separate(self.frame, x, tolerance)
            converged = not len(cuts)
            if converged or turn == rounds - 1:
                break
            if self.crowded:
                self.drop(self.rows.slacks(x)[self.n_fixed :] > _FAR)
            self.add(cuts)
        found = self._solution(cost, converged)
        if found.status == LPStatus.TIME_LIMIT and proved is not None and not self._for_checker:
            # the multipliers of the round before prove more than those of an unfinished one
            rows, y = proved
            before = safe_bound(cost, rows.matrix, rows.upper, self.frame.box, y)
            found = replace(found, bound=max(found.bound, before))
        return found

    def _run(self, deadline: Deadline) -> LPStatus:
        """Solve from the last basis; where that gives no answer, from scratch and in other ways."""
        for attempt in _ATTEMPTS:
            if self._refused:
                break
            for option, value in attempt.items():
                self.highs.setOptionValue(option, value)
            left = max(deadline.left, 1e-3)
            self.highs.setOptionValue("time_limit", self.highs.getRunTime() + left)
            self.highs.run()
            if attempt:
                for option, value in _DEFAULTS.items():
                    self.highs.setOptionValue(option, value)
            if self._has_answer():
                break
            self.highs.clearSolver()
        return self._status()

    def _status(self) -> LPStatus:
        if self._refused:
            return LPStatus.REFUSED
        return _STATUS.get(self.highs.getModelStatus(), LPStatus.FAILED)

    def _has_answer(self) -> bool:
        """Whether HiGHS gave the multipliers that its status promises."""
        status = self._status()
        if status == LPStatus.OPTIMAL:
            return len(self.highs.getSolution().row_dual) == len(self.rows)
        return status == LPStatus.TIME_LIMIT or (
            status == LPStatus.INFEASIBLE and self._ray() is not None
        )

    def _ray(self) -> Array | None:
        """Multipliers that prove the rows contradictory, (n_rows,); None if HiGHS has none."""
        _, known, ray = self.highs.getDualRay()
        return -np.array(ray) if known and len(ray) == len(self.rows) else None

    def _solution(self, cost: Array, converged: bool) -> LPSolution:
        status, solution = self._status(), self.highs.getSolution()
        x, y = np.array(solution.col_value), -np.array(solution.row_dual)
        if len(x) != self.frame.size or len(y) != len(self.rows):
            x, y = self.frame.box.mean(axis=1), np.zeros(len(self.rows))
        ray = self._ray() if status == LPStatus.INFEASIBLE else None
        y = self._kept(y if ray is None else ray)
        empty = ray is not None and self._bound(0.0 * cost, y) > 0.0
        bound = np.inf if empty else self._bound(cost, y)
        reason = self.highs.modelStatusToString(self.highs.getModelStatus())
        return LPSolution(status, reason, x, y, bound, converged, empty)

    def proved(self, cost: Array, x: Array, multipliers: Array) -> LPSolution:
        """Say what multipliers from elsewhere prove.

        Parameters
        ----------
        cost : Array, shape (size,)
        x : Array, shape (size,)
        multipliers : Array, shape (n_rows,)
            Those of later rows are 0.

        Returns
        -------
        LPSolution
        """
        y = np.zeros(len(self.rows))
        y[: len(multipliers)] = multipliers
        y = self._kept(y)
        bound = self._bound(cost, y)
        return LPSolution(LPStatus.OPTIMAL, "from elsewhere", x, y, bound, False, False)

    def _kept(self, y: Array) -> Array:
        """The multipliers that a proof keeps."""
        if not self._for_checker:
            return y
        return np.where(y > _LEAST * np.abs(y).max(initial=0.0), y, 0.0)

    def _bound(self, cost: Array, y: Array) -> float:
        """The certified bound, lowered for a checker if there is one."""
        bound = self.certify(cost, y)
        if not self._for_checker:
            return bound
        columns = np.abs(cost) + abs(self.rows.matrix).T @ y
        terms = columns @ np.abs(self.frame.box).max(axis=1) + y @ np.abs(self.rows.upper)
        return bound - _CHECKERS_ROUNDING * float(terms)

    def certify(self, cost: Array, multipliers: Array) -> float:
        """Compute a safe lower bound of the cost from any multipliers.

        Parameters
        ----------
        cost : Array, shape (size,)
        multipliers : Array, shape (n_rows,)

        Returns
        -------
        float
        """
        rows = self.rows
        return safe_bound(cost, rows.matrix, rows.upper, self.frame.box, multipliers)
