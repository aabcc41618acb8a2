"""PSO of Zhang 2025: inertia with a Beta term, factors by fitness, and a crossover of differential evolution.

References
----------
Zhang Y., Li Y., Ye L. (2025).  Trajectory planning for the mechanical arm of the moxibustion robot based on
the improved particle swarm optimization algorithm.  Electronic Measurement Technology.
doi:10.19651/j.cnki.emt.2520058.  Section 1, eq. 1-7; 20 particles, 200 iterations.

Printed, and how it is read
---------------------------
eq. 5  One Beta number is drawn per step.
eq. 6  alpha and beta are only said to lie in (0, 1): 0.5 each.  The average is over feasible particles.  The
       listed bounds of the factors are applied, because eq. 6 alone makes c2 negative for a particle much
       worse than the average.
eq. 7  Where no mutant is taken, the text keeps the particle's own coordinate; the equation prints that of
       particle r1 (``printed``).  The crossover changes the positions themselves, as the text has it: there is
       no selection, and no evaluation of its own.
"""

from __future__ import annotations

from math import exp
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.swarms.particles import Swarm, excess_over_best

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
    """Run the PSO of Zhang 2025 as its text describes it.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of particles.
    w_max, w_min, sigma, p, q : float
        Inertia and its Beta term (eq. 5).
    alpha, beta : float
        Constants of the learning factors (eq. 6).
    c_min, c_max : float
        Bounds of the learning factors.
    F, CR : float
        Scaling factor and probability of the crossover (eq. 7).
    printed : bool
        Follow eq. 7 literally.

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """
    swarm = Swarm(task, task.first(population))
    while True:
        fitness = yield swarm.x
        swarm.remember(fitness)
        w = (
            w_min + (w_max - w_min) * exp(-task.progress) + sigma * task.rng.beta(p, q)
        )  # Zhang 2025, eq. 5
        c1, c2 = adaptive_factors(fitness, alpha, beta, c_min, c_max)
        swarm.move(w, c1[:, None], c2[:, None])  # Zhang 2025, eq. 3, 2
        swarm.x = crossed(task, swarm.x, F, CR, printed=printed)


def adaptive_factors(
    fitness: Array, alpha: float, beta: float, c_min: float, c_max: float
) -> tuple[Array, Array]:
    """Return the learning factors of each particle, Zhang 2025, eq. 6.

    Parameters
    ----------
    fitness : Array, shape (n,)
        Fitness of the particles; +inf marks an infeasible one, which is infinitely worse than the average.
    alpha, beta : float
        Constants of eq. 6.
    c_min, c_max : float
        Bounds of both factors.

    Returns
    -------
    c1, c2 : Array, shape (n,)
        Own and social factors.
    """
    finite = np.isfinite(fitness)
    ratio = np.where(finite, 0.0, np.inf)
    if finite.any():
        excess, average = excess_over_best(fitness)
        if average > 0:  # otherwise all feasible ones are the best
            ratio[finite] = excess[finite] / average
    c1 = alpha * ratio + beta  # Zhang 2025, eq. 6
    c2 = alpha * (1 - ratio) + beta  # Zhang 2025, eq. 6
    return np.clip(c1, c_min, c_max), np.clip(c2, c_min, c_max)


def crossed(task: Task, x: Array, F: float, CR: float, *, printed: bool = False) -> Array:
    """Return positions in which some coordinates are replaced by mutants, Zhang 2025, eq. 7.

    Parameters
    ----------
    task : Task
        Box and random numbers.
    x : Array, shape (n, dim)
        Positions.  Fewer than four particles have no three others, and stay as they are.
    F, CR : float
        Scaling factor, and probability that a coordinate is replaced.
    printed : bool
        Keep the coordinate of particle r1, as printed, in place of the particle's own.

    Returns
    -------
    Array, shape (n, dim)
        Positions in the box.
    """
    n = len(x)
    if n < 4:
        return x
    r1, r2, r3 = three_others(task.rng, n)
    mutants = x[r1] + F * (x[r2] - x[r3])
    kept = x[r1] if printed else x
    return task.clip(np.where(task.rng.random(x.shape) < CR, mutants, kept))  # Zhang 2025, eq. 7


def three_others(rng: np.random.Generator, n: int) -> tuple[Indices, Indices, Indices]:
    """Draw for each particle three others, all different.

    Parameters
    ----------
    rng : numpy.random.Generator
        Random numbers.
    n : int
        Number of particles, at least four.

    Returns
    -------
    r1, r2, r3 : Indices, shape (n,)
        The others.
    """
    own = np.arange(n)
    first = rng.integers(n - 1, size=n)  # steps ahead of one's own place, less one
    second = rng.integers(n - 2, size=n)
    third = rng.integers(n - 3, size=n)
    second += second >= first
    low, high = np.minimum(first, second), np.maximum(first, second)
    third += third >= low
    third += third >= high
    return (own + 1 + first) % n, (own + 1 + second) % n, (own + 1 + third) % n
