"""What the driver refuses: from its caller, from an objective, from an algorithm."""

from __future__ import annotations

import operator
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from metaheuristics.driver.archive import Archive
from metaheuristics.driver.reason import reason, shown
from metaheuristics.driver.task import Array, BoxRows, Fault, ObjectiveError, Status, TaskError

ROUNDING = 1e-9
"""How far a claim may lie below what was evaluated, relative."""


def box(lo: ArrayLike, hi: ArrayLike) -> tuple[Array, Array]:
    """Return both ends of the box as the driver's own arrays.

    Parameters
    ----------
    lo, hi : ArrayLike, shape (dim,)
        Ends, as the caller gave them.

    Returns
    -------
    lower, upper : Array, shape (dim,)
        Copies of the ends.

    Raises
    ------
    TaskError
        They are not finite, not in order, or not of one shape.
    """
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
    """Return the budget as a whole number.

    Parameters
    ----------
    evaluations : int
        Any integer type.

    Returns
    -------
    int
        At least one.

    Raises
    ------
    TaskError
        It is no whole number, or less than one.
    """
    try:
        whole = operator.index(evaluations)
    except TypeError:
        raise TaskError(f"budget needs a whole number, got {evaluations!r}") from None
    if whole < 1:
        raise TaskError(f"budget needs at least one evaluation, got {whole}")
    return whole


def rng(seed: int | np.random.SeedSequence) -> np.random.Generator:
    """Return a generator that depends on the value of the seed, not on what the seed spawned before.

    Parameters
    ----------
    seed : int or numpy.random.SeedSequence
        Non-negative, if a number.

    Returns
    -------
    numpy.random.Generator
        A new generator.

    Raises
    ------
    TaskError
        It is no seed.
    """
    if isinstance(seed, np.random.SeedSequence):
        seed = np.random.SeedSequence(seed.entropy, spawn_key=seed.spawn_key, pool_size=seed.pool_size)
    elif not isinstance(seed, int | np.integer) or seed < 0:
        raise TaskError(f"seed needs a whole number >= 0 or a SeedSequence, got {seed!r}")
    return np.random.default_rng(seed)


def start(points: ArrayLike | None, lo: Array, hi: Array) -> Array:
    """Return the points to start from as the driver's own array.

    Parameters
    ----------
    points : ArrayLike, shape (m, dim), or None
        Points, as the caller gave them.
    lo, hi : Array, shape (dim,)
        Ends of the box.

    Returns
    -------
    Array, shape (m, dim)
        A copy; no rows for None.

    Raises
    ------
    TaskError
        They are no points of the box.
    """
    if points is None:
        return np.empty((0, len(lo)))
    x = np.array(points, dtype=np.float64)
    if x.ndim != 2 or x.shape[1] != len(lo):
        raise TaskError(f"start needs shape (m, {len(lo)}), got {x.shape}")
    outside = ~((x >= lo) & (x <= hi))  # NaN too
    if outside.any():
        i, d = np.argwhere(outside)[0]
        raise TaskError(f"start[{i}, {d}] = {x[i, d]} lies outside the box [{lo[d]}, {hi[d]}]")
    return x


def begins_with(x: Array, given: Array) -> None:
    """Compare the first points that an algorithm asks for with those that it was given to start from.

    Parameters
    ----------
    x : Array, shape (n, dim)
        Its first population, as far as the budget reaches.
    given : Array, shape (m, dim)
        The start.

    Raises
    ------
    Fault
        They are others.
    """
    n = min(len(x), len(given))
    if not np.array_equal(x[:n], given[:n]):
        raise Fault(Status.ignored_start, f"asked for other points than the {len(given)} to start from")


def read_only(x: Array) -> Array:
    """Return a copy that cannot be written to.

    Parameters
    ----------
    x : Array, any shape
        What is copied.

    Returns
    -------
    Array, shape of x
        The copy.
    """
    copy = x.copy()
    copy.flags.writeable = False
    return copy


def fitness(returned: ArrayLike, n: int) -> Array:
    """Return the values of the objective as the driver's own array.

    Parameters
    ----------
    returned : ArrayLike, shape (n,)
        What the objective returned.
    n : int
        Number of points that it was given.

    Returns
    -------
    Array, shape (n,)
        A copy in which +inf replaces NaN.

    Raises
    ------
    ObjectiveError
        The shape is another one, or a value is -inf.
    """
    values = np.array(returned, dtype=np.float64)
    if values.shape != (n,):
        raise ObjectiveError(f"f returned shape {values.shape} for {n} points")
    if not values[values.argmin()] > -np.inf:  # argmin finds NaN first
        np.copyto(values, np.inf, where=np.isnan(values))
        if values[values.argmin()] == -np.inf:
            raise ObjectiveError(f"f returned -inf for point {values.argmin()} of {n}")
    return values


def population(yielded: object, box: BoxRows) -> Array:
    """Return the points that an algorithm asks for as the driver's own array.

    Parameters
    ----------
    yielded : object
        What the algorithm yielded: anything.
    box : BoxRows
        Ends of the box.

    Returns
    -------
    Array, shape (n, dim)
        A copy, n >= 1.

    Raises
    ------
    Fault
        It is no array of finite points of the box.
    """
    try:
        array = np.asarray(yielded)
        if array.dtype.kind == "c":
            raise TypeError("complex numbers")
        x = np.array(array, dtype=np.float64)  # a copy first: what is checked is what is evaluated
    except BaseException as error:  # of foreign objects: whatever they raise
        raise Fault(Status.wrong_shape, f"not an array of floats: {reason(error)}") from None
    if x.ndim != 2 or x.shape[0] == 0 or x.shape[1] != box.dim:
        raise Fault(Status.wrong_shape, f"yielded shape {x.shape}, needs (n, {box.dim})")
    lo, hi = box.of(len(x))
    inside = x >= lo
    inside &= x <= hi
    if np.count_nonzero(inside) < x.size:
        finite = np.isfinite(x)
        status = Status.out_of_box if finite.all() else Status.not_finite
        i, d = np.argwhere(~inside if status is Status.out_of_box else ~finite)[0]
        raise Fault(status, f"x[{i}, {d}] = {x[i, d]}, box [{lo[i, d]}, {hi[i, d]}]")
    return x


def claim(returned: object, archive: Archive) -> None:
    """Compare what an algorithm claims with what was evaluated.

    Parameters
    ----------
    returned : object
        What the algorithm returned.  A tuple of two is a claim (x, fitness), anything else is none.
    archive : Archive
        What was evaluated.

    Raises
    ------
    Fault
        The fitness is better than anything that was evaluated, or no number.
    """
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
    """Tell whether an array that was lent to an algorithm is still the same, bit by bit.

    Parameters
    ----------
    theirs : Array, any shape
        The array that the algorithm had; it may have been made into anything.
    ours : Array, any shape
        A copy that it never saw.

    Returns
    -------
    bool
        Whether type, shape and content agree.
    """
    same_kind = theirs.dtype == ours.dtype and theirs.shape == ours.shape
    return same_kind and theirs.tobytes() == ours.tobytes()
