"""A program solved by sequential linear programming on HiGHS: the fallback that needs no IPOPT.

Each step minimises the linearised program within a box, at the price ``weight`` for every unit that a
nonlinear row is missed by (Fletcher & Sainz de la Maza 1989); linear rows are kept. The box grows and
shrinks with the ratio of the gain made to the gain promised.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi
import numpy as np
from scipy import sparse
from scipy.optimize import linprog

from formulations.optima.free_form.nlp.equations import Shape
from formulations.optima.free_form.nlp.program import Program, Solution
from formulations.problem.arrays import Array

_LINEARISED: dict[Shape, tuple[Any, Any, Any]] = {}
_BOX, _SMALLEST, _LARGEST = 0.3, 1e-6, 10.0  # half side of the box, in the program's units
_ROUNDING = 1e-9
_NONLINEAR = {"dynamics", "velocity", "displacement", "position"}


@dataclass(frozen=True)
class _Step:
    """A linear program's answer: the step, what it promises, multipliers in CasADi's signs."""

    x: Array
    merit: float
    row_multipliers: Array
    bound_multipliers: Array


def solve(
    program: Program,
    x: Array,
    *,
    tolerance: float,
    near: float | None = None,
    iterations: int = 100,
    warm: Solution | None = None,
) -> Solution:
    """Solve from x until a step promises less than ``tolerance`` of the time.

    tolerance: 1e-7, HiGHS's own, if less. near, warm: the start is good, and the first box is small.
    """
    value, jacobian, gradient = _linearised(program)
    nonlinear = np.concatenate(
        [np.full(n, kind in _NONLINEAR) for kind, _, n in program.symbols.kinds] or [np.zeros(0, bool)]
    )
    tolerance = max(tolerance, 1e-7)
    box = _BOX if near is None and warm is None else 0.1 * _BOX
    weight = 2.0
    p = program.parameters
    rows = np.asarray(value(x, p)).ravel()
    last: _Step | None = None
    status, converged, iteration = "maximum iterations exceeded", False, 0
    slopes, cost = _sparse(jacobian(x, p)), np.asarray(gradient(x, p)).ravel()

    def judged(at: Array, weight: float) -> tuple[Array, Array, float]:
        """A point within its bounds, its rows and its merit."""
        at = np.clip(at, program.low, program.high)
        there = np.asarray(value(at, p)).ravel()
        return at, there, float(cost @ at) + weight * _missed(program, there)

    for iteration in range(1, iterations + 1):  # noqa: B007
        step = _linear_step(program, x, rows, slopes, cost, box, weight, nonlinear)
        if isinstance(step, str):
            status = f"linear program: {step}"
            break
        last = step
        now = _missed(program, rows)
        promised = weight * now - step.merit
        before = float(cost @ x) + weight * now
        enough = promised <= tolerance * float(x[: program.task.n_segments].sum())
        if (enough and now <= tolerance) or box < _SMALLEST:
            status, converged = "solve succeeded", enough and now <= 1e-6
            break
        steepest = float(np.abs(step.row_multipliers[nonlinear]).max(initial=0.0))
        if enough and now > tolerance and steepest >= 0.99 * weight and weight < 1e4:
            weight *= 4.0  # rows are missed for profit
            continue
        trial, trial_rows, merit = judged(x + step.x, weight)
        if merit > before - 0.5 * promised:
            # second-order correction: the same slopes, the rows as the step has found them
            bent = _linear_step(
                program, x, trial_rows - slopes @ step.x, slopes, cost, box, weight, nonlinear
            )
            if not isinstance(bent, str):
                corrected = judged(x + bent.x, weight)
                if corrected[2] < merit:
                    trial, trial_rows, merit = corrected
        ratio = (before - merit) / promised if promised > 0.0 else -1.0
        if ratio > 1e-4:
            x, rows = trial, trial_rows
            slopes, cost = _sparse(jacobian(x, p)), np.asarray(gradient(x, p)).ravel()
        if ratio > 0.75:
            box = min(2.0 * box, _LARGEST)
        elif ratio < 0.25:
            box = 0.4 * min(box, float(np.abs(step.x).max()))
    if last is None:
        return Solution(x, np.zeros(len(rows)), np.zeros(len(x)), False, status, iteration)
    return Solution(x, last.row_multipliers, last.bound_multipliers, converged, status, iteration)


def _missed(program: Program, rows: Array) -> float:
    """Sum of what the rows are missed by."""
    return float(
        np.maximum(program.row_low - rows, 0.0).sum() + np.maximum(rows - program.row_high, 0.0).sum()
    )


def _linear_step(
    program: Program,
    x: Array,
    rows: Array,
    slopes: sparse.csr_matrix,
    cost: Array,
    box: float,
    weight: float,
    nonlinear: Array,
) -> _Step | str:
    """The best step within the box; every nonlinear row may be missed on either side at its price."""
    equal = program.row_low == program.row_high
    below = np.flatnonzero(np.isfinite(program.row_low) & ~equal)
    above = np.flatnonzero(np.isfinite(program.row_high) & ~equal)
    missed = (rows < program.row_low - _ROUNDING) | (rows > program.row_high + _ROUNDING)
    is_priced = np.logical_or(nonlinear, missed)
    priced = np.flatnonzero(is_priced)
    n, m = len(x), len(priced)
    slack = sparse.csr_matrix((np.ones(m), (priced, np.arange(m))), shape=(len(rows), m))
    whole = sparse.hstack([slopes, slack, -slack], format="csr")
    low, high = (program.row_low - rows) / box, (program.row_high - rows) / box
    # kept rows may be missed by rounding, and a step that stays must remain possible
    low = np.where(is_priced, low, np.minimum(low, 0.0))
    high = np.where(is_priced, high, np.maximum(high, 0.0))
    sides = np.stack(
        [np.maximum((program.low - x) / box, -1.0), np.minimum((program.high - x) / box, 1.0)], axis=1
    )
    found = linprog(
        np.concatenate([cost, np.full(2 * m, weight)]),
        A_ub=sparse.vstack([whole[above], -whole[below]], format="csc"),
        b_ub=np.concatenate([high[above], -low[below]]),
        A_eq=whole[equal].tocsc(),
        b_eq=np.where(is_priced, low, 0.0)[equal],
        bounds=np.concatenate([sides, np.tile([0.0, np.inf], (2 * m, 1))]),
        method="highs",
    )
    if found.x is None:
        return str(found.message).splitlines()[0]
    multipliers = np.zeros(len(rows))
    multipliers[equal] = -found.eqlin.marginals
    multipliers[above] -= found.ineqlin.marginals[: len(above)]
    multipliers[below] += found.ineqlin.marginals[len(above) :]
    bounds = -np.asarray(found.upper.marginals[:n]) - np.asarray(found.lower.marginals[:n])
    return _Step(box * found.x[:n], box * float(found.fun), multipliers, bounds)


def _linearised(program: Program) -> tuple[Any, Any, Any]:
    shape = program.shape
    if shape not in _LINEARISED:
        if len(_LINEARISED) >= 64:
            _LINEARISED.clear()
        nlp = program.symbols.nlp
        point = [nlp["x"], nlp["p"]]
        _LINEARISED[shape] = (
            casadi.Function("rows", point, [nlp["g"]]),
            casadi.Function("slopes", point, [casadi.jacobian(nlp["g"], nlp["x"])]),
            casadi.Function("cost", point, [casadi.gradient(nlp["f"], nlp["x"])]),
        )
    return _LINEARISED[shape]


def _sparse(matrix: Any) -> sparse.csr_matrix:
    pattern = matrix.sparsity()
    return sparse.csc_matrix(
        (np.array(matrix.nonzeros()), np.array(pattern.row()), np.array(pattern.colind())),
        shape=matrix.shape,
    ).tocsr()
