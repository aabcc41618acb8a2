"""What an algorithm is given, and the words that all files here share."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.float64]
Claim: TypeAlias = tuple[ArrayLike, float]
"""(x, fitness): what an algorithm says is its best; the driver compares it with what it saw."""
Moves: TypeAlias = Generator[Array, Array, Any]
"""What an algorithm is once started: yields x (n, dim), receives fitness (n,), may return a claim."""
Search: TypeAlias = Callable[..., Moves]
"""A generator function ``(task, *, parameters...) -> Moves``."""
Objective: TypeAlias = Callable[[Array], ArrayLike]
"""f: x (n, dim) -> fitness (n,); +inf (or NaN) marks an infeasible row."""


class TaskError(ValueError):
    """The box, budget or seed makes no task."""


class ObjectiveError(ValueError):
    """The objective returned something other than n floats above -inf."""


class Status(StrEnum):
    """How a run ended; anything but ``ok`` is the algorithm's doing, or an empty feasible set."""

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
    no_feasible_point = "no-feasible-point"


class Fault(Exception):  # noqa: N818 (not of this program)
    """An algorithm misbehaved; ends its run with this status and note."""

    def __init__(self, status: Status, note: str) -> None:
        super().__init__(note)
        self.status = status
        self.note = note


class BudgetSpent(Exception):  # noqa: N818 (no error)
    """Thrown into an algorithm with the last fitness (n,) when its budget is gone.

    Most let it pass. One that knows its budget may catch it to return its claim; yielding again is
    asking for more than the budget.
    """

    def __init__(self, fitness: Array) -> None:
        super().__init__("the budget is spent")
        self.fitness = fitness


@dataclass(frozen=True, eq=False)
class Task:
    """What an algorithm may know: the box, the random numbers, how much of the budget is gone.

    ``lo``, ``hi`` (dim,) are read-only.  ``rng`` is the only source of randomness.  ``budget`` is in
    evaluations; most algorithms need ``progress`` alone.
    """

    lo: Array
    hi: Array
    rng: np.random.Generator
    budget: int
    _used: Callable[[], int] = field(repr=False)

    @property
    def dim(self) -> int:
        """Number of coordinates."""
        return len(self.lo)

    @property
    def progress(self) -> float:
        """Evaluations used / budget, in [0, 1]: the k/K of the papers."""
        return self._used() / self.budget

    def sample(self, n: int) -> Array:
        """Draw n points (n, dim), uniform in the box."""
        return self.lo + (self.hi - self.lo) * self.rng.random((n, self.dim))  # rounds to <= hi

    def clip(self, x: Array) -> Array:
        """Return x (..., dim) with every coordinate moved to the nearest one in the box."""
        return np.minimum(np.maximum(x, self.lo), self.hi)
