"""What is asked for beyond waypoints and limits, in a motion from elsewhere: stops, times, cycles, balls."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from formulations.motion.smoothness import Jump, end_jumps, motion_at
from formulations.motion.timing import segment_faults, wait_faults
from formulations.motion.tool_check import tool_faults
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands

TIME_TOLERANCE = 1e-5  # s by which a time may differ from what is asked for
STILL = 1e-3  # of the velocity and acceleration limits: less counts as standing still at a stop


def unkept(
    demands: Demands, trajectory: Trajectory, tolerance: float, smooth: Sequence[Array]
) -> Iterator[str]:
    """Find the times, waits, cycles and balls of the tool that are asked for and not kept.

    Parameters
    ----------
    demands : Demands
    trajectory : Trajectory
        With the passages that were found.
    tolerance : float [rad]
        By how much a waypoint may be missed, and a ball of the tool [m].
    smooth : sequence of Array, shape (3, dof)
        Relative size of a jump of position, velocity and acceleration that is rounding.

    Yields
    ------
    str
        A line each.
    """
    yield from segment_faults(demands, trajectory, TIME_TOLERANCE)
    yield from wait_faults(demands, trajectory, tolerance, TIME_TOLERANCE)
    yield from tool_faults(demands, trajectory, tolerance)
    early, late = demands.passages[-1].tolist()
    if early != late and not early - TIME_TOLERANCE <= trajectory.seconds <= late + TIME_TOLERANCE:
        yield f"ends at {trajectory.seconds:.9g} s, [{early:.9g}, {late:.9g}] s asked for"
    for jump in end_jumps(demands.problem, trajectory, smooth) if demands.cyclic else ():
        if jump.quantity != "position" or jump.size > tolerance:
            where = demands.problem.joint_name(jump.joint)
            yield f"{jump.quantity} of {where} differs by {jump.size:.3g} between both ends of the cycle"


def moving_at(demands: Demands, trajectory: Trajectory, stop: int, tolerance: float) -> list[Jump]:
    """Find what moves where a motion is slowest while it is at a waypoint, or when it has to be there.

    Parameters
    ----------
    demands : Demands
    trajectory : Trajectory
        With the passages that were found.
    stop : int
        An inner waypoint, from 0.
    tolerance : float [rad]
        How near is at the waypoint.

    Returns
    -------
    list of Jump
    """
    problem, times = demands.problem, trajectory.passage_times[[stop]]
    if demands.passages[stop, 0] < demands.passages[stop, 1]:
        before, after = trajectory.passage_times[[stop - 1, stop + 1]]
        meet = trajectory.breaks[(trajectory.breaks > before) & (trajectory.breaks < after)]
        at, (low, high) = trajectory.at(meet), demands.waypoints[stop].T
        off = np.maximum(low - at, at - high).max(axis=1)
        times = np.append(times, meet[off <= tolerance])
    limits = problem.limits
    speed = np.abs(trajectory.at(times, 1)) / limits.velocity
    gained = np.abs(trajectory.at(times, 2)) / limits.acceleration * np.isfinite(limits.jerk)
    slowest = times[[int(np.maximum(speed, gained).max(axis=1).argmin())]]
    still = np.full(problem.dof, STILL)
    found = motion_at(problem, trajectory, slowest, relative=[still] * 3)
    return [replace(jump, waypoint=stop) for jump in found]


def from_arrival(demands: Demands, trajectory: Trajectory, tolerance: float) -> Trajectory:
    """Move the passages of waits to the arrival: where the pieces around them begin to stand still.

    Parameters
    ----------
    demands : Demands
    trajectory : Trajectory
        With the passages that were found.
    tolerance : float [rad]
        How near is at the waypoint.

    Returns
    -------
    Trajectory
    """
    times, breaks = trajectory.passage_times.copy(), trajectory.breaks
    for waypoint in np.flatnonzero(demands.waits):
        earlier = breaks[(breaks < times[waypoint]) & (breaks > times[waypoint - 1])]
        later = breaks[(breaks > times[waypoint]) & (breaks < times[waypoint + 1])]
        around = np.concatenate([earlier, times[[waypoint]], later])
        at, (low, high) = trajectory.at(around), demands.waypoints[waypoint].T
        near = np.maximum(low - at, at - high).max(axis=1) <= tolerance
        speeds = np.abs(trajectory.at(around, 1)) <= STILL * demands.problem.limits.velocity
        resting = np.flatnonzero(near & speeds.all(axis=1))
        if len(resting):
            times[waypoint] = around[resting[0]]
    return Trajectory(trajectory.durations, trajectory.coefficients, times)
