"""A verified motion below a certified bound contradicts a theorem: the comparison stops there."""

from __future__ import annotations

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rejudge import BELOW
from compare.benchmark.records.rows import Row


class BelowBoundError(Exception):
    """A verified motion is faster than a certified bound: a bug of this program, whoever found it."""


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
    for key in ("family_lower", "free_form_lower"):
        rung = ladder["ladder"].get(key)
        least = rung["seconds"] if rung is not None and rung["certified"] else None
        if row.seconds is not None and least and row.seconds < least * (1.0 - BELOW):
            raise BelowBoundError(
                f"{row.case}, {row.variant}, {row.swarm}, seed {row.seed}: a motion that passed the check takes"
                f" {row.seconds:.12g} s, less than the certified bound of {least:.12g} s ({key}). This is a"
                f" bug of timebound; please report it with the digest {row.problem} and the durations"
                f" {list(row.durations)}"
            )
