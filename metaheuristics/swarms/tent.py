"""A start along the chaotic orbit of the tent map, shared by Wang 2025 and Lu 2024.

Open, and read so: the papers do not say what their sequence runs over.  Here it runs over the particles,
from a random state per coordinate.

Both papers allow the peak 0.5 (Lu 2024 prints it), at which the map loses one bit of a double each time:
the orbit ends in 0 after some 50 steps.  The default is 0.499, the value of Wang 2025, Table 7.
"""

from __future__ import annotations

import numpy as np

from metaheuristics.driver.task import Array, Task


def tent_map(z: Array, lam: float = 0.499) -> Array:
    """Return the tent map, elementwise.

    Parameters
    ----------
    z : Array, any shape
        States in [0, 1].
    lam : float
        Place of the peak in (0, 1).

    Returns
    -------
    Array, shape of z
        The next states.
    """
    return np.where(z < lam, z / lam, (1 - z) / (1 - lam))  # Wang 2025, eq. 12; Lu 2024, eq. 23


def tent_population(task: Task, n: int, lam: float = 0.499) -> Array:
    """Return points of the box along one orbit of the tent map per coordinate.

    Parameters
    ----------
    task : Task
        Box and random numbers.
    n : int
        Number of points.
    lam : float
        Place of the map's peak in (0, 1).

    Returns
    -------
    Array, shape (n, dim)
        A first population.
    """
    z = np.empty((n, task.dim))
    state = task.rng.random(task.dim)
    for row in z:
        row[:] = state = tent_map(state, lam)
    # Wang 2025, eq. 13; z = 1 may round past hi
    return task.started(task.clip(task.lo + z * (task.hi - task.lo)))
