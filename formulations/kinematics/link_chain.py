"""A serial chain of joints as a product of steps A M(q) B: a fixed pose, the motion of one joint, a fixed pose.

Robots of a URDF and Denavit-Hartenberg arms both give one: ``Robot.chain`` and ``Arm.tool``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from formulations.problem.arrays import Array


@dataclass(frozen=True, eq=False)
class Step:
    """One joint of a chain.

    Attributes
    ----------
    before, after : Array, shape (4, 4)
        Fixed poses around its motion [m].
    axis : Array, shape (3,)
        Unit vector.
    prismatic : bool
        Whether it moves along the axis.
    variable : int
        Index of the joint position that moves it.
    factor, offset : float
        It is moved by ``factor * position + offset`` [rad or m].
    """

    before: Array
    after: Array
    axis: Array
    prismatic: bool
    variable: int
    factor: float
    offset: float

    def motion(self, joints: Array) -> Array:
        """The pose of its motion.

        Parameters
        ----------
        joints : Array, shape (n, dof)
            Joint positions [rad or m].

        Returns
        -------
        Array, shape (n, 4, 4)
            [m].
        """
        q = self.factor * joints[:, self.variable] + self.offset
        pose = np.broadcast_to(np.eye(4), (len(q), 4, 4)).copy()
        if self.prismatic:
            pose[:, :3, 3] = q[:, None] * self.axis
            return pose
        K, square = self._turns  # Rodrigues: I + sin q K + (1 - cos q) K^2
        pose[:, :3, :3] += np.sin(q)[:, None, None] * K + (1.0 - np.cos(q))[:, None, None] * square
        return pose

    @cached_property
    def _turns(self) -> tuple[Array, Array]:
        x, y, z = self.axis
        K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        return K, K @ K


@dataclass(frozen=True, eq=False)
class LinkChain:
    """The joints between two links.

    Attributes
    ----------
    names : tuple of str
        The joints, in the order of the columns of joint positions.
    steps : tuple of Step
        From base to tip.
    end : Array, shape (4, 4)
        Fixed pose behind the last step [m].
    """

    names: tuple[str, ...]
    steps: tuple[Step, ...]
    end: Array

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, LinkChain):
            return NotImplemented
        return self._numbers == other._numbers

    def __hash__(self) -> int:
        return hash(self._numbers)

    @cached_property
    def _numbers(self) -> tuple[object, ...]:
        """All that the chain consists of, as plain values."""
        steps = (
            (
                *(part.tobytes() for part in (s.before, s.after, s.axis)),
                s.prismatic,
                s.variable,
                s.factor,
                s.offset,
            )
            for s in self.steps
        )
        return (self.names, self.end.tobytes(), *steps)

    def extended(self, position: ArrayLike) -> LinkChain:
        """The chain with its tool point elsewhere on the last link.

        Parameters
        ----------
        position : array_like, shape (3,)
            The new tool point in the frame of the old one [m].

        Returns
        -------
        LinkChain
        """
        offset = np.eye(4)
        offset[:3, 3] = position
        return replace(self, end=self.end @ offset)

    @property
    def dof(self) -> int:
        """Number of joint positions."""
        return len(self.names)

    @cached_property
    def size(self) -> float:
        """Upper bound on the distance between base and tip without prismatic joints [m]."""
        poses = [self.end, *(pose for step in self.steps for pose in (step.before, step.after))]
        return float(sum(np.linalg.norm(pose[:3, 3]) for pose in poses))

    def forward(self, joints: ArrayLike) -> Array:
        """Pose of the tip link in the base link.

        Parameters
        ----------
        joints : array_like, shape (..., dof)
            Joint positions [rad or m].

        Returns
        -------
        Array, shape (..., 4, 4)
            [m].
        """
        q = np.asarray(joints, dtype=np.float64)
        flat = q.reshape(-1, self.dof)
        pose = np.broadcast_to(np.eye(4), (len(flat), 4, 4))
        for step in self.steps:
            pose = pose @ step.before @ step.motion(flat) @ step.after
        return np.asarray((pose @ self.end).reshape(*q.shape[:-1], 4, 4))

    def points(self, joints: ArrayLike) -> Array:
        """Where base, joints and tip are: the robot as a chain of straight links, to be drawn.

        Parameters
        ----------
        joints : array_like, shape (..., dof)
            Joint positions [rad or m].

        Returns
        -------
        Array, shape (..., n_steps + 3, 3)
            In the base link: its origin, each joint, what the last one moves, and the tip [m].
        """
        q = np.asarray(joints, dtype=np.float64)
        flat = q.reshape(-1, self.dof)
        pose = np.broadcast_to(np.eye(4), (len(flat), 4, 4))
        found = [pose[:, :3, 3]]
        for step in self.steps:
            pose = pose @ step.before
            found.append(pose[:, :3, 3])
            pose = pose @ step.motion(flat) @ step.after
        found += [pose[:, :3, 3], (pose @ self.end)[:, :3, 3]]
        return np.stack(found, axis=1).reshape(*q.shape[:-1], len(found), 3)

    def pose_and_jacobian(self, joints: Array) -> tuple[Array, Array]:
        """Pose of the tip, and its velocity and angular velocity per joint velocity.

        Parameters
        ----------
        joints : Array, shape (n, dof)
            Joint positions [rad or m].

        Returns
        -------
        pose : Array, shape (n, 4, 4)
            [m].
        jacobian : Array, shape (n, 6, dof)
            In the base link: velocity, then angular velocity.
        """
        pose = np.broadcast_to(np.eye(4), (len(joints), 4, 4))
        axes, origins = [], []
        for step in self.steps:
            pose = pose @ step.before
            axes.append(pose[:, :3, :3] @ step.axis)
            origins.append(pose[:, :3, 3])
            pose = pose @ step.motion(joints) @ step.after
        pose = pose @ self.end
        jacobian = np.zeros((len(joints), 6, self.dof))
        for step, axis, origin in zip(self.steps, axes, origins, strict=True):
            if step.prismatic:
                jacobian[:, :3, step.variable] += step.factor * axis
            else:
                (x, y, z), (a, b, c) = (pose[:, :3, 3] - origin).T, axis.T
                jacobian[:, 0, step.variable] += step.factor * (b * z - c * y)
                jacobian[:, 1, step.variable] += step.factor * (c * x - a * z)
                jacobian[:, 2, step.variable] += step.factor * (a * y - b * x)
                jacobian[:, 3:, step.variable] += step.factor * axis
        return np.asarray(pose), jacobian
