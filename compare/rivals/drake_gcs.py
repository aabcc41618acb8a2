"""Drake's GcsTrajectoryOptimization: a Bezier curve of free duration per segment, joined at the waypoints."""

from __future__ import annotations

import numpy as np

from compare.rivals.pieces import from_derivatives
from compare.rivals.rival import RivalAnswer, moving_waypoints
from formulations import Trajectory
from formulations.problem.problem import Problem

_DEGREE = 5
_MARGIN = 1.0  # rad beyond the waypoints where there are no position limits
_LONGEST = 100.0  # times what the velocity limits ask for


def drake_gcs(problem: Problem, seconds: float) -> RivalAnswer:
    """Find the fastest chain of Bezier curves by a graph of convex sets that is one path.

    Parameters
    ----------
    problem : Problem
    seconds : float
        Not used: its solvers have no common time limit.

    Returns
    -------
    RivalAnswer
    """
    from pydrake.geometry.optimization import GraphOfConvexSetsOptions, HPolyhedron, Point
    from pydrake.planning import GcsTrajectoryOptimization

    limits, points = problem.limits, moving_waypoints(problem)
    low, high = problem.position_bounds.T
    low = np.where(np.isfinite(low), low, points.min(axis=0) - _MARGIN)
    high = np.where(np.isfinite(high), high, points.max(axis=0) + _MARGIN)
    box = HPolyhedron.MakeBox(low, high)
    longest = _LONGEST * float((np.abs(problem.displacements) / limits.velocity).max())
    program = GcsTrajectoryOptimization(problem.dof)
    start = program.AddRegions([Point(points[0])], [], 0, 0.0, 0.0, "start")
    end = program.AddRegions([Point(points[-1])], [], 0, 0.0, 0.0, "end")
    curves = [
        program.AddRegions([box], [], _DEGREE, 1e-6, longest, f"segment {k + 1}")
        for k in range(len(points) - 1)
    ]
    smooth = 2 if limits.has_jerk else 1
    for ends in (program.AddEdges(start, curves[0]), program.AddEdges(curves[-1], end)):
        for order in range(1, smooth + 1):
            ends.AddZeroDerivativeConstraints(order)
    for before, after, point in zip(curves[:-1], curves[1:], points[1:-1], strict=True):
        joint = program.AddEdges(before, after, Point(point))
        for order in range(1, smooth + 1):
            joint.AddContinuityConstraints(order)
    program.AddTimeCost(1.0)
    for curve in curves:
        curve.AddVelocityBounds(-limits.velocity, limits.velocity)
        if limits.has_acceleration:
            curve.AddNonlinearDerivativeBounds(-limits.acceleration, limits.acceleration, 2)
        if limits.has_jerk:
            curve.AddNonlinearDerivativeBounds(-limits.jerk, limits.jerk, 3)
    options = GraphOfConvexSetsOptions()
    options.convex_relaxation = True
    options.max_rounded_paths = 1
    options.preprocessing = False
    found, result = program.SolvePath(start, end, options)
    if not result.is_success():
        return RivalAnswer(None, note=f"no path found ({result.get_solution_result().name})")
    motions = []
    for index in range(found.get_number_of_segments()):
        curve = found.segment(index)
        if curve.end_time() - curve.start_time() > 1e-9:  # the two points have no duration
            derivatives = [curve.MakeDerivative(k) if k else curve for k in range(_DEGREE + 1)]
            breaks = np.array([curve.start_time(), curve.end_time()])
            motions.append(
                from_derivatives(lambda t, k, d=derivatives: d[k].value(t), breaks, _DEGREE)  # type: ignore[misc]
            )
    motion = Trajectory(
        np.concatenate([m.durations for m in motions]),
        np.concatenate([m.coefficients for m in motions]),
    )
    return RivalAnswer(motion, float(found.end_time() - found.start_time()))
