"""Several algorithms over several instances: ranks, and which of them differ.

References
----------
Demsar J. (2006). Statistical comparisons of classifiers over multiple data sets. JMLR 7, 1-30.
Benavoli A., Corani G., Mangili F. (2016). Should we really use post-hoc tests based on mean-ranks?
JMLR 17(5), 1-10 (why pairs are judged by Wilcoxon, and the diagram is for display).
Dolan E. D., More J. J. (2002). Benchmarking optimization software with performance profiles.
Mathematical Programming 91, 201-213.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from compare.statistics.needed import needed

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Ranks:
    """Mean ranks of algorithms over instances.

    Attributes
    ----------
    mean : Array, shape (k,)
        1 is best.
    p : float
        Friedman's test that all are alike.
    difference : float
        The critical difference of two mean ranks (Nemenyi).
    pairs : Array, shape (k, k)
        p-value of each pair by Nemenyi's test.
    groups : tuple of tuple of int
        Sets of algorithms that the diagram ties together, by their numbers, best first.
    """

    mean: Array
    p: float
    difference: float
    pairs: Array
    groups: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, eq=False)
class Profile:
    """Performance profiles: at each ratio, the share of instances within it of the best.

    Attributes
    ----------
    ratios : Array, shape (m,)
    share : Array, shape (k, m)
    """

    ratios: Array
    share: Array


def table_of(values: ArrayLike) -> Array:
    """Return a table of losses as an array.

    Parameters
    ----------
    values : ArrayLike, shape (n_instances, k)

    Returns
    -------
    Array, shape (n_instances, k)

    Raises
    ------
    ValueError
        It is no such table, or a cell is not a number; the message names the cell.
    """
    table = np.asarray(values, dtype=np.float64)
    if table.ndim != 2 or table.shape[1] < 2 or table.shape[0] < 1:
        raise ValueError(f"a table (instances, algorithms >= 2) is needed, got {table.shape}")
    if np.isnan(table).any():
        row, column = np.argwhere(np.isnan(table))[0]
        raise ValueError(f"the cell of instance {row} and algorithm {column} is missing")
    return table


def ranks(values: ArrayLike, alpha: float = 0.05) -> Ranks:
    """Rank algorithms on each instance and say which mean ranks differ.

    Parameters
    ----------
    values : ArrayLike, shape (n_instances, k)
        Losses; infinite ones tie as the worst.
    alpha : float
        Level of the critical difference.

    Returns
    -------
    Ranks
    """
    table = table_of(values)
    n, k = table.shape
    each = stats.rankdata(table, axis=1)
    mean = each.mean(axis=0)
    if k < 3 or np.ptp(each) == 0:  # Friedman's test of two is the sign test
        p = 1.0 if np.ptp(each) == 0 else signed_rank(each[:, 0] - each[:, 1])
    else:
        p = float(stats.friedmanchisquare(*each.T).pvalue)
    nemenyi = needed("scikit_posthocs").posthoc_nemenyi_friedman
    pairs = np.asarray(nemenyi(each), dtype=np.float64)
    quantile = stats.studentized_range.ppf(1 - alpha, k, np.inf) / np.sqrt(2)
    difference = float(quantile * np.sqrt(k * (k + 1) / (6 * n)))
    return Ranks(mean, p, difference, pairs, _groups(mean, difference))


def _groups(mean: Array, difference: float) -> tuple[tuple[int, ...], ...]:
    """Longest rows of neighbours whose mean ranks lie within the critical difference."""
    order = np.argsort(mean, kind="stable")
    found: list[tuple[int, ...]] = []
    for i in range(len(order)):
        last = max(j for j in range(i, len(order)) if mean[order[j]] - mean[order[i]] < difference)
        row = tuple(int(one) for one in order[i : last + 1])
        if len(row) > 1 and not any(set(row) <= set(other) for other in found):
            found.append(row)
    return tuple(found)


def signed_rank(differences: ArrayLike) -> float:
    """Return the p-value of Wilcoxon's signed-rank test, two-sided.

    It is exact where the differences are few. Differences of zero are ranked and then dropped (Pratt).

    Parameters
    ----------
    differences : ArrayLike, shape (n_instances,)
        One per instance, finite.

    Returns
    -------
    float
        1 if every difference is zero.
    """
    listed = np.asarray(differences, dtype=np.float64)
    if listed.ndim != 1 or listed.size == 0 or not np.isfinite(listed).all():
        raise ValueError("finite differences of the shape (n,), n > 0, are needed")
    if not listed.any():
        return 1.0
    size = np.abs(listed)
    tied = len(np.unique(size)) < len(size) or not size.all()
    if not tied and len(size) <= 50:
        method: object = "exact"
    elif len(size) <= 10:  # all signs are tried: 1024 at most
        method = stats.PermutationMethod(n_resamples=2 ** len(size))
    else:
        method = "asymptotic"
    return min(1.0, float(stats.wilcoxon(listed, zero_method="pratt", method=method).pvalue))


def performance_profile(costs: ArrayLike, points: int = 200) -> Profile:
    """Return the share of instances on which each algorithm costs at most r times the least.

    Parameters
    ----------
    costs : ArrayLike, shape (n_instances, k)
        Positive; infinite: not solved.
    points : int
        Number of ratios.

    Returns
    -------
    Profile
        Ratios from 1, spaced logarithmically, up to the largest finite one. An instance that nobody
        solved counts as solved by nobody.
    """
    table = table_of(costs)
    if (table <= 0).any():
        raise ValueError("costs are positive")
    least = table.min(axis=1, keepdims=True)
    with np.errstate(invalid="ignore"):
        ratio = np.where(np.isfinite(table), table / least, np.inf)
    finite = ratio[np.isfinite(ratio)]
    most = float(finite.max()) if finite.size else 1.0
    ratios = np.geomspace(1.0, max(most, 1.0 + 1e-9), points)
    ratios[-1] = max(most, ratios[-1])
    share = (ratio.T[:, :, None] <= ratios).mean(axis=1)
    return Profile(ratios, share)
