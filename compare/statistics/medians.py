"""The median of some runs, and by how much one median is below another, each with its interval.

A run that found nothing has an infinite loss, and counts. Of an even number of runs the lower one of the two
in the middle is the median: it is the result of a run.

References
----------
David H. A., Nagaraja H. N. (2003). Order Statistics, 3rd ed., sec. 7.1 (interval of a quantile).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from compare.statistics.pairs import losses_of

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Estimate:
    """A value with its interval."""

    value: float
    low: float
    high: float


def median_of(losses: ArrayLike, level: float = 0.95) -> Estimate:
    """Return the median with an interval that holds for every distribution.

    The interval runs between two of the runs, chosen so that it misses the median with a probability of at most
    ``1 - level`` (binomial). Fewer than six runs have no interval of 95 %: it is then unbounded.

    Parameters
    ----------
    losses : ArrayLike, shape (n,)
        Of the runs; infinite: it found nothing.
    level : float
        Confidence.

    Returns
    -------
    Estimate
    """
    x = np.sort(losses_of(losses))
    out = int(stats.binom.ppf((1.0 - level) / 2.0, len(x), 0.5))  # runs left out on each side, and one
    inside = (x[out - 1], x[len(x) - out]) if out > 0 else (-np.inf, np.inf)
    return Estimate(float(lower_median(x)), float(inside[0]), float(inside[1]))


def gain_over(
    first: ArrayLike, second: ArrayLike, *, seed: int, level: float = 0.95, resamples: int = 4000
) -> Estimate:
    """Return by how much the first median is below the second, 1 - first / second.

    The interval is a percentile bootstrap over the runs of both sets.

    Parameters
    ----------
    first, second : ArrayLike, shape (n,), (m,)
        Positive losses of the runs; infinite: it found nothing.
    seed : int
        Of the bootstrap.
    level : float
        Confidence.
    resamples : int
        Number of resamples.

    Returns
    -------
    Estimate
        Negative where the first is the greater one; 0 where both are infinite.
    """
    x, y = losses_of(first), losses_of(second)
    rng = np.random.default_rng(seed)
    drawn = [lower_median(z[rng.integers(len(z), size=(resamples, len(z)))]) for z in (x, y)]
    tail = (1.0 - level) / 2.0
    # interpolation between infinite values would give NaN
    low, high = np.quantile(_gain(*drawn), [tail, 1.0 - tail], method="inverted_cdf")
    return Estimate(float(_gain(lower_median(x), lower_median(y))), float(low), float(high))


def lower_median(values: ArrayLike) -> Array:
    """Return the median along the last axis, the lower of the middle two of an even number: one of the values.

    Parameters
    ----------
    values : ArrayLike, shape (..., n), n > 0
        Infinite ones count.

    Returns
    -------
    Array, shape (...)
    """
    return np.asarray(np.quantile(np.asarray(values), 0.5, axis=-1, method="inverted_cdf"))


def _gain(first: Array, second: Array) -> Array:
    with np.errstate(invalid="ignore"):  # infinity / infinity: both found nothing, and are alike
        return np.asarray(1.0 - np.where(np.isinf(first) & np.isinf(second), 1.0, first / second))
