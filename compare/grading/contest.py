"""Two swarms over all instances, and the rule that makes a verdict of what is seen.

The rule. On each instance A12 is the probability that a run of the swarm beats a run of the other one.
Over the instances there is its mean with the interval of two one-sided tests at 5 %, and Wilcoxon's
signed-rank test that A12 lies on neither side of 1/2.

equal      the interval lies within 0.44 and 0.56: whatever the difference is, it is negligible
better     not equal, p < 5 %, and the mean is above 1/2
worse      not equal, p < 5 %, and the mean is below 1/2
undecided  none of these: more seeds or more instances are needed

A win is an instance on which the Mann-Whitney test, Holm-corrected over all instances, is below 5 % and A12
is above 1/2; a loss is the same below 1/2; all others are ties.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from compare.grading.cells import Cell
from compare.statistics.cells import complete
from compare.statistics.equivalence import (
    Effect,
    PracticalEquality,
    effect_over_instances,
    practically_equal,
)
from compare.statistics.pairs import Pair, compared, holm
from compare.statistics.seeds import SeedsNeeded, seeds_needed

ALPHA = 0.05


class SwarmVerdict(StrEnum):
    """What is said of a swarm beside another one."""

    better = "better"
    worse = "worse"
    equal = "equal"
    undecided = "undecided"


class DuelOutcome(StrEnum):
    """What is said of one instance."""

    win = "win"
    loss = "loss"
    tie = "tie"


@dataclass(frozen=True)
class Duel:
    """Two swarms on one instance: their median gaps, the comparison, and its p-value after Holm."""

    instance: str
    gap: float
    other_gap: float
    pair: Pair
    p: float

    @property
    def outcome(self) -> DuelOutcome:
        """Whether it is significant, and who wins."""
        if self.p >= ALPHA or self.pair.a12 == 0.5:
            return DuelOutcome.tie
        return DuelOutcome.win if self.pair.a12 > 0.5 else DuelOutcome.loss


@dataclass(frozen=True)
class Contest:
    """Two swarms over all instances.

    Attributes
    ----------
    duels : tuple of Duel
        One per instance, in their order.
    effect : Effect
        Over all of them.
    practical : PracticalEquality
        Whether a user of the motions would notice.
    needed : SeedsNeeded
        How many seeds a significant instance takes.
    """

    duels: tuple[Duel, ...]
    effect: Effect
    practical: PracticalEquality
    needed: SeedsNeeded

    @property
    def verdict(self) -> SwarmVerdict:
        """By the rule at the head of this file."""
        if self.effect.negligible:
            return SwarmVerdict.equal
        if self.effect.p >= ALPHA:
            return SwarmVerdict.undecided
        return SwarmVerdict.better if self.effect.mean > 0.5 else SwarmVerdict.worse

    @property
    def counts(self) -> tuple[int, int, int]:
        """Wins, losses, ties."""
        found = [duel.outcome for duel in self.duels]
        return found.count(DuelOutcome.win), found.count(DuelOutcome.loss), found.count(DuelOutcome.tie)

    @property
    def gaps(self) -> tuple[float, float]:
        """Median over the instances of the median gaps, of the swarm and of the other one."""
        return middle([d.gap for d in self.duels]), middle([d.other_gap for d in self.duels])


def middle(values: Sequence[float]) -> float:
    """Return the median, the upper of the middle two of an even number, which may be infinite.

    Parameters
    ----------
    values : sequence of float

    Returns
    -------
    float
    """
    return float(np.quantile(np.asarray(values), 0.5, method="higher"))


def contest(mine: Mapping[str, Cell], other: Mapping[str, Cell], *, seed: int = 0) -> Contest:
    """Compare two swarms over all instances.

    Parameters
    ----------
    mine, other : mapping of str to Cell
        By instance, the same ones with the same number of runs each.
    seed : int
        Of the samples of the posterior.

    Returns
    -------
    Contest

    Raises
    ------
    MissingCellError
        If an instance has fewer runs than the first one; it is named.
    """
    instances = list(dict.fromkeys([*mine, *other]))
    runs = len(next(iter(mine.values())))
    named: dict[tuple[str, str], Sequence[object]] = {
        (instance, which): cells[instance].rows
        for which, cells in (("the swarm", mine), ("the other", other))
        for instance in cells
    }
    complete(named, instances, ["the swarm", "the other"], runs)
    pairs = [compared(mine[name].losses, other[name].losses) for name in instances]
    together = holm([pair.p for pair in pairs])
    duels = tuple(
        Duel(name, mine[name].gap, other[name].gap, pair, float(p))
        for name, pair, p in zip(instances, pairs, together, strict=True)
    )
    effect = effect_over_instances([pair.a12 for pair in pairs], runs, runs, ALPHA)
    return Contest(
        duels,
        effect,
        practically_equal([d.gap for d in duels], [d.other_gap for d in duels], seed=seed),
        seeds_needed(runs, effect.mean, len(duels), ALPHA),
    )
