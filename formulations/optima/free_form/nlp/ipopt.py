"""A program solved by IPOPT (Wächter & Biegler 2006) through CasADi."""

from __future__ import annotations

from typing import Any

import casadi
import numpy as np

from formulations.optima.free_form.nlp.equations import Shape
from formulations.optima.free_form.nlp.program import Program, Solution
from formulations.problem.arrays import Array

_OPTIONS: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.nlp_scaling_method": "none",  # the program is posed in its own units
    "error_on_fail": False,
    "show_eval_warnings": False,  # a step too far is IPOPT's to take back
}
_SOLVERS: dict[tuple[Shape, tuple[tuple[str, Any], ...]], Any] = {}


def solve(
    program: Program,
    x: Array,
    *,
    tolerance: float,
    near: float | None = None,
    iterations: int = 300,
    warm: Solution | None = None,
) -> Solution:
    """Solve from x. near: barrier parameter to start with where x is known to be good.

    warm: a solution whose multipliers to start from.
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
    key = (program.shape, tuple(sorted(options.items())))
    if key not in _SOLVERS:
        if len(_SOLVERS) >= 64:
            _SOLVERS.clear()
        _SOLVERS[key] = casadi.nlpsol("free_form", "ipopt", program.symbols.nlp, _OPTIONS | options)
    solver = _SOLVERS[key]
    found = solver(
        x0=x,
        p=program.parameters,
        lbx=program.low,
        ubx=program.high,
        lbg=program.row_low,
        ubg=program.row_high,
        **start,
    )
    stats = solver.stats()
    return Solution(
        np.asarray(found["x"]).ravel(),
        np.asarray(found["lam_g"]).ravel(),
        np.asarray(found["lam_x"]).ravel(),
        bool(stats["success"]),
        str(stats["return_status"]).replace("_", " ").lower(),
        int(stats["iter_count"]),
    )
