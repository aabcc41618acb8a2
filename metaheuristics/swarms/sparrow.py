"""The sparrow search algorithm ("SSA" also names the salp swarm, so it is sparrow here).

References
----------
Xue J., Shen B. (2020).  A novel swarm intelligence optimization approach: sparrow search algorithm.  Systems
Science & Control Engineering 8(1), 22-34.  Eq. 3-5.

Zhou Y. (2025).  Trajectory optimization of manipulator based on improved sparrow algorithm.  Hans
Publishers.  Section 4.1 prints them as eq. 8-11.

Printed, and how it is read
---------------------------
`sparrow` follows Xue & Shen 2020; `sparrow_printed` follows Zhou 2025, eq. 8 and 10, literally:

eq. 8   i is called the generation; it is the rank by fitness.
eq. 8   R is called a fitness; it is the alarm value R2 ~ U(0, 1).  The standard M that Zhou 2025 compares the
        fitness with is open: the median of the flock.
eq. 9   L is a row of ones.
eq. 10  A+ is called a random number; it is the pseudo-inverse A^T (A A^T)^-1.

A generation is three batches, all evaluated: producers, then scroungers around the best producer as it now
is, then scouts from where they now are.  A sparrow keeps what is better.  The moves of producers scale x
itself, so that the flock is drawn towards x = 0.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from metaheuristics.driver.task import Array, Moves, Task

Rows: TypeAlias = NDArray[np.intp]
Drawn: TypeAlias = Callable[[], Array]
"""Moves (m, dim) whose random numbers are drawn already; the call computes them, if anybody wants them."""
Combine: TypeAlias = Callable[[Rows, Drawn], Array]
"""(rows, sparrow moves) -> what is done instead (m, dim); neither is in the box yet."""

EPSILON = 1e-50
"""Keeps the divisor of Xue & Shen 2020, eq. 5, above zero."""
LARGEST = 700.0
"""Largest exponent: exp of more would overflow."""


class Flock:
    """Positions ``x`` (n, dim) and their ``fitness`` (n,), +inf until evaluated.

    Parameters
    ----------
    x : Array, shape (n, dim)
        Start.
    """

    def __init__(self, x: Array) -> None:
        self.x = x
        self.fitness = np.full(len(x), np.inf)

    def rank(self) -> None:
        """Sort, best first."""
        order = self.fitness.argsort(kind="stable")
        self.x, self.fitness = self.x.take(order, axis=0), self.fitness.take(order)

    def keep(self, rows: Rows, moved: Array, fitness: Array) -> None:
        """Take over the moves that are better.

        Parameters
        ----------
        rows : Rows, shape (m,)
            The sparrows that moved.
        moved : Array, shape (m, dim)
            Where to.
        fitness : Array, shape (m,)
            Fitness there.
        """
        better = (fitness < self.fitness.take(rows)).nonzero()[0]
        if len(better):
            taken = rows.take(better)
            self.x[taken], self.fitness[taken] = moved.take(better, axis=0), fitness.take(better)


def sparrow(
    task: Task,
    *,
    population: int = 50,
    producers: float = 0.2,
    scouts: float = 0.1,
    safety: float = 0.8,
) -> Moves:
    """Run the sparrow search.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of sparrows.
    producers, scouts : float
        Shares of the flock.
    safety : float
        Safety threshold ST.

    Yields
    ------
    Array, shape (m, dim)
        Points to be evaluated.
    """
    flock = Flock(task.first(population))
    yield from forage(task, flock, producers, scouts, safety)


def sparrow_printed(
    task: Task, *, population: int = 50, producers: float = 0.2, scouts: float = 0.1
) -> Moves:
    """Run the sparrow search with Zhou 2025, eq. 8 and 10, as printed.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of sparrows.
    producers, scouts : float
        Shares of the flock.

    Yields
    ------
    Array, shape (m, dim)
        Points to be evaluated.
    """
    flock = Flock(task.first(population))
    yield from forage(task, flock, producers, scouts, safety=None)


def forage(
    task: Task,
    flock: Flock,
    producers: float,
    scouts: float,
    safety: float | None,
    combine: Combine = lambda rows, moves: moves(),
    after: Callable[[], None] = lambda: None,
) -> Moves:
    """Move a flock until the budget is gone.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    flock : Flock
        The flock at its start.
    producers, scouts : float
        Shares of the flock.
    safety : float or None
        Safety threshold ST; None for Zhou 2025, eq. 8 and 10, as printed.
    combine : Combine
        Puts another move in place of the sparrow moves.
    after : Callable[[], None]
        Called after the first evaluation, and after each generation.

    Yields
    ------
    Array, shape (m, dim)
        Points to be evaluated.
    """
    n = len(flock.x)
    n_producers, n_scouts = max(1, round(producers * n)), max(1, round(scouts * n))
    generations = max(1.0, (task.budget - n) / (n + n_scouts))
    flock.fitness[:] = yield flock.x
    after()
    t = 0
    while True:
        t += 1
        flock.rank()
        every = np.arange(n)
        if safety is None:
            moves = _produced_printed(task, flock, every[:n_producers], t / generations)
        else:
            moves = _produced(task, flock, every[:n_producers], generations, safety)
        yield from _batch(task, flock, every[:n_producers], moves, combine)
        if n > n_producers:
            rows = every[n_producers:]
            moves = _scrounged(task, flock, n_producers, printed=safety is None)
            yield from _batch(task, flock, rows, moves, combine)
        rows = task.rng.permutation(n)[:n_scouts]
        yield from _batch(task, flock, rows, _scouted(task, flock, rows), combine)
        after()


def _batch(task: Task, flock: Flock, rows: Rows, moves: Drawn, combine: Combine) -> Moves:
    moved = task.clip(combine(rows, moves))
    flock.keep(rows, moved, (yield moved))


def _produced(task: Task, flock: Flock, rows: Rows, generations: float, safety: float) -> Drawn:
    """Moves of producers; alpha and Q are one number per sparrow, R2 one per generation."""
    x = flock.x.take(rows, axis=0)
    if task.rng.random() < safety:
        alpha = 1 - task.rng.random((len(rows), 1))  # in (0, 1]
        # eq. 3; Zhou 2025, eq. 8
        return lambda: np.asarray(x * np.exp(-(rows[:, None] + 1) / (alpha * generations)))
    Q = task.rng.standard_normal((len(rows), 1))
    return lambda: np.asarray(x + Q)  # eq. 3, L is a row of ones; Zhou 2025, eq. 9


def _produced_printed(task: Task, flock: Flock, rows: Rows, t: float) -> Drawn:
    """Moves of producers as printed: t = generation / generations for i / iter_max, R the fitness."""
    x, R = flock.x.take(rows, axis=0), flock.fitness.take(rows)[:, None]
    alpha = 1 - task.rng.random((len(rows), 1))
    Q = task.rng.standard_normal((len(rows), 1))

    def moves() -> Array:
        exponent = -t * np.where(np.isfinite(R), R, 0.0) / alpha
        shrunk = x * np.exp(np.minimum(exponent, LARGEST))  # Zhou 2025, eq. 8
        return np.where(np.median(flock.fitness) > R, shrunk, x + Q)  # Zhou 2025, eq. 9

    return moves


def _scrounged(task: Task, flock: Flock, n_producers: int, *, printed: bool) -> Drawn:
    """Moves of scroungers, who follow the producers, around the best of these; Q: one per sparrow."""
    n, dim = flock.x.shape
    x = flock.x[n_producers:]
    Q = task.rng.standard_normal((len(x), 1))
    r = task.rng.random(x.shape) if printed else 2.0 * task.rng.integers(2, size=x.shape) - 1

    def moves() -> Array:
        best = flock.x[flock.fitness[:n_producers].argmin()]
        worst = flock.x[flock.fitness.argmax()]
        if printed:
            near = best + np.abs(x - best) * r  # Zhou 2025, eq. 10, printed
        else:
            # A = r; A+ = A^T (A A^T)^-1 = A^T / dim: one number for all coordinates
            near = best + np.add.reduce(np.abs(x - best) * r, axis=1, keepdims=True) / dim  # eq. 4
        rank = np.arange(n_producers + 1.0, n + 1.0)[:, None]
        with np.errstate(over="ignore"):
            hungry = Q * np.exp((worst - x) / rank**2)  # eq. 4; Zhou 2025, eq. 10
        first = max(n // 2 - n_producers, 0)  # of the ranks above n / 2
        near[first:] = hungry[first:]
        return np.asarray(near)

    return moves


def _scouted(task: Task, flock: Flock, rows: Rows) -> Drawn:
    """Moves of scouts; K is one number per sparrow, beta one per coordinate."""
    beta = task.rng.standard_normal((len(rows), task.dim))
    K = 2 * task.rng.random((len(rows), 1)) - 1

    def moves() -> Array:
        x, fitness = flock.x.take(rows, axis=0), flock.fitness.take(rows)[:, None]
        best, worst = flock.fitness.argmin(), flock.fitness.argmax()
        to_best = flock.x[best] + beta * np.abs(x - flock.x[best])  # eq. 5; Zhou 2025, eq. 11
        worse = fitness > flock.fitness[best]
        if np.count_nonzero(worse) == len(rows):  # nobody needs the other move
            return np.asarray(to_best)
        f_worst = flock.fitness[worst]
        gap = np.subtract(fitness, f_worst, out=np.zeros_like(fitness), where=fitness < f_worst)
        with np.errstate(over="ignore"):
            # eq. 5; Zhou 2025, eq. 11
            away = x + K * (np.abs(x - flock.x[worst]) / (gap + EPSILON))
        return np.asarray(np.where(worse, to_best, away))

    return moves
