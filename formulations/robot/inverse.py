"""Inverse kinematics on the chain of a URDF: the joint positions of each pose that are nearest to the last.

Damped Newton steps (Levenberg 1944, Marquardt 1963) run from the last waypoint and from many other starts at
once, within the position limits. For six rotary joints with a closed form, EAIK gives all branches as starts
(the extra ``arms``); without it, and for any other arm, the starts are spread over the limits. Pinocchio
would bring the same Newton steps in a C++ library. Where an arm has more joints than a pose needs, the
solution is moved along its self-motion towards the last waypoint. Every answer is checked by forward
kinematics.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from formulations.kinematics.link_chain import LinkChain
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, OutOfReach
from formulations.robot.joints import UNLIMITED, Joint, JointKind
from formulations.robot.text.files import shown

REACHED = 1e-6  # m that a solution may miss a position by
TURNED = 1e-4  # rad that it may miss an orientation by: an arm of four joints cannot do 3.1416 exactly
MOST_POSES = 2000

_STARTS = 24
_STEPS = 80
_TURN = 2.0 * np.pi


def joints_of_poses(
    chain: LinkChain, joints: Sequence[Joint], poses: Array, near: Array | None = None
) -> Array:
    """Joint positions for poses in order, each nearest to the last.

    Parameters
    ----------
    chain : LinkChain
        From the link that poses are measured from to the one they are given for.
    joints : sequence of Joint
        Its joints; a position limit that is not known limits nothing.
    poses : Array, shape (n, 4, 4)
        [m].
    near : Array, shape (dof,), optional
        What the first shall be nearest to; the middle of the position limits, 0 where there is none, if
        left out.

    Returns
    -------
    Array, shape (n, dof)
        [rad or m]. Nearest is meant as the root of the sum of squares, a metre counting as a radian.

    Raises
    ------
    OutOfReach
        No joint positions within the limits reach a pose within 1e-6 m and 1e-4 rad.
    """
    if poses.ndim != 3 or poses.shape[1:] != (4, 4):
        raise InputError(f"poses: expected shape (n, 4, 4), got {poses.shape}")
    if len(poses) > MOST_POSES:
        raise InputError(f"poses: {len(poses)} are given; at most {MOST_POSES} are solved")
    low, high = np.array([joint.position or UNLIMITED for joint in joints]).T
    if near is None:
        near = np.where(np.isfinite(low) & np.isfinite(high), 0.5 * (low + high), 0.0)
    elif near.shape != (chain.dof,) or not np.isfinite(near).all():
        raise InputError(
            f"near: expected {chain.dof} finite joint positions, got {shown(near.tolist())}"
        )
    near = np.clip(near, low, high)
    search = _Search(chain, joints, low, high)
    path = []
    for index, pose in enumerate(poses):
        try:
            near = search.nearest(pose, near)
        except OutOfReach as error:
            raise OutOfReach(f"pose {index + 1}: {error}", error.distance) from None
        path.append(near)
    return np.array(path).reshape(-1, chain.dof)


class _Search:
    """Solutions of one arm within its position limits."""

    def __init__(self, chain: LinkChain, joints: Sequence[Joint], low: Array, high: Array) -> None:
        self.chain, self.joints, self.low, self.high = chain, joints, low, high
        self.rotary = np.array([joint.kind is not JointKind.PRISMATIC for joint in joints])
        reach = np.where(self.rotary, np.pi, max(chain.size, 1.0))
        box_low = np.where(np.isfinite(low), low, np.minimum(-reach, high - reach))
        box_high = np.where(np.isfinite(high), high, np.maximum(reach, low + reach))
        self.starts = np.random.default_rng(0).uniform(box_low, box_high, (_STARTS, chain.dof))

    def nearest(self, pose: Array, near: Array) -> Array:
        """The solution nearest to ``near``; raises OutOfReach."""
        forms = _closed_forms(self.chain, pose)
        seeds = [near[None], *([self._turned(forms, near)] if len(forms) else [self.starts])]
        starts = np.clip(np.concatenate(seeds), self.low, self.high)
        q, error = _descend(self.chain, pose, starts, self.low, self.high)
        found = q[_is_solved(error)]
        if len(forms) and (not len(found) or self._is_singular(found)):  # EAIK drops singular branches
            q, error = _descend(self.chain, pose, self.starts, self.low, self.high)
            found = np.concatenate([found, q[_is_solved(error)]])
        if not len(found):
            raise self._refusal(pose, near)
        found = np.clip(self._turned(found, near), self.low, self.high)
        order = np.argsort(np.linalg.norm(found - near, axis=1), kind="stable")
        best = [self._pulled(pose, found[k], near) for k in order[:2]]
        return min(best, key=lambda joints: float(np.linalg.norm(joints - near)))

    def _is_singular(self, joints: Array) -> bool:
        """Whether the tip cannot move in some direction at one of the solutions (n, dof)."""
        _, jacobian = self.chain.pose_and_jacobian(joints)
        return bool(np.linalg.svd(jacobian, compute_uv=False)[:, -1].min() < 1e-4)

    def _turned(self, joints: Array, near: Array) -> Array:
        """The same poses with whole turns added: nearest to ``near``, within the limits if that can be."""
        free = np.round((near - joints) / _TURN)
        fewest = np.ceil((self.low - joints) / _TURN - 1e-12)
        most = np.floor((self.high - joints) / _TURN + 1e-12)
        turns = np.where(fewest <= most, np.clip(free, fewest, most), 0.0)
        return np.asarray(np.where(self.rotary, joints + _TURN * turns, joints))

    def _pulled(self, pose: Array, joints: Array, near: Array) -> Array:
        """Move a solution along its self-motion towards ``near`` within the limits, where it has one."""
        share = 1.0
        for _ in range(30):
            _, jacobian = self.chain.pose_and_jacobian(joints[None])
            _, sizes, Vt = np.linalg.svd(jacobian[0])
            rank = int((sizes > 1e-6 * max(1.0, sizes[0])).sum())
            still = Vt[rank:]  # motions of the joints that leave the pose as it is
            step = still.T @ (still @ (near - joints))
            if len(still) == 0 or np.abs(step).max() < 1e-6 or share < 1e-3:
                break
            start = np.clip(joints + share * step, self.low, self.high)[None]
            moved, error = _descend(self.chain, pose, start, self.low, self.high, damping=1e-9)
            closer = np.linalg.norm(moved[0] - near) < np.linalg.norm(joints - near)
            if _is_solved(error)[0] and closer:
                joints = moved[0]
            else:
                share *= 0.5
        return joints

    def _refusal(self, pose: Array, near: Array) -> OutOfReach:
        """Say why a pose has no solution: by which joint, or by how much."""
        infinite = np.full(self.chain.dof, np.inf)
        starts = np.concatenate([near[None], self.starts, _closed_forms(self.chain, pose)])
        q, error = _descend(self.chain, pose, starts, -infinite, infinite)
        free = self._turned(q[_is_solved(error)], near)
        if len(free):
            over = np.maximum(self.low - free, free - self.high)
            best = int(over.max(axis=1).argmin())
            joint = self.joints[int(over[best].argmax())]
            return OutOfReach(
                f"no solution keeps the position limits; the best leaves that of joint {shown(joint.name)} "
                f"by {over[best].max():.3g} {joint.unit}",
                0.0,
            )
        places, miss = _descend(self.chain, pose, starts[: _STARTS + 1], self.low, self.high, rows=3)
        distance = float(np.linalg.norm(miss[:, :3], axis=1).min())
        if distance > REACHED:
            return OutOfReach(f"its position is out of reach by {distance:.3g} m", distance)
        q, error = _descend(self.chain, pose, np.concatenate([starts, places]), self.low, self.high)
        best = int(np.linalg.norm(error, axis=1).argmin())
        shift, turn = np.linalg.norm(error[best, :3]), np.linalg.norm(error[best, 3:])
        return OutOfReach(
            f"its position is within reach, but not with this orientation; the nearest pose found misses "
            f"it by {shift:.3g} m and {np.rad2deg(turn):.3g} deg",
            float(shift),
        )


def _errors(wanted: Array, reached: Array) -> Array:
    """From poses reached (n, 4, 4) to the one wanted, in the base link: position [m], rotation [rad]."""
    turn = Rotation.from_matrix(wanted[:3, :3] @ np.swapaxes(reached[:, :3, :3], 1, 2))
    return np.concatenate([wanted[:3, 3] - reached[:, :3, 3], turn.as_rotvec()], axis=1)


def _is_solved(error: Array) -> Array:
    position, rotation = np.linalg.norm(error[:, :3], axis=1), np.linalg.norm(error[:, 3:], axis=1)
    return np.asarray((position <= REACHED) & (rotation <= TURNED))


def _descend(
    chain: LinkChain,
    pose: Array,
    starts: Array,
    low: Array,
    high: Array,
    *,
    rows: int = 6,
    damping: float = 1e-3,
) -> tuple[Array, Array]:
    """Damped Newton steps from all starts (n, dof) at once, within limits.

    rows: 6 for the whole pose, 3 for its position alone. damping: that of the first step. Returns joint
    positions and errors (n, 6).
    """
    q = np.clip(starts, low, high)
    reached, jacobian = chain.pose_and_jacobian(q)
    error = _errors(pose, reached)
    damped = np.full(len(q), damping)
    for _ in range(_STEPS):
        J, e = jacobian[:, :rows], error[:, :rows]
        slope = np.einsum("nij,ni->nj", J, e)
        held = ((q <= low) & (slope < 0.0)) | ((q >= high) & (slope > 0.0))
        J = np.where(held[:, None], 0.0, J)
        slope = np.where(held, 0.0, slope)
        exact = np.linalg.norm(e, axis=1) < 1e-13
        if ((np.abs(slope).max(axis=1) < 1e-14) | exact).all():
            break
        normal = np.swapaxes(J, 1, 2) @ J + damped[:, None, None] * np.eye(chain.dof)
        step = np.linalg.solve(normal, slope[:, :, None])[:, :, 0]
        step *= np.minimum(1.0, 0.5 / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-300))
        trial = np.clip(q + step, low, high)
        reached, trial_jacobian = chain.pose_and_jacobian(trial)
        trial_error = _errors(pose, reached)
        better = np.linalg.norm(trial_error[:, :rows], axis=1) < np.linalg.norm(e, axis=1)
        q = np.where(better[:, None], trial, q)
        error = np.where(better[:, None], trial_error, error)
        jacobian = np.where(better[:, None, None], trial_jacobian, jacobian)
        damped = np.clip(np.where(better, damped / 5.0, damped * 4.0), 1e-10, 1e6)
        if not better.any() and damped[~exact].min() >= 1e3:
            break
    return q, error


def _closed_forms(chain: LinkChain, pose: Array) -> Array:
    """EAIK's branches (m, dof) [rad] of a pose, near enough to start from; none where it has no closed form."""
    none = np.empty((0, chain.dof))
    if chain.dof != 6 or len(chain.steps) != 6 or any(step.prismatic for step in chain.steps):
        return none
    if sorted(step.variable for step in chain.steps) != list(range(6)):
        return none
    solver, turn = _solver(chain)
    if solver is None:
        return none
    asked = pose.copy()
    asked[:3, :3] = pose[:3, :3] @ turn.T
    angles = np.array(solver.IK(asked).Q, dtype=np.float64).reshape(-1, 6)
    angles = angles[np.isfinite(angles).all(axis=1)]
    found = np.empty_like(angles)
    for k, step in enumerate(chain.steps):
        found[:, step.variable] = (angles[:, k] - step.offset) / step.factor
    return found


@lru_cache(maxsize=32)
def _solver(chain: LinkChain) -> tuple[Any, Array]:
    """EAIK's solver of a chain, and the orientation of its tip where no joint is turned."""
    pose, axes, points = np.eye(4), [], []
    for step in chain.steps:
        pose = pose @ step.before
        axes.append(pose[:3, :3] @ step.axis)
        points.append(pose[:3, 3])
        pose = pose @ step.after
    pose = pose @ chain.end
    if any(step.factor == 0.0 for step in chain.steps):
        return None, pose[:3, :3]
    try:
        from eaik.IK_HP import HPRobot
    except ImportError:
        return None, pose[:3, :3]
    offsets = np.diff(np.array([np.zeros(3), *points, pose[:3, 3]]), axis=0)
    solver = HPRobot(np.array(axes), offsets)
    return (solver if solver.hasKnownDecomposition() else None), pose[:3, :3]
