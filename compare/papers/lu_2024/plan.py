"""Paper 003 (Unitree Z1): the task, waypoints in place of those it does not print, and its protocol."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.random import SeedSequence

from compare.benchmark.grade import Trace
from compare.benchmark.objective import Objective
from compare.papers.descent import descent
from compare.papers.measure import judged
from compare.papers.printed import tables
from formulations import Problem, load
from formulations.arms import load_arm
from formulations.problem.arrays import Array
from metaheuristics import algorithm, minimise

_SHORTEST = 1e-3  # s, for the printed 0: a duration is positive


def drawn_waypoints(seed: int) -> Array:
    """Eight waypoints by the rule of the case file (whose seed is 2024), (8, 6) [rad]."""
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
    """Runs by the paper's protocol: its box and budget, infeasible = worst fitness; the median judged.

    seconds: of all solved runs. best: durations of the shortest.
    """
    setup = tables("z1")["swarm"]
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
    """The case z1 in one of the families compared."""
    return replace(load("z1"), family=family)
