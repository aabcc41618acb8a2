"""pyroboplan's TrapezoidalVelocityTrajectory: straight lines from stop to stop."""

from __future__ import annotations

import numpy as np

from compare.rivals.rival import RivalAnswer
from formulations.motion.interpolation import joined
from formulations.problem.problem import Problem


def pyroboplan_trapezoids(problem: Problem, seconds: float) -> RivalAnswer:
    """Move from waypoint to waypoint with trapezoidal speed.

    Parameters
    ----------
    problem : Problem
        Its jerk limits cannot be asked for; without an acceleration limit there is no trapezoid.
    seconds : float
        Not used: it takes microseconds.

    Returns
    -------
    RivalAnswer
    """
    from pyroboplan.trajectory.trapezoidal_velocity import TrapezoidalVelocityTrajectory

    limits = problem.limits
    if not limits.has_acceleration:
        return RivalAnswer(None, note="needs an acceleration limit")
    found = TrapezoidalVelocityTrajectory(problem.waypoints.T, limits.velocity, limits.acceleration)
    joints = found.single_dof_trajectories  # all joints switch at the same times
    positions = np.array([joint.positions for joint in joints]).T
    velocities = np.array([joint.velocities for joint in joints]).T
    # the cubic through both ends of a piece of constant acceleration is that piece
    motion = joined(np.array(joints[0].times), positions, velocities, interpolation="cubic")
    return RivalAnswer(motion, float(found.segment_times[-1]))
