"""The same dynamics as CasADi symbols, for programs: the recursive Newton-Euler equations.

Pinocchio's wheel comes without its CasADi half. The check uses Pinocchio, so that it shares no code with the
programs that it judges.

References
----------
Featherstone 2008, "Rigid Body Dynamics Algorithms", table 5.1, Springer.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi
import numpy as np

from formulations.dynamics.model import ArmDynamics, Body


@lru_cache(maxsize=16)
def symbolic_torques(dynamics: ArmDynamics) -> Any:
    """Make the torques of a sample as a function of CasADi.

    Parameters
    ----------
    dynamics : ArmDynamics

    Returns
    -------
    casadi.Function
        (q, v, a), each (dof,), to torques (dof,) as shares of what is available.
    """
    q, v, a = (casadi.SX.sym(name, dynamics.dof) for name in "qva")
    turns: list[Any] = []
    spins: list[Any] = []
    moves: list[Any] = []
    poses, forces, moments = [], [], []
    for body in dynamics.bodies:
        rotation, offset = _pose(body, q[body.joint])
        axis = casadi.DM(body.axis)
        if body.parent < 0:
            turn, spin = casadi.SX(3, 1), casadi.SX(3, 1)
            move = casadi.SX(casadi.DM(-dynamics.gravity))  # gravity as an acceleration of the base
        else:
            turn, spin, move = (known[body.parent] for known in (turns, spins, moves))
        move = rotation.T @ (
            move + casadi.cross(spin, offset) + casadi.cross(turn, casadi.cross(turn, offset))
        )
        turn, spin = rotation.T @ turn, rotation.T @ spin
        rate, gain = axis * v[body.joint], axis * a[body.joint]
        if body.prismatic:
            move += gain + 2.0 * casadi.cross(turn, rate)
        else:
            spin += gain + casadi.cross(turn, rate)
            turn += rate
        turns.append(turn)
        spins.append(spin)
        moves.append(move)
        poses.append((rotation, offset))
        com, inertia = casadi.DM(body.com), casadi.DM(body.inertia)
        at_com = move + casadi.cross(spin, com) + casadi.cross(turn, casadi.cross(turn, com))
        forces.append(body.mass * at_com)
        moments.append(
            inertia @ spin + casadi.cross(turn, inertia @ turn) + casadi.cross(com, forces[-1])
        )
    found: list[Any] = [0.0] * dynamics.dof
    for index in range(len(dynamics.bodies) - 1, -1, -1):
        body, (rotation, offset) = dynamics.bodies[index], poses[index]
        along = casadi.dot(casadi.DM(body.axis), (forces if body.prismatic else moments)[index])
        found[body.joint] = along + dynamics.damping[body.joint] * v[body.joint]
        if body.parent >= 0:
            force = rotation @ forces[index]
            forces[body.parent] += force
            moments[body.parent] += rotation @ moments[index] + casadi.cross(offset, force)
    shares = casadi.densify(casadi.vertcat(*found)) / casadi.DM(dynamics.available)
    return casadi.Function("torques", [q, v, a], [shares], {"cse": True})


def _pose(body: Body, position: Any) -> tuple[Any, Any]:
    """Rotation and origin of a joint's frame in the one before it."""
    fixed, offset = casadi.DM(body.rotation), casadi.DM(body.offset)
    if body.prismatic:
        return casadi.SX(fixed), offset + fixed @ casadi.DM(body.axis) * position
    k = casadi.DM(np.cross(body.axis, np.eye(3)).T)  # k @ x is axis x x
    turned = casadi.DM.eye(3) + casadi.sin(position) * k + (1.0 - casadi.cos(position)) * (k @ k)
    return fixed @ turned, casadi.SX(offset)
