"""A verified motion below a certified bound contradicts a theorem: the comparison stops there."""

from __future__ import annotations

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row
from formulations.motion.verdict import TOLERANCE

# no motion that the check lets pass is faster than a certified bound by more (`least_verified`)
_BELOW = 10.0 * TOLERANCE


class BelowBoundError(Exception):
    """A verified motion is faster than a certified bound: a bug of this program, whoever found it."""


def broken_bound(seconds: float | None, ladder: LadderRecord) -> tuple[str, float] | None:
    """Find a certified bound that a verified motion is faster than.

    Parameters
    ----------
    seconds : float or None [s]
        Time of the motion; None where there is none.
    ladder : LadderRecord
        The bounds of its case.

    Returns
    -------
    (str, float [s]) or None
        Key and time of the bound; None if the motion is above all of them.
    """
    for key in ("family_lower", "free_form_lower"):
        rung = ladder["ladder"].get(key)
        least = rung["seconds"] if rung is not None and rung["certified"] else None
        if seconds is not None and least and seconds < least * (1.0 - _BELOW):
            return key, least
    return None


def require_above(row: Row, ladder: LadderRecord) -> None:
    """Stop at a verified motion that is faster than what is proved.

    Parameters
    ----------
    row : Row
    ladder : LadderRecord
        The bounds of its case.

    Raises
    ------
    BelowBoundError
        One of the two is wrong, and so is this program.
    """
    broken = broken_bound(row.seconds, ladder)
    if broken is not None:
        key, least = broken
        raise BelowBoundError(
            f"{row.case}, {row.variant}, {row.swarm}, seed {row.seed}: a motion that passed the check takes"
            f" {row.seconds:.12g} s, less than the certified bound of {least:.12g} s ({key}). This is a"
            f" bug of timebound; please report it with the digest {row.problem} and the durations"
            f" {list(row.durations)}"
        )
