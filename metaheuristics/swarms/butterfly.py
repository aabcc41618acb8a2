"""The butterfly optimisation algorithm.

Source: Arora & Singh 2019, "Butterfly optimization algorithm: a novel approach for global
optimization", Soft Computing 23, 715-734, eq. 1-3 and algorithm 1, and the growth of c in the authors'
code.  r is one number per butterfly, and a move is kept if it is not worse, as there.

Moves scale x itself (r^2 x_j - x_k), so the swarm is drawn towards x = 0.
"""

from __future__ import annotations

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task


def butterfly(
    task: Task, *, population: int = 50, p: float = 0.8, c: float = 0.01, a: float = 0.1
) -> Moves:
    """Butterflies with sensory modality ``c``, power exponent ``a``, switch probability ``p``."""
    x = task.sample(population)
    fitness = (yield x).copy()
    generations = max(1.0, (task.budget - population) / population)
    while True:
        best = x[fitness.argmin()]
        moved = task.clip(fluttered(task, x, x, best, fragrance(fitness, c, a), p))
        new = yield moved
        kept = new <= fitness
        x = np.where(kept[:, None], moved, x)
        fitness[kept] = new[kept]
        c = grown(c, generations)


def fragrance(fitness: Array, c: float, a: float) -> Array:
    """Return c I^a of each butterfly (n,); the stimulus I is its fitness (n,).

    The power wants I > 0.  If the least is not, all are raised until it is 1; an infeasible one
    has the largest finite stimulus, or 1 if there is none.
    """
    finite = np.isfinite(fitness)
    stimulus = np.where(finite, fitness, -np.inf)
    largest = stimulus.max()
    stimulus = np.where(finite, fitness, largest if finite.any() else 1.0)
    least = stimulus.min()
    if least <= 0:
        stimulus = stimulus - least + 1
    return np.asarray(c * stimulus**a)  # (1)


def fluttered(task: Task, x: Array, flock: Array, best: Array, fragrances: Array, p: float) -> Array:
    """Return the moves of x (m, dim), which smell ``fragrances`` (m,), in a flock (n, dim)."""
    m, n = len(x), len(flock)
    share = task.rng.random((m, 1)) ** 2
    local = task.rng.random((m, 1)) >= p
    j = task.rng.integers(n, size=m)
    k = (j + 1 + task.rng.integers(max(n - 1, 1), size=m)) % n  # another one
    towards = np.where(local, share * flock[j] - flock[k], share * best - x)
    return np.asarray(x + towards * fragrances[:, None])  # (2), (3)


def grown(c: float, generations: float) -> float:
    """Return the sensory modality of the next generation."""
    return c + 0.025 / (c * generations)
