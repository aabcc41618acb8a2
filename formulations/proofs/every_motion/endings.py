"""How a search for a bound ends, in words."""

from __future__ import annotations

from typing import NamedTuple

from formulations.deadlines import Deadline
from formulations.proofs.every_motion.relaxation.linear_program import LPSolution, LPStatus
from formulations.proofs.status import BoundStatus


class Ending(NamedTuple):
    """A status and, where it needs one, its reason."""

    status: BoundStatus
    reason: str = ""


def why(solution: LPSolution) -> str:
    """Say why HiGHS has no answer.

    Parameters
    ----------
    solution : LPSolution

    Returns
    -------
    str
    """
    if solution.status == LPStatus.REFUSED or solution.reason == "Not Set":
        return "the numbers are too far apart for HiGHS"
    return f"HiGHS ended with {solution.reason.lower()}"


def out_of_time(deadline: Deadline) -> Ending:
    """Say who ended the search.

    Parameters
    ----------
    deadline : Deadline

    Returns
    -------
    Ending
    """
    return Ending(BoundStatus.INTERRUPTED if deadline.interrupted else BoundStatus.TIME_LIMIT)
