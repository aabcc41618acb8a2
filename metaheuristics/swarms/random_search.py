"""Uniform random search: the least that any algorithm must beat.

There is no paper: independent uniform points, of which the driver keeps the best.
"""

from __future__ import annotations

from metaheuristics.driver.task import Moves, Task


def random_search(task: Task, *, population: int = 50) -> Moves:
    """Draw uniform points; the batch size does not change them.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Points per batch.

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """
    yield task.first(population)
    while True:
        yield task.sample(population)
