"""The driver: one box, one budget, one archive, the same for every algorithm.

An algorithm is a generator function.  It yields a whole population ``x`` (n, dim) and is sent back
its fitness (n,); +inf means infeasible.  It keeps no score: the answer is the driver's archive of
what was evaluated, so no algorithm can report a point it did not pay for.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Generator
from dataclasses import dataclass, field
from enum import StrEnum
from time import perf_counter
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.float64]
Moves: TypeAlias = Generator[Array, Array, None]
"""What an algorithm is once started: yields x (n, dim), receives fitness (n,)."""
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
    raised = "raised"
    wrong_shape = "wrong-shape"
    out_of_box = "out-of-box"
    not_finite = "not-finite"
    no_feasible_point = "no-feasible-point"


@dataclass(frozen=True, eq=False)
class Task:
    """What an algorithm may know: the box, the random numbers, how much of the budget is gone.

    ``lo``, ``hi`` (dim,) are read-only.  ``rng`` is the only source of randomness.
    """

    lo: Array
    hi: Array
    rng: np.random.Generator
    _progress: Callable[[], float] = field(repr=False)

    @property
    def dim(self) -> int:
        """Number of coordinates."""
        return len(self.lo)

    @property
    def progress(self) -> float:
        """Evaluations used / budget, in [0, 1]: the k/K of the papers."""
        return self._progress()

    def sample(self, n: int) -> Array:
        """Draw n points (n, dim), uniform in the box."""
        return self.lo + (self.hi - self.lo) * self.rng.random((n, self.dim))  # rounds to <= hi

    def clip(self, x: Array) -> Array:
        """Return x (..., dim) with every coordinate moved to the nearest one in the box."""
        return np.minimum(np.maximum(x, self.lo), self.hi)


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


class _PopulationError(Exception):
    """The algorithm yielded what is not a population in the box."""

    def __init__(self, status: Status, note: str) -> None:
        super().__init__(note)
        self.status = status


class _Archive:
    """Best-so-far over every evaluation, exact to the row."""

    def __init__(self) -> None:
        self.evaluations = 0
        self.x: Array | None = None
        self.fitness = np.inf
        self.trace: list[tuple[int, float]] = []

    def add(self, x: Array, fitness: Array) -> None:
        """Count x (n, dim) with fitness (n,), in the order of its rows."""
        first = int(fitness.argmin())
        if fitness[first] < self.fitness:
            before = np.minimum.accumulate(np.concatenate(([self.fitness], fitness[:first])))
            better = np.flatnonzero(fitness[: first + 1] < before)
            self.trace += [(self.evaluations + int(i) + 1, float(fitness[i])) for i in better]
            self.x, self.fitness = x[first].copy(), float(fitness[first])
        self.evaluations += len(x)


def minimise(
    algorithm: Search,
    f: Objective,
    lo: ArrayLike,
    hi: ArrayLike,
    *,
    budget: int,
    seed: int | np.random.SeedSequence,
    **parameters: object,
) -> Result:
    """Run an algorithm on f over the box [lo, hi] for exactly ``budget`` evaluations.

    ``lo``, ``hi`` (dim,), finite, lo < hi.  ``f`` maps (n, dim) to (n,).  A batch larger than what
    is left of the budget is evaluated as far as it fits, row by row from the first.  The same
    algorithm, f, box, budget, seed and parameters give the same result, times apart.

    Misbehaviour of the algorithm ends the run with a `Status` and a note, and keeps what was
    found.  Raises `TaskError` for a bad box, budget or seed, `ObjectiveError` for what f may not
    return; an exception inside f, or an unknown parameter (TypeError), passes through.
    """
    lower, upper = _box(lo, hi)
    budget = _budget(budget)
    archive = _Archive()
    task = Task(_read_only(lower), _read_only(upper), _rng(seed), lambda: archive.evaluations / budget)
    moves = algorithm(task, **parameters)
    status, note = Status.ok, ""
    seconds_algorithm = seconds_objective = 0.0
    fitness: Array | None = None

    while archive.evaluations < budget:
        start = perf_counter()
        try:
            yielded = next(moves) if fitness is None else moves.send(fitness)
        except StopIteration:
            status = Status.stopped_early
            note = f"returned after {archive.evaluations} of {budget} evaluations"
        except Exception as error:
            status, note = Status.raised, _one_line(error)
        seconds_algorithm += perf_counter() - start
        if status is not Status.ok:
            break

        try:
            x = _population(yielded, lower, upper)[: budget - archive.evaluations]
        except _PopulationError as error:
            status, note = error.status, str(error)
            break

        start = perf_counter()
        returned = f(x.copy())
        seconds_objective += perf_counter() - start
        fitness = _fitness(returned, len(x))
        archive.add(x, fitness)

    try:
        moves.close()  # lets an adapter clean up
    except Exception as error:
        if status is Status.ok:
            status, note = Status.raised, _one_line(error)

    if status is Status.ok and archive.x is None:
        status, note = Status.no_feasible_point, f"none of {budget} values was finite"
    if not archive.trace or archive.trace[-1][0] < archive.evaluations:
        archive.trace.append((archive.evaluations, archive.fitness))
    evaluations, best = zip(*archive.trace, strict=True)
    return Result(
        x=archive.x,
        fitness=archive.fitness,
        evaluations=archive.evaluations,
        trace_evaluations=np.array(evaluations, dtype=np.int64),
        trace_best=np.array(best, dtype=np.float64),
        status=status,
        note=note,
        seconds_algorithm=seconds_algorithm,
        seconds_objective=seconds_objective,
    )


def _population(yielded: object, lo: Array, hi: Array) -> Array:
    """Return what was yielded as floats (n, dim), n >= 1, or raise the `_PopulationError` it is."""
    try:
        x: Array = np.asarray(yielded, dtype=np.float64)
    except Exception as error:
        raise _PopulationError(
            Status.wrong_shape, f"not an array of floats: {_one_line(error)}"
        ) from None
    if x.ndim != 2 or x.shape[0] == 0 or x.shape[1] != lo.size:
        raise _PopulationError(Status.wrong_shape, f"yielded shape {x.shape}, needs (n, {lo.size})")
    inside = (x >= lo) & (x <= hi)
    if np.count_nonzero(inside) < x.size:
        finite = np.isfinite(x)
        status = Status.out_of_box if finite.all() else Status.not_finite
        i, d = np.argwhere(~inside if status is Status.out_of_box else ~finite)[0]
        raise _PopulationError(status, f"x[{i}, {d}] = {x[i, d]}, box [{lo[d]}, {hi[d]}]")
    return x


def _fitness(returned: ArrayLike, n: int) -> Array:
    """Return f's values (n,) as the algorithm's own array, NaN replaced by +inf."""
    fitness = np.array(returned, dtype=np.float64)
    if fitness.shape != (n,):
        raise ObjectiveError(f"f returned shape {fitness.shape} for {n} points")
    np.copyto(fitness, np.inf, where=np.isnan(fitness))
    if fitness[fitness.argmin()] == -np.inf:
        raise ObjectiveError(f"f returned -inf for point {fitness.argmin()} of {n}")
    return fitness


def _box(lo: ArrayLike, hi: ArrayLike) -> tuple[Array, Array]:
    """Return both ends of the box as float arrays (dim,)."""
    lower, upper = np.array(lo, dtype=np.float64), np.array(hi, dtype=np.float64)
    if lower.ndim != 1 or lower.size == 0 or lower.shape != upper.shape:
        raise TaskError(f"lo and hi need one shape (dim,), got {lower.shape} and {upper.shape}")
    with np.errstate(over="ignore", invalid="ignore"):
        good = (lower < upper) & np.isfinite(upper - lower)
    if not good.all():
        d = int(good.argmin())
        raise TaskError(f"coordinate {d} needs finite lo < hi, got [{lower[d]}, {upper[d]}]")
    return lower, upper


def _budget(budget: int) -> int:
    """Return the budget as a whole number, at least one."""
    try:
        whole = operator.index(budget)
    except TypeError:
        raise TaskError(f"budget needs a whole number, got {budget!r}") from None
    if whole < 1:
        raise TaskError(f"budget needs at least one evaluation, got {whole}")
    return whole


def _rng(seed: int | np.random.SeedSequence) -> np.random.Generator:
    """Return a generator that depends on the seed's value, not on what it spawned before."""
    if isinstance(seed, np.random.SeedSequence):
        seed = np.random.SeedSequence(seed.entropy, spawn_key=seed.spawn_key, pool_size=seed.pool_size)
    elif not isinstance(seed, int | np.integer) or seed < 0:
        raise TaskError(f"seed needs a whole number >= 0 or a SeedSequence, got {seed!r}")
    return np.random.default_rng(seed)


def _read_only(x: Array) -> Array:
    """Return a copy that cannot be written to."""
    copy = x.copy()
    copy.flags.writeable = False
    return copy


def _one_line(error: Exception) -> str:
    """Return an exception's type and message on one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())
