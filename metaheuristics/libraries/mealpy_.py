"""Optimisers of mealpy by class name."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil
from typing import Any

from metaheuristics.driver.bridge import inverted
from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.libraries.shared import finite, library, seed_of


def find(name: str) -> Any:
    """Return an optimiser of mealpy.

    Parameters
    ----------
    name : str
        Name of its class; ``GWO`` stands for ``OriginalGWO``.

    Returns
    -------
    Any
        The class.

    Raises
    ------
    KeyError
        There is none.
    """
    known = library("mealpy").get_all_optimizers(verbose=False)
    return known[name] if name in known or f"Original{name}" not in known else known[f"Original{name}"]


def names() -> list[str]:
    """Return the names of all of them.

    Returns
    -------
    list of str
    """
    return sorted(library("mealpy").get_all_optimizers(verbose=False))


def mealpy(name: str, task: Task, *, population: int = 50) -> Moves:
    """Run an optimiser of mealpy with its own defaults for budget / population epochs.

    Parameters
    ----------
    name : str
        Name of its class.
    task : Task
        Box, random numbers, budget.
    population : int
        Population size.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    kind = find(name)
    variables = library("mealpy").FloatVar(lb=task.lo.tolist(), ub=task.hi.tolist())

    def call(f: Callable[[Array], Array]) -> None:
        def objective(x: Array) -> float:
            return float(finite(f(task.clip(x)[None]))[0])

        problem = {"obj_func": objective, "bounds": variables, "minmax": "min", "log_to": None}
        epochs = ceil(task.budget / population)
        kind(epoch=epochs, pop_size=population).solve(problem, seed=seed_of(task))

    return inverted(task, call, endless=True)
