"""The whale optimisation algorithm, and the moves that its variants share.

References
----------
Mirjalili S., Lewis A. (2016).  The whale optimization algorithm.  Advances in Engineering Software 95,
51-67.  doi:10.1016/j.advengsoft.2016.01.008.  Eq. 2.1-2.8.

Printed, and how it is read
---------------------------
A and C are written as vectors, but |A| < 1 is tested on the whale: both are one number per whale here, as are
p and l ~ U(-1, 1).  The random whale is drawn per whale, from the positions before the step, and may be
the whale itself.

The moves scale positions (C X*), so they depend on where x = 0 lies: the algorithm is not invariant under a
translation of the box.
"""

from __future__ import annotations

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task


def whale(task: Task, *, population: int = 50, b: float = 1.0) -> Moves:
    """Run the whale optimisation algorithm.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of whales.
    b : float
        Constant of the spiral (eq. 2.5).

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """
    x = task.first(population)
    leader = Leader(x)
    while True:
        leader.renew(x, (yield x))
        a = 2 * (1 - task.progress)
        r1, r2, p, r3 = task.rng.random((4, population, 1))
        other = x[task.rng.integers(population, size=population)]
        A = 2 * a * r1 - a  # eq. 2.3
        C = 2 * r2  # eq. 2.4
        l = 2 * r3 - 1  # noqa: E741 (the paper's letter)
        near = np.where(np.abs(A) < 1, leader.x, other)
        encircled = encircle(near, near, A, C, x)  # eq. 2.1, 2.2; 2.7, 2.8
        spiral = spiral_around(leader.x, leader.x, l, b, x)  # eq. 2.5
        x = task.clip(np.where(p < 0.5, encircled, spiral))  # eq. 2.6


class Leader:
    """The best point so far, X*.

    Parameters
    ----------
    x : Array, shape (n, dim)
        The first population.  Its first row leads until something feasible is found.
    """

    def __init__(self, x: Array) -> None:
        self.x = x[0].copy()
        self._fitness = np.inf

    def renew(self, x: Array, fitness: Array) -> None:
        """Take over what is better.

        Parameters
        ----------
        x : Array, shape (n, dim)
            Points.
        fitness : Array, shape (n,)
            Their fitness.
        """
        i = fitness.argmin()
        if fitness[i] < self._fitness:
            self.x, self._fitness = x[i].copy(), float(fitness[i])


def encircle(centre: Array, leader: Array, A: Array, C: Array, x: Array) -> Array:
    """Return the move around a leader, Mirjalili & Lewis 2016, eq. 2.1 and 2.2.

    Parameters
    ----------
    centre : Array, shape (dim,) or (n, dim)
        What the move ends near: the leader itself, or the leader scaled.
    leader : Array, shape (dim,) or (n, dim)
        The point that the distance is measured from.
    A, C : Array, shape (n, 1)
        Coefficients of each whale.
    x : Array, shape (n, dim)
        Positions.

    Returns
    -------
    Array, shape (n, dim)
        Positions after the move.
    """
    return np.asarray(centre - A * np.abs(C * leader - x))


def spiral_around(centre: Array, leader: Array, l: Array, b: float, x: Array) -> Array:  # noqa: E741
    """Return the spiral move, Mirjalili & Lewis 2016, eq. 2.5.

    Parameters
    ----------
    centre : Array, shape (dim,)
        What the spiral runs around: the leader itself, or the leader scaled.
    leader : Array, shape (dim,)
        The point that the distance is measured from.
    l : Array, shape (n, 1)
        Place on the spiral in [-1, 1].
    b : float
        Constant of the spiral.
    x : Array, shape (n, dim)
        Positions.

    Returns
    -------
    Array, shape (n, dim)
        Positions after the move.
    """
    return np.asarray(np.abs(leader - x) * np.exp(b * l) * np.cos(2 * np.pi * l) + centre)
