"""How fast a swarm evaluates candidates, on one core and on two: the study behind ``timebound speed --swarms``.

Speed on one core is measured in time of the processor, not of the wall, so that other programs on the
machine count less. Rivals take turns, and the best of several rounds counts.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.benchmark.objective import Objective, search_box
from compare.engines import Engine, workers
from compare.screen import bar, table
from compare.studies.speed_mealpy import installed
from compare.studies.study import Study
from formulations import Problem
from formulations.problem.arrays import Array
from metaheuristics import ALGORITHMS, Result, Task, minimise
from metaheuristics.driver.task import Moves, Search

POPULATION, STEPS = 50, 60
RUNS = 3
"""Runs of a swarm per round; the best one counts."""
SLICE = 0.2
"""Time that each worker works when workers are compared [s]."""
GOALS = {"pso": 500_000, "papers": 200_000}
"""Evaluations per second and core that are aimed at, for `pso` and for the swarms of the papers."""


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
    two_workers, two_workers_wall : float or None
        Evaluations per second of two processes over those of one, in time of the processor and by the clock
        on the wall, which other programs slow down too; None if it was not measured.
    """

    swarm: str
    library: str
    seconds: float
    objective: float
    algorithm: float
    driver: float
    two_workers: float | None
    two_workers_wall: float | None

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
    names = names or [name for name, entry in ALGORITHMS.items() if installed(entry.libraries)]
    seconds = dict.fromkeys(names, np.inf)
    spent = dict.fromkeys(names, (np.inf, 0.0, 0.0))
    rates = {name: {jobs: np.zeros(2) for jobs in (1, 2)} for name in names}
    with workers(2) if two else nullcontext() as pool, bar("swarms", rounds * len(names)) as advance:
        if pool:
            _rates(pool, 2, objective, names[0])  # loads the compiled code
        for _ in range(rounds):
            for name in names:
                for seed in range(RUNS):
                    started = time.process_time()
                    evaluations = _whole_run(objective, name, seed).evaluations
                    took = (time.process_time() - started) / evaluations
                    seconds[name] = min(seconds[name], took)
                    spent[name] = min(spent[name], _spent(objective, name, seed))
                for jobs in (1, 2):
                    now = _rates(pool, jobs, objective, name) if pool else np.zeros(2)
                    rates[name][jobs] = np.maximum(rates[name][jobs], now)
                advance()
    found = []
    for name in names:
        whole, inside, own = spent[name]
        shares = inside / whole, own / whole, 1.0 - (inside + own) / whole
        ratios = (rates[name][2] / rates[name][1]).tolist() if two else (None, None)
        library = ", ".join(ALGORITHMS[name].libraries)
        found.append(SwarmCost(name, library, seconds[name], *shares, *ratios))
    return found


def _whole_run(objective: Objective, name: str, seed: int, spent: list[float] | None = None) -> Result:
    """Run a swarm; into ``spent`` goes the time of the processor in the objective and in the swarm."""
    entry = ALGORITHMS[name]
    parameters = dict(entry.parameters)
    if "population" in parameters:
        parameters["population"] = POPULATION
    f: Any = objective
    search = entry.function
    if spent is not None:
        f, search = _timed(objective, spent, 0), _timed_moves(entry.function, spent, 1)
    lo, hi = search_box(objective.problem)
    return minimise(search, f, lo, hi, budget=POPULATION * STEPS, seed=seed, **parameters)


def _spent(objective: Objective, name: str, seed: int) -> tuple[float, float, float]:
    """Time of the processor that a run takes, and its part in the objective and in the swarm [s]."""
    spent = [0.0, 0.0]
    started = time.process_time()
    _whole_run(objective, name, seed, spent)
    return time.process_time() - started, spent[0], spent[1]


def _timed(f: Callable[..., Any], spent: list[float], who: int) -> Callable[..., Any]:
    def timed(*arguments: Any) -> Any:
        started = time.process_time()
        try:
            return f(*arguments)
        finally:
            spent[who] += time.process_time() - started

    return timed


def _timed_moves(function: Search, spent: list[float], who: int) -> Search:
    def timed(task: Task, **parameters: Any) -> Moves:
        moves = _timed(lambda: function(task, **parameters), spent, who)()
        send = _timed(moves.send, spent, who)
        try:
            x = _timed(next, spent, who)(moves)
            while True:
                x = send((yield x))
        finally:
            moves.close()

    return timed


def _rates(pool: Engine, jobs: int, objective: Objective, name: str) -> Array:
    """Evaluations per second of so many processes that start together: of the processor, by the clock."""
    start = time.time() + 0.02
    waiting = [pool.submit(_slice, objective, name, start) for _ in range(jobs)]
    return np.asarray(np.sum([future.result() for future in waiting], axis=0))


def _slice(objective: Objective, name: str, start: float) -> tuple[float, float]:
    """Run a swarm again and again for a while."""
    time.sleep(max(start - time.time(), 0.0))
    evaluations, wall, cpu = 0, time.perf_counter(), time.process_time()
    while time.perf_counter() - wall < SLICE:
        evaluations += _whole_run(objective, name, seed=evaluations).evaluations
    return evaluations / (time.process_time() - cpu), evaluations / (time.perf_counter() - wall)


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
         *("-" if ratio is None else f"{ratio:.2f}" for ratio in (c.two_workers, c.two_workers_wall)),
         "-" if c.goal is None else f"{c.goal:,}",
         "-" if c.goal is None else "yes" if summary[c.swarm] >= c.goal else "NO"]
        for c in rows
    ]  # fmt: skip
    title = (
        f"whole runs of {POPULATION * STEPS} evaluations in the stretched coding, population {POPULATION},"
        " swarm and driver included"
    )
    header = ["swarm", "library", "evaluations/s", "objective %", "swarm %", "driver %", "two workers",
              "by the clock", "goal", "reached"]  # fmt: skip
    return f"{title}\n{table(header, lines, right=(2, 3, 4, 5, 6, 7, 8))}\n"


COSTS = Study(
    name="speed_swarms",
    row=SwarmCost,
    compute=costs,
    summarise=lambda rows: {c.swarm: 1.0 / c.seconds for c in rows},
    text=cost_text,
)
