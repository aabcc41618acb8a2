"""Particle swarm optimisation with a global best, and three published settings of its constants.

    v = w v + c1 r1 (p - x) + c2 r2 (g - x),   x = x + v

Sources: Kennedy & Eberhart 1995 (the form without w); Shi & Eberhart 1998 (inertia); Clerc &
Kennedy 2002 (constants equal to constriction); as printed in seed paper 004, eq. 1-4, and seed
paper 001, eq. 14.  Conventions the papers leave open are those of the package (`metaheuristics`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task

Factors: TypeAlias = Callable[[float], tuple[float, float, float]]
"""Progress k/K in [0, 1] -> (w, c1, c2)."""

CLAMP = 0.2  # largest |v|, as a share of hi - lo


class Swarm:
    """Positions x, velocities v, own bests p (n, dim each) and the global best g (dim,)."""

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
        """Keep in p and g what is better at x, given its fitness (n,); the first found stays."""
        better = fitness < self.p_fitness
        np.copyto(self.p, self.x, where=better[:, None])
        np.copyto(self.p_fitness, fitness, where=better)
        i = fitness.argmin()
        if fitness[i] < self.g_fitness:
            self.g, self.g_fitness = self.x[i].copy(), float(fitness[i])

    def move(self, w: float, c1: float | Array, c2: float | Array) -> None:
        """Take one synchronous step with inertia w, own factor c1 and social factor c2.

        The factors are numbers, or one for each particle (n, 1).
        """
        r1, r2 = self._task.rng.random((2, *self.x.shape))
        v = w * self.v + c1 * r1 * (self.p - self.x) + c2 * r2 * (self.g - self.x)  # 004 (1), (3)
        self.v = np.minimum(np.maximum(v, -self._v_max), self._v_max)
        self.x = self._task.clip(self.x + self.v)  # 004 (2)


def fly(task: Task, x: Array, factors: Factors) -> Moves:
    """Fly a swarm from x (n, dim) at rest, with factors that follow the progress."""
    swarm = Swarm(task, x)
    while True:
        swarm.remember((yield swarm.x))
        swarm.move(*factors(task.progress))


def pso(
    task: Task,
    *,
    population: int = 50,
    w: float = 0.7298,
    c1: float = 1.49618,
    c2: float = 1.49618,
) -> Moves:
    """Constant factors; the defaults are constriction's (Clerc & Kennedy 2002, phi = 4.1)."""
    yield from fly(task, task.sample(population), lambda k: (w, c1, c2))


def pso_linear(
    task: Task,
    *,
    population: int = 50,
    w_max: float = 0.9,
    w_min: float = 0.4,
    c1: float = 2.0,
    c2: float = 2.0,
) -> Moves:
    """Linearly decreasing inertia (004 eq. 3-4, 001 eq. 14)."""
    x = task.sample(population)
    yield from fly(task, x, lambda k: (linear_inertia(k, w_max, w_min), c1, c2))


def pso_1995(task: Task, *, population: int = 50, c1: float = 2.0, c2: float = 2.0) -> Moves:
    """No inertia weight (004 eq. 1-2); only the velocity clamp keeps it from diverging."""
    yield from fly(task, task.sample(population), lambda k: (1.0, c1, c2))


def linear_inertia(k: float, w_max: float = 0.9, w_min: float = 0.4) -> float:
    """Return w at progress k in [0, 1]."""
    return w_max - (w_max - w_min) * k  # 004 (4), 001 (14)
