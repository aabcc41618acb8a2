"""What an arm can reach: its Monte Carlo workspace (Lu & Wang 2024), and how far a point is out of it."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import minimize

from formulations.arms.arm import Arm
from formulations.arms.kinematics import error_of
from formulations.problem.arrays import Array
from formulations.problem.errors import OutOfReach

_STARTS = 40
_REACHED = 1e-6  # m
_TURNED = 1e-7  # rad off an orientation that is to be kept


def random_joints(arm: Arm, n: int, seed: int = 0) -> Array:
    """Draw joint positions evenly within the limits, or within +-pi where there are none.

    Parameters
    ----------
    arm : Arm
        The arm.
    n : int
        How many.
    seed : int
        Of the random numbers.

    Returns
    -------
    Array, shape (n, dof)
        [rad].
    """
    low, high = _box(arm)
    return np.asarray(np.random.default_rng(seed).uniform(low, high, (n, arm.dof)))


def workspace(arm: Arm, n: int = 20_000, seed: int = 0) -> Array:
    """Compute the tool points of random joint positions, the Monte Carlo workspace.

    Parameters
    ----------
    arm : Arm
        The arm.
    n : int
        How many points.
    seed : int
        Of the random numbers.

    Returns
    -------
    Array, shape (n, 3)
        [m].
    """
    return np.asarray(arm.chain.forward(random_joints(arm, n, seed))[:, :3, 3])


def distance_to(arm: Arm, position: Array) -> tuple[float, Array]:
    """Find how near the tool gets to a position, in any orientation.

    This is the best of many local searches within the joint limits: an upper bound on the true distance.

    Parameters
    ----------
    arm : Arm
        The arm.
    position : Array, shape (3,)
        [m].

    Returns
    -------
    distance : float
        [m].
    joints : Array, shape (dof,)
        Joint positions at this distance [rad].
    """
    joints = _nearest(arm, position, ())
    return float(np.linalg.norm(arm.chain.forward(joints)[:3, 3] - position)), joints


def distance_in_pose(arm: Arm, pose: Array) -> float:
    """Find how near the tool gets to the position of a pose in the orientation of that pose.

    Parameters
    ----------
    arm : Arm
        The arm.
    pose : Array, shape (4, 4)
        Homogeneous transform, lengths in m.

    Returns
    -------
    float
        Distance [m], the best of many local searches; infinite if none of them ends in the orientation.
    """

    def turned(q: Array) -> Array:
        return error_of(pose, arm.chain.forward(q))[3:]

    def slope(q: Array) -> Array:
        return -arm.chain.jacobian(q)[3:]  # exact where the constraint holds

    joints = _nearest(arm, pose[:3, 3], ({"type": "eq", "fun": turned, "jac": slope},))
    if np.abs(turned(joints)).max() > _TURNED:
        return float("inf")
    return float(np.linalg.norm(arm.chain.forward(joints)[:3, 3] - pose[:3, 3]))


def refusal(arm: Arm, pose: Array) -> OutOfReach:
    """Explain why no joint positions put the tool at a pose.

    Parameters
    ----------
    arm : Arm
        The arm.
    pose : Array, shape (4, 4)
        Homogeneous transform, lengths in m.

    Returns
    -------
    OutOfReach
        One line with the distance, to be raised.
    """
    point = np.array2string(pose[:3, 3], precision=4, separator=", ", suppress_small=True)
    orientation = "any"
    distance, _ = distance_to(arm, pose[:3, 3])
    if distance < _REACHED:
        orientation, distance = "this", distance_in_pose(arm, pose)
    return OutOfReach(
        f"position {point} m is out of reach of {arm.name} in {orientation} orientation: "
        f"its tool gets no nearer than {1e3 * distance:.1f} mm",
        distance,
    )


def _nearest(arm: Arm, position: Array, constraints: tuple[dict[str, Any], ...]) -> Array:
    """The joint positions of the best of many local searches, (dof,) [rad]."""

    def miss(q: Array) -> tuple[float, Array]:
        gap = arm.chain.forward(q)[:3, 3] - position
        return float(gap @ gap), 2.0 * gap @ arm.chain.jacobian(q)[:3]

    low, high = _box(arm)
    best, joints = np.inf, low
    for start in np.random.default_rng(0).uniform(low, high, (_STARTS, arm.dof)):
        found = minimize(
            miss, start, jac=True, method="SLSQP", bounds=arm.position, constraints=constraints,
            options={"ftol": 1e-14, "maxiter": 200},
        )  # fmt: skip
        broken = max((float(np.abs(c["fun"](found.x)).max()) for c in constraints), default=0.0)
        if broken <= _TURNED and found.fun < best:
            best, joints = float(found.fun), np.asarray(found.x)
        if best < _REACHED**2:
            break
    return joints


def _box(arm: Arm) -> tuple[Array, Array]:
    low, high = arm.position.T
    return np.where(np.isfinite(low), low, -np.pi), np.where(np.isfinite(high), high, np.pi)
