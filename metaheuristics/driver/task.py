"""What an algorithm is given, and the words that all files of the driver share."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.float64]
Claim: TypeAlias = tuple[ArrayLike, float]
"""(x, fitness): what an algorithm says is its best; the driver compares it with what it evaluated."""
Moves: TypeAlias = Generator[Array, Array, Any]
"""A running algorithm: yields points x (n, dim), receives their fitness (n,), may return a claim."""
Search: TypeAlias = Callable[..., Moves]
"""An algorithm: a generator function ``(task, *, parameters...) -> Moves``."""
Objective: TypeAlias = Callable[[Array], ArrayLike]
"""f: points x (n, dim) -> fitness (n,); +inf (or NaN) marks an infeasible point."""


class TaskError(ValueError):
    """The box, the budget, the seed or a time limit makes no task; the message shows the value."""


class ObjectiveError(ValueError):
    """The objective returned something other than n floats above -inf."""


class Status(StrEnum):
    """How a run ended.

    Everything but ``ok`` and ``no_feasible_point`` is the algorithm's doing.

    Attributes
    ----------
    ok
        The budget is spent, and something feasible was found.
    stopped_early
        The algorithm returned before its budget was spent.
    over_budget
        It asked for more evaluations than its budget.
    raised
        It raised an exception.
    exited
        It called ``sys.exit``, or its process ended.
    timed_out
        It exceeded its time limit.
    bad_message
        Its process sent something that the driver of that process never sends.
    wrong_shape
        It asked for points that are not n points of dim coordinates.
    out_of_box
        It asked for a point outside the box.
    not_finite
        It asked for a point with a coordinate that is NaN or infinite.
    changed_input
        It wrote to the box, or to the fitness that it was sent.
    false_fitness
        It claims a fitness that is better than any that was evaluated, or is no number.
    global_random
        It drew from ``numpy.random`` or ``random``, and not from the generator of its task.
    ignored_start
        It was given points to start from, and did not ask for them first.
    no_feasible_point
        The budget is spent, and every fitness was infinite.

    Examples
    --------
    >>> from metaheuristics import Status
    >>> Status("timed-out") is Status.timed_out
    True
    """

    ok = "ok"
    stopped_early = "stopped-early"
    over_budget = "over-budget"
    raised = "raised"
    exited = "exited"
    timed_out = "timed-out"
    bad_message = "bad-message"
    wrong_shape = "wrong-shape"
    out_of_box = "out-of-box"
    not_finite = "not-finite"
    changed_input = "changed-input"
    false_fitness = "false-fitness"
    global_random = "global-random"
    ignored_start = "ignored-start"
    no_feasible_point = "no-feasible-point"


class Fault(Exception):  # noqa: N818 (not of this program)
    """An algorithm misbehaved; ends its run.

    Parameters
    ----------
    status : Status
        What it did.
    note : str
        One line for people.
    """

    def __init__(self, status: Status, note: str) -> None:
        super().__init__(note)
        self.status = status
        self.note = note


class BudgetSpent(Exception):  # noqa: N818 (no error)
    """Thrown into an algorithm when its budget is spent.

    Most algorithms let it pass.  One that knows its budget may catch it and return its claim.  If it yields
    again, it asks for more than its budget.

    Parameters
    ----------
    fitness : Array, shape (n,)
        Fitness of the last points, as far as the budget reached.
    """

    def __init__(self, fitness: Array) -> None:
        super().__init__("the budget is spent")
        self.fitness = fitness


class BoxRows:
    """The ends of a box, repeated for each row of a population: NumPy is slow on short broadcast rows.

    Parameters
    ----------
    lo, hi : Array, shape (dim,)
        Ends of the box.
    """

    def __init__(self, lo: Array, hi: Array) -> None:
        self.dim = len(lo)
        self._ends = lo, hi
        self._lo, self._hi = lo[None], hi[None]

    def of(self, n: int) -> tuple[Array, Array]:
        """Return both ends for n rows.

        Parameters
        ----------
        n : int
            Number of rows.

        Returns
        -------
        lo, hi : Array, shape (n, dim)
            Views of arrays that are kept.
        """
        if len(self._lo) < n:
            self._lo, self._hi = (np.array([end]).repeat(n, axis=0) for end in self._ends)
        return self._lo[:n], self._hi[:n]


@dataclass(frozen=True, eq=False)
class Task:
    """What an algorithm may know: the box, the random numbers, and how much of the budget is used.

    `minimise` makes it and hands it to the algorithm.

    Parameters
    ----------
    lo, hi : Array, shape (dim,)
        Ends of the box, read-only.
    rng : numpy.random.Generator
        The only source of random numbers.
    budget : int
        Evaluations of the run; most algorithms need `progress` alone.
    start : Array, shape (m, dim)
        Points to start from, read-only, the most important first; none by default.  An algorithm that is
        given some asks for them first: `first` and `started` put them into a first population.

    Examples
    --------
    >>> from metaheuristics import minimise
    >>> def shrinking(task, *, population=10):
    ...     centre = task.first(1)
    ...     while True:
    ...         width = (1 - task.progress) * (task.hi - task.lo) / 2
    ...         x = task.clip(centre + width * task.rng.uniform(-1, 1, (population, task.dim)))
    ...         fitness = yield x
    ...         centre = x[[fitness.argmin()]]
    >>> minimise(shrinking, lambda x: abs(x[:, 0]), [-1], [1], budget=200, seed=0).evaluations
    200
    """

    lo: Array
    hi: Array
    rng: np.random.Generator
    budget: int
    _used: Callable[[], int] = field(repr=False)
    start: Array = field(default_factory=lambda: np.empty((0, 0)))

    @property
    def dim(self) -> int:
        """Number of coordinates."""
        return len(self.lo)

    @property
    def progress(self) -> float:
        """Evaluations used / budget, in [0, 1]: the k/K of the papers."""
        return self._used() / self.budget

    def sample(self, n: int) -> Array:
        """Draw uniform points of the box.

        Parameters
        ----------
        n : int
            Number of points.

        Returns
        -------
        Array, shape (n, dim)
            Points.
        """
        return self.lo + (self.hi - self.lo) * self.rng.random((n, self.dim))  # rounds to <= hi

    def first(self, n: int) -> Array:
        """Draw a first population: the points to start from, then uniform points.

        Parameters
        ----------
        n : int
            Number of points.

        Returns
        -------
        Array, shape (n, dim)
            Points.
        """
        return self.started(self.sample(n))

    def started(self, x: Array) -> Array:
        """Put the points to start from into a population that was drawn otherwise.

        Parameters
        ----------
        x : Array, shape (n, dim)
            The population; its first rows are written to.

        Returns
        -------
        Array, shape (n, dim)
            The same array.  A population of fewer than m takes the first points of the start.
        """
        if len(self.start):
            x[: len(self.start)] = self.start[: len(x)]
        return x

    def clip(self, x: Array) -> Array:
        """Move every coordinate that is outside the box to the nearest end of the box.

        Parameters
        ----------
        x : Array, shape (..., dim)
            Points.

        Returns
        -------
        Array, shape (..., dim)
            Points of the box.
        """
        x = np.asarray(x)
        lo, hi = self._rows.of(len(x)) if x.ndim == 2 else (self.lo, self.hi)
        clipped = np.maximum(x, lo)
        return np.minimum(clipped, hi, out=clipped)

    @cached_property
    def _rows(self) -> BoxRows:
        return BoxRows(self.lo, self.hi)
