"""Better, worse, or alike over all instances: the effect with its interval, and regions of equivalence.

Two regions, for two questions. Is one swarm the better searcher? The probability that a run of one beats a
run of the other, averaged over the instances, is compared with [0.44, 0.56], which Vargha and Delaney (2000)
call negligible. Would a user of the motions notice? The median gaps are compared with 0.1 %.

References
----------
Benavoli A., Corani G., Demsar J., Zaffalon M. (2017). Time for a change: a tutorial for comparing multiple
classifiers through Bayesian analysis. JMLR 18(77), 1-36.
Schuirmann D. J. (1987). A comparison of the two one-sided tests procedure and the power approach for
assessing the equivalence of average bioavailability. J. Pharmacokinetics and Biopharmaceutics 15, 657-680.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from compare.statistics.instances import signed_rank
from compare.statistics.needed import needed

Array = NDArray[np.float64]

NEGLIGIBLE = 0.06
"""Distance of A12 from 1/2 below which an effect is negligible (Vargha & Delaney 2000)."""
REGION = 1e-3
"""Difference of gaps that no user of a motion notices: 0.1 % of its time."""


@dataclass(frozen=True)
class Effect:
    """The probability that a run of one swarm beats a run of another, over all instances.

    Attributes
    ----------
    mean : float
        Mean of A12 over the instances.
    low, high : float
        Its interval at ``1 - 2 alpha``, that of two one-sided tests at ``alpha``.
    p : float
        Wilcoxon's signed-rank test over the instances that A12 lies on either side of 1/2.
    alpha : float
        The level.
    """

    mean: float
    low: float
    high: float
    p: float
    alpha: float

    @property
    def negligible(self) -> bool:
        """Whether the interval lies in the region of equivalence."""
        return self.low > 0.5 - NEGLIGIBLE and self.high < 0.5 + NEGLIGIBLE


def effect_over_instances(a12: ArrayLike, n: int, m: int, alpha: float = 0.05) -> Effect:
    """Return the mean effect over instances with its interval.

    The variance of the mean is estimated from the spread of A12 over the instances, and is never taken
    to be less than what the numbers of runs cause alone, (n + m + 1) / (12 n m) per instance.

    Parameters
    ----------
    a12 : ArrayLike, shape (n_instances,)
        The effect on each instance.
    n, m : int
        Numbers of runs on each instance.
    alpha : float
        Level of each one-sided test.

    Returns
    -------
    Effect
    """
    each = np.asarray(a12, dtype=np.float64)
    if each.ndim != 1 or each.size == 0 or not np.isfinite(each).all():
        raise ValueError("an effect for each instance is needed")
    mean, runs_alone = float(each.mean()), (n + m + 1) / (12 * n * m)
    seen = float(each.var(ddof=1)) if len(each) > 1 else np.inf
    error = np.sqrt(max(seen, runs_alone) / len(each))
    width = stats.t.ppf(1 - alpha, len(each) - 1) * error if len(each) > 1 else np.inf
    low, high = max(0.0, mean - width), min(1.0, mean + width)
    return Effect(mean, float(low), float(high), signed_rank(each - 0.5), alpha)


@dataclass(frozen=True)
class PracticalEquality:
    """Posterior probabilities that the first gap is lower, that both are equal in practice, or higher."""

    lower: float
    equal: float
    higher: float
    region: float


def practically_equal(
    first: ArrayLike, second: ArrayLike, *, seed: int, region: float = REGION, samples: int = 20_000
) -> PracticalEquality:
    """Return how probable it is that two swarms' motions are equally fast in practice.

    The Bayesian signed-rank test over the instances with a region of practical equivalence.

    Parameters
    ----------
    first, second : ArrayLike, shape (n_instances,)
        Median gap on each instance; infinite where most runs found nothing.
    seed : int
        Of the posterior samples.
    region : float
        Difference of gaps that is no difference.
    samples : int
        Number of posterior samples.

    Returns
    -------
    PracticalEquality
    """
    x, y = np.asarray(first, dtype=np.float64), np.asarray(second, dtype=np.float64)
    if x.shape != y.shape or x.ndim != 1 or x.size == 0:
        raise ValueError(f"one gap each per instance is needed, got {x.shape} and {y.shape}")
    finite = np.concatenate([x, y])
    finite = finite[np.isfinite(finite)]
    # a miss is farther from any gap than two gaps are from each other
    most = 2.0 * float(np.abs(finite).max(initial=0.0)) + 1.0
    x, y = np.minimum(x, most), np.minimum(y, most)
    test = needed("baycomp").two_on_multiple
    # the first column of the answer is "x larger": there the second gap is lower
    higher, equal, lower = test(x, y, rope=region, nsamples=samples, random_state=seed)
    return PracticalEquality(float(lower), float(equal), float(higher), region)
