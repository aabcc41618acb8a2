"""A finished motion, whoever made it: what is wrong with it, how far it is from the fastest, and why."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from formulations.diagnosis import Hold, largest_holds
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.judgement import WAYPOINT_TOLERANCE, Judgement, judge
from formulations.motion.peaks import Peak
from formulations.motion.smoothness import Jump
from formulations.motion.trajectory import Trajectory
from formulations.problem.conditions import Conditions
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.bound import FreeFormBound, free_form_bound

NEAR = 0.02  # gap below which what holds the fastest motion up holds this one up too


@dataclass(frozen=True)
class Assessment:
    """A judged motion beside the bound that no motion beats.

    Attributes
    ----------
    problem : Problem
    judgement : Judgement
    bound : FreeFormBound or None
        The certified lower bound of all motions that keep the conditions, their total time aside; None if
        it was not asked for.
    holds : tuple of Hold
        How long each limit holds the fastest motion up, to first order, largest first; empty where the
        bound does not say.
    """

    problem: Problem
    judgement: Judgement
    bound: FreeFormBound | None
    holds: tuple[Hold, ...]

    @property
    def gap(self) -> float | None:
        """Time of the motion over the bound, less 1; None without a bound.

        Negative for a motion that is faster than any that keeps the limits.
        """
        return self._over(self.judgement.seconds)

    @property
    def gap_when_mended(self) -> float | None:
        """The gap of the motion stretched until it is feasible; None without a bound or such a stretch."""
        factor = max(self.judgement.stretch, 1.0)
        return self._over(self.judgement.seconds * factor) if np.isfinite(factor) else None

    @property
    def is_near_the_optimum(self) -> bool:
        """Whether the motion is feasible and its gap below 2 % (``NEAR``)."""
        return self.judgement.feasible and self.gap is not None and self.gap < NEAR

    @property
    def conditions(self) -> Conditions:
        """What was asked for beyond the problem."""
        return self.judgement.conditions

    def _over(self, seconds: float) -> float | None:
        if self.bound is None or not self.bound.seconds > 0.0:
            return None
        return seconds / self.bound.seconds - 1.0

    def to_json(self) -> dict[str, Any]:
        """Write everything as plain data; joints and waypoints count from 1, as in the text.

        Returns
        -------
        dict
            Ready for strict JSON. ``stretch`` is None where no uniform stretch mends the motion.
        """
        found = self.judgement
        stretch = found.stretch
        return {
            "feasible": found.feasible,
            "seconds": found.seconds,
            "stretch": stretch if np.isfinite(stretch) else None,
            "violations": [self._peak(peak) for peak in found.violations],
            "missed_waypoints": [
                {
                    "waypoint": miss.waypoint + 1,
                    **self._joint(miss.joint),
                    "distance": miss.distance,
                    "time": miss.time,
                }
                for miss in found.missed
            ],
            "bound": None if self.bound is None else self.bound.seconds,
            "gap": self.gap,
            "gap_when_mended": self.gap_when_mended,
            "stretch_for_limits": found.stretch_for_limits,
            "jumps": [self._jump(jump) for jump in found.jumps],
            "not_at_rest": [self._jump(jump) for jump in found.not_at_rest],
            "missed_total": found.missed_total,
            "unkept": list(found.unkept),
            "tolerance": found.tolerance,
            "interpolation": found.interpolation,
            "passage_times": found.motion.passage_times.tolist(),
            "used_most": [self._peak(peak) for peak in found.peaks],
            "held_by": [
                {
                    "quantity": hold.quantity,
                    **self._joint(hold.joint),
                    "segment": hold.segment + 1,
                    "seconds": hold.seconds,
                }
                for hold in self.holds
            ],
        }

    def _joint(self, joint: int) -> dict[str, Any]:
        names = self.judgement.names
        return {"joint": joint + 1, **({"name": names[joint]} if names else {})}

    def _peak(self, peak: Peak) -> dict[str, Any]:
        return {
            "quantity": peak.quantity,
            **self._joint(peak.joint),
            "time": peak.time,
            "value": peak.value,
            "limit": peak.limit,
            "factor": peak.factor,
        }

    def _jump(self, jump: Jump) -> dict[str, Any]:
        return {
            "quantity": jump.quantity,
            **self._joint(jump.joint),
            "time": jump.time,
            "size": jump.size,
            "count": jump.count,
            **({} if jump.waypoint is None else {"waypoint": jump.waypoint + 1}),
        }


def assess(
    problem: Problem,
    motion: MotionPoints | Trajectory,
    *,
    interpolation: str = "auto",
    tolerance: float = WAYPOINT_TOLERANCE,
    conditions: Conditions | None = None,
    bound: bool = True,
    time_limit: float = 20.0,
) -> Assessment:
    """Judge a motion from elsewhere, and set it beside the bound that no motion beats.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    motion : MotionPoints or Trajectory
        Points as they stand in a file, or exact pieces.
    interpolation : {"auto", "linear", "cubic", "quintic"}
        How the controller joins points.
    tolerance : float, default 1e-4 [rad]
        By how much a waypoint may be missed in each joint.
    conditions : Conditions, optional
        What was asked of the motion; the conditions of the problem if left out. The bound is that of the
        motions that keep it, and says how fast they could be where a total time is asked for.
    bound : bool, default True
        Whether to prove a lower bound.
    time_limit : float, default 20 [s]
        The search for a better bound ends after this time.

    Returns
    -------
    Assessment

    Raises
    ------
    InputError
        As ``formulations.motion.judgement.judge``.

    Examples
    --------
    >>> import formulations as f
    >>> problem = f.load("sr4c")
    >>> found = assess(problem, f.free_form(problem).trajectory)
    >>> found.judgement.feasible, found.gap < 1e-6
    (True, True)
    """
    asked = problem.conditions if conditions is None else conditions
    judged = judge(problem, motion, interpolation=interpolation, tolerance=tolerance, conditions=asked)
    if not bound:
        return beside(problem, judged, None)
    # the time of a motion is of use to the proof only if the motion is feasible
    upper = judged.seconds if judged.feasible else None
    free = asked.without_total(problem)
    proved = free_form_bound(problem, conditions=free, upper=upper, time_limit=time_limit)
    return beside(problem, judged, proved)


def beside(problem: Problem, judged: Judgement, bound: FreeFormBound | None) -> Assessment:
    """Set a judged motion beside a bound that is proved already.

    Parameters
    ----------
    problem : Problem
    judged : Judgement
        Of a motion of this problem.
    bound : FreeFormBound or None
        Of all motions under the same conditions, their total time aside.

    Returns
    -------
    Assessment
    """
    holds: list[Hold] = []
    if bound is not None and bound.savings is not None:
        # raising a limit of order k by 1 % saves 1 / k % of the time that it holds
        held = bound.savings * np.arange(1.0, 4.0)[:, None, None]
        holds = largest_holds(held, bound.seconds)
    return Assessment(problem, judged, bound, tuple(holds))
