"""The whale optimisation algorithm.

Source: Mirjalili & Lewis 2016, "The Whale Optimization Algorithm", Advances in Engineering
Software 95, eq. 2.1-2.8.  Its moves scale positions themselves (C X*), so they depend on where
x = 0 lies: the algorithm is not invariant under translation of the box.
"""

from __future__ import annotations

import numpy as np

from metaheuristics.driver.task import Moves, Task


def whale(task: Task, *, population: int = 50, b: float = 1.0) -> Moves:
    """Encircle, search, or spiral with constant ``b``; the best so far X* is (dim,).

    The paper writes A and C as vectors, but tests |A| < 1 on the whale: both are one number per
    whale here, as are p and l ~ U(-1, 1).  The random whale is drawn per whale, itself included,
    and from the positions before the step.
    """
    x = task.sample(population)
    best, best_fitness = x[0].copy(), np.inf
    while True:
        fitness = yield x
        i = fitness.argmin()
        if fitness[i] < best_fitness:
            best, best_fitness = x[i].copy(), fitness[i]

        a = 2 * (1 - task.progress)
        r1, r2, p, r3 = task.rng.random((4, population, 1))
        other = x[task.rng.integers(population, size=population)]
        A = 2 * a * r1 - a  # (2.3)
        C = 2 * r2  # (2.4)
        l = 2 * r3 - 1  # noqa: E741 (the paper's letter)
        leader = np.where(np.abs(A) < 1, best, other)
        encircled = leader - A * np.abs(C * leader - x)  # (2.1), (2.2); (2.7), (2.8)
        spiral = np.abs(best - x) * np.exp(b * l) * np.cos(2 * np.pi * l) + best  # (2.5)
        x = task.clip(np.where(p < 0.5, encircled, spiral))  # (2.6)
