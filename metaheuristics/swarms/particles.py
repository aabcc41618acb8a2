"""The particle swarm that all variants of PSO share: one step, the bests, and a schedule.

    v = w v + c1 r1 (p - x) + c2 r2 (g - x),   x = x + v

x, v, p are position, velocity and own best of each particle, g is the global best; r1 and r2 are uniform in
[0, 1) per coordinate.  The step is printed as Zhang 2025, eq. 3 and 2, and as Wang 2025, eq. 10 and 11.
What the papers leave open follows the conventions of the package (`metaheuristics`).

References
----------
Kennedy J., Eberhart R. (1995).  Particle swarm optimization.  Proc. ICNN'95, 1942-1948.  (Without w.)

Shi Y., Eberhart R. (1998).  A modified particle swarm optimizer.  Proc. ICEC'98, 69-73.  (With w.)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task

Factors: TypeAlias = Callable[[float], tuple[float, float, float]]
"""Progress k/K in [0, 1] -> inertia w, own factor c1, social factor c2."""

CLAMP = 0.2
"""Largest |v| as a share of hi - lo."""


class Swarm:
    """Positions ``x``, velocities ``v``, own bests ``p`` (n, dim each), and the global best ``g`` (dim,).

    Parameters
    ----------
    task : Task
        Box and random numbers.
    x : Array, shape (n, dim)
        Start; the velocities start at zero.
    """

    def __init__(self, task: Task, x: Array) -> None:
        self._task = task
        self._v_max = CLAMP * (task.hi - task.lo)
        self.x = x
        self.v = np.zeros_like(x)
        self.p = x.copy()
        self.p_fitness = np.full(len(x), np.inf)
        self.g = x[0].copy()
        self.g_fitness = np.inf

    def remember(self, fitness: Array) -> None:
        """Renew the bests; of equal ones the first that was found stays.

        Parameters
        ----------
        fitness : Array, shape (n,)
            Of the positions ``x``.
        """
        better = fitness < self.p_fitness
        np.copyto(self.p, self.x, where=better[:, None])
        np.copyto(self.p_fitness, fitness, where=better)
        i = fitness.argmin()
        if fitness[i] < self.g_fitness:
            self.g, self.g_fitness = self.x[i].copy(), float(fitness[i])

    def move(self, w: float, c1: float | Array, c2: float | Array) -> None:
        """Take one synchronous step.

        Parameters
        ----------
        w : float
            Inertia.
        c1, c2 : float or Array, shape (n, 1)
            Own and social factor, of all particles or of each.
        """
        r1, r2 = self._task.rng.random((2, *self.x.shape))
        v = w * self.v + c1 * r1 * (self.p - self.x) + c2 * r2 * (self.g - self.x)  # Wang 2025, eq. 10
        self.v = np.minimum(np.maximum(v, -self._v_max), self._v_max)
        self.x = self._task.clip(self.x + self.v)  # Wang 2025, eq. 11


def fly(task: Task, x: Array, factors: Factors) -> Moves:
    """Move a swarm until the budget is gone.

    Parameters
    ----------
    task : Task
        Box, random numbers, and progress.
    x : Array, shape (n, dim)
        Start, at rest.
    factors : Factors
        Inertia and factors as functions of the progress.

    Yields
    ------
    Array, shape (n, dim)
        The positions, once a step.
    """
    swarm = Swarm(task, x)
    while True:
        swarm.remember((yield swarm.x))
        swarm.move(*factors(task.progress))


def linear_inertia(k: float, w_max: float = 0.9, w_min: float = 0.4) -> float:
    """Return the inertia that falls linearly (Shi & Eberhart 1998).

    Parameters
    ----------
    k : float
        Progress in [0, 1].
    w_max, w_min : float
        Inertia at the start and at the end.

    Returns
    -------
    float
        Inertia w.
    """
    return w_max - (w_max - w_min) * k  # Zhang 2025, eq. 4; Li 2022, eq. 14


def excess_over_best(fitness: Array) -> tuple[Array, float]:
    """Return how much worse than the best each particle is, and the mean of that.

    These are f - f_min and f_avg - f_min of Wang 2025, eq. 17, and Zhang 2025, eq. 6.

    Parameters
    ----------
    fitness : Array, shape (n,)
        At least one is finite; +inf marks an infeasible particle.

    Returns
    -------
    excess : Array, shape (n,)
        Fitness above the best, +inf where infeasible.
    average : float
        Its mean over the feasible particles, which cannot overflow.
    """
    excess = fitness - fitness.min()
    finite = excess[excess < np.inf]
    return excess, float((finite / finite.size).sum())
