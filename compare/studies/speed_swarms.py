"""How fast a swarm evaluates candidates, on one core and on two, and beside the same swarm in mealpy.

These are the two studies behind ``timebound speed --swarms``. Speed on one core is measured in time of the
processor, not of the wall, so that other programs on the machine count less. Rivals take turns, and the best
of several rounds counts.
"""

from __future__ import annotations

import importlib.util
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.benchmark.objective import Objective, search_box
from compare.benchmark.run import workers
from compare.screen import bar, table
from compare.studies.study import Study
from formulations import Problem
from metaheuristics import ALGORITHMS, Result, minimise

POPULATION, STEPS, BUDGET = 50, 60, 5000
RUNS = 3
"""Runs of a swarm per round; the best one counts."""
SLICE = 0.2
"""Time that each worker works when workers are compared [s]."""
GOALS = {"pso": 500_000, "papers": 200_000}
"""Evaluations per second and core that are aimed at, for `pso` and for the swarms of the papers."""
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
    """Time of one evaluation, swarm and driver included, and who spends it.

    Parameters
    ----------
    swarm, library : str
        Name of the algorithm, and the library it comes from; empty if it is written out here.
    seconds : float
        Time of the processor per evaluation, on one core [s].
    objective, algorithm, driver : float
        Shares of the objective, of the swarm's own work, and of the driver that counts and checks; they
        add up to 1.
    two_workers : float or None
        Evaluations per second of two processes over those of one, by the clock on the wall; None if it was
        not measured.
    """

    swarm: str
    library: str
    seconds: float
    objective: float
    algorithm: float
    driver: float
    two_workers: float | None

    @property
    def goal(self) -> int | None:
        """Evaluations per second and core that are aimed at; None for the controls."""
        if ALGORITHMS[self.swarm].group == "controls":
            return None
        return GOALS.get(self.swarm, GOALS["papers"])


def costs(
    problem: Problem, rounds: int, names: list[str] | None = None, *, two: bool = True
) -> list[SwarmCost]:
    """Measure whole runs of each swarm in the stretched coding at population 50.

    Parameters
    ----------
    problem : Problem
        The problem.
    rounds : int
        Rounds; the best one counts.
    names : list of str, optional
        Algorithms; all whose libraries are installed if left out.
    two : bool
        Also run each swarm in two processes at once.

    Returns
    -------
    list of SwarmCost
        A row per swarm.
    """
    objective = Objective(problem, stretch=True)
    names = names or [name for name, entry in ALGORITHMS.items() if _there(entry.libraries)]
    seconds, shares = dict.fromkeys(names, np.inf), dict.fromkeys(names, (np.inf, 0.0, 0.0))
    rates = {name: {1: 0.0, 2: 0.0} for name in names}
    with workers(2) if two else nullcontext() as pool, bar("swarms", rounds * len(names)) as advance:
        if pool:
            _rate(pool, 2, objective, names[0])  # loads the compiled code
        for _ in range(rounds):
            for name in names:
                for seed in range(RUNS):
                    cpu, wall = time.process_time(), time.perf_counter()
                    found = _whole_run(objective, name, seed)
                    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
                    seconds[name] = min(seconds[name], cpu / found.evaluations)
                    spent = (wall, found.seconds_objective, found.seconds_algorithm)
                    shares[name] = min(shares[name], spent)
                for jobs in (1, 2) if pool else ():
                    rates[name][jobs] = max(rates[name][jobs], _rate(pool, jobs, objective, name))
                advance()
    return [
        SwarmCost(name, ", ".join(ALGORITHMS[name].libraries), seconds[name], *_parts(*shares[name]),
                  rates[name][2] / rates[name][1] if two else None)
        for name in names
    ]  # fmt: skip


def _whole_run(objective: Objective, name: str, seed: int) -> Result:
    parameters = dict(ALGORITHMS[name].parameters)
    if "population" in parameters:
        parameters["population"] = POPULATION
    lo, hi = search_box(objective.problem)
    function, budget = ALGORITHMS[name].function, POPULATION * STEPS
    return minimise(function, objective, lo, hi, budget=budget, seed=seed, **parameters)


def _parts(wall: float, objective: float, algorithm: float) -> tuple[float, float, float]:
    return objective / wall, algorithm / wall, 1.0 - (objective + algorithm) / wall


def _rate(pool: ProcessPoolExecutor, jobs: int, objective: Objective, name: str) -> float:
    """Evaluations per second of so many processes, which start at the same moment."""
    start = time.time() + 0.02
    waiting = [pool.submit(_slice, objective, name, start) for _ in range(jobs)]
    return sum(future.result() for future in waiting)


def _slice(objective: Objective, name: str, start: float) -> float:
    """Run a swarm again and again for a while; evaluations per second."""
    time.sleep(max(start - time.time(), 0.0))
    evaluations, started = 0, time.perf_counter()
    while (spent := time.perf_counter() - started) < SLICE:
        evaluations += _whole_run(objective, name, evaluations).evaluations
    return evaluations / spent


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
    """Lay the speeds out as a table.

    Parameters
    ----------
    rows : list of SwarmCost
        All swarms.
    summary : dict
        Evaluations per second and core, by swarm.

    Returns
    -------
    str
        A line per swarm.
    """
    lines = [
        [c.swarm, c.library or "-", f"{summary[c.swarm]:,.0f}",
         *(f"{100 * share:.0f}" for share in (c.objective, c.algorithm, c.driver)),
         "-" if c.two_workers is None else f"{c.two_workers:.2f}",
         "-" if c.goal is None else f"{c.goal:,}",
         "-" if c.goal is None else "yes" if summary[c.swarm] >= c.goal else "NO"]
        for c in rows
    ]  # fmt: skip
    title = (
        f"whole runs of {POPULATION * STEPS} evaluations in the stretched coding, population {POPULATION},"
        " swarm and driver included"
    )
    header = ["swarm", "library", "evaluations/s", "objective %", "swarm %", "driver %", "two workers",
              "goal", "reached"]  # fmt: skip
    return f"{title}\n{table(header, lines, right=(2, 3, 4, 5, 6, 7))}\n"


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
    summarise=lambda rows: {c.swarm: 1.0 / c.seconds for c in rows},
    text=cost_text,
)
PAIRED = Study(
    name="speed_mealpy",
    row=SwarmPair,
    compute=pairs,
    summarise=lambda rows: {p.swarm: p.seconds_theirs / p.seconds for p in rows},
    text=pair_text,
)
