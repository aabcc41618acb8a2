"""One step of the search for the fastest motion, and the judgement of what its solver returned."""

from __future__ import annotations

from dataclasses import dataclass

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.free_form.faults import finite, least_stretch
from formulations.optima.free_form.nlp.arcs import ArcMotion
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem

_STRETCHES = 10  # attempts, the last with a margin of 1e-5


@dataclass(frozen=True)
class Stage:
    """One step of the search.

    Attributes
    ----------
    name : str
    seconds : float [s]
        Time of its motion, infinite if the check refused it.
    status : str
        Why the check refused it, or how the solver ended.
    runtime : float [s]
    """

    name: str
    seconds: float
    status: str
    runtime: float


@dataclass(frozen=True)
class VerifiedMotion:
    """A motion that has passed the check, with the name of its stage."""

    name: str
    motion: ArcMotion
    trajectory: Trajectory
    verdict: Verdict


def judged(task: ConditionedProblem, name: str, motion: ArcMotion) -> tuple[VerifiedMotion | None, str]:
    """Judge what a solver returned, slowed down by the least factor that keeps its limits.

    Parameters
    ----------
    task : ConditionedProblem
    name : str
        Of the stage.
    motion : ArcMotion

    Returns
    -------
    found : VerifiedMotion or None
        None if the check refuses the motion.
    reason : str
        Why it does.
    """
    if task.stretchable and task.paced:
        motion = motion.stretched(least_stretch(task, motion))
    for attempt in range(_STRETCHES):
        whole = finite(task, motion)
        if whole is None:
            return None, "the numbers overflow"
        verdict = check(task.problem, whole, conditions=task.conditions)
        if verdict.feasible:
            return VerifiedMotion(name, motion, whole, verdict), ""
        if not (task.stretchable and verdict.position_kept and 1.0 < verdict.stretch < 2.0):
            break
        # assembly rounds the stretched breaks again, so that slightly more may be needed
        motion = motion.stretched(verdict.stretch * (1.0 + 10.0 ** (attempt - 14)))
    return None, verdict.faults[0]
