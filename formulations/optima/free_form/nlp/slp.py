"""The free-form program solved by sequential linear programming on HiGHS, where there is no IPOPT.

Each step minimises the linearised program within a trust region; every unit by which a nonlinear row is
violated costs ``weight`` (an exact penalty), and linear rows are kept. The trust region grows and shrinks
with the ratio of actual to predicted reduction.

References
----------
Fletcher & Sainz de la Maza 1989, "Nonlinear programming and nonsmooth optimization by successive linear
programming", Mathematical Programming 43, pp. 235-256.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import casadi
import numpy as np
from scipy import sparse
from scipy.optimize import linprog

from formulations.deadlines import NEVER, Deadline
from formulations.optima.free_form.nlp.blocks import Shape
from formulations.optima.free_form.nlp.equations import equations_of
from formulations.optima.free_form.nlp.program import FreeFormNLP, NLPSolution
from formulations.problem.arrays import Array, Truths

# half side of the trust region, in the program's units
_RADIUS, _SMALLEST, _LARGEST = 0.3, 1e-6, 10.0
_ROUNDING = 1e-9
_LONGEST = 1e6  # s


@dataclass(frozen=True)
class _Step:
    """A linear program's answer: the step, the merit it predicts, multipliers in CasADi's signs."""

    x: Array
    merit: float
    row_multipliers: Array
    bound_multipliers: Array


class _Model(NamedTuple):
    """The program linearised at x: values and slopes of the rows, slope of the cost."""

    x: Array
    rows: Array
    slopes: sparse.csr_matrix
    cost: Array


def solve(
    program: FreeFormNLP,
    x: Array,
    *,
    tolerance: float,
    near: float | None = None,
    iterations: int = 100,
    warm: NLPSolution | None = None,
    deadline: Deadline = NEVER,
) -> NLPSolution:
    """Solve a program from a starting point.

    Parameters
    ----------
    program : FreeFormNLP
    x : Array, shape (n_variables,)
        The starting point.
    tolerance : float
        The solve ends when a step predicts a reduction below this share of the time; at least 1e-7,
        HiGHS's own tolerance.
    near : float, optional
        If given, the starting point is good and the first trust region is small.
    iterations : int
        Greatest number of steps.
    warm : NLPSolution, optional
        If given, as ``near``.
    deadline : Deadline
        No step is begun after it, and HiGHS gets what is left of the time.

    Returns
    -------
    NLPSolution
    """
    value, jacobian, gradient = _linearised(program.shape)
    nonlinear = np.concatenate(
        [np.full(block.symbols.numel(), not block.linear) for block in program.equations.rows]
        or [np.zeros(0, bool)]
    )
    tolerance = max(tolerance, 1e-7)
    radius = _RADIUS if near is None and warm is None else 0.1 * _RADIUS
    weight = 2.0
    p = program.parameters

    def linearised(x: Array, rows: Array) -> _Model:
        return _Model(x, rows, _sparse(jacobian(x, p)), np.asarray(gradient(x, p)).ravel())

    def judged(model: _Model, at: Array, weight: float) -> tuple[Array, Array, float]:
        """A point within its bounds, its rows and its merit."""
        at = np.clip(at, program.low, program.high)
        there = np.asarray(value(at, p)).ravel()
        return at, there, float(model.cost @ at) + weight * _missed(program, there)

    model = linearised(x, np.asarray(value(x, p)).ravel())
    last: _Step | None = None
    status, converged, iteration = "maximum iterations exceeded", False, 0
    for iteration in range(1, iterations + 1):  # noqa: B007
        if deadline.over:
            status = "stopped at the deadline"
            break
        step = _linear_step(program, model, radius, weight, nonlinear, deadline)
        if isinstance(step, str):
            status = f"linear program: {step}"
            break
        last = step
        now = _missed(program, model.rows)
        predicted = weight * now - step.merit
        before = float(model.cost @ model.x) + weight * now
        enough = predicted <= tolerance * float(model.x[: program.task.n_segments].sum())
        if (enough and now <= tolerance) or radius < _SMALLEST:
            status, converged = "solve succeeded", enough and now <= 1e-6
            break
        steepest = float(np.abs(step.row_multipliers[nonlinear]).max(initial=0.0))
        if enough and now > tolerance and steepest >= 0.99 * weight and weight < 1e4:
            weight *= 4.0  # violating rows is too cheap
            continue
        trial, trial_rows, merit = judged(model, model.x + step.x, weight)
        if merit > before - 0.5 * predicted:
            # second-order correction: the same slopes, with the rows at the end of the step
            corrected_model = model._replace(rows=trial_rows - model.slopes @ step.x)
            bent = _linear_step(program, corrected_model, radius, weight, nonlinear, deadline)
            if not isinstance(bent, str):
                corrected = judged(model, model.x + bent.x, weight)
                if corrected[2] < merit:
                    trial, trial_rows, merit = corrected
        ratio = (before - merit) / predicted if predicted > 0.0 else -1.0
        if ratio > 1e-4:
            model = linearised(trial, trial_rows)
        if ratio > 0.75:
            radius = min(2.0 * radius, _LARGEST)
        elif ratio < 0.25:
            radius = 0.4 * min(radius, float(np.abs(step.x).max()))
    x, rows = model.x, model.rows
    if last is None:
        return NLPSolution(x, np.zeros(len(rows)), np.zeros(len(x)), False, status, iteration)
    return NLPSolution(x, last.row_multipliers, last.bound_multipliers, converged, status, iteration)


def _missed(program: FreeFormNLP, rows: Array) -> float:
    """Sum of the rows' violations."""
    return float(
        np.maximum(program.row_low - rows, 0.0).sum() + np.maximum(rows - program.row_high, 0.0).sum()
    )


def _linear_step(
    program: FreeFormNLP,
    model: _Model,
    radius: float,
    weight: float,
    nonlinear: Truths,
    deadline: Deadline,
) -> _Step | str:
    """The best step within the trust region, or why there is none."""
    x, rows, slopes, cost = model
    if not (np.isfinite(rows).all() and np.isfinite(slopes.data).all()):
        return "numbers out of range"
    equal = program.row_low == program.row_high
    below = np.flatnonzero(np.isfinite(program.row_low) & ~equal)
    above = np.flatnonzero(np.isfinite(program.row_high) & ~equal)
    missed = (rows < program.row_low - _ROUNDING) | (rows > program.row_high + _ROUNDING)
    is_priced = np.logical_or(nonlinear, missed)
    priced = np.flatnonzero(is_priced)
    n, m = len(x), len(priced)
    slack = sparse.csr_matrix((np.ones(m), (priced, np.arange(m))), shape=(len(rows), m))
    whole = sparse.hstack([slopes, slack, -slack], format="csr")
    low, high = (program.row_low - rows) / radius, (program.row_high - rows) / radius
    # rows that are kept may be violated by rounding; the zero step has to remain feasible
    low = np.where(is_priced, low, np.minimum(low, 0.0))
    high = np.where(is_priced, high, np.maximum(high, 0.0))
    sides = np.stack(
        [np.maximum((program.low - x) / radius, -1.0), np.minimum((program.high - x) / radius, 1.0)],
        axis=1,
    )
    found = linprog(
        np.concatenate([cost, np.full(2 * m, weight)]),
        A_ub=sparse.vstack([whole[above], -whole[below]], format="csc"),
        b_ub=np.concatenate([high[above], -low[below]]),
        A_eq=whole[equal].tocsc(),
        b_eq=np.where(is_priced, low, 0.0)[equal],
        bounds=np.concatenate([sides, np.tile([0.0, np.inf], (2 * m, 1))]),
        method="highs",
        options={"time_limit": max(min(deadline.left, _LONGEST), 1e-3)},
    )
    if found.x is None:
        if "Model error" in str(found.message):  # HiGHS refuses coefficients beyond 1e15
            return "the numbers are too far apart for HiGHS"
        return str(found.message).splitlines()[0]
    multipliers = np.zeros(len(rows))
    multipliers[equal] = -found.eqlin.marginals
    multipliers[above] -= found.ineqlin.marginals[: len(above)]
    multipliers[below] += found.ineqlin.marginals[len(above) :]
    bounds = -np.asarray(found.upper.marginals[:n]) - np.asarray(found.lower.marginals[:n])
    return _Step(radius * found.x[:n], radius * float(found.fun), multipliers, bounds)


@lru_cache(maxsize=64)
def _linearised(shape: Shape) -> tuple[Any, Any, Any]:
    """Functions of (x, parameters): the rows, their slopes, the slope of the cost."""
    nlp = equations_of(shape).nlp
    point = [nlp["x"], nlp["p"]]
    return (
        casadi.Function("rows", point, [nlp["g"]]),
        casadi.Function("slopes", point, [casadi.jacobian(nlp["g"], nlp["x"])]),
        casadi.Function("cost", point, [casadi.gradient(nlp["f"], nlp["x"])]),
    )


def _sparse(matrix: Any) -> sparse.csr_matrix:
    pattern = matrix.sparsity()
    return sparse.csc_matrix(
        (np.array(matrix.nonzeros()), np.array(pattern.row()), np.array(pattern.colind())),
        shape=matrix.shape,
    ).tocsr()
