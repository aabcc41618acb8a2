"""Two sets of runs on one instance: which is better, by how much, and whether it could be chance.

What is compared is a loss: the smaller, the better. A run that found nothing has an infinite loss, worse
than any other and as bad as another such run.

References
----------
Vargha A., Delaney H. D. (2000). A critique and improvement of the CL common language effect size
statistics of McGraw and Wong. J. Educational and Behavioral Statistics 25(2), 101-132.
Newcombe R. G. (2006). Confidence intervals for an effect size measure based on the Mann-Whitney
statistic. Part 2: asymptotic methods and evaluation. Statistics in Medicine 25, 559-573 (method 5).
Holm S. (1979). A simple sequentially rejective multiple test procedure. Scand. J. Statistics 6, 65-70.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import optimize, stats

from compare.statistics.needed import needed

Array = NDArray[np.float64]

_ENUMERATED = 4_000  # most arrangements that are counted one by one, where there are ties
_EXACT = 50  # most runs of a set for the exact distribution without ties


@dataclass(frozen=True)
class Pair:
    """Two sets of runs compared.

    Attributes
    ----------
    a12 : float
        Probability that a run of the first set is better than one of the second, ties counted half.
    low, high : float
        Its interval.
    p : float
        Two-sided Mann-Whitney test that neither is better.
    method : str
        ``exact``, or ``asymptotic`` with the correction for ties.
    """

    a12: float
    low: float
    high: float
    p: float
    method: str


def losses_of(values: ArrayLike) -> Array:
    """Return losses as an array.

    Parameters
    ----------
    values : ArrayLike, shape (n,)

    Returns
    -------
    Array, shape (n,)

    Raises
    ------
    ValueError
        There are none, or one is not a number.
    """
    losses = np.asarray(values, dtype=np.float64)
    if losses.ndim != 1 or losses.size == 0:
        raise ValueError(f"losses need the shape (n,), n > 0, got {losses.shape}")
    if np.isnan(losses).any():
        raise ValueError("a loss is NaN; a run that found nothing has an infinite loss")
    return losses


def superiority(first: ArrayLike, second: ArrayLike) -> float:
    """Return A12: the probability that a run of the first set has the smaller loss, ties counted half.

    Parameters
    ----------
    first : ArrayLike, shape (n,)
    second : ArrayLike, shape (m,)

    Returns
    -------
    float
    """
    x, y = losses_of(first), losses_of(second)
    ranks = stats.rankdata(np.concatenate([x, y]))[len(x) :]
    return float((ranks.sum() - len(y) * (len(y) + 1) / 2) / (len(x) * len(y)))


def compared(first: ArrayLike, second: ArrayLike, level: float = 0.95) -> Pair:
    """Compare two sets of runs on one instance.

    The test is exact where the sets are small: without ties by the distribution of the statistic, with
    ties by counting all arrangements of the runs (of two runs each at least). Beyond, it is the normal
    approximation with the corrections for ties and continuity.

    Parameters
    ----------
    first : ArrayLike, shape (n,)
        Losses.
    second : ArrayLike, shape (m,)
        Losses.
    level : float
        Confidence of the interval.

    Returns
    -------
    Pair
    """
    x, y = losses_of(first), losses_of(second)
    a12 = superiority(x, y)
    low, high = _interval(a12, len(x), len(y), level)
    both = np.concatenate([x, y])
    ranks = stats.rankdata(both)  # infinite losses too, which tie with each other
    tied = len(np.unique(both)) < len(both)
    given = (ranks[: len(x)], ranks[len(x) :])
    if not tied and max(len(x), len(y)) <= _EXACT:
        p, method = stats.mannwhitneyu(*given, method="exact").pvalue, "exact"
    elif min(len(x), len(y)) > 1 and (arrangements := comb(len(both), len(x))) <= _ENUMERATED:
        every = stats.PermutationMethod(n_resamples=arrangements)
        p, method = stats.mannwhitneyu(*given, method=every).pvalue, "exact"
    else:
        p, method = stats.mannwhitneyu(*given, method="asymptotic").pvalue, "asymptotic"
    return Pair(a12, low, high, 1.0 if np.isnan(p) else min(1.0, float(p)), method)


def _interval(a12: float, n: int, m: int, level: float) -> tuple[float, float]:
    """Newcombe's method 5: the values from which the seen one is no more than z deviations away."""
    z = stats.norm.ppf(0.5 + level / 2)

    def beyond(theta: float) -> float:
        mean = (n + m) / 2 - 1
        spread = 1 + mean * ((1 - theta) / (2 - theta) + theta / (1 + theta))
        return float((theta - a12) ** 2 - z**2 * theta * (1 - theta) * spread / (n * m))

    low = 0.0 if a12 <= 0 else optimize.brentq(beyond, 0.0, a12) if a12 < 1 else _root(beyond, 0.0, 1.0)
    high = (
        1.0 if a12 >= 1 else optimize.brentq(beyond, a12, 1.0) if a12 > 0 else _root(beyond, 1.0, 0.0)
    )
    return float(low), float(high)


def _root(beyond: Callable[[float], float], start: float, end: float) -> float:
    """The root between an end of [0, 1] and the seen value, which is the other end and a root too."""
    inside = end + (start - end) * 1e-12
    return float(optimize.brentq(beyond, *sorted((start, inside))))


def holm(p: ArrayLike) -> Array:
    """Return p-values that hold for all tests together (Holm).

    Parameters
    ----------
    p : ArrayLike, shape (k,)
        The p-value of each test alone.

    Returns
    -------
    Array, shape (k,)
        A test counts if its value is below the level.
    """
    alone = np.asarray(p, dtype=np.float64)
    if alone.size == 0:
        return alone
    multiple = needed("statsmodels.stats.multitest").multipletests
    return np.asarray(multiple(alone, method="holm")[1], dtype=np.float64)
