"""MPSO: PSO whose inertia and learning factors all fall linearly.

References
----------
Li X., Cui F., Guo Y., Zhang X., Rong B. (2022).  Trajectory optimization method of valve pocket bagging
robot.  Packaging Engineering 43(13), 180-188.  doi:10.19554/j.cnki.1001-3563.2022.13.023.
Section 3, eq. 14-16; 20 particles, 200 iterations.

Printed, and how it is read
---------------------------
eq. 12, 13  The step is lost in print.  The standard step is taken (`metaheuristics.swarms.particles`).
eq. 15, 16  The factors 0.05 to 0.02 hardly attract: on average a step adds to the velocity at most 0.025 of
            the distance to either best.  `mpso` has them as printed; the registry has them times ten under
            a name of its own.
"""

from __future__ import annotations

from metaheuristics.driver.task import Moves, Task
from metaheuristics.swarms.particles import fly, linear_inertia


def mpso(
    task: Task,
    *,
    population: int = 20,
    w_max: float = 0.9,
    w_min: float = 0.4,
    c_start: float = 0.05,
    c_end: float = 0.02,
) -> Moves:
    """Run MPSO; the defaults are as printed.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of particles.
    w_max, w_min : float
        Inertia at the start and at the end.
    c_start, c_end : float
        Both learning factors at the start and at the end.

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """

    def factors(k: float) -> tuple[float, float, float]:
        c = linear_factor(k, c_start, c_end)
        return linear_inertia(k, w_max, w_min), c, c  # Li 2022, eq. 14

    yield from fly(task, task.first(population), factors)


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
