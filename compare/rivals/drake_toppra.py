"""Drake's Toppra on the cubic spline through the waypoints; its arm is a chain of joints without mass."""

from __future__ import annotations

import numpy as np

from compare.rivals.pieces import along, from_derivatives
from compare.rivals.rival import RivalAnswer
from compare.rivals.spline_path import as_pieces, grid_of, spline_path
from formulations.problem.problem import Problem


def drake_toppra(problem: Problem, seconds: float) -> RivalAnswer:
    """Time the spline as fast as velocity and acceleration limits allow.

    Parameters
    ----------
    problem : Problem
        Its jerk and position limits cannot be asked for.
    seconds : float
        Not used: it takes milliseconds.

    Returns
    -------
    RivalAnswer
    """
    from pydrake.multibody.optimization import Toppra
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import PrismaticJoint, RevoluteJoint, SpatialInertia
    from pydrake.trajectories import PiecewisePolynomial

    limits, path = problem.limits, spline_path(problem)
    plant = MultibodyPlant(0.0)
    frame = plant.world_frame()
    for joint, unit in enumerate(problem.units):
        body = plant.AddRigidBody(f"body{joint}", SpatialInertia.SolidSphereWithMass(1.0, 0.1))
        kind = PrismaticJoint if unit == "m" else RevoluteJoint
        plant.AddJoint(kind(f"joint{joint}", frame, body.body_frame(), [0.0, 0.0, 1.0]))
        frame = body.body_frame()
    plant.Finalize()
    given = PiecewisePolynomial.CubicHermite(path.x, path(path.x).T, path(path.x, 1).T)
    grid = grid_of(path)
    timing = Toppra(given, plant, grid)
    timing.AddJointVelocityLimit(-limits.velocity, limits.velocity)
    if limits.has_acceleration:
        timing.AddJointAccelerationLimit(-limits.acceleration, limits.acceleration)
    found = timing.SolvePathParameterization()
    if found is None:
        return RivalAnswer(None, note="no parameterisation found")
    breaks = np.array(found.get_segment_times())
    derivatives = [found.derivative(k) for k in range(4)]
    pace = from_derivatives(lambda t, k: derivatives[k].value(t), breaks - breaks[0], 3)
    return RivalAnswer(
        along(as_pieces(path), pace), float(breaks[-1] - breaks[0]), note=f"{len(grid)} grid points"
    )
