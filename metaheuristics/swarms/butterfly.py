"""The butterfly optimisation algorithm.

References
----------
Arora S., Singh S. (2019).  Butterfly optimization algorithm: a novel approach for global optimization.  Soft
Computing 23, 715-734.  Eq. 1-3 and algorithm 1; the growth of c follows the authors' code.

Printed, and how it is read
---------------------------
r is one number per butterfly, and a move is kept if it is not worse, as in the authors' code.  Eq. 1 needs
positive fitness: see `fragrance` for what is done with any other.

The moves scale x itself (r^2 x_j - x_k), so that the swarm is drawn towards x = 0.
"""

from __future__ import annotations

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task


def butterfly(
    task: Task, *, population: int = 50, p: float = 0.8, c: float = 0.01, a: float = 0.1
) -> Moves:
    """Run the butterfly optimisation algorithm.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of butterflies.
    p : float
        Probability of a move towards the best.
    c : float
        Sensory modality at the start.
    a : float
        Power exponent.

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """
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
    """Return the fragrance c I^a of each butterfly, Arora & Singh 2019, eq. 1.

    The stimulus I is the fitness, and the power needs I > 0.  If the least fitness is not positive, all are
    raised until it is 1.  An infeasible butterfly has the largest finite stimulus, or 1 if there is none.

    Parameters
    ----------
    fitness : Array, shape (n,)
        Fitness; +inf marks an infeasible butterfly.
    c : float
        Sensory modality.
    a : float
        Power exponent.

    Returns
    -------
    Array, shape (n,)
        Fragrances.
    """
    least, stimulus = fitness[fitness.argmin()], fitness
    if least == np.inf:
        return np.full(len(fitness), c)
    if fitness[fitness.argmax()] == np.inf:
        feasible = np.where(fitness < np.inf, fitness, -np.inf)
        stimulus = np.minimum(fitness, feasible[feasible.argmax()])
    if least <= 0:
        stimulus = stimulus - least + 1
    return np.asarray(c * stimulus**a)  # eq. 1


def fluttered(task: Task, x: Array, flock: Array, best: Array, fragrances: Array, p: float) -> Array:
    """Return the moves of some butterflies, Arora & Singh 2019, eq. 2 and 3.

    Parameters
    ----------
    task : Task
        Random numbers.
    x : Array, shape (m, dim)
        The butterflies that move.
    flock : Array, shape (n, dim)
        All butterflies.
    best : Array, shape (dim,)
        The best of them.
    fragrances : Array, shape (m,)
        Fragrance of each that moves.
    p : float
        Probability of a move towards the best.

    Returns
    -------
    Array, shape (m, dim)
        Positions after the move, not yet in the box.
    """
    m, n = len(x), len(flock)
    r, choice = task.rng.random((2, m, 1))
    share = r**2
    j = task.rng.integers(n, size=m)
    k = (j + 1 + task.rng.integers(max(n - 1, 1), size=m)) % n  # another one
    other, another = flock.take(j, axis=0), flock.take(k, axis=0)
    towards = np.where(choice < p, share * best - x, share * other - another)
    return np.asarray(x + towards * fragrances[:, None])  # eq. 2, 3


def grown(c: float, generations: float) -> float:
    """Return the sensory modality of the next generation.

    Parameters
    ----------
    c : float
        Sensory modality.
    generations : float
        Generations of the whole run.

    Returns
    -------
    float
        Sensory modality, larger.
    """
    return c + 0.025 / (c * generations)
