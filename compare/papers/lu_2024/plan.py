"""Lu 2024: the task, on made waypoints since the paper prints none, and its protocol."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.random import SeedSequence

from compare.audit.paper import settings
from compare.benchmark.grade import Trace
from compare.benchmark.objective import Objective
from compare.papers.measure import judged
from compare.papers.pictures.descent import descent
from formulations import Problem, load
from formulations.arms import load_arm
from formulations.problem.arrays import Array
from metaheuristics import algorithm, minimise

_SHORTEST = 1e-3  # s, for the printed 0: a duration is positive


def drawn_waypoints(seed: int) -> Array:
    """Draw eight waypoints by the rule of the case file, whose own seed is 2024.

    Parameters
    ----------
    seed : int
        Of the draw.

    Returns
    -------
    Array, shape (8, 6) [rad]
    """
    arm, rng = load_arm("z1"), np.random.default_rng(seed)
    found: list[Array] = []
    low, high = (arm.position + np.deg2rad(5.0) * np.array([1.0, -1.0])).T
    while len(found) < 8:
        q = rng.uniform(low, high)
        x, y, z = arm.chain.forward(q)[:3, 3]
        if z > 0.05 and np.hypot(x, y) > 0.15:
            found.append(np.round(np.rad2deg(q), 1))
    return np.deg2rad(found)


def plan(problem: Problem, swarm: str, runs: int) -> dict[str, Any]:
    """Run a swarm by the paper's protocol: its box and budget; an infeasible candidate has the worst fitness.

    Parameters
    ----------
    problem : Problem
        The task.
    swarm : str
        A name of ``ALGORITHMS``.
    runs : int
        Number of runs.

    Returns
    -------
    dict
        runs (a count), seconds of the solved ones [s], median (judged, or None), descent.
    """
    setup = settings("z1")["swarm"]
    n, iterations = setup["population"], setup["iterations"]
    entry = algorithm(swarm)
    lo, hi = np.full(problem.n_segments, _SHORTEST), np.full(problem.n_segments, float(setup["high"]))
    results = [
        minimise(
            entry.function, Objective(problem, stretch=False), lo, hi, budget=n * (iterations + 1),
            seed=SeedSequence([seed]), **{**entry.parameters, "population": n},
        )
        for seed in range(runs)
    ]  # fmt: skip
    solved = sorted((r for r in results if r.x is not None), key=lambda r: r.fitness)
    traces = [Trace(-1, r.trace_evaluations.tolist(), r.trace_best.tolist()) for r in results]
    median = solved[(len(solved) - 1) // 2].x if solved else None
    return {
        "runs": runs,
        "seconds": [r.fitness for r in solved],
        "median": None if median is None else judged(problem, median),
        "descent": descent(traces, n, iterations),
    }


def task(family: str) -> Problem:
    """Pose the case z1 in one spline family.

    Parameters
    ----------
    family : str
        A key of ``FAMILIES``.

    Returns
    -------
    Problem
    """
    return replace(load("z1"), family=family)
