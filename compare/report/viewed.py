"""What is known of one problem, and of one motion given for it: what its page shows."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

from compare.benchmark.ladders import LadderRecord
from formulations import RUNGS, Conditions, Ladder, Problem, Trajectory
from formulations.assessment import Assessment
from formulations.diagnosis import Diagnosis
from formulations.planning import PlannedMotion

if TYPE_CHECKING:
    from formulations.arms import Arm
    from formulations.robot import Robot

_EVERY_MOTION = ("displacement", "ruckig_end_to_end", "free_form_lower")  # bounds on every motion


@dataclass(frozen=True)
class Viewed:
    """What is known of a problem, and of a motion given for it.

    Attributes
    ----------
    ladder : Ladder
        Climbed as far as there was time.
    diagnosis : Diagnosis or None
        What limits the fastest motion.
    conditions : Conditions
        What is asked for beyond the problem.
    planned : PlannedMotion or None
        The fastest motion under the conditions; None where there are none, or no motion.
    given : Assessment or None
        The motion from elsewhere.
    file : str
        Name of its file.
    arm : Arm or Robot or None
        None where no arm is known.
    remarks : tuple of str
        What the reader has to know: that it was interrupted, why there is no motion.
    """

    ladder: Ladder
    diagnosis: Diagnosis | None = None
    conditions: Conditions = field(default_factory=Conditions)
    planned: PlannedMotion | None = None
    given: Assessment | None = None
    file: str = ""
    arm: Arm | Robot | None = None
    remarks: tuple[str, ...] = ()

    @property
    def problem(self) -> Problem:
        """The problem."""
        return self.ladder.problem

    @property
    def is_conditional(self) -> bool:
        """Whether something is asked for beyond the problem."""
        return not self.conditions.none

    @property
    def best(self) -> str | None:
        """Key of the rung with the fastest verified motion of the problem; None where there is none."""
        found = {rung.seconds: key for key, rung in self.ladder.rungs.items() if rung.kind == "upper"}
        return min(((t, key) for t, key in found.items() if t is not None), default=(0.0, None))[1]

    @property
    def seconds(self) -> float | None:
        """Time of the fastest motion known that keeps what is asked for [s]."""
        if self.is_conditional:
            return None if self.planned is None else self.planned.seconds
        return None if self.best is None else self.ladder.seconds(self.best)

    @property
    def bound(self) -> float | None:
        """Time that no such motion beats, proved; a total time that is asked for is left aside [s]."""
        if self.is_conditional:
            return None if self.planned is None else self.planned.bound
        found = [self.record["ladder"][key]["seconds"] for key in _EVERY_MOTION]
        return max((t for t in found if t is not None), default=None)

    @property
    def fastest(self) -> Trajectory | None:
        """The fastest motion known that keeps what is asked for; None where there is none, or nothing moves."""
        if self.is_conditional:
            return None if self.planned is None else self.planned.found.trajectory
        return None if self.best is None else self.ladder.trajectories.get(self.best)

    @property
    def was_sought(self) -> bool:
        """Whether a motion was looked for."""
        return self.is_conditional or any(rung.kind == "upper" for rung in self.ladder.rungs.values())

    @cached_property
    def record(self) -> LadderRecord:
        """The ladder as plain data, with every rung: those that were not climbed say so."""
        record = cast(LadderRecord, self.ladder.to_json())
        empty = {"seconds": None, "status": "left out", "certified": False, "runtime": 0.0, "note": ""}
        record["ladder"] = {
            key: record["ladder"].get(key, cast(Any, {**empty, "kind": rung.kind.value}))
            for key, rung in RUNGS.items()
        }
        record["held_up_by"] = [] if self.diagnosis is None else self.diagnosis.lines()
        return record
