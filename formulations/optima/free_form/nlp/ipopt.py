"""The free-form program solved by IPOPT, the interior point method, through CasADi.

References
----------
Wächter & Biegler 2006, "On the implementation of an interior-point filter line-search algorithm for
large-scale nonlinear programming", Mathematical Programming 106, pp. 25-57.
Andersson et al. 2019, "CasADi: a software framework for nonlinear optimization and optimal control",
Mathematical Programming Computation 11, pp. 1-36.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from formulations.deadlines import NEVER, Deadline
from formulations.deadlines.ipopt import StoppableIpopt
from formulations.optima.free_form.nlp.blocks import Shape
from formulations.optima.free_form.nlp.equations import equations_of
from formulations.optima.free_form.nlp.program import FreeFormNLP, NLPSolution
from formulations.problem.arrays import Array

_OPTIONS: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.nlp_scaling_method": "none",  # the program is posed in its own units
    "error_on_fail": False,
    "show_eval_warnings": False,  # IPOPT shortens a step to a point that cannot be evaluated
}


def solve(
    program: FreeFormNLP,
    x: Array,
    *,
    tolerance: float,
    near: float | None = None,
    iterations: int = 300,
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
        IPOPT's ``tol``.
    near : float, optional
        Barrier parameter to start with, where the starting point is known to be good.
    iterations : int
        Greatest number of iterations.
    warm : NLPSolution, optional
        A solution whose multipliers to start from.
    deadline : Deadline
        IPOPT stops after the iteration in which it is over.

    Returns
    -------
    NLPSolution
        At the starting point, not converged, where IPOPT gave no finite point.
    """
    options: dict[str, Any] = {"ipopt.tol": tolerance, "ipopt.max_iter": iterations}
    if near is None:
        options["ipopt.mu_strategy"] = "adaptive"
    else:
        options |= {"ipopt.mu_strategy": "monotone", "ipopt.mu_init": near}
    start: dict[str, Any] = {}
    if warm is not None:
        options |= {"ipopt.warm_start_init_point": "yes"}
        for push in ("bound", "mult_bound", "slack_bound"):
            options[f"ipopt.warm_start_{push}_push"] = 1e-9
        for frac in ("bound_frac", "slack_bound_frac"):
            options[f"ipopt.warm_start_{frac}"] = 1e-9
        start = {"lam_g0": warm.row_multipliers, "lam_x0": warm.bound_multipliers}
    solver = _solver(program.shape, tuple(sorted(options.items())))
    try:
        solved = solver.solve(
            deadline,
            x0=x,
            p=program.parameters,
            lbx=program.low,
            ubx=program.high,
            lbg=program.row_low,
            ubg=program.row_high,
            **start,
        )
    except RuntimeError as error:  # CasADi refuses the numbers
        return _none(program, x, str(error).strip().splitlines()[-1])
    if solved is None:
        return _none(program, x, "stopped at the deadline")
    found, stats = solved
    status = str(stats["return_status"]).replace("_", " ").lower()
    point = np.asarray(found["x"]).ravel()
    if not np.isfinite(point).all():
        return _none(program, x, status)
    return NLPSolution(
        point,
        np.asarray(found["lam_g"]).ravel(),
        np.asarray(found["lam_x"]).ravel(),
        bool(stats["success"]),
        status,
        int(stats["iter_count"]),
    )


def _none(program: FreeFormNLP, x: Array, status: str) -> NLPSolution:
    rows, variables = np.zeros(len(program.row_low)), np.zeros(len(x))
    return NLPSolution(x, rows, variables, False, status, 0)


@lru_cache(maxsize=64)
def _solver(shape: Shape, options: tuple[tuple[str, Any], ...]) -> StoppableIpopt:
    equations = equations_of(shape)
    blocks = [block.symbols for block in equations.rows]
    return StoppableIpopt("free_form", equations.nlp, _OPTIONS | dict(options), blocks)
