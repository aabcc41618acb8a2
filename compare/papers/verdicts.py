"""Verdicts on what a paper prints, computed from the numbers beside them.

Every sentence of a page that judges ("not reproduced", "as the text says") takes its outcome from a
function of this module, so that it follows when the numbers change. The thresholds stand here, once.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from itertools import pairwise
from math import inf, sqrt

SAME = 0.01
"""Two times count as the same if they differ by at most this, relative."""
CLOSE = 0.25
"""Two gains count as the same if they differ by at most this, relative."""
NO_GAIN = 1e-3
"""A method that is shorter by less than this, relative, has gained nothing."""
WIDTH = 1.96
"""Standard deviations that a share of wins has to be away from one half to show a difference."""
AT_A_LIMIT = 0.01
"""A peak is at a limit if it differs from it by at most this, relative."""
BEST = 1e-3
"""A time is at the optimum if it differs from it by at most this, relative."""
UNUSED = 0.01
"""A motion leaves its limits unused if it could be faster by at least this, relative."""
SMOOTH = 1e-6
"""Jumps and end values up to this are rounding [rad, rad/s, rad/s^2, or the same in deg]."""


class Reproduction(StrEnum):
    """What is left of something printed; the text begins a sentence."""

    REPRODUCED = "Reproduced"
    IN_KIND = "Reproduced in kind"
    NOT = "Not reproduced"
    UNDECIDED = "Not decided by these runs"

    @property
    def inside(self) -> str:
        """The outcome within a sentence: not reproduced."""
        return self.value[0].lower() + self.value[1:]


def held(holds: bool) -> Reproduction:
    """Judge something printed that either holds or does not.

    Parameters
    ----------
    holds : bool
        Whether it does.

    Returns
    -------
    Reproduction
    """
    return Reproduction.REPRODUCED if holds else Reproduction.NOT


def same_times(
    printed: Sequence[float], found: Sequence[float], impossible: Sequence[bool] = ()
) -> Reproduction:
    """Judge printed times by reproduced ones.

    Parameters
    ----------
    printed, found : sequence of float [s]
        In the same order.
    impossible : sequence of bool
        Whether each printed time is proved to be too short for the limits.

    Returns
    -------
    Reproduction
        Not reproduced if a printed time is impossible or differs by more than ``SAME``.
    """
    if any(impossible):
        return Reproduction.NOT
    return held(all(abs(f / p - 1.0) <= SAME for p, f in zip(printed, found, strict=True)))


def same_gain(printed: float, found: float) -> Reproduction:
    """Judge by how much one method is better than another.

    Parameters
    ----------
    printed, found : float
        1 - better / other; negative if it is worse.

    Returns
    -------
    Reproduction
        Reproduced if both differ by at most ``CLOSE``; in kind if the same method is better, by at least
        ``NO_GAIN``.
    """
    if abs(found - printed) <= CLOSE * abs(printed):
        return Reproduction.REPRODUCED
    return Reproduction.IN_KIND if found * printed > 0.0 and abs(found) >= NO_GAIN else Reproduction.NOT


def shown_gain(printed: float, found: float, low: float, high: float) -> Reproduction:
    """Judge a gain that was measured by runs, with the interval that they leave.

    Parameters
    ----------
    printed, found : float
        As for ``same_gain``.
    low, high : float
        The interval of ``found``.

    Returns
    -------
    Reproduction
        Not decided if the interval has both signs in it; else as ``same_gain``.
    """
    return Reproduction.UNDECIDED if low <= 0.0 <= high else same_gain(printed, found)


def same_gains(printed: Sequence[float], found: Sequence[float]) -> Reproduction:
    """Judge several gains together.

    Parameters
    ----------
    printed, found : sequence of float
        As for ``same_gain``, in the same order.

    Returns
    -------
    Reproduction
        The worst of the single outcomes.
    """
    order = (Reproduction.NOT, Reproduction.IN_KIND, Reproduction.REPRODUCED)
    return min((same_gain(p, f) for p, f in zip(printed, found, strict=True)), key=order.index)


def same_order(values: Sequence[float]) -> Reproduction:
    """Judge a printed order of methods, best first.

    Parameters
    ----------
    values : sequence of float
        What was found for each, in the printed order; smaller is better.

    Returns
    -------
    Reproduction
    """
    return held(all(a < b for a, b in pairwise(values)))


def pairs_won(one: Sequence[float | None], other: Sequence[float | None]) -> float:
    """Count the pairs of runs in which the first one is shorter.

    Parameters
    ----------
    one, other : sequence of (float or None) [s]
        Times in pairs; None, for a run without a feasible motion, is longer than any time.

    Returns
    -------
    float
        A tie counts half.
    """
    pairs = [
        (inf if a is None else a, inf if b is None else b) for a, b in zip(one, other, strict=True)
    ]
    return sum(1.0 if a < b else 0.5 if a == b else 0.0 for a, b in pairs)


def more_often(share: float, pairs: int) -> str:
    """Say whether one of two is the better one, by the share of pairs in which it is.

    Parameters
    ----------
    share : float
        From 0 to 1; 0.5 is no difference.
    pairs : int
        How many independent pairs there are.

    Returns
    -------
    str
        more often, less often, or not more often beyond chance.
    """
    if _by_chance(share, pairs):
        return "not more often beyond chance"
    return "more often" if share > 0.5 else "less often"


def _by_chance(share: float, pairs: int) -> bool:
    return abs(share - 0.5) <= WIDTH * 0.5 / sqrt(pairs)


def seen_in_pairs(share: float, pairs: int, *, clear: bool) -> Reproduction:
    """Judge a printed pair, of which one is the better one, by many such pairs.

    Parameters
    ----------
    share : float
        Of pairs in which the same one is better; 0.5 is no difference.
    pairs : int
        How many independent pairs there are.
    clear : bool
        Whether one pair is enough to tell both apart in most cases.

    Returns
    -------
    Reproduction
        In kind if the same one is better, but so little that one pair shows nothing.
    """
    if _by_chance(share, pairs):
        return Reproduction.UNDECIDED
    if share < 0.5:
        return Reproduction.NOT
    return Reproduction.REPRODUCED if clear else Reproduction.IN_KIND


def counted(outcomes: Sequence[Reproduction]) -> str:
    """Say how many results have which outcome: 1 of 3 reproduced, 2 of 3 not reproduced.

    Parameters
    ----------
    outcomes : sequence of Reproduction
        One alone is named without a number.

    Returns
    -------
    str
        nothing to judge, if there is none.
    """
    if not outcomes:
        return "nothing to judge"
    if len(outcomes) == 1:
        return outcomes[0].inside
    found = {outcome: list(outcomes).count(outcome) for outcome in Reproduction}
    return ", ".join(f"{n} of {len(outcomes)} {outcome.inside}" for outcome, n in found.items() if n)


def agrees(holds: bool) -> str:
    """Say whether the paper's own words hold.

    Parameters
    ----------
    holds : bool
        Whether it does.

    Returns
    -------
    str
        as the paper says, or unlike what the paper says.
    """
    return "as the paper says" if holds else "unlike what the paper says"


def yes_no(holds: bool) -> str:
    """Yes or no.

    Parameters
    ----------
    holds : bool
        Whether it does.

    Returns
    -------
    str
    """
    return "yes" if holds else "no"


def smooth(*values: float) -> bool:
    """Whether jumps or end values are zero up to rounding.

    Parameters
    ----------
    *values : float
        Each has to be zero.

    Returns
    -------
    bool
    """
    return all(abs(value) <= SMOOTH for value in values)
