"""ISSA: sparrows and butterflies in one flock, weighted by how fast the best still falls.

Source: seed paper 002 (Zhou 2025, UR5), section 4.2, eq. 12-15; 1000 sparrows, 50 iterations.

Open, and taken so: how the weights enter (each individual makes the sparrow's move with the weight as
probability, else a butterfly's; or, `blended`, the weighted sum of both steps); the
window of eq. 13 (5 generations) and the threshold of eq. 14, which is printed as a fitness difference
without a value: here a share of the best fitness, 1e-3.  The sensory modality of the butterflies grows
once a generation.
"""

from __future__ import annotations

from collections import deque
from math import inf, isfinite

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.swarms.butterfly import fluttered, fragrance, grown
from metaheuristics.swarms.sparrow import Flock, Rows, forage


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
) -> Moves:
    """ISSA in which each individual chooses its move, or, ``blended``, adds both steps weighted."""
    blend = Blend(task, Flock(task.sample(population)), scouts, (p, c, a), window, threshold)
    combine = blend.blended if blended else blend.chosen
    yield from forage(task, blend.flock, producers, scouts, safety, combine, blend.weigh)


class Blend:
    """The weight of the sparrow's move, and the butterfly's move beside it."""

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
        self.weight = 0.5  # step one of section 4.2
        self._task = task
        self._p, self._c, self._a = butterfly
        n = len(flock.x)
        self._generations = max(1.0, (task.budget - n) / (n + max(1, round(scouts * n))))
        self._changes = deque([0.0] * window, maxlen=window)
        self._threshold = threshold
        self._best: float | None = None

    def weigh(self) -> None:
        """Renew the weight after a generation; the first call, after the start, keeps 0.5."""
        before, best = self._best, float(self.flock.fitness.min())
        self._best = best
        if before is None:
            return
        self._changes.append(abs(best - before) if isfinite(before) else inf)  # (12)
        self.weight = weight(list(self._changes), self._threshold * abs(best))
        self._c = grown(self._c, self._generations)

    def chosen(self, rows: Rows, moved: Array) -> Array:
        """Give each row its sparrow's move with probability ``weight``, else a butterfly's."""
        sparrows = self._task.rng.random((len(rows), 1)) < self.weight
        return np.where(sparrows, moved, self._butterflies(rows))

    def blended(self, rows: Rows, moved: Array) -> Array:
        """Add both steps, weighted."""
        w = self.weight
        return self._task.clip(w * moved + (1 - w) * self._butterflies(rows))

    def _butterflies(self, rows: Rows) -> Array:
        flock = self.flock
        best = flock.x[flock.fitness.argmin()]
        smell = fragrance(flock.fitness, self._c, self._a)[rows]
        moves = fluttered(self._task, flock.x[rows], flock.x, best, smell, self._p)
        return self._task.clip(moves)


def weight(changes: list[float], threshold: float) -> float:
    """Return the sparrow's weight: the mean change of the best over the threshold, 1 at most."""
    smooth = sum(changes) / len(changes)  # (13)
    if smooth >= threshold:
        return 1.0 if smooth > 0 else 0.0
    return smooth / threshold  # (14)
