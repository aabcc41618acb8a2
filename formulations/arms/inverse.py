"""Inverse kinematics with all branches: EAIK's closed forms, each polished on forward kinematics.

The closed forms divide by zero at a singular pose (two axes in line), where single solutions become a
continuum. There the pose is moved by a hair, solved, and the solutions are polished back onto it;
of a continuum that leaves some members, and the one nearest to the last waypoint is found by moving
along it (000 sec. 1 and 001 eq. 2-6 stop at this case).
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
_HAIR = 1e-3  # m and rad that a singular pose is moved by
_SAME = 1e-6  # rad between solutions that count as one
_TURN = 2.0 * np.pi


def branches(arm: Arm, pose: Array) -> Array:
    """All joint positions (m, 6) [rad] within +-pi that put the tool at a pose (4, 4) [m].

    Joint limits are ignored. Of a continuum of solutions, some members. Raises InputError if EAIK is
    missing.
    """
    # EAIK drops a singular solution without a word, so a moved pose is always asked too
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
    """The joint positions (6,) [rad] for a pose within the joint limits that are nearest to ``near``.

    Whole turns are added where the limits allow. Raises OutOfReach, which says how far the pose is out
    of reach, of limits or of both.
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
    """Joint positions (n, 6) [rad] for poses in order, each nearest to the last; the first to ``near``.

    near: (6,) [rad]; the middle of the joint limits, or 0 where there are none, if left out. Raises
    OutOfReach that names the pose.
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
    """EAIK's solver of a chain without offsets; one per arm."""
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
    """EAIK's solutions in joint coordinates; its least-squares ones too, where they nearly fit."""
    chain = arm.chain
    solver = _solver(arm.name, *(tuple(row.tolist()) for row in (chain.alpha, chain.a, chain.d)))
    thetas = np.array(solver.IK(pose).Q, dtype=np.float64).reshape(-1, arm.dof)
    joints = _wrapped(chain.sign * (thetas - chain.offset))
    return [q for q in joints if np.abs(error_of(pose, chain.forward(q))).max() < _LOOSE]


def _solutions(arm: Arm, pose: Array, asked: Array) -> list[Array]:
    """The closed forms of one pose, polished onto another."""
    found = [_polished(arm, pose, q) for q in _closed_forms(arm, asked)]
    return [q for q in found if q is not None]


def _moved(pose: Array, axis: int, sign: float) -> Array:
    """A pose beside another: turned and shifted by a hair in directions that no symmetry shares."""
    twist = np.roll([1.0, 0.6, 0.3, 0.8, -0.5, 0.4], axis) * sign * _HAIR
    moved = pose_of(pose[:3, 3] + twist[:3], twist[3:])
    moved[:3, :3] = moved[:3, :3] @ pose[:3, :3]
    return moved


def _polished(arm: Arm, pose: Array, start: Array, near: Array | None = None) -> Array | None:
    """Newton's method on the pose error from a start, within +-pi; None where it does not converge.

    Directions in which the tool does not move are left alone, or followed towards ``near``.
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
    """Angles within +-pi."""
    return np.asarray((angles + np.pi) % _TURN - np.pi)


def _turned(arm: Arm, joints: Array, near: Array) -> Array:
    """The same pose with whole turns added: nearest to ``near``, within the limits if that can be."""
    free = joints + _TURN * np.round((near - joints) / _TURN)
    low, high = arm.position.T
    fewest = np.ceil((low - POSITION_TOLERANCE - joints) / _TURN)
    most = np.floor((high + POSITION_TOLERANCE - joints) / _TURN)
    turns = np.clip(np.round((near - joints) / _TURN), fewest, most)
    return np.asarray(np.where(fewest <= most, joints + _TURN * turns, free))
