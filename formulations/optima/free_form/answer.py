"""The answer of ``free_form``: the best motion found, and what is known of it."""

from __future__ import annotations

from dataclasses import dataclass

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict
from formulations.optima.free_form.ending import SearchStatus
from formulations.optima.free_form.sensitivity import Sensitivity
from formulations.optima.free_form.stage import Stage
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.problem import Problem


@dataclass(frozen=True)
class FreeForm:
    """The best motion found, judged by the independent check.

    Attributes
    ----------
    problem : Problem
    conditions : Conditions
        Those asked for, or empty ones.
    durations : Array, shape (n_segments,) [s]
        Time between consecutive waypoints.
    trajectory : Trajectory or None
        The motion as polynomial pieces; None where nothing moves and nothing takes time.
    verdict : Verdict or None
        What the independent check says of it: it keeps all that was asked for.
    method : str
        Name of the stage that found it.
    status : SearchStatus
        "ok" if a local solve converged to this time, within the tolerance; "not converged"; "time limit"
        or "interrupted" if the search was ended before it was done.
    reason : str
        Why the status is "not converged"; else empty.
    notes : tuple of str
        What a user should know about the answer.
    sensitivity : Sensitivity or None
        What each limit costs; None where the time is fixed, or where no program was solved to within
        1e-3 of the motion.
    stages : tuple of Stage
        All that was tried, in order.
    runtime : float [s]
        Time of the computation on this machine.
    """

    problem: Problem
    conditions: Conditions
    durations: Array
    trajectory: Trajectory | None
    verdict: Verdict | None
    method: str
    status: SearchStatus
    reason: str
    notes: tuple[str, ...]
    sensitivity: Sensitivity | None
    stages: tuple[Stage, ...]
    runtime: float

    @property
    def seconds(self) -> float:
        """Total time [s]."""
        return 0.0 if self.trajectory is None else self.trajectory.seconds

    @property
    def ending(self) -> str:
        """The status and its reason in one line."""
        return f"{self.status}: {self.reason}" if self.reason else str(self.status)

    def __repr__(self) -> str:
        return f"FreeForm({self.problem.name!r}: {self.seconds:.9g} s, {self.method}, {self.status})"
