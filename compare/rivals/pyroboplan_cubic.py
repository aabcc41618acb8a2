"""pyroboplan's CubicTrajectoryOptimization: one cubic per segment, velocities and times free."""

from __future__ import annotations

import numpy as np

from compare.rivals.rival import RivalAnswer
from formulations import REFERENCES, Trajectory
from formulations.problem.problem import Problem

_UNLIMITED = 1e3  # rad, or of any limit that is missing: its program takes no infinite numbers
_SHARE = 0.8  # of the time


def pyroboplan_cubic(problem: Problem, seconds: float) -> RivalAnswer:
    """Find the fastest cubics between the waypoints.

    Parameters
    ----------
    problem : Problem
    seconds : float
        Its program gets four fifths of them [s].

    Returns
    -------
    RivalAnswer
    """
    import pinocchio
    from pyroboplan.trajectory.trajectory_optimization import (
        CubicTrajectoryOptimization,
        CubicTrajectoryOptimizationOptions,
    )

    limits, model, parent = problem.limits, pinocchio.Model(), 0
    for j in range(problem.dof):
        parent = model.addJoint(
            parent, pinocchio.JointModelRZ(), pinocchio.SE3.Identity(), f"joint{j + 1}"
        )
    low, high = problem.position_bounds.T
    model.lowerPositionLimit, model.upperPositionLimit = (
        np.maximum(low, -_UNLIMITED),
        np.minimum(high, _UNLIMITED),
    )
    stopping = REFERENCES["ruckig_stop_and_go"](problem).durations
    longest = 10.0 if stopping is None else 4.0 * float(stopping.max())
    options = CubicTrajectoryOptimizationOptions(
        num_waypoints=len(problem.waypoints),
        min_segment_time=1e-3,
        max_segment_time=longest,
        min_vel=-limits.velocity,
        max_vel=limits.velocity,
        min_accel=-limits.acceleration,
        max_accel=limits.acceleration,
        min_jerk=-limits.jerk,
        max_jerk=limits.jerk,
        max_planning_time=_SHARE * seconds,
    )
    found = CubicTrajectoryOptimization(model, pinocchio.GeometryModel(), options).plan(
        list(problem.waypoints)
    )
    if found is None:
        return RivalAnswer(None, note="its solver found no motion")
    durations = np.array([end - start for start, end in found.segment_times])
    coefficients = np.moveaxis(np.array(found.coeffs), 0, 1)[
        ..., ::-1
    ]  # highest power first, a list per joint
    return RivalAnswer(Trajectory(durations, coefficients.copy()), float(durations.sum()))
