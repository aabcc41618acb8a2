"""The whale optimisation algorithm of Lu 2024: an inertia weight on the leader, and a chaotic start.

References
----------
Lu Z., Wang X. (2024).  Mechanical arm trajectory planning based on B-spline and whale optimization algorithm.
Journal of Northeastern University (Natural Science) 45(5), 683-689.  Section 2, eq. 14-23; 30 whales, 500
iterations.

Printed, and how it is read
---------------------------
The default agrees with the text, whose step 3 in section 3.2 lets A choose the move as in Mirjalili & Lewis
2016; ``printed`` follows these equations literally:

eq. 16      One random number r for both A and C.
eq. 19, 21  The test |A| < 1 is left out.
eq. 23      The tent map has its peak at 0.5, where its orbit ends in 0 (``lam``; 0.499 by default).

Open: s of eq. 22 (1; the larger, the sooner the weight falls), and b of the spiral (1, as in 2016).  A, C,
lambda and g are one number per whale, as in `metaheuristics.swarms.whale`.

The weight falls from 1 to 0, so that the leader w X* ends in x = 0.  Where the optimum is elsewhere, the last
steps of the search are lost.
"""

from __future__ import annotations

import numpy as np

from metaheuristics.driver.task import Moves, Task
from metaheuristics.swarms.tent import tent_population
from metaheuristics.swarms.whale import Leader, encircle, spiral_around


def whale_lu_2024(
    task: Task,
    *,
    population: int = 30,
    s: float = 1.0,
    b: float = 1.0,
    lam: float = 0.499,
    printed: bool = False,
) -> Moves:
    """Run the whales of Lu 2024.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of whales.
    s : float
        Constant of the inertia weight (eq. 22), above -1.
    b : float
        Constant of the spiral (eq. 18).
    lam : float
        Place of the tent map's peak in (0, 1).
    printed : bool
        One r for A and C, and no test of |A|.

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """
    x = tent_population(task, population, lam)  # Lu 2024, eq. 23
    leader = Leader(x)
    while True:
        leader.renew(x, (yield x))
        k = task.progress
        centre = inertia(k, s) * leader.x
        delta = 2 * (1 - k)
        r1, r2, choice, r3 = task.rng.random((4, population, 1))
        other = x[task.rng.integers(population, size=population)]
        A = 2 * delta * r1 - delta  # Lu 2024, eq. 16
        C = 2 * (r1 if printed else r2)  # Lu 2024, eq. 16; printed with one r
        g = 2 * r3 - 1
        near = True if printed else np.abs(A) < 1  # Lu 2024, eq. 19, 21 leave the test out
        encircled = encircle(centre, leader.x, A, C, x)  # Lu 2024, eq. 14, 21
        searched = encircle(other, other, A, C, x)  # Lu 2024, eq. 20
        spiral = spiral_around(centre, leader.x, g, b, x)  # Lu 2024, eq. 18, 21
        x = task.clip(np.where(choice < 0.5, np.where(near, encircled, searched), spiral))


def inertia(k: float, s: float = 1.0) -> float:
    """Return the inertia weight of Lu 2024, eq. 22.

    Parameters
    ----------
    k : float
        Progress in [0, 1].
    s : float
        Its constant, above -1.

    Returns
    -------
    float
        The weight, from 1 to 0.
    """
    return (1 - k) / (1 + s * k)  # Lu 2024, eq. 22
