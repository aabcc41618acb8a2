"""Inverse kinematics with all solutions: EAIK's closed forms, each polished by Newton's method.

The closed forms divide by zero at a singular pose (two axes in line), where the solutions form a continuum.
There a pose nearby is solved, and its solutions are polished back onto the pose asked for. This gives some
members of the continuum; the one nearest to the last waypoint is found by moving along it. The papers do
not treat this case (Wang 2025, sec. 1; Li 2022, eq. 2-6).
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from formulations.arms.arm import Arm
from formulations.arms.kinematics import error_of, pose_of
from formulations.arms.reach import refusal
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, OutOfReach
from formulations.problem.problem import POSITION_TOLERANCE

_EXACT = 1e-9  # m and rad that a solution may miss its pose by
_LOOSE = 1e-3  # of EAIK's own, before polishing
_SINGULAR = 1e-4  # least singular value of the Jacobian (m/rad and 1) of a regular solution
_NEARBY = 1e-3  # m and rad between a singular pose and the one that is solved in its place
_SAME = 1e-6  # rad between solutions that count as one
_TURN = 2.0 * np.pi


def branches(arm: Arm, pose: Array) -> Array:
    """Find all joint positions within +-pi that put the tool at a pose; joint limits are ignored.

    Parameters
    ----------
    arm : Arm
        An arm with six joints.
    pose : Array, shape (4, 4)
        Homogeneous transform of the tool, lengths in m.

    Returns
    -------
    Array, shape (m, 6)
        Solutions [rad]; of a continuum, some members.

    Raises
    ------
    InputError
        If EAIK is not installed.
    """
    # EAIK drops singular solutions without notice, so a pose nearby is always solved too
    exact = _solutions(arm, pose, pose) + _solutions(arm, pose, _moved(pose, 0, 1.0))
    if not exact or any(_is_singular(arm, q) for q in exact):
        for axis in range(6):
            for sign in (1.0, -1.0):
                exact += _solutions(arm, pose, _moved(pose, axis, sign))
    distinct: list[Array] = []
    for q in exact:
        if all(np.abs(_wrapped(q - other)).max() > _SAME for other in distinct):
            distinct.append(q)
    return np.array(distinct).reshape(-1, arm.dof)


def nearest(arm: Arm, pose: Array, near: Array) -> Array:
    """Find the joint positions for a pose, within the joint limits, that are nearest to others.

    Whole turns are added where the limits allow it.

    Parameters
    ----------
    arm : Arm
        An arm with six joints.
    pose : Array, shape (4, 4)
        Homogeneous transform of the tool, lengths in m.
    near : Array, shape (6,)
        Joint positions to stay near to [rad].

    Returns
    -------
    Array, shape (6,)
        Joint positions [rad].

    Raises
    ------
    OutOfReach
        Says how far the pose is out of the arm's reach, or of its joint limits.
    """
    inside: list[Array] = []
    excess: list[tuple[float, int]] = []
    followed = _polished(arm, pose, _wrapped(near), near)  # from the last waypoint itself
    found = list(branches(arm, pose)) + ([] if followed is None else [followed])
    for branch in found:
        choices = [branch]
        if _is_singular(arm, branch):
            pulled = _polished(arm, pose, branch, near)
            choices += [] if pulled is None else [pulled]
        for q in choices:
            turned = _turned(arm, q, near)
            low, high = arm.position.T
            over = np.maximum(low - turned, turned - high)
            if over.max() <= POSITION_TOLERANCE:
                inside.append(turned)
            else:
                excess.append((float(over.max()), int(over.argmax())))
    if inside:
        return min(inside, key=lambda q: float(np.linalg.norm(q - near)))
    if excess:
        most, joint = min(excess)
        raise OutOfReach(
            f"all {len(excess)} solutions leave the joint limits of {arm.name}; the best by "
            f"{np.rad2deg(most):.3g} deg, joint {joint + 1}",
            0.0,
        )
    raise refusal(arm, pose)


def joints_of(arm: Arm, poses: list[Array], near: Array | None = None) -> Array:
    """Find joint positions for poses in order, each nearest to the one before.

    Parameters
    ----------
    arm : Arm
        An arm with six joints.
    poses : list of Array, shape (4, 4)
        Homogeneous transforms of the tool, lengths in m.
    near : Array, shape (6,), optional
        What the first is nearest to [rad]. Left out: the middle of the joint limits, or 0 without limits.

    Returns
    -------
    Array, shape (n, 6)
        Joint positions [rad].

    Raises
    ------
    OutOfReach
        Names the pose.
    """
    if near is None:
        known = np.where(np.isfinite(arm.position), arm.position, 0.0)
        near = np.where(np.isfinite(arm.position).all(axis=1), known.mean(axis=1), 0.0)
    path = []
    for index, pose in enumerate(poses):
        try:
            near = nearest(arm, pose, near)
        except OutOfReach as error:
            raise OutOfReach(f"pose {index + 1}: {error}", error.distance) from None
        path.append(near)
    return np.array(path)


@cache
def _solver(name: str, *table: tuple[float, ...]) -> Any:
    """Make EAIK's solver of a chain without offsets, once per arm."""
    try:
        from eaik.IK_DH import DhRobot
    except ImportError:
        raise InputError(
            "pose: inverse kinematics needs the package eaik: pip install 'timebound[arms]'"
        ) from None
    alpha, a, d = (np.array(row) for row in table)
    solver = DhRobot(alpha, a, d)
    if not solver.hasKnownDecomposition():
        raise InputError(f"arm: {name} has no closed-form inverse kinematics")
    return solver


def _closed_forms(arm: Arm, pose: Array) -> list[Array]:
    """Return EAIK's solutions in joint coordinates, and its least-squares ones that nearly fit."""
    chain = arm.chain
    solver = _solver(arm.name, *(tuple(row.tolist()) for row in (chain.alpha, chain.a, chain.d)))
    asked = np.linalg.solve(chain.base, pose)
    thetas = np.array(solver.IK(asked).Q, dtype=np.float64).reshape(-1, arm.dof)
    joints = _wrapped(chain.sign * (thetas - chain.offset))
    return [q for q in joints if np.abs(error_of(pose, chain.forward(q))).max() < _LOOSE]


def _solutions(arm: Arm, pose: Array, asked: Array) -> list[Array]:
    """Solve one pose in closed form and polish the solutions onto another."""
    found = [_polished(arm, pose, q) for q in _closed_forms(arm, asked)]
    return [q for q in found if q is not None]


def _moved(pose: Array, axis: int, sign: float) -> Array:
    """Turn and shift a pose a little, in directions that no symmetry of an arm shares."""
    twist = np.roll([1.0, 0.6, 0.3, 0.8, -0.5, 0.4], axis) * sign * _NEARBY
    moved = pose_of(pose[:3, 3] + twist[:3], twist[3:])
    moved[:3, :3] = moved[:3, :3] @ pose[:3, :3]
    return moved


def _polished(arm: Arm, pose: Array, start: Array, near: Array | None = None) -> Array | None:
    """Apply Newton's method to the pose error, within +-pi; None if it does not converge.

    In directions in which the tool does not move, the joints stay or, if given, move towards ``near``.
    """
    q = start
    for _ in range(50):
        error = error_of(pose, arm.chain.forward(q))
        U, s, Vt = np.linalg.svd(arm.chain.jacobian(q))
        kept = s > 1e-2 * _SINGULAR
        step = Vt[kept].T @ ((U.T @ error)[kept] / s[kept])
        if near is not None:
            rest = _wrapped(near - q)
            step = step + rest - Vt[kept].T @ (Vt[kept] @ rest)
        size = float(np.abs(step).max())
        if size < 1e-13:
            break
        q = q + step * min(1.0, 0.3 / size)
    good = np.abs(error_of(pose, arm.chain.forward(q))).max() < _EXACT
    return _wrapped(q) if good else None


def _is_singular(arm: Arm, joints: Array) -> bool:
    return bool(np.linalg.svd(arm.chain.jacobian(joints), compute_uv=False)[-1] < _SINGULAR)


def _wrapped(angles: Array) -> Array:
    """Return the same angles within +-pi."""
    return np.asarray((angles + np.pi) % _TURN - np.pi)


def _turned(arm: Arm, joints: Array, near: Array) -> Array:
    """Add whole turns: nearest to ``near``, and within the limits where that is possible."""
    free = joints + _TURN * np.round((near - joints) / _TURN)
    low, high = arm.position.T
    fewest = np.ceil((low - POSITION_TOLERANCE - joints) / _TURN)
    most = np.floor((high + POSITION_TOLERANCE - joints) / _TURN)
    turns = np.clip(np.round((near - joints) / _TURN), fewest, most)
    return np.asarray(np.where(fewest <= most, joints + _TURN * turns, free))
