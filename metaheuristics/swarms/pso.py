"""PSO with three published settings of its constants.

References
----------
`pso`: Clerc M., Kennedy J. (2002).  The particle swarm: explosion, stability, and convergence in a
multidimensional complex space.  IEEE Trans. Evolutionary Computation 6(1), 58-73.  With phi = 4.1 their
constriction equals w = 0.7298, c1 = c2 = 1.49618.

`pso_linear`: Shi Y., Eberhart R. (1998), printed as Zhang 2025, eq. 3-4, and Li 2022, eq. 14.

`pso_1995`: Kennedy J., Eberhart R. (1995), printed as Zhang 2025, eq. 1-2.

Step, bests and references in full: `metaheuristics.swarms.particles`.
"""

from __future__ import annotations

from metaheuristics.driver.task import Moves, Task
from metaheuristics.swarms.particles import fly, linear_inertia


def pso(
    task: Task,
    *,
    population: int = 50,
    w: float = 0.7298,
    c1: float = 1.49618,
    c2: float = 1.49618,
) -> Moves:
    """Run PSO with constant factors.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of particles.
    w, c1, c2 : float
        Inertia, own factor, social factor.

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """
    yield from fly(task, task.first(population), lambda k: (w, c1, c2))


def pso_linear(
    task: Task,
    *,
    population: int = 50,
    w_max: float = 0.9,
    w_min: float = 0.4,
    c1: float = 2.0,
    c2: float = 2.0,
) -> Moves:
    """Run PSO with linearly decreasing inertia.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of particles.
    w_max, w_min : float
        Inertia at the start and at the end.
    c1, c2 : float
        Own factor, social factor.

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """
    x = task.first(population)
    yield from fly(task, x, lambda k: (linear_inertia(k, w_max, w_min), c1, c2))  # Zhang 2025, eq. 3-4


def pso_1995(task: Task, *, population: int = 50, c1: float = 2.0, c2: float = 2.0) -> Moves:
    """Run PSO without an inertia weight: the clamp alone keeps the velocities from diverging.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of particles.
    c1, c2 : float
        Own factor, social factor.

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """
    yield from fly(task, task.first(population), lambda k: (1.0, c1, c2))  # Zhang 2025, eq. 1-2
