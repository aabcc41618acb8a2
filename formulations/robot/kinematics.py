"""Forward kinematics and Jacobian of the links between two links of a URDF.

A chain is a product of steps A M(q) B: a fixed pose, the motion of one joint, a fixed pose. A joint that
follows another moves by its leader's position; one on the way up to the base moves backward.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.robot.joints import JointKind
from formulations.robot.text.files import shown
from formulations.robot.urdf import Urdf, UrdfJoint


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


def chain_between(urdf: Urdf, names: tuple[str, ...], base: str, tip: str) -> LinkChain:
    """The chain between two links of a robot.

    Parameters
    ----------
    urdf : Urdf
        The robot.
    names : tuple of str
        The joints that are moved; their order is that of the joint positions.
    base, tip : str
        Links of the URDF.

    Returns
    -------
    LinkChain
        Ready to compute with.

    Raises
    ------
    InputError
        A joint on the way moves but is not among ``names``, or moves otherwise than along or about an axis.
    """
    up, down = urdf.path_to(base), urdf.path_to(tip)
    while up and down and up[0] is down[0]:
        up, down = up[1:], down[1:]
    steps: list[Step] = []
    fixed = np.eye(4)
    for joint, backward in [*((j, True) for j in reversed(up)), *((j, False) for j in down)]:
        origin = np.array(joint.origin)
        variable = _variable(urdf, joint, names, base, tip)
        if variable is None:
            fixed = fixed @ (_inverse(origin) if backward else origin)
            continue
        index, factor, offset = variable
        sign = -1.0 if backward else 1.0
        steps.append(
            Step(
                before=fixed if backward else fixed @ origin,
                after=_inverse(origin) if backward else np.eye(4),
                axis=np.array(joint.axis),
                prismatic=joint.type == JointKind.PRISMATIC,
                variable=index,
                factor=sign * factor,
                offset=sign * offset,
            )
        )
        fixed = np.eye(4)
    return LinkChain(names, tuple(steps), fixed)


def _variable(
    urdf: Urdf, joint: UrdfJoint, names: tuple[str, ...], base: str, tip: str
) -> tuple[int, float, float] | None:
    """Index, factor and offset of the position that moves a joint; None for a fixed one."""
    if joint.type == "fixed":
        return None
    leader, factor, offset = leader_of(urdf, joint)
    if joint.joint is None or leader not in names:
        raise InputError(
            f"{urdf.file}: joint {shown(leader)} between links {shown(base)} and {shown(tip)} moves, but is "
            f"not among the robot's joints ({', '.join(names)}); add it, or choose other links as base and tip"
        )
    return names.index(leader), factor, offset


def leader_of(urdf: Urdf, joint: UrdfJoint) -> tuple[str, float, float]:
    """The joint that moves a joint in the end, by way of all that it follows.

    Parameters
    ----------
    urdf : Urdf
        The robot.
    joint : UrdfJoint
        Any joint of it.

    Returns
    -------
    leader : str
        A joint that follows none; the joint itself where it follows none.
    multiplier, offset : float
        Its position is ``multiplier`` times the leader's plus ``offset``.

    Raises
    ------
    InputError
        Joints follow one another in a circle, or one that does not move.
    """
    named = urdf.named()
    multiplier, offset = 1.0, 0.0
    current = joint
    for _ in range(len(named) + 1):
        if current.mimic is None:
            if current is not joint and current.joint is None:
                raise InputError(
                    f"{urdf.file}: joint {shown(joint.name)} follows joint {shown(current.name)}, which "
                    f"is {current.type}"
                )
            return current.name, multiplier, offset
        leader, m, o = current.mimic
        multiplier, offset = multiplier * m, multiplier * o + offset
        current = named[leader]
    raise InputError(f"{urdf.file}: joint {shown(joint.name)} follows itself")


def _inverse(pose: Array) -> Array:
    inverse = np.eye(4)
    inverse[:3, :3] = pose[:3, :3].T
    inverse[:3, 3] = -pose[:3, :3].T @ pose[:3, 3]
    return inverse
