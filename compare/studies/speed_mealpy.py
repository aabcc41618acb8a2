"""Whole runs of a swarm here and of the same swarm in mealpy: a study behind ``timebound speed --swarms``.

They are measured in time of the processor. Rivals take turns, and the best of several rounds counts.
"""

from __future__ import annotations

import importlib.util
import time
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.benchmark.objective import Objective, search_box
from compare.screen import table
from compare.studies.study import Study
from formulations import Problem
from metaheuristics import ALGORITHMS, minimise

POPULATION, BUDGET = 50, 5000
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
    if not installed(("mealpy",)):
        return []
    import mealpy

    objective = Objective(problem, stretch=True)
    lo, hi = search_box(problem)
    kinds = mealpy.get_all_optimizers(verbose=False)
    found = []
    for ours, theirs in PAIRS.items():
        if not installed(ALGORITHMS[ours].libraries):
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


def installed(libraries: tuple[str, ...]) -> bool:
    """Tell whether libraries can be imported.

    Parameters
    ----------
    libraries : tuple of str
        Their names.

    Returns
    -------
    bool
    """
    return all(importlib.util.find_spec(name) is not None for name in libraries)


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


PAIRED = Study(
    name="speed_mealpy",
    row=SwarmPair,
    compute=pairs,
    summarise=lambda rows: {p.swarm: p.seconds_theirs / p.seconds for p in rows},
    text=pair_text,
)
