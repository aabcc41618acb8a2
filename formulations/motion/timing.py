"""Whether a motion keeps the times asked for: of its passages, of its segments, and of its waits."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from formulations.motion.cut import range_between
from formulations.motion.smoothness import TOLERANCE
from formulations.motion.trajectory import Trajectory
from formulations.problem.demands import Demands


def passage_faults(demands: Demands, trajectory: Trajectory) -> Iterator[str]:
    """Find the waypoints that are passed at another time than asked for.

    Parameters
    ----------
    demands : Demands
    trajectory : Trajectory
        With a passage time for each waypoint.

    Yields
    ------
    str
        A line each; waypoints count from 1.
    """
    for waypoint, (early, late) in enumerate(demands.passages.tolist()):
        time = float(trajectory.passage_times[waypoint])
        passed = f"passes waypoint {waypoint + 1} at {time:.9g} s"
        if early == late:
            if waypoint > 0 and abs(time - early) > TOLERANCE * early:
                yield f"{passed}, not {early:.9g} s"
        elif time < early * (1.0 - TOLERANCE):
            yield f"{passed}, before the earliest time, {early:.9g} s"
        elif time > late * (1.0 + TOLERANCE):
            yield f"{passed}, after the latest time, {late:.9g} s"


def segment_faults(demands: Demands, trajectory: Trajectory, slack: float = 0.0) -> Iterator[str]:
    """Find the segments that take another time than asked for, from leaving to arriving.

    Parameters
    ----------
    demands : Demands
    trajectory : Trajectory
        With a passage time for each waypoint.
    slack : float [s]
        By how much a time may be missed, beside rounding.

    Yields
    ------
    str
        A line each; segments count from 1.
    """
    allowed = slack + TOLERANCE * trajectory.seconds
    taken = np.diff(trajectory.passage_times) - demands.waits[:-1]
    for segment, (seconds, (least, greatest)) in enumerate(
        zip(taken.tolist(), demands.durations.tolist(), strict=True)
    ):
        if seconds < least - allowed:
            yield f"segment {segment + 1} takes {seconds:.9g} s, the least time is {least:.9g} s"
        if seconds > greatest + allowed:
            yield f"segment {segment + 1} takes {seconds:.9g} s, the greatest time is {greatest:.9g} s"


def wait_faults(
    demands: Demands, trajectory: Trajectory, still: float, slack: float = 0.0
) -> Iterator[str]:
    """Find the waits during which something moves, by the exact range of every position.

    Parameters
    ----------
    demands : Demands
    trajectory : Trajectory
        With a passage time for each waypoint.
    still : float [rad]
        By how much a position may change while the motion stands still.
    slack : float [s]
        By how much a wait may be too short, beside rounding.

    Yields
    ------
    str
        A line each; waypoints count from 1.
    """
    problem, short = demands.problem, slack + TOLERANCE * trajectory.seconds
    for waypoint in np.flatnonzero(demands.waits).tolist():
        wait = float(demands.waits[waypoint])
        start = float(trajectory.passage_times[waypoint])
        where = f"at waypoint {waypoint + 1}, where it waits {wait:.9g} s from {start:.9g} s on"
        if start + wait > trajectory.passage_times[waypoint + 1] + short:
            yield f"passes waypoint {waypoint + 2} while it waits {where}"
            continue
        low, high = range_between(trajectory, start, start + max(wait - short, 0.0))
        moved = np.maximum(high - trajectory.at(start), trajectory.at(start) - low)
        joint = int(moved.argmax())
        if moved[joint] > still:
            by = problem.amount(float(moved[joint]), joint, digits=3)
            yield f"{problem.joint_name(joint)} moves by {by} {where}"
