"""MPSO: PSO whose inertia and learning factors all fall linearly.

Source: seed paper 001 (Li, Cui, Guo, Zhang, Rong 2022, DOI 10.19554/j.cnki.1001-3563.2022.13.023),
section 3, eq. 14-16; 20 particles, 200 iterations.  Its eq. 12-13, the step, are lost in print: the
standard step is taken (`metaheuristics.swarms.pso`).

The printed factors, 0.05 falling to 0.02, hardly pull: on average a step adds to the velocity at most
0.025 of the distance to either best.  The factors times ten, 0.5 falling to 0.2, stand beside them
under a name of their own.
"""

from __future__ import annotations

from metaheuristics.driver.task import Moves, Task
from metaheuristics.swarms.pso import fly, linear_inertia


def mpso(
    task: Task,
    *,
    population: int = 20,
    w_max: float = 0.9,
    w_min: float = 0.4,
    c_start: float = 0.05,
    c_end: float = 0.02,
) -> Moves:
    """MPSO; the defaults are as printed."""

    def factors(k: float) -> tuple[float, float, float]:
        c = linear_factor(k, c_start, c_end)
        return linear_inertia(k, w_max, w_min), c, c

    yield from fly(task, task.sample(population), factors)


def linear_factor(k: float, start: float = 0.05, end: float = 0.02) -> float:
    """Return c1 = c2 at progress k in [0, 1]."""
    return start + (end - start) * k  # (15), (16)
