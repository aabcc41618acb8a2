"""What a run leaves behind, and the archive that it is made of: the best so far at every evaluation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from metaheuristics.driver.task import Array, Status


@dataclass(frozen=True, eq=False)
class Result:
    """What one run found, by the driver's own count.

    Parameters
    ----------
    x : Array or None, shape (dim,)
        The first point that reached ``fitness``; None if every value was infinite.
    fitness : float
        The best value; +inf if every value was infinite.
    evaluations : int
        Evaluations of the objective.
    trace_evaluations : NDArray[np.int64], shape (m,)
        Evaluation at which each improvement was found; the last entry is ``evaluations``.
    trace_best : Array, shape (m,)
        Best value from there on.
    status : Status
        How the run ended.
    note : str
        The reason in one printable line; empty if the status is ``ok``.
    seconds_algorithm, seconds_objective : float
        Time spent in the algorithm and in the objective [s].
    isolated : bool
        Whether the algorithm ran in a process of its own (`apart`), where it could not reach the objective.

    Examples
    --------
    >>> from metaheuristics import ALGORITHMS, minimise
    >>> found = minimise(ALGORITHMS["random"].function, lambda x: x[:, 0], [0], [1], budget=100, seed=0)
    >>> bool(found.trace_best[-1] == found.fitness), int(found.trace_evaluations[-1]), found.isolated
    (True, 100, False)
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
        """Count evaluations in the order of their rows.

        Parameters
        ----------
        x : Array, shape (n, dim)
            Points.
        fitness : Array, shape (n,)
            Their fitness, NaN excluded.
        """
        first = int(fitness.argmin())
        if fitness[first] < self.fitness:
            best = self.fitness
            for count, value in enumerate(fitness[: first + 1].tolist(), self.evaluations + 1):
                if value < best:
                    best = value
                    self._trace.append((count, best))
            self.x, self.fitness = x[first].copy(), float(fitness[first])
        self.evaluations += len(x)

    def result(
        self, status: Status, note: str, algorithm: float, objective: float, *, isolated: bool
    ) -> Result:
        """Return all that was found.

        Parameters
        ----------
        status : Status
            How the run ended.
        note : str
            The reason.
        algorithm, objective : float
            Time spent in each [s].
        isolated : bool
            Whether the algorithm ran in a process of its own.

        Returns
        -------
        Result
            The result of the run.
        """
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
            isolated=isolated,
        )
