"""What a swarm costs beside its objective, and beside the same swarm in mealpy.

These are the two studies behind ``timebound speed --swarms``. They measure time of the processor, not
of the wall, so that other programs on the machine count less. Rivals take turns, and the best of
several rounds counts.
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
from compare.screen import table
from compare.studies.study import Study
from formulations import Problem
from metaheuristics import ALGORITHMS, minimise

POPULATION, STEPS, BUDGET = 50, 60, 5000
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
class SwarmCost:
    """Time of a swarm's own work, a driver's checks included, and of its objective [s per 50 evaluations]."""

    swarm: str
    algorithm: float
    objective: float


def costs(problem: Problem, rounds: int, names: list[str] | None = None) -> list[SwarmCost]:
    """Measure each swarm's own work against its objective, in the stretched coding at population 50.

    Parameters
    ----------
    problem : Problem
        The problem.
    rounds : int
        Rounds; the best one counts.
    names : list of str, optional
        Algorithms; all whose libraries are installed if left out.

    Returns
    -------
    list of SwarmCost
        A row per swarm.
    """
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
    return [SwarmCost(name, *pair) for name, pair in best.items()]


def _timed(f: Callable[[Any], Any], inside: list[float]) -> Callable[[Any], Any]:
    def timed(x: Any) -> Any:
        started = time.process_time()
        value = f(x)
        inside[0] += time.process_time() - started
        return value

    return timed


@dataclass(frozen=True)
class SwarmPair:
    """The same swarm here and in mealpy, by its name there: time of a whole run [s]."""

    swarm: str
    theirs: str
    seconds: float
    seconds_theirs: float


def pairs(problem: Problem, rounds: int, budget: int = BUDGET) -> list[SwarmPair]:
    """Time whole runs of each swarm here and in mealpy, on the same objective and budget.

    Parameters
    ----------
    problem : Problem
        The problem.
    rounds : int
        Rounds; the best one counts.
    budget : int
        Evaluations per run.

    Returns
    -------
    list of SwarmPair
        A row per pair; none if mealpy is not installed.
    """
    if not _there(("mealpy",)):
        return []
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
        found.append(SwarmPair(ours, theirs, *best))
    return found


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


def cost_text(rows: list[SwarmCost], summary: dict[str, Any]) -> str:
    """Lay the costs out as a table.

    Parameters
    ----------
    rows : list of SwarmCost
        All swarms.
    summary : dict
        Ratio of own work to objective, by swarm.

    Returns
    -------
    str
        A line per swarm.
    """
    lines = [
        [c.swarm, f"{c.algorithm * 1e6:.0f}", f"{c.objective * 1e6:.0f}", f"{summary[c.swarm]:.2f}",
         "yes" if summary[c.swarm] <= 2.0 else "NO"]
        for c in rows
    ]  # fmt: skip
    title = f"a step of {POPULATION} evaluations in the stretched coding, time of the processor"
    header = ["swarm", "own work [us]", "objective [us]", "ratio", "at most twice"]
    return f"{title}\n{table(header, lines, right=(1, 2, 3))}\n"


def pair_text(rows: list[SwarmPair], summary: dict[str, Any]) -> str:
    """Lay the pairs out as a table.

    Parameters
    ----------
    rows : list of SwarmPair
        All pairs.
    summary : dict
        How many times faster, by swarm.

    Returns
    -------
    str
        A line per pair; one line if mealpy is not installed.
    """
    if not rows:
        return "pairs with mealpy: it is not installed: pip install 'timebound[rivals]'"
    lines = [
        [p.swarm, p.theirs, f"{p.seconds * 1e3:.0f}", f"{p.seconds_theirs * 1e3:.0f}",
         f"{summary[p.swarm]:.1f}", "yes" if summary[p.swarm] >= 10.0 else "NO"]
        for p in rows
    ]  # fmt: skip
    title = (
        f"whole runs of {BUDGET} evaluations, in pairs; mealpy as its users run it, without this driver"
    )
    header = ["swarm", "in mealpy", "ours [ms]", "mealpy [ms]", "times faster", "ten times"]
    return f"{title}\n{table(header, lines, right=(2, 3, 4))}"


COSTS = Study(
    name="speed_swarms",
    row=SwarmCost,
    compute=costs,
    summarise=lambda rows: {c.swarm: c.algorithm / c.objective for c in rows},
    text=cost_text,
)
PAIRED = Study(
    name="speed_mealpy",
    row=SwarmPair,
    compute=pairs,
    summarise=lambda rows: {p.swarm: p.seconds_theirs / p.seconds for p in rows},
    text=pair_text,
)
