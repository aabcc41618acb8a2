"""MIPSO: PSO with a tent-map start, dynamic factors and mutation.

Source: seed paper 000 (Wang, Ni, Zhou, Wang 2025, DOI 10.3969/j.issn.1004-132X.2025.05.016),
section 3, eq. 10-18 and table 7.  `mipso` is the reading that agrees with the paper's text,
`mipso_printed` takes eq. 15 and 16 to the letter.  Where they differ, and what the paper leaves
open, is said at the line.
"""

from __future__ import annotations

from math import cos, exp, pi

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.swarms.pso import Factors, Swarm

MEAN_DECAY = 0.4036526376768059  # of exp(1 - 1/k) over k in [0, 1]: 1 - Gompertz's constant


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
    """MIPSO as its text describes it; each switch turned off is one ablation of section 3.4.

    ``tent`` off (PSO1): uniform start.  ``mutation`` off (PSO3): no mutants.  ``dynamic`` off
    (PSO2): the paper does not give its constants; they are held at the mean of their own schedules
    over a run, so that the ablation takes away the change and not the level.
    """

    def moving(k: float) -> tuple[float, float, float]:
        return resolved_inertia(k, w_max, w_min), *learning_factors(k)

    def held(k: float) -> tuple[float, float, float]:
        return w_max - (w_max - w_min) * MEAN_DECAY, 1.0, 1.0

    x = tent_population(task, population, lam) if tent else task.sample(population)
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
    """MIPSO with eq. 15 and eq. 16 exactly as printed."""

    def factors(k: float) -> tuple[float, float, float]:
        return printed_inertia(k, w_max, w_min), *learning_factors(k)

    yield from _evolve(task, tent_population(task, population, lam), factors, (pm1, pm2), printed=True)


def _evolve(
    task: Task, x: Array, factors: Factors, pm: tuple[float, float] | None, *, printed: bool
) -> Moves:
    """Run steps 3-6 of section 3.3 from x (n, dim); mutants are their own batch, and count."""
    swarm = Swarm(task, x)
    swarm.remember((yield swarm.x))
    while True:
        swarm.move(*factors(task.progress))  # (10), (11)
        fitness = (yield swarm.x).copy()
        swarm.remember(fitness)
        if pm is None:
            continue
        chosen = task.rng.random(len(x)) < mutation_probability(fitness, *pm)  # step 5
        rows = np.flatnonzero(chosen)
        if rows.size == 0:
            continue
        mutants = mutate(task, swarm.x[rows], printed=printed)
        mutant_fitness = yield mutants
        accepted = fitness[rows] >= mutant_fitness  # (18)
        swarm.x[rows[accepted]] = mutants[accepted]
        fitness[rows[accepted]] = mutant_fitness[accepted]
        swarm.remember(fitness)  # at once: the next move leaves x


def tent_map(z: Array, lam: float = 0.499) -> Array:
    """Return the tent map of z in [0, 1], elementwise; its peak is at ``lam`` in (0, 1)."""
    return np.where(z < lam, z / lam, (1 - z) / (1 - lam))  # (12)


def tent_population(task: Task, n: int, lam: float = 0.499) -> Array:
    """Return n points (n, dim) of the box along one tent orbit per coordinate.

    The paper does not say what its sequence runs over: here over the particles, from a random
    state per coordinate.  With lam = 0.5 doubles lose a bit each time and the orbit ends in 0.
    """
    z = np.empty((n, task.dim))
    state = task.rng.random(task.dim)
    for row in z:
        row[:] = state = tent_map(state, lam)
    return task.clip(task.lo + z * (task.hi - task.lo))  # (13); z = 1 may round past hi


def learning_factors(k: float) -> tuple[float, float]:
    """Return c1 (2 -> 0) and c2 (0 -> 2) at progress k in [0, 1]."""
    c1 = 2 * cos(pi * k / 2) ** 2  # (14)
    return c1, 2 - c1


def resolved_inertia(k: float, w_max: float = 0.9, w_min: float = 0.4) -> float:
    """Return w at progress k in [0, 1]: from w_max to w_min, slow at first, as the text wants.

    Eq. 15 with K/k for its k/K: an inverted fraction is the smallest change that does it.
    """
    return w_max - (w_max - w_min) * (exp(1 - 1 / k) if k > 0 else 0.0)  # (15), resolved


def printed_inertia(k: float, w_max: float = 0.9, w_min: float = 0.4) -> float:
    """Return w at progress k in [0, 1] by the letter: it rises, from -0.459 to w_min = 0.4."""
    return w_max - (w_max - w_min) * exp(1 - k)  # (15), printed


def mutation_probability(fitness: Array, pm1: float = 0.1, pm2: float = 0.2) -> Array:
    """Return the chance (n,) of each particle to mutate, given its fitness (n,), +inf allowed.

    The average is over finite fitness only.  The first best never mutates, even where all are
    equal (0/0 by the upper branch, pm2 by the lower); with nothing finite there is no best.
    """
    p = np.full_like(fitness, pm2)
    best = fitness.argmin()
    if fitness[best] == np.inf:
        return p
    excess = fitness - fitness[best]
    finite = excess[excess < np.inf]
    average = (finite / finite.size).sum()  # f_avg - f_min, safe from overflow
    below = excess < average
    p[below] = pm1 * excess[below] / average  # (17)
    p[best] = 0.0
    return p


def mutate(task: Task, x: Array, *, printed: bool = False) -> Array:
    """Return a copy of x (m, dim) with one random gene of each row drawn anew.

    The text wants any value of the domain.  Eq. 16 as printed spans only from the lower bound to
    x itself, so that a mutant never moves up.  Which genes mutate is open: one, drawn uniformly.
    """
    mutants = x.copy()
    rows, genes = np.arange(len(x)), task.rng.integers(task.dim, size=len(x))
    lo = task.lo[genes]
    end = x[rows, genes] if printed else task.hi[genes]
    mutants[rows, genes] = lo + (end - lo) * task.rng.random(len(x))  # (16)
    return mutants
