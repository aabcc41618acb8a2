"""How many seeds a comparison needs: where the present number cannot show anything, it is said.

References
----------
Noether G. E. (1987). Sample size determination for some common nonparametric tests. JASA 82, 645-647.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count
from math import ceil, comb

from scipy import stats


@dataclass(frozen=True)
class SeedsNeeded:
    """Seeds of each swarm for a Mann-Whitney test on one instance, Holm-corrected over some.

    Attributes
    ----------
    seeds : int
        The present number.
    least_p : float
        The least p-value that so many seeds can give, after Holm.
    possible : bool
        Whether that is below the level: otherwise no outcome can be significant.
    least_seeds : int
        The least number whose outcome can be significant at all.
    for_effect : int or None
        The number that shows an effect as large as the one seen with the stated power; None if the
        effect is none.
    """

    seeds: int
    least_p: float
    possible: bool
    least_seeds: int
    for_effect: int | None


def least_p(n: int, m: int) -> float:
    """Return the least p-value of an exact two-sided Mann-Whitney test.

    Parameters
    ----------
    n, m : int
        Numbers of runs.

    Returns
    -------
    float
        Two of the C(n + m, n) arrangements separate the two sets.
    """
    return min(1.0, 2.0 / comb(n + m, n))


def least_seeds(tests: int, alpha: float = 0.05) -> int:
    """Return the least number of seeds that can be significant on one instance.

    Parameters
    ----------
    tests : int
        Number of instances over which Holm corrects.
    alpha : float
        Level.

    Returns
    -------
    int
    """
    return next(n for n in count(1) if tests * least_p(n, n) < alpha)


def seeds_for_effect(a12: float, tests: int = 1, alpha: float = 0.05, power: float = 0.8) -> int | None:
    """Return the number of seeds of each swarm that shows an effect (Noether 1987, equal numbers).

    Parameters
    ----------
    a12 : float
        The effect.
    tests : int
        Number of instances over which Holm corrects; the first of its steps is assumed.
    alpha : float
        Level.
    power : float
        Probability that the test finds the effect.

    Returns
    -------
    int or None
        None for no effect, a12 = 1/2.
    """
    if a12 == 0.5:
        return None
    # N = z^2 / (12 c (1 - c) (p - 1/2)^2) in all, c = 1/2; half of it each
    noether = ceil(_quantiles(tests, alpha, power) ** 2 / (6 * (a12 - 0.5) ** 2))
    return max(noether, least_seeds(tests, alpha))


def least_effect(seeds: int, tests: int = 1, alpha: float = 0.05, power: float = 0.8) -> float | None:
    """Return the least effect that so many seeds of each swarm show: the inverse of ``seeds_for_effect``.

    Parameters
    ----------
    seeds : int
        Of each swarm.
    tests : int
        Number of instances over which Holm corrects.
    alpha : float
        Level.
    power : float
        Probability that the test finds the effect.

    Returns
    -------
    float or None
        A12 above 1/2; None if Noether's formula asks for more seeds even where each run of one swarm is better.
    """
    found = 0.5 + _quantiles(tests, alpha, power) / (6 * seeds) ** 0.5
    return found if found <= 1.0 and seeds >= least_seeds(tests, alpha) else None


def _quantiles(tests: int, alpha: float, power: float) -> float:
    """Sum of the normal quantiles of level and power."""
    return float(stats.norm.ppf(1 - alpha / (2 * tests)) + stats.norm.ppf(power))


def seeds_needed(
    seeds: int, a12: float, tests: int, alpha: float = 0.05, power: float = 0.8
) -> SeedsNeeded:
    """Say whether so many seeds can show anything, and how many would.

    Parameters
    ----------
    seeds : int
        The present number, the same for both swarms.
    a12 : float
        The effect seen.
    tests : int
        Number of instances over which Holm corrects.
    alpha : float
        Level.
    power : float
        Probability that the test finds the effect.

    Returns
    -------
    SeedsNeeded
    """
    least = min(1.0, tests * least_p(seeds, seeds))
    return SeedsNeeded(
        seeds,
        least,
        least < alpha,
        least_seeds(tests, alpha),
        seeds_for_effect(a12, tests, alpha, power),
    )
