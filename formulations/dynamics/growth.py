"""How fast the torques of a motion can change: bounds on their second derivatives in time.

The Newton-Euler equations are sums of products of vectors in space whose lengths are known. The time
derivatives of every vector are bounded one after the other, from the base outward and back: a vector that is
fixed in a body turns with it, and the derivatives of a product follow Leibniz' rule. Directions are not looked
at, so that the bounds hold in every position of the arm. Bounds are kept as Taylor coefficients,
x_k >= |d^k x / dt^k| / k!, since these multiply as polynomials do.

Notes
-----
Assumed are rigid links with the masses and inertias of the URDF. The bounds are computed in double precision
without outward rounding: their errors are of the size of 1e-14, relative, those of the check 1e-9.
"""

from __future__ import annotations

from math import factorial

import numpy as np

from formulations.dynamics.model import ArmDynamics, Body
from formulations.problem.arrays import Array

ORDERS = 5  # position, and the four derivatives that a second derivative of a torque contains


def growth(dynamics: ArmDynamics, reach: Array) -> Array:
    """Bound the second derivatives of the torques in time.

    Parameters
    ----------
    dynamics : ArmDynamics
    reach : Array, shape (5, n, dof)
        Greatest moduli of the position and its first four derivatives during n spans of time [rad/s^k].

    Returns
    -------
    Array, shape (n, dof)
        Bounds on the moduli [N m/s^2].
    """
    n = reach.shape[1]
    joints = reach / np.array([factorial(k) for k in range(ORDERS)])[:, None, None]
    bodies = dynamics.bodies
    turns: list[Array] = []  # angular velocity of each body, (4, n)
    moves: list[Array] = []  # acceleration of each joint's origin, (3, n)
    arms: list[Array] = []  # from the origin of the joint before to this one, (3, n)
    axes: list[Array] = []
    for body in bodies:
        base = body.parent < 0
        turn = np.zeros((4, n)) if base else turns[body.parent]
        move = np.zeros((3, n)) if base else moves[body.parent]
        axis = _turned(1.0, turn)
        arm = _turned(float(np.linalg.norm(body.offset)), turn)
        rate = joints[:, :, body.joint]
        if body.prismatic:
            arm = arm + _product(axis, rate)
            turns.append(turn)
        else:
            turns.append(turn + _product(axis, _derived(rate)))
        axes.append(axis)
        arms.append(arm)
        moves.append(move + _derived(_derived(arm)))
    found = np.zeros((n, dynamics.dof))
    forces, moments = np.zeros((2, len(bodies), 3, n))
    for index in range(len(bodies) - 1, -1, -1):
        body, axis = bodies[index], axes[index][:3]
        force, moment = _needed(body, turns[index], moves[index], dynamics.gravity)
        force += forces[index]
        moment += moments[index]
        if body.parent >= 0:
            forces[body.parent] += force
            moments[body.parent] += moment + _product(arms[index][:3], force)
        torque = _product(axis, force if body.prismatic else moment)
        # viscous damping adds D q', whose second derivative is D q'''
        found[:, body.joint] = 2.0 * torque[2] + dynamics.damping[body.joint] * reach[3, :, body.joint]
    return found


def _needed(body: Body, turn: Array, move: Array, gravity: Array) -> tuple[Array, Array]:
    """Force on a body and moment about its joint, (3, n) each, without those of the bodies behind it."""
    com = _turned(float(np.linalg.norm(body.com)), turn)
    force = body.mass * (move + _derived(_derived(com)))
    force[0] += body.mass * np.linalg.norm(gravity)
    stiff = float(np.linalg.norm(body.inertia, 2))
    spin = _product(_turned(stiff, 2.0 * turn), turn)  # a tensor turns on both of its sides
    return force, _derived(spin) + _product(com[:3], force)


def _turned(length: float, turn: Array) -> Array:
    """A vector that is fixed in a body with angular velocity ``turn`` (4, n): x' = turn x x, (5, n)."""
    found = np.zeros((len(turn) + 1, turn.shape[1]))
    found[0] = length
    for k in range(len(turn)):
        found[k + 1] = (turn[: k + 1] * found[k::-1]).sum(axis=0) / (k + 1)
    return found


def _product(x: Array, y: Array) -> Array:
    """Leibniz' rule, as far as both factors are known."""
    orders = min(len(x), len(y))
    return np.stack([(x[: k + 1] * y[k::-1]).sum(axis=0) for k in range(orders)])


def _derived(x: Array) -> Array:
    """The derivative in time."""
    return np.asarray(x[1:] * np.arange(1, len(x))[:, None])
