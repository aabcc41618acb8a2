"""The chain of joints between two links of a URDF.

A joint that follows another moves by its leader's position; one on the way up to the base moves backward.
"""

from __future__ import annotations

import numpy as np

from formulations.kinematics.link_chain import LinkChain, Step
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.robot.joints import JointKind
from formulations.robot.text.files import shown
from formulations.robot.urdf import Urdf, UrdfJoint


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
