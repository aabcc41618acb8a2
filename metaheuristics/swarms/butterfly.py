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

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from metaheuristics.driver.task import Array, Moves, Task

Rows: TypeAlias = NDArray[np.intp]


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
    x = task.first(population)
    fitness = (yield x).copy()
    generations = max(1.0, (task.budget - population) / population)
    every = np.arange(population)
    while True:
        moves = fluttered(task, x, every, int(fitness.argmin()), fragrance(fitness, c, a), p)
        moved = task.clip(moves)
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


def fluttered(task: Task, x: Array, rows: Rows, best: int, fragrances: Array, p: float) -> Array:
    """Return the moves of some butterflies, Arora & Singh 2019, eq. 2 and 3.

    Parameters
    ----------
    task : Task
        Random numbers.
    x : Array, shape (n, dim)
        All butterflies.
    rows : Rows, shape (m,)
        Those that move.
    best : int
        The best of all.
    fragrances : Array, shape (m,)
        Fragrance of each that moves.
    p : float
        Probability of a move towards the best.

    Returns
    -------
    Array, shape (m, dim)
        Positions after the move, not yet in the box.
    """
    m, n = len(rows), len(x)
    r, choice = task.rng.random((2, m))
    j = task.rng.integers(n, size=m)
    k = j + task.rng.integers(1, max(n, 2), size=m)  # another one, counted round the end
    # r^2 g - x_i towards the best, r^2 x_j - x_k between two others
    towards_best = choice < p
    np.copyto(j, best, where=towards_best)
    np.copyto(k, rows, where=towards_best)
    ahead, behind = x.take(j, axis=0), x.take(k, axis=0, mode="wrap")
    steps = (r**2)[:, None] * ahead - behind
    return np.asarray(x.take(rows, axis=0) + steps * fragrances[:, None])  # eq. 2, 3


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
