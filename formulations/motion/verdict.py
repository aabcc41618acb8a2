"""The independent check: whether a motion keeps what its problem asks for, by exact extremes.

It judges every number that is reported, and shares no code with the kernels that make the motions.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from formulations.motion.peaks import QUANTITIES, Peak, peaks_of_joints, worst_of_quantities
from formulations.motion.smoothness import (
    TOLERANCE,
    end_jumps,
    jumps,
    motion_at,
    rounding_of_positions,
)
from formulations.motion.timing import passage_faults, segment_faults, wait_faults
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem

__all__ = ["QUANTITIES", "TOLERANCE", "Peak", "Verdict", "check"]


@dataclass(frozen=True)
class Verdict:
    """What the independent check found about one motion.

    Attributes
    ----------
    seconds : float
        Total time of the motion [s].
    feasible : bool
        Whether it passes the waypoints, is continuous, rests at both ends and keeps every limit.
    stretch : float
        Least factor on all durations that keeps the velocity, acceleration and jerk limits.
    peaks : tuple of Peak
        The worst place of each quantity that is limited, worst first.
    faults : tuple of str
        All that is wrong, a line each; empty if feasible.
    """

    seconds: float
    feasible: bool
    stretch: float
    peaks: tuple[Peak, ...]
    faults: tuple[str, ...]

    @property
    def worst(self) -> Peak | None:
        """The limit used most; None if nothing is limited or nothing moves."""
        return self.peaks[0] if self.peaks else None

    @property
    def position_kept(self) -> bool:
        """Whether the position limits are kept; no stretch can mend them."""
        return all(p.factor <= 1.0 for p in self.peaks if p.quantity == "position")


def check(
    problem: Problem,
    trajectory: Trajectory,
    *,
    through: bool = True,
    conditions: Conditions | None = None,
) -> Verdict:
    """Judge a motion by its exact extremes: waypoints, continuity, states at the ends, times and limits.

    A limit counts as kept up to a relative excess of 1e-9 (``TOLERANCE``), which is rounding.

    Parameters
    ----------
    problem : Problem
        What the motion has to do.
    trajectory : Trajectory
        The motion, whoever made it.
    through : bool
        Whether every waypoint has to be passed; False asks for the first and the last alone.
    conditions : Conditions, optional
        What else is asked for: zones, times, stops, waits, states at the ends, limits of single segments.
        Those of the problem if left out.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        If the motion has another number of joints than the problem.

    Examples
    --------
    >>> import formulations as f
    >>> problem = f.load("sr4c")
    >>> spline = f.FAMILIES["3-5-3"].trajectory(problem, [2.0, 1.0, 2.0])
    >>> verdict = f.check(problem, spline)
    >>> verdict.feasible
    False
    >>> slower = f.check(problem, spline.stretched(verdict.stretch))
    >>> slower.feasible
    True
    """
    if trajectory.dof != problem.dof:
        raise InputError(f"trajectory: {trajectory.dof} joints, the problem has {problem.dof}")
    demands = Demands.of(problem, conditions)
    boxes = demands.waypoints if through else demands.waypoints[[0, -1]]
    faults = [
        *_waypoint_faults(problem, trajectory, boxes),
        *_smoothness_faults(demands, trajectory),
    ]
    if len(trajectory.passage_times) == len(problem.waypoints):
        faults += [
            *_stop_faults(demands, trajectory),
            *passage_faults(demands, trajectory),
            *segment_faults(demands, trajectory),
            *wait_faults(demands, trajectory, rounding_of_positions(problem)),
        ]
    peaks = worst_of_quantities(peaks_of_joints(demands, trajectory))
    faults += [f"over the limit: {peak}" for peak in peaks if peak.factor > 1.0 + TOLERANCE]
    stretch = max((peak.stretch for peak in peaks if peak.quantity != "position"), default=0.0)
    return Verdict(trajectory.seconds, not faults, stretch, tuple(peaks), tuple(faults))


def _waypoint_faults(problem: Problem, trajectory: Trajectory, boxes: Array) -> Iterator[str]:
    """Passage times that cannot be, and waypoints whose boxes (n, dof, 2) are missed."""
    times = trajectory.passage_times
    if len(times) != len(boxes):
        yield f"{len(times)} passage times for {len(boxes)} waypoints"
    elif not (
        abs(times[0]) <= TOLERANCE * trajectory.seconds
        and abs(times[-1] - trajectory.seconds) <= TOLERANCE * trajectory.seconds
        and (np.diff(times) >= 0.0).all()
    ):
        yield "passage times do not run from the start to the end of the motion"
    else:
        at, (low, high) = trajectory.at(times), np.moveaxis(boxes, -1, 0)
        miss = np.maximum(low - at, at - high)
        if miss.max() > rounding_of_positions(problem):
            row, joint = divmod(int(miss.argmax()), problem.dof)
            by = problem.amount(float(miss.max()), joint, digits=3)
            zone = "" if low[row, joint] == high[row, joint] else "the zone of "
            yield f"misses {zone}waypoint {row + 1}, {problem.joint_name(joint)} by {by}"


def _smoothness_faults(demands: Demands, trajectory: Trajectory) -> Iterator[str]:
    """Jumps between pieces, and wrong states at both ends; of the acceleration where jerk is limited."""
    problem = demands.problem
    jumping = jumps(problem, trajectory)
    ends = np.stack([demands.end_velocity, demands.end_acceleration])
    moving = motion_at(problem, trajectory, np.array([0.0, trajectory.seconds]), ends)
    differing = end_jumps(problem, trajectory) if demands.cyclic else []
    for order, name in enumerate(QUANTITIES[:3]):
        for jump in [jump for jump in jumping if jump.quantity == name][:1]:
            yield f"{name} of {problem.joint_name(jump.joint)} jumps by {jump.size:.3g}"
        for jump in [jump for jump in moving if jump.quantity == name][:1]:
            off = f"off by {jump.size:.3g}" if order and ends[order - 1].any() else f"{jump.size:.3g}"
            yield f"{name} of {problem.joint_name(jump.joint)} is {off} at an end"
        for jump in [jump for jump in differing if jump.quantity == name][:1]:
            where = problem.joint_name(jump.joint)
            yield f"{name} of {where} differs by {jump.size:.3g} between both ends of the cycle"


def _stop_faults(demands: Demands, trajectory: Trajectory) -> Iterator[str]:
    """Stops at which something moves."""
    problem = demands.problem
    for stop in sorted(demands.conditions.stops | set(demands.conditions.waits)):
        found = motion_at(problem, trajectory, trajectory.passage_times[[stop]])
        for name in QUANTITIES[1:3]:
            for jump in [jump for jump in found if jump.quantity == name][:1]:
                where = problem.joint_name(jump.joint)
                yield f"{name} of {where} is {jump.size:.3g} at waypoint {stop + 1}, a stop"
