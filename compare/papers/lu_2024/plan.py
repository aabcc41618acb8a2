"""Lu 2024: the task, on made waypoints since the paper prints none, and its protocol."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.random import SeedSequence

from compare.audit.paper import load_papers, settings
from compare.benchmark.grade import Trace
from compare.benchmark.objective import Objective
from compare.papers.pictures.descent import descent
from compare.statistics.medians import Estimate
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


def plan(
    objective: Callable[[Array], Array], n_segments: int, swarm: str, runs: int, **changed: Any
) -> dict[str, Any]:
    """Run a swarm by the paper's protocol: its box and budget; an infeasible candidate has the worst fitness.

    Parameters
    ----------
    objective : callable
        Durations (n, n_segments) [s] -> total times (n,) [s], infinite if infeasible.
    n_segments : int
        Number of durations.
    swarm : str
        A name of ``ALGORITHMS``.
    runs : int
        Number of runs, with seeds 0, 1, ...
    **changed
        Parameters of the swarm other than those of its entry.

    Returns
    -------
    dict
        seconds of each run, in the order of the seeds [s] (None: nothing feasible), durations of the median
        run (the lower one of two; None if it found nothing), descent.
    """
    setup = settings("z1")["swarm"]
    n, iterations = setup["population"], setup["iterations"]
    entry = algorithm(swarm)
    parameters = entry.parameters | {"population": n} | changed
    lo, hi = np.full(n_segments, _SHORTEST), np.full(n_segments, float(setup["high"]))
    results = [
        minimise(
            entry.function, objective, lo, hi, budget=n * (iterations + 1), seed=SeedSequence([seed]),
            **parameters,
        )
        for seed in range(runs)
    ]  # fmt: skip
    traces = [Trace(-1, r.trace_evaluations.tolist(), r.trace_best.tolist()) for r in results]
    fitness = [np.inf if r.x is None else r.fitness for r in results]
    median = results[int(np.argsort(fitness, kind="stable")[(runs - 1) // 2])].x
    return {
        "seconds": [None if r.x is None else r.fitness for r in results],
        "durations": None if median is None else median.tolist(),
        "descent": descent(traces, n, iterations),
    }


def shared(family: str) -> Objective:
    """Pose the case z1 in one spline family as the paper's swarm sees it.

    Parameters
    ----------
    family : str
        A key of ``FAMILIES``.

    Returns
    -------
    Objective
        Infinite for a candidate that breaks a limit.
    """
    return Objective(task(family), stretch=False)


def losses(found: dict[str, Any]) -> list[float]:
    """Times of all runs; infinite where a run found nothing feasible.

    Parameters
    ----------
    found : dict
        Of ``plan``.

    Returns
    -------
    list of float [s]
    """
    return [np.inf if seconds is None else seconds for seconds in found["seconds"]]


def solved(found: dict[str, Any]) -> str:
    """Say how many runs found a motion within the limits.

    Parameters
    ----------
    found : dict
        Of ``plan``.

    Returns
    -------
    str
    """
    times = found["seconds"]
    return f"{sum(seconds is not None for seconds in times)} of {len(times)}"


def between(found: Estimate, digits: int = 2) -> str:
    """Write a time with its interval: 17.67 (16.58 to 17.84).

    Parameters
    ----------
    found : Estimate
        Of ``medians.median_of`` [s].
    digits : int
        Decimals.

    Returns
    -------
    str
    """
    if not np.isfinite(found.value):
        return "none"
    if not np.isfinite(found.low):
        return f"{found.value:.{digits}f} (too few runs for an interval)"
    high = f"{found.high:.{digits}f}" if np.isfinite(found.high) else "none found"
    return f"{found.value:.{digits}f} ({found.low:.{digits}f} to {high})"


def printed_total(by: str) -> str:
    """Return a total time as the paper prints it.

    Parameters
    ----------
    by : str
        The method, as ``printed.toml`` names it.

    Returns
    -------
    str
        Seconds.
    """
    return str(next(t.value for t in load_papers("z1")[0].totals if t.by == by))


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
