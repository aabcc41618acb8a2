"""Optimisers of nevergrad by the name in its registry."""

from __future__ import annotations

from typing import Any

import numpy as np

from metaheuristics.driver.task import Moves, Task
from metaheuristics.libraries.shared import finite, library, seed_of


def find(name: str) -> Any:
    """Return the optimiser of this name.  Raises KeyError."""
    return library("nevergrad").optimizers.registry[name]


def nevergrad(name: str, task: Task) -> Moves:
    """Any optimiser of nevergrad, told its budget, one point at a time."""
    ng = library("nevergrad")
    box = ng.p.Array(init=(task.lo + task.hi) / 2, lower=task.lo, upper=task.hi)
    box.random_state = np.random.RandomState(seed_of(task))
    search = find(name)(parametrization=box, budget=task.budget, num_workers=1)
    while True:
        point = search.ask()
        fitness = yield task.clip(point.value)[None]
        search.tell(point, float(finite(fitness)[0]))
