"""ISSA: sparrow and butterfly moves, weighted by how fast the best fitness falls.

References
----------
Zhou Y. (2025).  Trajectory optimization of manipulator based on improved sparrow algorithm.  Hans
Publishers.  Section 4.2, eq. 12-15; 1000 sparrows, 50 iterations.

Printed, and how it is read
---------------------------
Eq. 8-11 are those of `metaheuristics.swarms.sparrow`.  These are open:

step 1      Sparrows and butterflies are both started, but eq. 8-15 and steps 2 to 7 have one population.  By
            default there is one flock, whose individuals make both kinds of moves.  With ``two_groups`` there
            are two of one size: see `Groups`.
eq. 13      The window of the mean change: 5 generations.
eq. 14      The threshold is printed as a difference of fitness, without a value: here a share of the best
            fitness, 1e-3.
eq. 15      How the weights enter.  By default each individual makes the sparrow's move with the weight as
            probability, else the butterfly's; ``blended`` adds both steps, weighted.

The sensory modality of the butterflies grows once a generation.
"""

from __future__ import annotations

from collections import deque
from math import inf, isfinite

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.swarms.butterfly import fluttered, fragrance, grown
from metaheuristics.swarms.sparrow import Drawn, Flock, Rows, forage


def issa(
    task: Task,
    *,
    population: int = 50,
    producers: float = 0.2,
    scouts: float = 0.1,
    safety: float = 0.8,
    p: float = 0.8,
    c: float = 0.01,
    a: float = 0.1,
    window: int = 5,
    threshold: float = 1e-3,
    blended: bool = False,
    two_groups: bool = False,
) -> Moves:
    """Run ISSA.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Number of individuals, in each group if there are two.
    producers, scouts : float
        Shares of the flock.
    safety : float
        Safety threshold ST of the sparrows.
    p, c, a : float
        Constants of the butterflies: `metaheuristics.swarms.butterfly.butterfly`.
    window : int
        Generations in the mean change (eq. 13).
    threshold : float
        Change, as a share of the best fitness, from which all moves are sparrow moves (eq. 14).
    blended : bool
        Add both steps, weighted, in place of a choice between them.
    two_groups : bool
        Keep sparrows and butterflies apart (section 4.2, step 1).  Cannot be blended.

    Yields
    ------
    Array, shape (m, dim)
        Points to be evaluated.

    Raises
    ------
    ValueError
        Two groups were to be blended.
    """
    if blended and two_groups:
        raise ValueError("blended=True needs one flock, got two_groups=True")
    flock = Flock(task.first(population))
    if two_groups:
        flock.fitness[:] = yield flock.x
        flock = Groups(task.sample(population), flock)
    blend = Blend(task, flock, scouts, (p, c, a), window, threshold)
    combine = blend.blended if blended else blend.chosen
    yield from forage(task, flock, producers, scouts, safety, combine, blend.weigh)


class Groups(Flock):
    """Sparrows, each with a butterfly that may move in its place; both groups know the best of both.

    A move that is chosen to be a butterfly's is made, and kept if it is better, by the butterfly of the same
    row, so that a generation of two groups takes as many evaluations as one of a single flock.

    Parameters
    ----------
    x : Array, shape (n, dim)
        Start of the sparrows.
    butterflies : Flock
        The other group, n too, evaluated.
    """

    def __init__(self, x: Array, butterflies: Flock) -> None:
        super().__init__(x)
        self.butterflies = butterflies
        self.sparrows_move = np.ones(0, dtype=bool)  # (m,): of the moves that are kept next

    def keep(self, rows: Rows, moved: Array, fitness: Array) -> None:
        """Take over the moves that are better, each in its group."""
        walked = self.sparrows_move
        super().keep(rows[walked], moved[walked], fitness[walked])
        self.butterflies.keep(rows[~walked], moved[~walked], fitness[~walked])

    def exchange(self) -> None:
        """Put the better best of both groups in place of the worst of the other one (step 7)."""
        for one, other in ((self, self.butterflies), (self.butterflies, self)):
            best, worst = one.fitness.argmin(), other.fitness.argmax()
            if one.fitness[best] < other.fitness.min():
                other.x[worst], other.fitness[worst] = one.x[best], one.fitness[best]


class Blend:
    """The weight of the sparrow move, and the butterfly move beside it.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    flock : Flock
        The flock, which `metaheuristics.swarms.sparrow.forage` moves.
    scouts : float
        Share of scouts in the flock.
    butterfly : tuple[float, float, float]
        Constants p, c, a of the butterflies.
    window : int
        Generations in the mean change (eq. 13).
    threshold : float
        Threshold as a share of the best fitness (eq. 14).
    """

    def __init__(
        self,
        task: Task,
        flock: Flock,
        scouts: float,
        butterfly: tuple[float, float, float],
        window: int,
        threshold: float,
    ) -> None:
        self.flock = flock
        self.weight = 0.5  # section 4.2, step 1
        self._task = task
        self._p, self._c, self._a = butterfly
        n = len(flock.x)
        self._generations = max(1.0, (task.budget - n) / (n + max(1, round(scouts * n))))
        self._changes = deque([0.0] * window, maxlen=window)
        self._threshold = threshold
        self._best: float | None = None

    def weigh(self) -> None:
        """Renew the weight after a generation; the first call, after the start, keeps 0.5."""
        if isinstance(self.flock, Groups):
            self.flock.exchange()
        fitness = self.flock.fitness
        before, best = self._best, float(fitness[fitness.argmin()])
        self._best = best
        if before is None:
            return
        self._changes.append(abs(best - before) if isfinite(before) else inf)  # Zhou 2025, eq. 12
        self.weight = weight(list(self._changes), self._threshold * abs(best))
        self._c = grown(self._c, self._generations)

    def chosen(self, rows: Rows, moves: Drawn) -> Array:
        """Choose the sparrow move with probability ``weight``, else the butterfly move.

        Parameters
        ----------
        rows : Rows, shape (m,)
            The individuals that move.
        moves : Drawn
            Their sparrow moves, (m, dim).

        Returns
        -------
        Array, shape (m, dim)
            What they do, not yet in the box.
        """
        sparrows = self._task.rng.random((len(rows), 1)) < self.weight
        if isinstance(self.flock, Groups):
            self.flock.sparrows_move = sparrows[:, 0]
        chosen = self._butterflies(rows)
        if np.count_nonzero(sparrows):
            np.copyto(chosen, moves(), where=sparrows)
        return chosen

    def blended(self, rows: Rows, moves: Drawn) -> Array:
        """Add both steps, weighted.

        Parameters
        ----------
        rows : Rows, shape (m,)
            The individuals that move.
        moves : Drawn
            Their sparrow moves, (m, dim).

        Returns
        -------
        Array, shape (m, dim)
            What they do, not yet in the box.
        """
        w = self.weight
        sparrows, butterflies = self._task.clip(moves()), self._task.clip(self._butterflies(rows))
        return w * sparrows + (1 - w) * butterflies  # Zhou 2025, eq. 15

    def _butterflies(self, rows: Rows) -> Array:
        flock = self.flock.butterflies if isinstance(self.flock, Groups) else self.flock
        smell = fragrance(flock.fitness, self._c, self._a).take(rows)
        return fluttered(self._task, flock.x, rows, int(flock.fitness.argmin()), smell, self._p)


def weight(changes: list[float], threshold: float) -> float:
    """Return the weight of the sparrow move, Zhou 2025, eq. 13 and 14.

    Parameters
    ----------
    changes : list[float]
        Change of the best fitness in each generation of the window; inf if nothing was feasible before.
    threshold : float
        Mean change from which the weight is 1.

    Returns
    -------
    float
        The mean change over the threshold, at most 1.
    """
    smooth = sum(changes) / len(changes)  # Zhou 2025, eq. 13
    if smooth >= threshold:
        return 1.0 if smooth > 0 else 0.0
    return smooth / threshold  # Zhou 2025, eq. 14
