"""Uniform random search: the least any algorithm must beat.

Source: no paper; independent uniform points, the best one kept by the driver.
"""

from __future__ import annotations

from metaheuristics.driver.task import Moves, Task


def random_search(task: Task, *, population: int = 50) -> Moves:
    """Yield uniform points (population, dim) for ever; batch size does not change the points."""
    while True:
        yield task.sample(population)
