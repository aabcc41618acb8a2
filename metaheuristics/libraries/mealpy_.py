"""Optimisers of mealpy by class name."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil
from typing import Any

from metaheuristics.driver.bridge import inverted
from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.libraries.shared import finite, library, seed_of


def find(name: str) -> Any:
    """Return the class of this name. Raises KeyError."""
    return library("mealpy").get_all_optimizers(verbose=False)[name]


def mealpy(name: str, task: Task, *, population: int = 50) -> Moves:
    """Any optimiser of mealpy with its own defaults; its epochs are budget / population."""
    kind = find(name)
    variables = library("mealpy").FloatVar(lb=task.lo.tolist(), ub=task.hi.tolist())

    def call(f: Callable[[Array], Array]) -> None:
        def objective(x: Array) -> float:
            return float(finite(f(task.clip(x)[None]))[0])

        problem = {"obj_func": objective, "bounds": variables, "minmax": "min", "log_to": None}
        epochs = ceil(task.budget / population)
        kind(epoch=epochs, pop_size=population).solve(problem, seed=seed_of(task))

    return inverted(task, call, endless=True)
