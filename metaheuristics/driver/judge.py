"""The judge of all algorithms: one box, one budget, one archive, the same for every one of them.

An algorithm is a generator function.  It yields a whole population x (n, dim) and is sent its fitness (n,);
+inf means infeasible.  It keeps no score: the answer is the best of what the driver evaluated, so that no
algorithm can report a point that it did not pay for.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from time import perf_counter
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from metaheuristics.driver import checks
from metaheuristics.driver.archive import Archive, Result
from metaheuristics.driver.guards import Interrupt, global_random, user_interrupt
from metaheuristics.driver.isolation import Apart
from metaheuristics.driver.reason import fault_of
from metaheuristics.driver.task import (
    Array,
    BoxRows,
    BudgetSpent,
    Fault,
    Moves,
    Objective,
    Search,
    Status,
    Task,
)

T = TypeVar("T")


def minimise(
    algorithm: Search,
    f: Objective,
    lo: ArrayLike,
    hi: ArrayLike,
    *,
    budget: int,
    seed: int | np.random.SeedSequence,
    start: ArrayLike | None = None,
    **parameters: object,
) -> Result:
    """Run an algorithm on an objective over a box, for exactly ``budget`` evaluations.

    The same algorithm, objective, box, budget, seed and parameters give the same result to the last bit,
    times apart.  Misbehaviour of the algorithm ends the run with a `Status` and a note, and keeps what was
    found.

    Parameters
    ----------
    algorithm : Search
        A generator function ``(task, **parameters)``: see `Task` for an example.  `apart` runs one in a
        process of its own.
    f : Objective
        Maps points (n, dim) to fitness (n,), which is to be small; +inf or NaN marks an infeasible point.
    lo, hi : ArrayLike, shape (dim,)
        Ends of the box, finite, lo < hi.
    budget : int
        Evaluations.  A batch larger than what is left is evaluated as far as it fits, from its first row.
    seed : int or numpy.random.SeedSequence
        Fixes all random numbers.
    start : ArrayLike, shape (m, dim), optional
        Points of the box to start from, the most important first: results of an earlier search.  They are
        the first points that the algorithm asks for, and they count.  All swarms of this package take a
        start; an algorithm that does not has the status ``ignored-start``, before anything is evaluated.
    **parameters : object
        Parameters of the algorithm.

    Returns
    -------
    Result
        The best point, how it was approached, and how the run ended.

    Raises
    ------
    TaskError
        The box, budget, seed or start makes no task.
    ObjectiveError
        The objective returned something else than n floats above -inf.
    TypeError
        The algorithm has no such parameter.
    Exception
        Whatever the objective raises.
    KeyboardInterrupt
        The user interrupted.  (One that the algorithm raises itself is its fault.)

    Examples
    --------
    >>> from metaheuristics import ALGORITHMS, minimise
    >>> entry = ALGORITHMS["pso"]
    >>> f = lambda x: ((x - 0.3) ** 2).sum(axis=1)
    >>> found = minimise(entry.function, f, [-1, -1], [1, 1], budget=2000, seed=0, **entry.parameters)
    >>> found.status, found.evaluations, found.x.round(3)
    (<Status.ok: 'ok'>, 2000, array([0.3, 0.3]))
    """
    lower, upper = checks.box(lo, hi)
    budget = checks.budget(budget)
    given = checks.start(start, lower, upper)
    archive = Archive()
    task = Task(
        lo=checks.read_only(lower),
        hi=checks.read_only(upper),
        rng=checks.rng(seed),
        budget=budget,
        _used=lambda: archive.evaluations,
        start=checks.read_only(given),
    )
    inspect.signature(algorithm).bind(task, **parameters)  # a TypeError here is the caller's
    lent = task.lo, task.hi
    with user_interrupt() as interrupt, global_random(task.rng) as drawn:
        run = _Run(archive, f, lower, upper, budget, given, interrupt)
        status, note = run.judged(lambda: algorithm(task, **parameters))
    if status is Status.ok and not (
        checks.unchanged(lent[0], lower) and checks.unchanged(lent[1], upper)
    ):
        status, note = Status.changed_input, "wrote to the box"
    if status is Status.ok and drawn():
        status, note = Status.global_random, "drew from numpy.random or random, not from task.rng"
    if status is Status.ok and archive.x is None:
        status, note = Status.no_feasible_point, f"none of {budget} values was finite"
    seconds = run.seconds_algorithm, run.seconds_objective
    return archive.result(status, note, *seconds, isolated=type(algorithm) is Apart)


class _Run:
    """One algorithm at work: its time and that of f are measured, and what it asks for is checked."""

    def __init__(
        self,
        archive: Archive,
        f: Objective,
        lo: Array,
        hi: Array,
        budget: int,
        given: Array,
        interrupt: Interrupt,
    ) -> None:
        self.archive, self.given, self.interrupt = archive, given, interrupt
        self.f, self.box, self.budget = f, BoxRows(lo, hi), budget
        self.seconds_algorithm = self.seconds_objective = 0.0

    def judged(self, start: Callable[[], Moves]) -> tuple[Status, str]:
        """Run until the budget is spent or the algorithm commits a fault; return status and note."""
        moves: Moves | None = None
        status, note = Status.ok, ""
        try:
            moves = self._guarded(start)
            self._steps(moves)
        except Fault as fault:
            status, note = fault.status, fault.note
        finally:  # an adapter cleans up, whatever passes through
            if moves is not None:
                try:
                    self._guarded(lambda: moves.close())
                except Fault as fault:
                    if status is Status.ok:
                        status, note = fault.status, fault.note
        if status is Status.ok and self.archive.evaluations < self.budget:
            return self._early()
        return status, note

    def _steps(self, moves: Moves) -> None:
        """Ask, evaluate, tell, until the budget is spent."""
        yielded: object = self._guarded(lambda: next(moves))
        while True:
            left = self.budget - self.archive.evaluations
            try:
                x = checks.population(yielded, self.box)[:left]
            finally:
                self.interrupt.check()
            if self.archive.evaluations == 0:
                checks.begins_with(x, self.given)
            started = perf_counter()
            returned = self.f(x.copy())
            self.seconds_objective += perf_counter() - started
            fitness = checks.fitness(returned, len(x))
            self.archive.add(x, fitness)
            told = fitness.copy()
            if len(x) == left:
                self._farewell(moves, told)
            else:
                yielded = self._guarded(lambda told=told: moves.send(told))  # type: ignore[misc]
            if not checks.unchanged(told, fitness):
                raise Fault(Status.changed_input, "wrote to the fitness it was sent")
            if len(x) == left:
                return

    def _farewell(self, moves: Moves, fitness: Array) -> None:
        """Tell the algorithm that its budget is gone; it may return a claim, and nothing else."""
        spent = BudgetSpent(fitness)
        try:
            self._guarded(lambda: moves.throw(spent))
        except Fault as fault:
            if fault.__cause__ is spent or fault.status is Status.stopped_early:
                return
            raise
        raise Fault(Status.over_budget, f"asked for more than {self.budget} evaluations")

    def _guarded(self, enter: Callable[[], T]) -> T:
        """Let the algorithm work until it yields, and measure its time; raises the `Fault` that it commits."""
        started = perf_counter()
        try:
            try:
                return enter()
            except StopIteration as end:
                checks.claim(end.value, self.archive)
                raise Fault(*self._early()) from None
        except BaseException as error:  # of foreign code: whatever it raises
            raise fault_of(error) from error
        finally:
            self.seconds_algorithm += perf_counter() - started
            self.interrupt.check()

    def _early(self) -> tuple[Status, str]:
        used = self.archive.evaluations
        return Status.stopped_early, f"returned after {used} of {self.budget} evaluations"
