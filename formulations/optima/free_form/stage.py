"""One step of the search for the fastest motion, and a motion that has passed the check."""

from __future__ import annotations

from dataclasses import dataclass

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict
from formulations.optima.free_form.nlp.arcs import ArcMotion


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
