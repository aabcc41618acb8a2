"""MPSO: PSO whose inertia and learning factors all fall linearly.

References
----------
Li X., Cui F., Guo Y., Zhang X., Rong B. (2022).  Trajectory optimization method of valve pocket bagging
robot.  Packaging Engineering 43(13), 180-188.  doi:10.19554/j.cnki.1001-3563.2022.13.023.
Section 3, eq. 14-16; 20 particles, 200 iterations.

van den Bergh F., Engelbrecht A. P. (2004).  A cooperative approach to particle swarm optimization.  IEEE
Trans. Evolutionary Computation 8(3), 225-239.  (CPSO-S: a swarm per coordinate.)

Printed, and how it is read
---------------------------
step 1      Each of the six durations has a population of its own, "six populations", but step 4 takes the i-th
            particles of all six as one vector, which has one fitness: six populations of numbers that share
            their bests are one population of vectors, which is the default.  ``split`` is the other reading:
            each population has bests of its own, and its particles are judged beside the best durations of the
            others, as in CPSO-S.
eq. 12, 13  The step is lost in print.  The standard step is taken (`metaheuristics.swarms.particles`).
eq. 15, 16  The factors 0.05 to 0.02 hardly attract: on average a step adds to the velocity at most 0.025 of
            the distance to either best.  `mpso` has them as printed; the registry has them times ten under
            a name of its own.
"""

from __future__ import annotations

from dataclasses import replace

from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.swarms.particles import Factors, Swarm, fly, linear_inertia


def mpso(
    task: Task,
    *,
    population: int = 20,
    w_max: float = 0.9,
    w_min: float = 0.4,
    c_start: float = 0.05,
    c_end: float = 0.02,
    split: bool = False,
) -> Moves:
    """Run MPSO; the defaults are as printed.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of particles, in each population if they are split.
    w_max, w_min : float
        Inertia at the start and at the end.
    c_start, c_end : float
        Both learning factors at the start and at the end.
    split : bool
        Give each coordinate a population of its own (section 3, step 1).

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """

    def factors(k: float) -> tuple[float, float, float]:
        c = linear_factor(k, c_start, c_end)
        return linear_inertia(k, w_max, w_min), c, c  # Li 2022, eq. 14

    x = task.first(population)
    yield from (apart if split else fly)(task, x, factors)


def apart(task: Task, x: Array, factors: Factors) -> Moves:
    """Move a population per coordinate, one after the other, until the budget is gone.

    Parameters
    ----------
    task : Task
        Box, random numbers, and progress.
    x : Array, shape (n, dim)
        Start; column d is the population of coordinate d.
    factors : Factors
        Inertia and factors as functions of the progress.

    Yields
    ------
    Array, shape (n, dim)
        The start; then the best vector so far, n times, with the positions of one population in its column.
    """
    fitness = yield x
    swarms = [Swarm(_column(task, d), x[:, d : d + 1]) for d in range(task.dim)]
    for swarm in swarms:
        swarm.remember(fitness)
    best, least = x[fitness.argmin()].copy(), float(fitness.min())
    while True:
        for d, swarm in enumerate(swarms):
            swarm.move(*factors(task.progress))
            rows = best[None].repeat(len(x), axis=0)
            rows[:, d] = swarm.x[:, 0]
            swarm.g_fitness = least  # of its best beside the bests of the others, as these are now
            swarm.remember((yield rows))
            best[d], least = swarm.g[0], swarm.g_fitness


def _column(task: Task, d: int) -> Task:
    """The same task on one coordinate of its box."""
    return replace(task, lo=task.lo[d : d + 1], hi=task.hi[d : d + 1])


def linear_factor(k: float, start: float = 0.05, end: float = 0.02) -> float:
    """Return c1 = c2 of Li 2022, eq. 15 and 16.

    Parameters
    ----------
    k : float
        Progress in [0, 1].
    start, end : float
        Factor at the start and at the end.

    Returns
    -------
    float
        The factor.
    """
    return start + (end - start) * k  # Li 2022, eq. 15, 16
