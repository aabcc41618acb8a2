"""What the driver refuses: from its caller, from an objective, from an algorithm."""

from __future__ import annotations

import operator
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from metaheuristics.driver.archive import Archive
from metaheuristics.driver.reason import reason, shown
from metaheuristics.driver.task import Array, Fault, ObjectiveError, Status, TaskError

ROUNDING = 1e-9  # relative: how far a claim may lie below what was evaluated


def box(lo: ArrayLike, hi: ArrayLike) -> tuple[Array, Array]:
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


def budget(evaluations: int) -> int:
    """Return the budget as a whole number, at least one."""
    try:
        whole = operator.index(evaluations)
    except TypeError:
        raise TaskError(f"budget needs a whole number, got {evaluations!r}") from None
    if whole < 1:
        raise TaskError(f"budget needs at least one evaluation, got {whole}")
    return whole


def rng(seed: int | np.random.SeedSequence) -> np.random.Generator:
    """Return a generator that depends on the seed's value, not on what it spawned before."""
    if isinstance(seed, np.random.SeedSequence):
        seed = np.random.SeedSequence(seed.entropy, spawn_key=seed.spawn_key, pool_size=seed.pool_size)
    elif not isinstance(seed, int | np.integer) or seed < 0:
        raise TaskError(f"seed needs a whole number >= 0 or a SeedSequence, got {seed!r}")
    return np.random.default_rng(seed)


def read_only(x: Array) -> Array:
    """Return a copy that cannot be written to."""
    copy = x.copy()
    copy.flags.writeable = False
    return copy


def fitness(returned: ArrayLike, n: int) -> Array:
    """Return f's values (n,) as the driver's own array, NaN replaced by +inf."""
    values = np.array(returned, dtype=np.float64)
    if values.shape != (n,):
        raise ObjectiveError(f"f returned shape {values.shape} for {n} points")
    np.copyto(values, np.inf, where=np.isnan(values))
    if values[values.argmin()] == -np.inf:
        raise ObjectiveError(f"f returned -inf for point {values.argmin()} of {n}")
    return values


def population(yielded: object, lo: Array, hi: Array) -> Array:
    """Return what an algorithm yielded as the driver's own floats (n, dim), n >= 1, or its `Fault`."""
    try:
        array = np.asarray(yielded)
        if array.dtype.kind == "c":
            raise TypeError("complex numbers")
        x = np.array(array, dtype=np.float64)  # a copy first: what is checked is what is evaluated
    except BaseException as error:  # of foreign objects: whatever they raise
        raise Fault(Status.wrong_shape, f"not an array of floats: {reason(error)}") from None
    if x.ndim != 2 or x.shape[0] == 0 or x.shape[1] != lo.size:
        raise Fault(Status.wrong_shape, f"yielded shape {x.shape}, needs (n, {lo.size})")
    inside = (x >= lo) & (x <= hi)
    if np.count_nonzero(inside) < x.size:
        finite = np.isfinite(x)
        status = Status.out_of_box if finite.all() else Status.not_finite
        i, d = np.argwhere(~inside if status is Status.out_of_box else ~finite)[0]
        raise Fault(status, f"x[{i}, {d}] = {x[i, d]}, box [{lo[d]}, {hi[d]}]")
    return x


def claim(returned: object, archive: Archive) -> None:
    """Raise a `Fault` if a returned (x, fitness) is better than anything that was evaluated."""
    kind: type = type(returned)  # the true one, and the methods of a plain tuple: both can be faked
    pair = cast("tuple[object, ...]", returned)
    if not issubclass(kind, tuple) or tuple.__len__(pair) != 2:
        return  # no claim
    claimed: Any = tuple.__getitem__(pair, 1)
    try:
        number = claimed.item() if type(claimed) is np.ndarray and claimed.size == 1 else claimed
        fitness = float(number)
    except BaseException:  # of a foreign object: whatever it raises
        raise Fault(Status.false_fitness, f"claims {shown(claimed)}, which is no number") from None
    least = archive.fitness
    if not fitness >= least - ROUNDING * abs(least):  # NaN too
        raise Fault(Status.false_fitness, f"claims {fitness:.9g}; its best evaluated is {least:.9g}")


def unchanged(theirs: Array, ours: Array) -> bool:
    """Tell whether an array that was lent to an algorithm is still the same, bit by bit."""
    same_kind = theirs.dtype == ours.dtype and theirs.shape == ours.shape
    return same_kind and theirs.tobytes() == ours.tobytes()
