"""How the search for a bound ended."""

from __future__ import annotations

from typing import NamedTuple

from formulations.deadlines import Deadline
from formulations.proofs.every_motion.relaxation.linear_program import LPSolution, LPStatus
from formulations.proofs.status import BoundStatus


class Ending(NamedTuple):
    """A status and, where it needs one, its reason."""

    status: BoundStatus
    reason: str = ""


def out_of_time(deadline: Deadline) -> Ending:
    """Say whether the time was over or somebody ended the search.

    Parameters
    ----------
    deadline : Deadline

    Returns
    -------
    Ending
    """
    return Ending(BoundStatus.INTERRUPTED if deadline.interrupted else BoundStatus.TIME_LIMIT)


def unsolved(solution: LPSolution) -> Ending:
    """Say why a linear program was not solved.

    Parameters
    ----------
    solution : LPSolution

    Returns
    -------
    Ending
    """
    why = f"HiGHS ended with {solution.reason.lower()}"
    if solution.status == LPStatus.REFUSED or solution.reason == "Not Set":
        why = "the numbers are too far apart for HiGHS"
    return Ending(BoundStatus.SOLVER_FAILED, why)
