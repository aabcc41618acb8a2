"""What a swarm costs beside its objective, and beside the same swarm in mealpy.

Times of the processor, not of the wall, so that what else runs on the machine counts less; rivals take
turns, and the best of several rounds counts. ``python -m compare.speed --swarms`` prints it.
"""

from __future__ import annotations

import importlib.util
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.benchmark.objective import Objective, search_box
from compare.commands import shared as commands
from formulations import Problem
from metaheuristics import ALGORITHMS, minimise

POPULATION, STEPS = 50, 60
WORST = 1e18
PAIRS = {  # ours: the same algorithm of mealpy
    "pso": "OriginalPSO",
    "pso-linear": "LDW_PSO",
    "whale": "OriginalWOA",
    "sparrow": "OriginalSSA",
    "de": "OriginalDE",
    "lshade": "L_SHADE",
}


@dataclass(frozen=True)
class Cost:
    """Seconds of a swarm's own work and of its objective, per 50 evaluations."""

    swarm: str
    algorithm: float
    objective: float


def costs(problem: Problem, rounds: int, names: list[str] | None = None) -> list[Cost]:
    """The swarm's own work against its objective, in the stretched coding at population 50."""
    objective = Objective(problem, stretch=True)
    lo, hi = search_box(problem)
    names = names or [name for name, entry in ALGORITHMS.items() if _there(entry.libraries)]
    best = dict.fromkeys(names, (np.inf, np.inf))
    for seed in range(rounds):
        for name in names:
            entry = ALGORITHMS[name]
            parameters = dict(entry.parameters)
            if "population" in parameters:
                parameters["population"] = POPULATION
            inside = [0.0]
            timed = _timed(objective, inside)
            started = time.process_time()
            minimise(entry.function, timed, lo, hi, budget=POPULATION * STEPS, seed=seed, **parameters)
            whole = time.process_time() - started
            found = ((whole - inside[0]) / STEPS, inside[0] / STEPS)
            best[name] = min(best[name], found, key=lambda pair: pair[0])
    return [Cost(name, *pair) for name, pair in best.items()]


def _timed(f: Callable[[Any], Any], inside: list[float]) -> Callable[[Any], Any]:
    def timed(x: Any) -> Any:
        started = time.process_time()
        value = f(x)
        inside[0] += time.process_time() - started
        return value

    return timed


def pairs(problem: Problem, rounds: int, budget: int = 5000) -> list[tuple[str, str, float, float]]:
    """Ours, theirs, and seconds of whole runs of each on the same objective and budget."""
    import mealpy

    objective = Objective(problem, stretch=True)
    lo, hi = search_box(problem)
    kinds = mealpy.get_all_optimizers(verbose=False)
    found = []
    for ours, theirs in PAIRS.items():
        if not _there(ALGORITHMS[ours].libraries):
            continue
        entry, best = ALGORITHMS[ours], [np.inf, np.inf]
        for seed in range(rounds):
            started = time.process_time()
            minimise(entry.function, objective, lo, hi, budget=budget, seed=seed, **entry.parameters)
            middle = time.process_time()
            _alone(mealpy, kinds[theirs], objective, lo, hi, budget, seed)
            best = [
                min(best[0], middle - started),
                min(best[1], time.process_time() - middle),
            ]
        found.append((ours, theirs, *best))
    return found  # type: ignore[return-value]


def _alone(
    mealpy: Any, kind: Any, objective: Objective, lo: Any, hi: Any, budget: int, seed: int
) -> None:
    """A run as mealpy's users write it: no driver, no bridge, stopped by its own count."""

    def one(x: Any) -> float:
        if not np.isfinite(x).all():  # its L-SHADE asks for NaN when nothing has improved
            return WORST
        return float(objective(np.clip(x, lo, hi)[None])[0])

    problem = {
        "obj_func": one,
        "bounds": mealpy.FloatVar(lb=lo.tolist(), ub=hi.tolist()),
        "minmax": "min",
        "log_to": None,
    }
    search = kind(epoch=budget // POPULATION, pop_size=POPULATION)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of theirs
        search.solve(problem, seed=seed, termination={"max_fe": budget})


def _there(libraries: tuple[str, ...]) -> bool:
    return all(importlib.util.find_spec(name) is not None for name in libraries)


def as_text(problem: Problem, rounds: int) -> str:
    """Both tables."""
    rows = [
        [c.swarm, f"{c.algorithm * 1e6:.0f}", f"{c.objective * 1e6:.0f}",
         f"{c.algorithm / c.objective:.2f}", "yes" if c.algorithm <= 2 * c.objective else "NO"]
        for c in costs(problem, rounds)
    ]  # fmt: skip
    header = ["swarm", "own work [us]", "objective [us]", "ratio", "at most twice"]
    parts = [
        f"{problem.name}: a step of {POPULATION} evaluations in the stretched coding, processor time,"
        f" best of {rounds} rounds; a driver's checks are the swarm's own work",
        commands.table(header, rows, right=(1, 2, 3)),
    ]
    if not _there(("mealpy",)):
        parts.append("pairs with mealpy: it is not installed: pip install 'timebound[rivals]'")
        return "\n".join(parts)
    rows = [
        [
            ours,
            theirs,
            f"{a * 1e3:.0f}",
            f"{b * 1e3:.0f}",
            f"{b / a:.1f}",
            "yes" if b >= 10 * a else "NO",
        ]
        for ours, theirs, a, b in pairs(problem, rounds)
    ]
    header = ["swarm", "in mealpy", "ours [ms]", "mealpy [ms]", "times faster", "ten times"]
    parts += [
        "\nwhole runs of 5000 evaluations, in pairs; mealpy as its users run it, without this driver",
        commands.table(header, rows, right=(2, 3, 4)),
    ]
    return "\n".join(parts)
