"""Makes a generator, which is asked for its points, of an optimiser that calls its objective.

The optimiser runs in a thread.  Each call of its objective hands the points over and sleeps until the driver
sends their fitness.  One side works at a time, so that a run repeats itself.  An optimiser that calls its
objective from several threads is served one call after the other.
"""

from __future__ import annotations

from collections.abc import Callable
from queue import SimpleQueue
from threading import Lock, Thread
from typing import Any, TypeAlias

import numpy as np

from metaheuristics.driver.task import Array, BudgetSpent, Claim, Fault, Moves, Status, Task

Call: TypeAlias = Callable[[Callable[[Array], Array]], Claim | None]
"""An optimiser: given f, (n, dim) -> (n,), it works until it has its answer."""

PATIENCE = 5.0
"""Time that an optimiser may take to stop once its budget is spent [s]."""


class _Stop(BaseException):
    """Ends the thread of the optimiser; not an Exception, so that few handlers catch it."""


class _Optimiser:
    """The thread of the optimiser, and the objective that it sees."""

    def __init__(self, call: Call) -> None:
        self._call = call
        self._stopped = False
        self._one_call = Lock()
        self.asked: SimpleQueue[tuple[str, Any]] = SimpleQueue()
        self.told: SimpleQueue[Array] = SimpleQueue()
        self.thread = Thread(target=self._work, daemon=True)

    def _work(self) -> None:
        try:
            self.asked.put(("returned", self._call(self._f)))
        except BaseException as error:  # raised again in the thread of the driver
            self.asked.put(("raised", error))

    def _f(self, x: Array) -> Array:
        with self._one_call:
            if not self._stopped:
                self.asked.put(("x", x))
                fitness = self.told.get()
                if not self._stopped:
                    return fitness
        raise _Stop

    def stop(self) -> None:
        """End the thread: its objective raises from now on."""
        self._stopped = True
        self.told.put(np.empty(0))
        self.thread.join(PATIENCE)
        if self.thread.is_alive():
            raise Fault(Status.timed_out, f"did not stop within {PATIENCE:g} s after its budget")


def inverted(task: Task, call: Call, *, endless: bool) -> Moves:
    """Yield the points that an optimiser evaluates, as it calls its objective.

    Parameters
    ----------
    task : Task
        Budget of the run.
    call : Call
        Starts the optimiser: ``call(f)`` works until it has its answer.
    endless : bool
        Whether the optimiser does not know its budget.  If so, it is stopped when the budget is spent.
        If not, a call of f beyond the budget is the fault `Status.over_budget`.

    Returns
    -------
    Moves
        A generator; it returns what the optimiser returns.
    """
    optimiser = _Optimiser(call)
    optimiser.thread.start()
    spent = False
    try:
        while True:
            kind, given = optimiser.asked.get()
            if kind == "returned":
                return given
            if kind == "raised":
                raise given
            if spent:
                raise Fault(Status.over_budget, f"asked for more than {task.budget} evaluations")
            try:
                fitness = yield given
            except BudgetSpent as last:
                if endless:
                    raise
                if len(last.fitness) < len(given):
                    over = f"asked for {len(given)} evaluations with {len(last.fitness)} left"
                    raise Fault(Status.over_budget, over) from None
                spent, fitness = True, last.fitness
            optimiser.told.put(fitness)
    finally:
        optimiser.stop()
