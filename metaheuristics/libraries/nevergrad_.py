"""Optimisers of nevergrad by the name in its registry."""

from __future__ import annotations

from typing import Any

import numpy as np

from metaheuristics.driver.task import Moves, Task
from metaheuristics.libraries.shared import finite, library, seed_of


def find(name: str) -> Any:
    """Return an optimiser of nevergrad.

    Parameters
    ----------
    name : str
        Its name in the registry of nevergrad.

    Returns
    -------
    Any
        The optimiser.

    Raises
    ------
    KeyError
        There is none.
    """
    return library("nevergrad").optimizers.registry[name]


def names() -> list[str]:
    """Return the names of all of them.

    Returns
    -------
    list of str
    """
    return sorted(library("nevergrad").optimizers.registry)


def nevergrad(name: str, task: Task) -> Moves:
    """Run an optimiser of nevergrad, which knows its budget, one point at a time.

    Parameters
    ----------
    name : str
        Its name in the registry of nevergrad.
    task : Task
        Box, random numbers, budget.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    ng = library("nevergrad")
    box = ng.p.Array(init=(task.lo + task.hi) / 2, lower=task.lo, upper=task.hi)
    box.random_state = np.random.RandomState(seed_of(task))
    search = find(name)(parametrization=box, budget=task.budget, num_workers=1)
    while True:
        point = search.ask()
        fitness = yield task.clip(point.value)[None]
        search.tell(point, float(finite(fitness)[0]))
