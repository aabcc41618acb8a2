"""Optimisers of minionpy by name, among them L-SHADE (Tanabe & Fukunaga 2014)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from metaheuristics.driver.bridge import inverted
from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.libraries.shared import finite, library, seed_of


def lshade(task: Task, *, memory_size: int = 6) -> Moves:
    """Run L-SHADE with the defaults of the library; it knows its budget, and never stops before.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    memory_size : int
        Size of its memory.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    return _search(task, "LSHADE", {"memory_size": memory_size, "x_tol": -1.0})


def minion(name: str, task: Task) -> Moves:
    """Run a minimiser of minionpy with its own defaults.

    Parameters
    ----------
    name : str
        Name of its class.
    task : Task
        Box, random numbers, budget.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    return _search(task, name, None)


def find(name: str) -> Any:
    """Return a minimiser of minionpy.

    Parameters
    ----------
    name : str
        Name of its class.

    Returns
    -------
    Any
        The class.

    Raises
    ------
    AttributeError
        There is none.
    """
    found = getattr(library("minionpy"), name)
    if not issubclass(found, library("minionpy").MinimizerBase):
        raise AttributeError(f"{name} is no minimiser")
    return found


def names() -> list[str]:
    """Return the names of all of them.

    Returns
    -------
    list of str
    """
    base = library("minionpy").MinimizerBase
    every = vars(library("minionpy")).items()
    return sorted(key for key, one in every if isinstance(one, type) and issubclass(one, base))


def _search(task: Task, name: str, options: dict[str, Any] | None) -> Moves:
    minimiser = find(name)
    bounds = list(zip(task.lo.tolist(), task.hi.tolist(), strict=True))

    def call(f: Callable[[Array], Array]) -> None:
        def objective(x: Any) -> list[float]:
            return finite(f(task.clip(np.array(x)))).tolist()  # type: ignore[no-any-return]

        seed = seed_of(task)
        minimiser(objective, bounds, maxevals=task.budget, seed=seed, options=options).optimize()

    return inverted(task, call, endless=True)
