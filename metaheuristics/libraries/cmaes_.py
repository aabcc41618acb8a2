"""CMA-ES with restarts and growing populations (IPOP), by the library cmaes.

It works on the unit box, from a uniform mean, with the default population; each restart doubles it.

References
----------
Hansen N. (2016).  The CMA evolution strategy: a tutorial.  arXiv:1604.00772.

Auger A., Hansen N. (2005).  A restart CMA evolution strategy with increasing population size.  Proc. CEC 2005.
"""

from __future__ import annotations

import numpy as np

from metaheuristics.driver.task import Moves, Task
from metaheuristics.libraries.shared import finite, seed_of


def cma_es(task: Task, *, sigma: float = 0.3) -> Moves:
    """Run CMA-ES, restarted until the budget is spent.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    sigma : float
        Initial step size on the unit box.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    import cmaes  # here: it loads scipy.stats, which takes longer than the rest of this package

    cells = max(task.dim, 2)  # the library wants two; a second one is not used
    size: int | None = None
    while True:
        search = cmaes.CMA(
            mean=task.rng.random(cells),
            sigma=sigma,
            bounds=np.tile([0.0, 1.0], (cells, 1)),
            seed=seed_of(task),
            population_size=size,
        )
        while not search.should_stop():
            z = np.array([search.ask() for _ in range(search.population_size)])
            fitness = yield task.clip(task.lo + (task.hi - task.lo) * z[:, : task.dim])
            search.tell(list(zip(z, finite(fitness).tolist(), strict=True)))
        size = 2 * search.population_size
