"""PSO with Beta-disturbed inertia, factors by fitness, and a crossover of differential evolution.

Source: seed paper 004 (Zhang, Li, Ye 2025, DOI 10.19651/j.cnki.emt.2520058), section 1, eq. 1-7;
20 particles, 200 iterations.  The default is the reading that agrees
with the text; where eq. 7 as printed differs, and what the paper leaves open, is said at the line.
"""

from __future__ import annotations

from math import exp
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.swarms.pso import Swarm

Indices: TypeAlias = NDArray[np.int64]


def pso_zhang_2025(
    task: Task,
    *,
    population: int = 20,
    w_max: float = 0.9,
    w_min: float = 0.4,
    sigma: float = 0.1,
    p: float = 1.0,
    q: float = 3.0,
    alpha: float = 0.5,
    beta: float = 0.5,
    c_min: float = 0.02,
    c_max: float = 2.0,
    F: float = 0.5,
    CR: float = 0.1,
    printed: bool = False,
) -> Moves:
    """PSO of 004 as its text describes it; ``printed``: eq. 7 to the letter.

    ``alpha`` and ``beta`` are only said to lie in (0, 1): the middle.  The Beta number is one a step.
    The crossover changes the positions themselves, as the text has it: no selection, no evaluation of
    its own.
    """
    swarm = Swarm(task, task.sample(population))
    while True:
        fitness = yield swarm.x
        swarm.remember(fitness)
        w = w_min + (w_max - w_min) * exp(-task.progress) + sigma * task.rng.beta(p, q)  # (5)
        c1, c2 = adaptive_factors(fitness, alpha, beta, c_min, c_max)
        swarm.move(w, c1[:, None], c2[:, None])  # (3), (2)
        swarm.x = crossed(task, swarm.x, F, CR, printed=printed)


def adaptive_factors(
    fitness: Array, alpha: float, beta: float, c_min: float, c_max: float
) -> tuple[Array, Array]:
    """Return c1 and c2 of each particle (n,), given its fitness (n,), +inf allowed.

    The average is over finite fitness only.  The listed bounds of c are applied here: eq. 6 alone
    leaves them for any particle worse than the average, where c2 turns negative.
    """
    finite = np.isfinite(fitness)
    ratio = np.where(finite, 0.0, np.inf)  # infeasible: infinitely worse than the average
    if finite.any():
        excess = fitness[finite] - fitness[finite].min()
        average = (excess / excess.size).sum()  # safe from overflow
        if average > 0:  # all equal: all are the best
            ratio[finite] = excess / average
    c1 = alpha * ratio + beta  # (6)
    c2 = alpha * (1 - ratio) + beta  # (6)
    return np.clip(c1, c_min, c_max), np.clip(c2, c_min, c_max)


def crossed(task: Task, x: Array, F: float, CR: float, *, printed: bool = False) -> Array:
    """Return x (n, dim) with some coordinates replaced by mutants, in the box.

    Where no mutant goes, the text keeps a particle's own coordinate; eq. 7 prints that of particle
    r1.  Fewer than four particles have no three others, and stay as they are.
    """
    n = len(x)
    if n < 4:
        return x
    r1, r2, r3 = three_others(task.rng, n)
    mutants = x[r1] + F * (x[r2] - x[r3])
    kept = x[r1] if printed else x
    return task.clip(np.where(task.rng.random(x.shape) < CR, mutants, kept))  # (7)


def three_others(rng: np.random.Generator, n: int) -> tuple[Indices, Indices, Indices]:
    """Draw for each of n >= 4 particles three others, all different: three index arrays (n,)."""
    own = np.arange(n)
    first = rng.integers(n - 1, size=n)  # steps ahead of one's own place, less one
    second = rng.integers(n - 2, size=n)
    third = rng.integers(n - 3, size=n)
    second += second >= first
    low, high = np.minimum(first, second), np.maximum(first, second)
    third += third >= low
    third += third >= high
    return (own + 1 + first) % n, (own + 1 + second) % n, (own + 1 + third) % n
