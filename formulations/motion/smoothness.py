"""Where a motion jumps between its pieces, and where it moves though it should stand still.

A jump of the position or the velocity asks for an infinite acceleration, and one of the acceleration for an
infinite jerk. No stretch mends them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from formulations.motion.peaks import QUANTITIES
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

TOLERANCE = 1e-9  # relative excess over a limit that still counts as keeping it


@dataclass(frozen=True)
class Jump:
    """The largest jump of one quantity of one joint.

    Attributes
    ----------
    quantity : str
        "position", "velocity" or "acceleration".
    joint : int
        From 0.
    time : float
        When it is, from the start [s].
    size : float
        By how much the value changes at once [rad/s^k].
    count : int
        Number of times at which this quantity of this joint jumps.
    waypoint : int or None
        From 0: the waypoint that is a stop, where the motion should have stood still.
    """

    quantity: str
    joint: int
    time: float
    size: float
    count: int
    waypoint: int | None = None


def jumps(
    problem: Problem, trajectory: Trajectory, relative: Sequence[Array] | None = None
) -> list[Jump]:
    """Find the jumps where two pieces of a motion meet; of the acceleration where jerk is limited.

    Parameters
    ----------
    problem : Problem
        Its limits say how small a jump is rounding.
    trajectory : Trajectory
        The motion.
    relative : sequence of Array, shape (3, dof), optional
        Relative size of a jump of position, velocity and acceleration that is rounding; ``TOLERANCE`` if
        left out.

    Returns
    -------
    list of Jump
        The largest of each quantity and joint that is no rounding; in each quantity the worst first.
    """
    return _found(problem, trajectory, trajectory.jumps_between, trajectory.breaks[1:-1], relative)


def motion_at(
    problem: Problem,
    trajectory: Trajectory,
    times: Array,
    states: Array | None = None,
    relative: Sequence[Array] | None = None,
) -> list[Jump]:
    """Find what moves at times of rest, and what has an acceleration there where jerk is limited.

    Parameters
    ----------
    problem : Problem
        Its limits say how small a value is rounding.
    trajectory : Trajectory
        The motion.
    times : Array, shape (n_times,) [s]
        When it should be at rest.
    states : Array, shape (2, n_times, dof, 2), optional
        Least and greatest velocity and acceleration that it should have instead; 0 if left out.
    relative : sequence of Array, shape (3, dof), optional
        As for ``jumps``.

    Returns
    -------
    list of Jump
        The difference to rest as a jump; in each quantity the worst first.
    """
    given = np.zeros((2, len(times), problem.dof, 2)) if states is None else states
    off = [np.zeros((len(times), problem.dof))]
    for order in (1, 2):
        value, (low, high) = trajectory.at(times, order), np.moveaxis(given[order - 1], -1, 0)
        off.append(np.maximum(np.maximum(low - value, value - high), 0.0))
    return _found(problem, trajectory, np.stack(off), times, relative)


def end_jumps(
    problem: Problem, trajectory: Trajectory, relative: Sequence[Array] | None = None
) -> list[Jump]:
    """Find by how much the end of a cycle differs from its start.

    Parameters
    ----------
    problem : Problem
        Its limits say how small a difference is rounding.
    trajectory : Trajectory
        The motion.
    relative : sequence of Array, shape (3, dof), optional
        As for ``jumps``.

    Returns
    -------
    list of Jump
        At the end of the motion; in each quantity the worst first.
    """
    ends = np.array([0.0, trajectory.seconds])
    sizes = np.stack([np.abs(np.diff(trajectory.at(ends, order), axis=0)) for order in range(3)])
    return _found(problem, trajectory, sizes, ends[1:], relative)


def rounding_of_positions(problem: Problem) -> float:
    """How far a waypoint may be missed [rad]: rounding of the way, and of the positions themselves.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    float
    """
    reach = float(np.ptp(problem.waypoints, axis=0).max())
    return TOLERANCE * reach + 1e-13 * float(np.abs(problem.waypoints).max())


def _found(
    problem: Problem,
    trajectory: Trajectory,
    sizes: Array,
    times: Array,
    relative: Sequence[Array] | None,
) -> list[Jump]:
    """Jumps among the sizes (3, n_times, dof) that are larger than rounding."""
    limits = problem.limits
    scales = [np.full(problem.dof, rounding_of_positions(problem)), TOLERANCE * limits.velocity]
    if limits.has_jerk:
        finite = np.where(np.isfinite(limits.acceleration), limits.acceleration, 0.0)
        scales.append(np.where(np.isfinite(limits.jerk), TOLERANCE * finite, np.inf))
    found = []
    for order, scale in enumerate(scales):
        # rounding grows with the size of the motion itself; 1e-300 for joints that never move
        allowed = np.maximum(scale, TOLERANCE * trajectory.reach(order)) + 1e-300
        if relative is not None:
            allowed = allowed * (relative[order] / TOLERANCE)
        worst = sizes[order].max(axis=0, initial=0.0) / allowed
        for joint in np.argsort(-worst, kind="stable").tolist():
            if worst[joint] > 1.0:
                mine = sizes[order][:, joint]
                at = int(mine.argmax())
                count = int((mine > allowed[joint]).sum())
                found.append(Jump(QUANTITIES[order], joint, float(times[at]), float(mine[at]), count))
    return found
