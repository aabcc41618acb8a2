"""The whale optimisation algorithm with an inertia weight on its leader and a chaotic start.

Source: seed paper 003 (Lu & Wang 2024, J. Northeastern University 45(5), 683-689), section 2,
eq. 14-23; 30 whales, 500 iterations.  The default is the reading that agrees with the
text (step 3 of section 3.2 lets A choose, as in Mirjalili & Lewis 2016); eq. 16, 19, 21 and 23 to the
letter are `printed`.  b is not printed: 1, as in 2016.

The weight falls from 1 to 0, so the leader w X* ends in x = 0: where the optimum is elsewhere, the last
steps search there for nothing.
"""

from __future__ import annotations

import numpy as np

from metaheuristics.driver.task import Moves, Task
from metaheuristics.swarms.mipso import tent_population


def whale_lu_2024(
    task: Task,
    *,
    population: int = 30,
    s: float = 1.0,
    b: float = 1.0,
    lam: float = 0.499,
    printed: bool = False,
) -> Moves:
    """Whales with inertia; ``s`` > -1 is open, the larger the sooner the weight falls.

    ``lam`` is 0.499 for the printed 0.5, at which the map's orbit ends in 0.  ``printed``: one r for A
    and C, no test of A.  A, C, lambda and g are one number per whale, as in `whale`.
    """
    x = tent_population(task, population, lam)
    best, best_fitness = x[0].copy(), np.inf
    while True:
        fitness = yield x
        i = fitness.argmin()
        if fitness[i] < best_fitness:
            best, best_fitness = x[i].copy(), fitness[i]

        k = task.progress
        w = inertia(k, s)
        delta = 2 * (1 - k)
        r1, r2, choice, r3 = task.rng.random((4, population, 1))
        other = x[task.rng.integers(population, size=population)]
        A = 2 * delta * r1 - delta  # (16)
        C = 2 * (r1 if printed else r2)  # (16); printed with the same r
        g = 2 * r3 - 1
        near = True if printed else np.abs(A) < 1  # (19) and (21) leave the test out
        encircled = w * best - A * np.abs(C * best - x)  # (14), (21)
        searched = other - A * np.abs(C * other - x)  # (20)
        spiral = np.abs(best - x) * np.exp(b * g) * np.cos(2 * np.pi * g) + w * best  # (18), (21)
        x = task.clip(np.where(choice < 0.5, np.where(near, encircled, searched), spiral))


def inertia(k: float, s: float = 1.0) -> float:
    """Return the weight at progress k in [0, 1]: from 1 to 0."""
    return (1 - k) / (1 + s * k)  # (22)
