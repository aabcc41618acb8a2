"""TOPP-RA (Pham & Pham 2018) with torque limits: the fastest motion along a fixed path, without jerk limits.

The torques of the arm are linear in the path's acceleration and in the square of its speed, but for viscous
damping, which TOPP-RA cannot take and which is left out here. Dry friction is subtracted from the limits.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from formulations.dynamics import ArmDynamics, dynamics_of
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.references.reference import Outcome, Rung, RungKind
from formulations.references.toppra_ import clamped_cubic, timed
from formulations.references.toppra_library import toppra


def toppra_torque_on(problem: Problem, path: Trajectory) -> Outcome:
    """Time the path of a motion as fast as velocity, acceleration and torque limits allow.

    Parameters
    ----------
    problem : Problem
        With torque limits among its conditions, and no others; jerk and position limits are not used.
    path : Trajectory
        A motion through the waypoints, from rest to rest.

    Returns
    -------
    Outcome
        Its note states the grid and the grid error.
    """
    torque = problem.conditions.torque
    if torque is None:
        return Outcome.not_applicable("no torque limits")
    replace(problem, conditions=problem.conditions.without_torque()).require_plain(
        "TOPP-RA with torques"
    )
    dynamics = dynamics_of(torque)
    limits = np.stack([-dynamics.available, dynamics.available], axis=1)
    constraint = toppra.constraint.JointTorqueConstraint(
        _inverse_dynamics(dynamics), limits, np.zeros(dynamics.dof)
    )
    found = timed(problem, path, [constraint])
    left_out = "; viscous damping left out" if dynamics.damping.any() else ""
    return replace(found, note=f"{found.note}; torque limits{left_out}")


def toppra_torque(problem: Problem) -> Outcome:
    """Time the clamped cubic spline through the waypoints within torque limits.

    Parameters
    ----------
    problem : Problem
        Its jerk and position limits are not used.

    Returns
    -------
    Outcome
        Its note states the grid and the grid error.
    """
    if problem.conditions.torque is None:
        return Outcome.not_applicable("no torque limits")
    if not problem.moving_joints:
        return Outcome.ok(0.0, note="nothing moves")
    return toppra_torque_on(problem, clamped_cubic(problem))


def _inverse_dynamics(dynamics: ArmDynamics) -> Any:
    def torques(q: Array, v: Array, a: Array) -> Array:
        return dynamics.torques(q, v, a) - dynamics.damping * v

    return torques


TOPPRA_TORQUE = Rung(
    key="toppra_torque",
    kind=RungKind.REFERENCE,
    name="TOPP-RA with torque limits, clamped cubic (no jerk limit)",
    meaning="TOPP-RA on the clamped cubic with torque limits, no jerk limit",
    find=toppra_torque,
    knows_conditions=True,
)
