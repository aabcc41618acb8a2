"""The bound is safe against rounding, and against whatever the solver says."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from every_motion_helpers import frame_for, holds, random_cuts
from scipy.sparse import csr_array

from formulations import Limits, Problem, free_form_bound, load
from formulations.problem.arrays import Array
from formulations.proofs.every_motion.closed_forms import least_durations
from formulations.proofs.every_motion.relaxation.cuts import Cuts, Kind
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram, LPStatus
from formulations.proofs.every_motion.relaxation.safe_dual import safe_bound
from formulations.proofs.status import BoundStatus


def lagrangian(cost: Array, matrix: Array, upper: Array, box: Array, y: Array) -> Fraction:
    """The bound of any multipliers in exact arithmetic."""
    exactly = np.vectorize(Fraction, otypes=[object])
    y = exactly(np.where(y > 0.0, y, 0.0))
    reduced = exactly(cost) + exactly(matrix).T @ y
    least = sum(min(r * low, r * high) for r, (low, high) in zip(reduced, exactly(box), strict=True))
    return Fraction(least - exactly(upper) @ y)


@pytest.mark.parametrize("seed", range(60))
def test_safe_bound_never_exceeds_the_exact_one(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m, n = rng.integers(1, 12, 2)
    matrix = rng.normal(size=(m, n)) * 10.0 ** rng.uniform(-8.0, 8.0, (m, n))
    cost, upper = rng.normal(size=n), rng.normal(size=m)
    box = np.sort(rng.normal(size=(n, 2)) * 10.0 ** rng.uniform(-3.0, 3.0, (n, 1)), axis=1)
    y = rng.normal(size=m) * 10.0 ** rng.uniform(-8.0, 8.0)
    if seed % 3 == 0:  # a reduced cost that cancels but for rounding
        cost = -(matrix.T @ np.maximum(y, 0.0))
    if seed % 3 == 1:  # nothing but the right hand sides
        box, y = 0.0 * box, np.abs(y)
    bound = safe_bound(cost, csr_array(matrix), upper, box, y)
    true = lagrangian(cost, matrix, upper, box, y)
    assert Fraction(bound) <= true
    reach = np.abs(box).max(axis=1)
    size = np.abs(cost) @ reach + np.abs(y) @ np.abs(upper) + np.abs(matrix).T @ np.abs(y) @ reach
    assert float(true) - bound <= 1e-13 * float(size) + 1e-280


def test_any_multipliers_give_a_valid_bound() -> None:
    problem = load("ur5")
    known = free_form_bound(problem).upper
    assert known is not None
    frame = frame_for(problem, known * 1.01)
    rng = np.random.default_rng(0)
    program = LinearProgram(frame, random_cuts(frame, rng))
    solution = program.solve(frame.cost, rounds=20, tolerance=1e-7)
    assert known * (1.0 - 1e-3) <= solution.bound <= known
    m = len(program.rows)
    for size in (1e-9, 1e-3, 1.0, 1e6, 1e300):
        for share in (0.0, 1.0):
            y = share * solution.multipliers + size * rng.normal(size=m)
            assert program.certify(frame.cost, y) <= known
            # what has a point is never certified to have none
            assert program.certify(0.0 * frame.cost, y) <= 0.0
    for value in (math.nan, math.inf, -math.inf, -1.0):
        assert program.certify(frame.cost, np.full(m, value)) <= known


def test_a_solver_that_fails_leaves_the_simple_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(self: LinearProgram, deadline: float) -> LPStatus:
        return LPStatus.FAILED

    monkeypatch.setattr(LinearProgram, "_run", broken)
    problem = load("ur5")
    bound = free_form_bound(problem)
    assert bound.status == BoundStatus.SOLVER_FAILED
    assert "HiGHS" in bound.reason
    assert bound.method == "segment"
    assert bound.seconds == pytest.approx(least_durations(problem).sum(), rel=1e-9)
    holds(problem, bound)


def test_a_solver_that_lies_proves_nothing_false(monkeypatch: pytest.MonkeyPatch) -> None:
    """Points and multipliers disturbed: every bound, of boxes too, stays below a known motion."""
    problem = load("ur5")
    known = free_form_bound(problem).upper
    honest = LinearProgram._solution
    rng = np.random.default_rng(0)

    def lying(self: LinearProgram, cost: Array, converged: bool) -> Any:
        solution = honest(self, cost, converged)
        noise = solution.multipliers * rng.uniform(0.5, 1.5, len(solution.multipliers))
        x = solution.x * rng.uniform(0.9, 1.1, len(solution.x))
        return replace(solution, x=x, multipliers=noise, bound=self.certify(cost, noise))

    monkeypatch.setattr(LinearProgram, "_solution", lying)
    bound = free_form_bound(problem, time_limit=2.0)
    assert known is not None
    assert bound.seconds <= known


@pytest.mark.parametrize("failures", [1, 2, 3])
def test_a_solve_without_multipliers_is_tried_again(
    failures: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From scratch, without presolve, by the interior point method: the bound is the same each time."""
    frame = frame_for(load("ur5"), 15.0)
    cuts = random_cuts(frame, np.random.default_rng(0))
    plain = LinearProgram(frame, cuts).solve(frame.cost, rounds=100, tolerance=1e-6)
    honest, seen = LinearProgram._has_answer, [0]

    def mute(self: LinearProgram) -> bool:
        seen[0] += 1
        return seen[0] % (failures + 1) == 0 and honest(self)

    monkeypatch.setattr(LinearProgram, "_has_answer", mute)
    again = LinearProgram(frame, cuts).solve(frame.cost, rounds=100, tolerance=1e-6)
    assert seen[0] >= 2 * (failures + 1)
    assert again.status == LPStatus.OPTIMAL
    assert again.bound == pytest.approx(plain.bound, rel=1e-6)


def test_rows_that_the_solver_refuses_leave_a_status(monkeypatch: pytest.MonkeyPatch) -> None:
    """HiGHS takes no coefficient above 1e15; without scaling this problem has some."""
    monkeypatch.setattr("formulations.proofs.every_motion.relaxation.inequalities._LARGEST", math.inf)
    problem = Problem.of([[0.0], [-0.113948], [-0.11395], [0.0]], Limits.of(9.0, 5.0, 400.0, dof=1))
    frame = frame_for(problem, 1.0)
    cuts = Cuts.of(Kind.PEAK_AT_START, np.array([1]), np.array([1e20]))
    program = LinearProgram(frame, cuts)
    with np.errstate(over="ignore"):
        solution = program.solve(frame.cost, rounds=5, tolerance=1e-7)
    assert solution.status == LPStatus.REFUSED
    assert len(solution.multipliers) == len(program.rows)
    assert 0.0 <= solution.bound <= free_form_bound(problem).seconds * (1.0 + 1e-6)
    holds(problem, free_form_bound(problem))
