"""What every reference returns: one number, or the reason why there is none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array

OutcomeStatus = Literal["ok", "not-applicable", "failed"]


@dataclass(frozen=True)
class Outcome:
    """A reference timing. seconds and durations (n_segments,) in s; None where there are none."""

    status: OutcomeStatus
    seconds: float | None = None
    durations: Array | None = None
    trajectory: Trajectory | None = None
    note: str = ""

    @staticmethod
    def ok(
        seconds: float,
        *,
        durations: Array | None = None,
        trajectory: Trajectory | None = None,
        note: str = "",
    ) -> Outcome:
        """A result."""
        return Outcome("ok", seconds, durations, trajectory, note)

    @staticmethod
    def not_applicable(reason: str) -> Outcome:
        """The problem gives this reference no meaning."""
        return Outcome("not-applicable", note=reason)

    @staticmethod
    def failed(reason: str) -> Outcome:
        """The method was run and gave no valid result."""
        return Outcome("failed", note=reason)
