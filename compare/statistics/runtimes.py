"""How long a search takes to reach a target: hitting times, and what is made of them.

A run that ends without having reached a target is right-censored: its hitting time is infinite, and it
is known to be longer than what the run spent. Nothing here drops such a run.

References
----------
Hansen N., Auger A., Ros R., et al. (2021). COCO: a platform for comparing continuous optimizers in a
black-box setting. Optimization Methods and Software 36(1), 114-144 (targets, runtimes, ERT, ECDF).
Wilson E. B. (1927). Probable inference, the law of succession, and statistical inference. JASA 22, 209-212.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Distribution:
    """An empirical distribution function, right-censored.

    Attributes
    ----------
    at : Array, shape (m,)
        Where it rises, increasing: evaluations.
    share : Array, shape (m,)
        SuccessShare of all runs and targets that were reached by then; the last value is below 1 where some
        were never reached.
    """

    at: Array
    share: Array


@dataclass(frozen=True)
class SuccessShare:
    """A share of runs that succeed, with its interval."""

    count: int
    of: int
    rate: float
    low: float
    high: float


@dataclass(frozen=True)
class ExpectedTime:
    """An expected running time in evaluations, with its interval; infinite where no run succeeded."""

    value: float
    low: float
    high: float
    successes: int
    runs: int


def targets_above(targets: ArrayLike, proved: float) -> Array:
    """Return the targets that are not below what is proved.

    Parameters
    ----------
    targets : ArrayLike, shape (m,)
        Gaps.
    proved : float
        The gap between the bound that gaps are measured against and the best motion known: closer to
        the bound than that, nobody knows whether there is a motion.

    Returns
    -------
    Array, shape (<= m,)
    """
    listed = np.asarray(targets, dtype=np.float64)
    return listed[listed >= proved]


def hitting_times(evaluations: ArrayLike, best: ArrayLike, optimum: float, targets: ArrayLike) -> Array:
    """Return how many evaluations a run needed to reach each target.

    Parameters
    ----------
    evaluations : ArrayLike, shape (n,)
        Numbers of evaluations at which the best value fell, increasing.
    best : ArrayLike, shape (n,) [s]
        Best value from there on, not increasing; infinite while nothing feasible was found.
    optimum : float [s]
        What gaps are measured against.
    targets : ArrayLike, shape (m,)
        Gaps: the target t is reached by a value of at most ``optimum * (1 + t)``.

    Returns
    -------
    Array, shape (m,)
        Infinite where the target was not reached.
    """
    steps, gaps = np.asarray(evaluations, dtype=np.float64), np.asarray(best) / optimum - 1.0
    reached = gaps[None, :] <= np.asarray(targets, dtype=np.float64)[:, None]
    first = reached.argmax(axis=1) if steps.size else np.zeros(len(reached), dtype=np.int64)
    return np.where(reached.any(axis=1), steps[first] if steps.size else np.inf, np.inf)


def fixed_target_ecdf(hits: ArrayLike) -> Distribution:
    """Return the share of runs and targets that are reached, against evaluations.

    Parameters
    ----------
    hits : ArrayLike, any shape
        Hitting times of all runs and targets; infinite: censored.

    Returns
    -------
    Distribution
    """
    every = np.asarray(hits, dtype=np.float64).ravel()
    if every.size == 0:
        raise ValueError("no hitting times: an empty set has no distribution")
    found = stats.ecdf(every[np.isfinite(every)]).cdf if np.isfinite(every).any() else None
    if found is None:
        return Distribution(np.empty(0), np.empty(0))
    scale = np.isfinite(every).mean()
    return Distribution(found.quantiles, found.probabilities * scale)


def mean_running_time(hits: ArrayLike, spent: ArrayLike) -> float:
    """Return the evaluations that restarts would need until the first success, on average.

    It is the sum of what all runs spent until they reached the target or ended, over the number of
    runs that reached it: each failure is charged its own budget.

    Parameters
    ----------
    hits : ArrayLike, shape (n,)
        Hitting time of each run for one target; infinite: it failed.
    spent : ArrayLike, shape (n,)
        Evaluations of each run.

    Returns
    -------
    float
        Infinite if no run succeeded.
    """
    return float(_time_per_success(*_paid(hits, spent)))


def expected_running_time(
    hits: ArrayLike, spent: ArrayLike, *, seed: int, level: float = 0.95, resamples: int = 2000
) -> ExpectedTime:
    """Return the mean running time of restarts with its interval.

    Parameters
    ----------
    hits : ArrayLike, shape (n,)
        Hitting time of each run for one target; infinite: it failed.
    spent : ArrayLike, shape (n,)
        Evaluations of each run.
    seed : int
        Of the bootstrap.
    level : float
        Confidence of the interval, a percentile bootstrap over the runs.
    resamples : int
        Number of resamples.

    Returns
    -------
    ExpectedTime
    """
    paid, success = _paid(hits, spent)
    value, successes = float(_time_per_success(paid, success)), int(success.sum())
    if len(paid) < 2 or not successes:
        return ExpectedTime(value, value, np.inf, successes, len(paid))
    # SciPy takes a standard error too, and a resample without a success is infinite
    with np.errstate(invalid="ignore"):
        made = stats.bootstrap(
            (paid, success),
            _time_per_success,
            paired=True,
            vectorized=True,
            method="percentile",
            n_resamples=resamples,
            rng=np.random.default_rng(seed),
        ).bootstrap_distribution
    tail = (1.0 - level) / 2.0
    # an interpolated quantile would turn infinite values into NaN
    low, high = np.quantile(made, [tail, 1.0 - tail], method="inverted_cdf")
    return ExpectedTime(value, float(low), float(high), successes, len(paid))


def _paid(hits: ArrayLike, spent: ArrayLike) -> tuple[Array, Array]:
    """What each run spent until it succeeded or ended, and 1 where it succeeded, else 0."""
    times = np.asarray(hits, dtype=np.float64)
    success = np.isfinite(times)
    paid = np.where(success, times, np.asarray(spent, dtype=np.float64))
    return paid, success.astype(np.float64)


def _time_per_success(paid: Array, success: Array, axis: int = -1) -> Array:
    with np.errstate(divide="ignore"):
        return np.asarray(paid.sum(axis=axis) / success.sum(axis=axis))


def success_rate(hits: ArrayLike, level: float = 0.95) -> SuccessShare:
    """Return the share of runs that reached a target, with its Wilson interval.

    Parameters
    ----------
    hits : ArrayLike, shape (n,)
        Hitting time of each run; infinite: it failed.
    level : float
        Confidence of the interval.

    Returns
    -------
    SuccessShare
    """
    reached = np.isfinite(np.asarray(hits, dtype=np.float64))
    count, of = int(reached.sum()), len(reached)
    interval = stats.binomtest(count, of).proportion_ci(level, method="wilson")
    return SuccessShare(count, of, count / of, float(interval.low), float(interval.high))


def area_over_curve(
    evaluations: ArrayLike,
    best: ArrayLike,
    optimum: float,
    budget: int,
    *,
    least: float = 1e-7,
    most: float = 1e1,
) -> float:
    """Return the area over the convergence curve: 1 is best, 0 is a run that never got below ``most``.

    The mean over all evaluations up to the budget of 1 - log(gap / least) / log(most / least), with the
    gap of the best so far kept between ``least`` and ``most``.

    Parameters
    ----------
    evaluations : ArrayLike, shape (n,)
        Numbers of evaluations at which the best value fell, increasing.
    best : ArrayLike, shape (n,) [s]
        Best value from there on.
    optimum : float [s]
        What gaps are measured against.
    budget : int
        Evaluations over which the mean is taken.
    least, most : float
        Gaps between which the curve counts.

    Returns
    -------
    float
    """
    steps = np.minimum(np.asarray(evaluations, dtype=np.float64), budget + 1.0)
    gaps = np.clip(np.asarray(best, dtype=np.float64) / optimum - 1.0, least, most)
    # the value found by evaluation e counts from e to the one before the next, both included
    lasts = np.diff(np.append(steps, budget + 1.0))
    height = 1.0 - np.log(gaps / least) / np.log(most / least)
    return float((lasts * height).sum() / budget)
