"""Forward kinematics of a Denavit-Hartenberg chain (Wang 2025, eq. 1-2; Li 2022, eq. 1), and poses.

Standard form: T = T1 T2 ... Tn, Ti = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i),
theta_i = sign_i q_i + offset_i.
Modified form (Craig): Ti = Rx(alpha_{i-1}) Tx(a_{i-1}) Rz(theta_i) Tz(d_i); row i of its table has alpha_{i-1}
and a_{i-1}. Its factors in other brackets are a standard chain on a base: Rx(alpha_0) Tx(a_0), then links with
alpha_i and a_i, the last of them without any (``Chain.modified``).

References
----------
Denavit, Hartenberg: A kinematic notation for lower-pair mechanisms based on matrices, J. Appl. Mech. 22 (1955).
Craig: Introduction to Robotics: Mechanics and Control, sec. 3.5-3.6.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from formulations.kinematics.link_chain import LinkChain, Step
from formulations.problem.arrays import Array


@dataclass(frozen=True)
class Chain:
    """A chain of revolute joints: Denavit-Hartenberg parameters of the standard form, on a base.

    Attributes
    ----------
    d, a : Array, shape (dof,)
        Link offsets and lengths [m].
    alpha, offset : Array, shape (dof,)
        Link twists, and the DH angles at joint position 0 [rad].
    sign : Array, shape (dof,)
        +1 or -1, the sense of each joint.
    base : Array, shape (4, 4)
        Homogeneous transform in front of the first joint [m]; the identity but for tables of the modified form.
    """

    d: Array
    a: Array
    alpha: Array
    offset: Array
    sign: Array
    base: Array = field(default_factory=lambda: np.eye(4))

    @classmethod
    def modified(cls, d: Array, a: Array, alpha: Array, offset: Array, sign: Array) -> Chain:
        """Make a chain of a table of the modified form (Craig).

        Parameters
        ----------
        d, offset, sign : Array, shape (dof,)
            As for a chain.
        a, alpha : Array, shape (dof,)
            a_{i-1} [m] and alpha_{i-1} [rad] of joint i, as the rows of such a table hold them.

        Returns
        -------
        Chain
            Its tool is the frame of the last joint.
        """
        c, s = np.cos(alpha[0]), np.sin(alpha[0])
        base = np.array([[1, 0, 0, a[0]], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])
        return cls(d, np.append(a[1:], 0.0), np.append(alpha[1:], 0.0), offset, sign, base)

    @cached_property
    def links(self) -> LinkChain:
        """The same chain as a product of fixed poses and joint motions, as those of URDF robots are."""
        after = self.link(np.zeros(len(self.d)))
        steps = tuple(
            Step(
                before=self.base if i == 0 else np.eye(4),
                after=after[i],
                axis=np.array([0.0, 0.0, 1.0]),
                prismatic=False,
                variable=i,
                factor=float(self.sign[i]),
                offset=float(self.offset[i]),
            )
            for i in range(len(self.d))
        )
        return LinkChain(tuple(f"joint {i + 1}" for i in range(len(steps))), steps, np.eye(4))

    def theta(self, joints: ArrayLike) -> Array:
        """Convert joint positions to DH angles.

        Parameters
        ----------
        joints : array_like, shape (..., dof)
            Joint positions [rad].

        Returns
        -------
        Array, shape (..., dof)
            [rad].
        """
        return np.asarray(self.sign * np.asarray(joints, dtype=np.float64) + self.offset)

    def frames(self, joints: ArrayLike) -> Array:
        """Compute the frame of the base and the frame at the end of each link.

        Parameters
        ----------
        joints : array_like, shape (..., dof)
            Joint positions [rad].

        Returns
        -------
        Array, shape (..., dof + 1, 4, 4)
            Homogeneous transforms, lengths in m.
        """
        link = self.link(self.theta(joints))
        frames = [np.broadcast_to(self.base, link[..., 0, :, :].shape)]
        for i in range(link.shape[-3]):
            frames.append(frames[-1] @ link[..., i, :, :])
        return np.stack(frames, axis=-3)

    def link(self, theta: Array) -> Array:
        """Compute the transform of each link (Wang 2025, eq. 1).

        Parameters
        ----------
        theta : Array, shape (..., dof)
            DH angles [rad].

        Returns
        -------
        Array, shape (..., dof, 4, 4)
            Homogeneous transforms, lengths in m.
        """
        c, s = np.cos(theta), np.sin(theta)
        ca, sa = np.cos(self.alpha), np.sin(self.alpha)
        link = np.zeros((*theta.shape, 4, 4))
        rows = (
            (c, -ca * s, sa * s, self.a * c),
            (s, ca * c, -sa * c, self.a * s),
            (0.0, sa, ca, self.d),
            (0.0, 0.0, 0.0, 1.0),
        )
        for i, row in enumerate(rows):
            for j, value in enumerate(row):
                link[..., i, j] = value
        return link

    def forward(self, joints: ArrayLike) -> Array:
        """Compute the pose of the tool (Wang 2025, eq. 2).

        Parameters
        ----------
        joints : array_like, shape (..., dof)
            Joint positions [rad].

        Returns
        -------
        Array, shape (..., 4, 4)
            Homogeneous transforms, lengths in m.
        """
        return np.asarray(self.frames(joints)[..., -1, :, :])

    def jacobian(self, joints: ArrayLike) -> Array:
        """Compute the Jacobian of the tool in the base frame.

        Parameters
        ----------
        joints : array_like, shape (dof,)
            Joint positions [rad].

        Returns
        -------
        Array, shape (6, dof)
            Velocity [m] and angular velocity [1] per joint velocity.
        """
        frames = self.frames(joints)
        axis, origin = frames[:-1, :3, 2] * self.sign[:, None], frames[:-1, :3, 3]
        return np.concatenate([np.cross(axis, frames[-1, :3, 3] - origin), axis], axis=1).T


def pose_of(position: ArrayLike, rpy: ArrayLike) -> Array:
    """Make a pose from a position and roll, pitch and yaw: R = Rz(yaw) Ry(pitch) Rx(roll).

    This is the reading of the angles in Wang 2025, Table 4 that fits the arm.

    Parameters
    ----------
    position : array_like, shape (3,)
        [m].
    rpy : array_like, shape (3,)
        Roll, pitch, yaw [rad].

    Returns
    -------
    Array, shape (4, 4)
        Homogeneous transform.
    """
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    pose = np.eye(4)
    pose[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    pose[:3, 3] = position
    return pose


def rpy_of(pose: Array) -> Array:
    """Extract roll, pitch and yaw.

    Parameters
    ----------
    pose : Array, shape (..., 4, 4)
        Homogeneous transforms.

    Returns
    -------
    Array, shape (..., 3)
        Roll, pitch, yaw [rad]; the yaw is 0 where the pitch is exactly +-90 deg.
    """
    R = pose[..., :3, :3]
    level = np.hypot(R[..., 0, 0], R[..., 1, 0])
    lost = level < 1e-12
    plain, locked = np.arctan2(R[..., 2, 1], R[..., 2, 2]), np.arctan2(-R[..., 1, 2], R[..., 1, 1])
    roll = np.where(lost, locked, plain)
    yaw = np.where(lost, 0.0, np.arctan2(R[..., 1, 0], R[..., 0, 0]))
    return np.stack([roll, np.arctan2(-R[..., 2, 0], level), yaw], axis=-1)


def error_of(wanted: Array, reached: Array) -> Array:
    """Compute the step from the pose reached to the pose wanted, in the base frame.

    Parameters
    ----------
    wanted, reached : Array, shape (4, 4)
        Homogeneous transforms.

    Returns
    -------
    Array, shape (6,)
        Position [m] and rotation vector [rad].
    """
    turn = wanted[:3, :3] @ reached[:3, :3].T
    axis = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    sine, cosine = float(np.linalg.norm(axis)), 0.5 * (float(np.trace(turn)) - 1.0)
    if sine < 1e-9 and cosine < 0.0:  # half a turn: the axis is what I + R projects on
        column = (turn + np.eye(3))[:, int(np.diag(turn).argmax())]
        axis, scale = column / np.linalg.norm(column), np.pi
    else:
        scale = np.arctan2(sine, cosine) / sine if sine > 0.0 else 1.0
    return np.concatenate([wanted[:3, 3] - reached[:3, 3], scale * axis])
