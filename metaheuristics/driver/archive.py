"""Best so far over every evaluation, exact to the row; and what a run leaves behind."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from metaheuristics.driver.task import Array, Status


@dataclass(frozen=True, eq=False)
class Result:
    """What one run found, by the driver's own count.

    ``x`` (dim,) is the first point that reached ``fitness``; None and +inf if every value was
    infinite.  ``trace_evaluations`` and ``trace_best`` (m,) hold one entry for each improvement,
    and end at ``evaluations``.  Times are in seconds.
    """

    x: Array | None
    fitness: float
    evaluations: int
    trace_evaluations: NDArray[np.int64]
    trace_best: Array
    status: Status
    note: str
    seconds_algorithm: float
    seconds_objective: float
    isolated: bool = False


class Archive:
    """Counts evaluations and keeps the best of them."""

    def __init__(self) -> None:
        self.evaluations = 0
        self.x: Array | None = None
        self.fitness = np.inf
        self._trace: list[tuple[int, float]] = []

    def add(self, x: Array, fitness: Array) -> None:
        """Count x (n, dim) with fitness (n,), in the order of its rows."""
        first = int(fitness.argmin())
        if fitness[first] < self.fitness:
            before = np.minimum.accumulate(np.concatenate(([self.fitness], fitness[:first])))
            better = np.flatnonzero(fitness[: first + 1] < before)
            self._trace += [(self.evaluations + int(i) + 1, float(fitness[i])) for i in better]
            self.x, self.fitness = x[first].copy(), float(fitness[first])
        self.evaluations += len(x)

    def result(self, status: Status, note: str, algorithm: float, objective: float) -> Result:
        """Return all that was found; ``algorithm``, ``objective``: seconds spent in each."""
        trace = list(self._trace)
        if not trace or trace[-1][0] < self.evaluations:
            trace.append((self.evaluations, self.fitness))
        evaluations, best = zip(*trace, strict=True)
        return Result(
            x=self.x,
            fitness=self.fitness,
            evaluations=self.evaluations,
            trace_evaluations=np.array(evaluations, dtype=np.int64),
            trace_best=np.array(best, dtype=np.float64),
            status=status,
            note=note,
            seconds_algorithm=algorithm,
            seconds_objective=objective,
        )
