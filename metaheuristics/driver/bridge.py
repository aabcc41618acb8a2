"""Turns an optimiser that calls its objective into a generator that is asked for its points.

The optimiser runs in a thread; each call of its objective hands the points over and sleeps until the
driver sends their fitness.  One side works at a time, so a run stays deterministic.
"""

from __future__ import annotations

from collections.abc import Callable
from queue import SimpleQueue
from threading import Thread
from typing import Any, TypeAlias

import numpy as np

from metaheuristics.driver.task import Array, BudgetSpent, Claim, Fault, Moves, Status, Task

Call: TypeAlias = Callable[[Callable[[Array], Array]], Claim | None]
"""An optimiser: given f, (n, dim) -> (n,), it works until it has its answer."""

PATIENCE = 5.0  # s that an optimiser may take to stop once its budget is gone


class _Stop(BaseException):
    """Unwinds the optimiser's thread; not an Exception, so that few handlers hold it up."""


class _Hand:
    """The optimiser's side: its thread, and the objective it sees."""

    def __init__(self, call: Call) -> None:
        self._call = call
        self._stopped = False
        self.asked: SimpleQueue[tuple[str, Any]] = SimpleQueue()
        self.told: SimpleQueue[Array] = SimpleQueue()
        self.thread = Thread(target=self._work, daemon=True)

    def _work(self) -> None:
        try:
            self.asked.put(("returned", self._call(self._f)))
        except BaseException as error:  # carried over to the driver's side
            self.asked.put(("raised", error))

    def _f(self, x: Array) -> Array:
        if not self._stopped:
            self.asked.put(("x", x))
            fitness = self.told.get()
            if not self._stopped:
                return fitness
        raise _Stop

    def stop(self) -> None:
        """End the thread by raising out of its objective."""
        self._stopped = True
        self.told.put(np.empty(0))
        self.thread.join(PATIENCE)
        if self.thread.is_alive():
            raise Fault(Status.timed_out, f"did not stop within {PATIENCE:g} s after its budget")


def inverted(task: Task, call: Call, *, endless: bool) -> Moves:
    """Yield the points that ``call(f)`` evaluates, as it calls f; returns what it returns.

    endless: it was not told its budget and is cut off there.  Otherwise calling f beyond the budget
    is the fault `over-budget`.
    """
    hand = _Hand(call)
    hand.thread.start()
    spent = False
    try:
        while True:
            kind, given = hand.asked.get()
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
            hand.told.put(fitness)
    finally:
        hand.stop()
