"""MIPSO: PSO with a tent-map start, dynamic factors and mutation.

References
----------
Wang G., Ni Z., Zhou K., Wang B. (2025).  Time-optimal trajectory planning of robotic arms based on MIPSO
algorithm.  China Mechanical Engineering 36(5), 1044-1053.  doi:10.3969/j.issn.1004-132X.2025.05.016.
Section 3, eq. 10-18; parameters: Table 7; ablations: section 3.4.

Printed, and how it is read
---------------------------
`mipso` is the reading that agrees with the paper's text; `mipso_printed` follows eq. 15 and 16 literally.

eq. 10, 11  The step of PSO: `metaheuristics.swarms.particles`.
eq. 12, 13  The tent map: `metaheuristics.swarms.tent`.
eq. 15      As printed, w rises from -0.46 to 0.4.  The text wants a decrease that is slow first and fast
            later; K/k in place of k/K is the smallest change that gives it.
eq. 16      As printed, a mutant lies between the lower bound and x.  The text wants any value of the
            domain.  Which gene mutates is open: one, drawn uniformly.
eq. 17      The average is over feasible particles.  The best never mutates.
section 3.4 The paper does not give the constants of PSO2 (no dynamic factors).  They are held at the mean
            of their own schedules over a run, so that the ablation removes the change and not the level.
"""

from __future__ import annotations

from math import cos, exp, pi

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.swarms.particles import Factors, Swarm, excess_over_best
from metaheuristics.swarms.tent import tent_population

MEAN_DECAY = 0.4036526376768059
"""Mean of exp(1 - 1/k) over k in [0, 1]: 1 - Gompertz's constant."""


def mipso(
    task: Task,
    *,
    population: int = 50,
    tent: bool = True,
    dynamic: bool = True,
    mutation: bool = True,
    lam: float = 0.499,
    w_max: float = 0.9,
    w_min: float = 0.4,
    pm1: float = 0.1,
    pm2: float = 0.2,
) -> Moves:
    """Run MIPSO as its text describes it; each switch that is off is one ablation of section 3.4.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of particles.
    tent : bool
        Start on the tent map; off (PSO1): uniform start.
    dynamic : bool
        Let inertia and factors follow the progress; off (PSO2): hold them at their means.
    mutation : bool
        Mutate; off (PSO3): no mutants.
    lam : float
        Place of the tent map's peak in (0, 1).
    w_max, w_min : float
        Inertia at the start and at the end.
    pm1, pm2 : float
        Probability of mutation below and above the average fitness (eq. 17).

    Yields
    ------
    Array, shape (population, dim) or (mutants, dim)
        Points to be evaluated.
    """

    def moving(k: float) -> tuple[float, float, float]:
        return resolved_inertia(k, w_max, w_min), *learning_factors(k)

    def held(k: float) -> tuple[float, float, float]:
        return w_max - (w_max - w_min) * MEAN_DECAY, 1.0, 1.0

    x = tent_population(task, population, lam) if tent else task.first(population)
    yield from _evolve(
        task, x, moving if dynamic else held, (pm1, pm2) if mutation else None, printed=False
    )


def mipso_printed(
    task: Task,
    *,
    population: int = 50,
    lam: float = 0.499,
    w_max: float = 0.9,
    w_min: float = 0.4,
    pm1: float = 0.1,
    pm2: float = 0.2,
) -> Moves:
    """Run MIPSO with eq. 15 and eq. 16 exactly as printed.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of particles.
    lam : float
        Place of the tent map's peak in (0, 1).
    w_max, w_min : float
        Constants of eq. 15.
    pm1, pm2 : float
        Probability of mutation below and above the average fitness (eq. 17).

    Yields
    ------
    Array, shape (population, dim) or (mutants, dim)
        Points to be evaluated.
    """

    def factors(k: float) -> tuple[float, float, float]:
        return printed_inertia(k, w_max, w_min), *learning_factors(k)

    yield from _evolve(task, tent_population(task, population, lam), factors, (pm1, pm2), printed=True)


def _evolve(
    task: Task, x: Array, factors: Factors, pm: tuple[float, float] | None, *, printed: bool
) -> Moves:
    """Run steps 3-6 of section 3.3 from x (n, dim); mutants are a batch of their own, and count."""
    swarm = Swarm(task, x)
    swarm.remember((yield swarm.x))
    while True:
        swarm.move(*factors(task.progress))  # Wang 2025, eq. 10, 11
        fitness = (yield swarm.x).copy()
        swarm.remember(fitness)
        if pm is None:
            continue
        chosen = task.rng.random(len(x)) < mutation_probability(fitness, *pm)  # section 3.3, step 5
        rows = np.flatnonzero(chosen)
        if rows.size == 0:
            continue
        mutants = mutate(task, swarm.x[rows], printed=printed)
        mutant_fitness = yield mutants
        accepted = fitness[rows] >= mutant_fitness  # Wang 2025, eq. 18
        swarm.x[rows[accepted]] = mutants[accepted]
        fitness[rows[accepted]] = mutant_fitness[accepted]
        swarm.remember(fitness)  # at once: the next move leaves x


def learning_factors(k: float) -> tuple[float, float]:
    """Return the learning factors, Wang 2025, eq. 14.

    Parameters
    ----------
    k : float
        Progress in [0, 1].

    Returns
    -------
    c1 : float
        Own factor, from 2 to 0.
    c2 : float
        Social factor, from 0 to 2.
    """
    c1 = 2 * cos(pi * k / 2) ** 2  # Wang 2025, eq. 14
    return c1, 2 - c1


def resolved_inertia(k: float, w_max: float = 0.9, w_min: float = 0.4) -> float:
    """Return the inertia that Wang 2025 describes: eq. 15 with K/k for its k/K.

    Parameters
    ----------
    k : float
        Progress in [0, 1].
    w_max, w_min : float
        Inertia at the start and at the end.

    Returns
    -------
    float
        Inertia w; it falls slowly first.
    """
    return w_max - (w_max - w_min) * (exp(1 - 1 / k) if k > 0 else 0.0)  # Wang 2025, eq. 15, resolved


def printed_inertia(k: float, w_max: float = 0.9, w_min: float = 0.4) -> float:
    """Return the inertia of Wang 2025, eq. 15, as printed.

    Parameters
    ----------
    k : float
        Progress in [0, 1].
    w_max, w_min : float
        Constants of eq. 15.

    Returns
    -------
    float
        Inertia w; it rises from w_max - e (w_max - w_min) to w_min.
    """
    return w_max - (w_max - w_min) * exp(1 - k)  # Wang 2025, eq. 15, printed


def mutation_probability(fitness: Array, pm1: float = 0.1, pm2: float = 0.2) -> Array:
    """Return the probability of each particle to mutate, Wang 2025, eq. 17.

    Parameters
    ----------
    fitness : Array, shape (n,)
        Fitness of the particles; +inf marks an infeasible one.
    pm1, pm2 : float
        Probability below and above the average fitness.

    Returns
    -------
    Array, shape (n,)
        Probabilities.  That of the first best is 0, also where all are equal (eq. 17 is 0/0 there by its
        upper branch, and pm2 by its lower).  If no particle is feasible, there is no best.
    """
    p = np.full_like(fitness, pm2)
    best = fitness.argmin()
    if fitness[best] == np.inf:
        return p
    excess, average = excess_over_best(fitness)
    below = excess < average
    p[below] = pm1 * excess[below] / average  # Wang 2025, eq. 17
    p[best] = 0.0
    return p


def mutate(task: Task, x: Array, *, printed: bool = False) -> Array:
    """Return points in which one random gene each is drawn anew, Wang 2025, eq. 16.

    Parameters
    ----------
    task : Task
        Box and random numbers.
    x : Array, shape (m, dim)
        The points before; they stay as they are.
    printed : bool
        Draw between the lower bound and x, as printed, in place of the whole domain.

    Returns
    -------
    Array, shape (m, dim)
        The mutants.
    """
    mutants = x.copy()
    rows, genes = np.arange(len(x)), task.rng.integers(task.dim, size=len(x))
    lo = task.lo[genes]
    end = x[rows, genes] if printed else task.hi[genes]
    mutants[rows, genes] = lo + (end - lo) * task.rng.random(len(x))  # Wang 2025, eq. 16
    return mutants
