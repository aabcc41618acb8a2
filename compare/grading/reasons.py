"""Where a swarm wins, and why: features of the instances that go with its advantage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import stats

from compare.grading.contest import ALPHA, Contest, DuelOutcome
from compare.statistics.pairs import holm
from formulations import Problem

Features = Mapping[str, float | None]

NAMES = {
    "dimension": "number of segments",
    "joints": "number of joints that move",
    "active": "number of limits that the optimum reaches",
    "basins": "number of local optima found",
    "conditioning": "conditioning",
}
"""Features of an instance, in words."""
_ENOUGH = 5  # instances, for a correlation


@dataclass(frozen=True)
class Reason:
    """How one feature goes with the advantage, over the instances.

    Attributes
    ----------
    feature : str
    correlation : float
        Spearman's rank correlation of the feature and A12.
    p : float
        Of it, Holm-corrected over the features.
    values : tuple of (float, int, int, int)
        Value of the feature, and the wins, losses and ties of the instances that have it; the halves
        below and above the median, by their greatest value, where there are many values.
    """

    feature: str
    correlation: float
    p: float
    values: tuple[tuple[float, int, int, int], ...]

    @property
    def sentence(self) -> str:
        """What the feature says."""
        more = "larger" if self.correlation > 0 else "smaller"
        if {value for value, *_ in self.values} == {0.0, 1.0}:
            return f"Its advantage is {more} with {self.feature} than without (p = {self.p:.1g})."
        return (
            f"Its advantage is the {more}, the larger the {self.feature} (rank correlation"
            f" {self.correlation:.2f}, p = {self.p:.1g})."
        )


def features_of(problem: Problem, described: Features) -> dict[str, float]:
    """Return the features of an instance by name in words.

    Parameters
    ----------
    problem : Problem
    described : mapping of str to float
        What its proof found, as `compare.benchmark.suite.features` names it; None where it found none.

    Returns
    -------
    dict of str to float
        NaN for what was not found.
    """
    limits = problem.limits
    found = {words: described.get(name) for name, words in NAMES.items()}
    return {
        **{words: np.nan if value is None else float(value) for words, value in found.items()},
        "jerk limits": float(np.isfinite(limits.jerk).any()),
        "position limits": float(limits.has_position),
    }


def reasons(contest: Contest, features: Mapping[str, Features]) -> list[Reason]:
    """Relate the advantage on each instance to the features of the instances.

    Parameters
    ----------
    contest : Contest
    features : mapping of str to mapping of str to float
        By instance, the same features for all.

    Returns
    -------
    list of Reason
        One per feature that varies, the strongest first; none of fewer than five instances.
    """
    names = [duel.instance for duel in contest.duels]
    if len(names) < _ENOUGH:
        return []
    a12 = np.array([duel.pair.a12 for duel in contest.duels])
    found = []
    for feature in features[names[0]]:
        column = np.array([features[name][feature] for name in names], dtype=np.float64)
        if np.isfinite(column).all() and np.ptp(column) > 0 and np.ptp(a12) > 0:
            related = stats.spearmanr(column, a12)
            table = _table(column, [duel.outcome for duel in contest.duels])
            found.append((feature, float(related.statistic), float(related.pvalue), table))
    together = holm([p for _, _, p, _ in found])
    made = [Reason(f, r, float(p), t) for (f, r, _, t), p in zip(found, together, strict=True)]
    return sorted(made, key=lambda reason: (reason.p, -abs(reason.correlation)))


def telling(found: list[Reason]) -> list[Reason]:
    """Return the reasons that are significant.

    Parameters
    ----------
    found : list of Reason

    Returns
    -------
    list of Reason
    """
    return [reason for reason in found if reason.p < ALPHA]


def _table(column: np.ndarray, outcomes: list[DuelOutcome]) -> tuple[tuple[float, int, int, int], ...]:
    """Wins, losses and ties by value of a feature."""
    values = np.unique(column)
    ends = values if len(values) <= 6 else np.unique([np.median(column), column.max()])
    lower, lines = -np.inf, []
    for end in ends:
        mine = [o for o, v in zip(outcomes, column, strict=True) if lower < v <= end]
        lines.append(
            (
                float(end),
                *(mine.count(kind) for kind in (DuelOutcome.win, DuelOutcome.loss, DuelOutcome.tie)),
            )
        )
        lower = end
    return tuple(lines)  # type: ignore[arg-type]
