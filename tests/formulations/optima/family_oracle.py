"""Oracles for the family optimum that share no code with the solver.

Stretching any shape to feasibility turns the problem into: minimise sum(T) stretch(T) over the
ratios of the durations. The oracles search that; the solver never does.
"""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest
from conftest import Array, climbed, problems
from hypothesis import Phase
from scipy.optimize import differential_evolution, minimize

from formulations import (
    CASES,
    FAMILIES,
    FamilyOptimum,
    Problem,
    check,
    family_optimum,
    load,
)

THREE = [case for case in CASES if load(case).family == "3-5-3"]


NO_SHRINKING = (Phase.explicit, Phase.generate)  # each example costs a second


KEPT = 1e-9  # rad outside the position limits that counts as inside


def inward(problem: Problem, t: Array) -> Array:
    """Whether joints that rest on a position limit leave it, and come to it, on the inner side.

    Rest leaves the jerk to decide. A dip of d rad outside lasts as long as d^(1/3): what rounding
    hides can be worth 1e-5 of the time, so no tolerance on the position itself will do.
    """
    c = FAMILIES[problem.family].coefficients(problem, t)
    starts, ends = 6.0 * c[:, 0, :, 3], c[:, -1] @ [0.0, 0.0, 0.0, 6.0, 24.0, 60.0]
    kept = np.ones(len(t), dtype=bool)
    for side, sign in ((0, 1.0), (1, -1.0)):
        bounds = problem.position_bounds[:, side]
        kept &= (sign * starts >= 0.0)[:, problem.waypoints[0] == bounds].all(axis=1)
        kept &= (sign * ends <= 0.0)[:, problem.waypoints[-1] == bounds].all(axis=1)
    return kept


def scaled_seconds(problem: Problem, t: Array) -> Array:
    """Total time of durations (n, n_segments), stretched to feasibility; infinite if out of the game.

    Out are those that leave the position limits, and segments shorter than 1e-7 of the whole.
    """
    family = FAMILIES[problem.family]
    total = t.sum(axis=1)
    kept = (family.position_excess(problem, t) <= KEPT) & inward(problem, t)
    kept &= t.min(axis=1) >= 1e-7 * total
    return np.where(kept, total * family.stretch(problem, t), np.inf)


def searched(problem: Problem, seed: int = 0, reach: float = 5.0) -> tuple[float, Array]:
    """Differential evolution over log ratios, polished by Nelder-Mead: the oracle."""
    n = problem.n_segments

    def seconds(y: Array) -> Any:
        rows = np.exp(np.atleast_2d(y.T))
        values = scaled_seconds(problem, np.column_stack([np.ones(len(rows)), rows]))
        values = np.where(np.isfinite(values), values, 1e6 + np.abs(y.T).max())
        return values if y.ndim > 1 else float(values[0])

    found = differential_evolution(
        seconds,
        [(-reach, reach)] * (n - 1),
        vectorized=True,
        updating="deferred",
        popsize=20,
        maxiter=180,
        tol=0.0,
        atol=0.0,
        polish=False,
        rng=seed,
    )
    y, best = found.x, float(found.fun)
    for _ in range(4):
        options = {"xatol": 1e-13, "fatol": 1e-14, "maxiter": 2000}
        polished = minimize(seconds, y, method="Nelder-Mead", options=options)
        if polished.fun < best:
            y, best = polished.x, float(polished.fun)
    return best, np.concatenate([[1.0], np.exp(y)])


quick = functools.partial(family_optimum, starts=4)  # for laws, where two are compared


def optimum(case: str, joint: int | None = None) -> FamilyOptimum:
    """Optimum of a shipped case or of one of its joints alone."""
    found = climbed(case).optimum if joint is None else climbed(case).alone[joint]
    assert found is not None
    return found


def judged(found: FamilyOptimum) -> None:
    """What every optimum must be."""
    verdict = check(found.problem, FAMILIES[found.family].trajectory(found.problem, found.durations))
    assert verdict.faults == ()
    assert found.verdict.feasible
    assert found.seconds == pytest.approx(verdict.seconds, rel=1e-12)
    assert (found.durations > 0.0).all()
    assert 1 <= found.agreeing_starts <= len(found.starts)
    assert min(start.seconds for start in found.starts) == pytest.approx(found.seconds, rel=1e-12)
    if found.durations.min() > 1e-7 * found.seconds:
        assert "ok" in {start.status for start in found.starts}


def agrees(problem: Problem, found: FamilyOptimum) -> None:
    judged(found)
    oracle, _ = searched(problem)
    assert found.seconds <= oracle * (1.0 + 1e-9)
    assert found.seconds >= oracle * (1.0 - 1e-6)


MOVING = problems(reach=(-2.0, 1.0)).filter(lambda problem: bool(problem.moving_joints))
