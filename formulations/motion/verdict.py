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
    jumps,
    motion_at,
    rounding_of_positions,
)
from formulations.motion.tool_check import tool_faults, tool_peaks
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
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
    """Judge a motion by its exact extremes: waypoints, continuity, rest and limits.

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
        What else is asked for: times, stops, velocities at the ends, limits of single segments.

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
    asked = problem.conditions if conditions is None else conditions
    if trajectory.dof != problem.dof:
        raise InputError(f"trajectory: {trajectory.dof} joints, the problem has {problem.dof}")
    targets = problem.waypoints if through else problem.waypoints[[0, -1]]
    known = len(trajectory.passage_times) == len(targets)
    faults = [
        *_waypoint_faults(problem, trajectory, targets),
        *_smoothness_faults(problem, trajectory, asked, known),
        *_time_faults(problem, trajectory, asked, known),
        *tool_faults(problem, trajectory, asked),
    ]
    found = [*peaks_of_joints(problem, trajectory, asked), *tool_peaks(problem, trajectory, asked)]
    peaks = worst_of_quantities(found)
    faults += [f"over the limit: {peak}" for peak in peaks if peak.factor > 1.0 + TOLERANCE]
    stretch = max((peak.stretch for peak in peaks if peak.quantity != "position"), default=0.0)
    return Verdict(trajectory.seconds, not faults, stretch, tuple(peaks), tuple(faults))


def _waypoint_faults(problem: Problem, trajectory: Trajectory, targets: Array) -> Iterator[str]:
    """Passage times that cannot be, and waypoints (n, dof) that are missed."""
    times = trajectory.passage_times
    if len(times) != len(targets):
        yield f"{len(times)} passage times for {len(targets)} waypoints"
    elif not (
        abs(times[0]) <= TOLERANCE * trajectory.seconds
        and abs(times[-1] - trajectory.seconds) <= TOLERANCE * trajectory.seconds
        and (np.diff(times) >= 0.0).all()
    ):
        yield "passage times do not run from the start to the end of the motion"
    else:
        miss = np.abs(trajectory.at(times) - targets)
        if miss.max() > rounding_of_positions(problem):
            row, joint = divmod(int(miss.argmax()), problem.dof)
            by = problem.amount(float(miss.max()), joint, digits=3)
            yield f"misses waypoint {row + 1}, {problem.joint_name(joint)} by {by}"


def _smoothness_faults(
    problem: Problem, trajectory: Trajectory, asked: Conditions, known: bool
) -> Iterator[str]:
    """Jumps between pieces, and motion at the ends and stops; of the acceleration where jerk is limited.

    known: whether there is a passage time for each waypoint.
    """
    jumping = jumps(problem, trajectory)
    ends = asked.end_velocities(problem)
    moving = motion_at(problem, trajectory, np.array([0.0, trajectory.seconds]), ends)
    stops = {
        stop: motion_at(problem, trajectory, trajectory.passage_times[[stop]])
        for stop in sorted(asked.stops if known else ())
    }
    for order, name in enumerate(QUANTITIES[:3]):
        for jump in [jump for jump in jumping if jump.quantity == name][:1]:
            yield f"{name} of {problem.joint_name(jump.joint)} jumps by {jump.size:.3g}"
        for jump in [jump for jump in moving if jump.quantity == name][:1]:
            off = f"off by {jump.size:.3g}" if order == 1 and ends.any() else f"{jump.size:.3g}"
            yield f"{name} of {problem.joint_name(jump.joint)} is {off} at an end"
        for stop, found in stops.items():
            for jump in [jump for jump in found if jump.quantity == name][:1]:
                where = problem.joint_name(jump.joint)
                yield f"{name} of {where} is {jump.size:.3g} at waypoint {stop + 1}, a stop"


def _time_faults(
    problem: Problem, trajectory: Trajectory, asked: Conditions, known: bool
) -> Iterator[str]:
    """Waypoints that are passed at another time than asked for."""
    times = trajectory.passage_times
    for waypoint, time in asked.times(problem).items():
        if known and abs(times[waypoint] - time) > TOLERANCE * time:
            yield f"passes waypoint {waypoint + 1} at {times[waypoint]:.9g} s, not {time:.9g} s"
