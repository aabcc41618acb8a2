"""A robot from its files: the tree of the URDF, the joints chosen, limits laid over, factors on them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from formulations.problem.errors import InputError
from formulations.problem.problem import Limits
from formulations.robot.joint_limits import (
    LARGEST_LIMITS,
    LimitsFile,
    check_names,
    laid_over,
    parse_limits,
)
from formulations.robot.joints import (
    QUANTITIES,
    UNLIMITED,
    Joint,
    JointKind,
    Mimic,
    limited_by,
    missing_limits,
)
from formulations.robot.kinematics import leader_of
from formulations.robot.robot import Robot
from formulations.robot.srdf import LARGEST_SRDF, parse_group
from formulations.robot.text.files import decode, known_names, read_bytes, shown
from formulations.robot.urdf import LARGEST_URDF, Urdf, UrdfJoint, parse_urdf

_FREE = QUANTITIES[1:]  # what a joint may go without: all but the velocity


def robot_of(
    urdf: str | Path,
    *,
    joints: Sequence[str] | None = None,
    group: str | None = None,
    srdf: str | Path | None = None,
    limits: str | Path | Iterable[str | Path] | None = None,
    velocity_scaling: float | None = None,
    acceleration_scaling: float | None = None,
    jerk_scaling: float | None = None,
    unlimited: str | Iterable[str] = (),
    base: str | None = None,
    tip: str | None = None,
) -> Robot:
    """Read a robot from a URDF and the files beside it. Only the files named are opened.

    Parameters
    ----------
    urdf : str or Path
        The robot description; a xacro file must be expanded first.
    joints : sequence of str, optional
        The joints to move, in this order. All that move, if neither this nor a group is given.
    group : str, optional
        A group of the SRDF in place of ``joints``.
    srdf : str or Path, optional
        MoveIt's semantic description; it goes with ``group``.
    limits : str, Path or iterable of them, optional
        joint_limits.yaml files, laid over the limits of the URDF in this order.
    velocity_scaling, acceleration_scaling : float, optional
        Factors above 0, up to 1, on the limits of all joints; those of the files (``default_..._factor``)
        if left out, as in MoveIt.
    jerk_scaling : float, optional
        The same for the jerk; MoveIt has none.
    unlimited : str or iterable of str, optional
        ``acceleration``, ``jerk`` or ``position`` where a joint without such a limit has none.
    base, tip : str, optional
        Links that Cartesian poses are measured from and given for. The ends of the group's chain, or else
        the link before the first joint and the link behind the last, if left out.

    Returns
    -------
    Robot
        Its ``limits`` raises where one is still missing.

    Raises
    ------
    InputError
        One line that names file, line, joint, value, and what is allowed or nearest.
    """
    tree = parse_urdf(decode(read_bytes(urdf, largest=LARGEST_URDF), str(urdf)), str(urdf))
    ends: tuple[str | None, str | None] = (None, None)
    if group is not None:
        if joints is not None:
            raise InputError(f"group: {shown(group)} is given beside joints; leave one of them out")
        if srdf is None:
            raise InputError(f"group: {shown(group)} needs an SRDF that says what it is (srdf=...)")
        text = decode(read_bytes(srdf, largest=LARGEST_SRDF), str(srdf))
        found = parse_group(text, str(srdf), group, tree)
        names, ends = found.joints, (found.base, found.tip)
    elif srdf is not None:
        raise InputError(f"srdf: {srdf} is given without a group of it (group=...)")
    else:
        names = _chosen(tree, joints)
    read = _limits_files(limits)
    known = {joint.name: joint.joint for joint in tree.joints}
    for file in read:
        check_names(file, known)
    factors = _factors(read, velocity_scaling, acceleration_scaling, jerk_scaling)
    free = _quantities(unlimited)
    in_force = {
        name: _in_force(laid_over(joint, read), factors, free)
        for name, joint in known.items()
        if joint is not None
    }
    followers = [m for m in _mimics(tree, in_force) if m.leader in names]
    moved = []
    for name in names:
        joint = in_force[name]
        for follower in followers:
            joint = limited_by(joint, follower) if follower.leader == name else joint
        if joint.position is not None and not joint.position[0] < joint.position[1]:
            raise InputError(f"{urdf}: joint {shown(name)}: its followers leave it no position")
        moved.append(joint)
    named = tree.named()
    return Robot(
        name=tree.name,
        joints=tuple(moved),
        mimics=tuple(followers),
        base=_link(tree, "base", base) or ends[0] or named[names[0]].parent,
        tip=_link(tree, "tip", tip) or ends[1] or named[names[-1]].child,
        urdf=tree,
    )


def limits_of(
    names: Sequence[str],
    limits: str | Path | Iterable[str | Path],
    *,
    unlimited: str | Iterable[str] = (),
) -> Limits:
    """Read the limits of joints from joint_limits.yaml files alone, without a URDF.

    Parameters
    ----------
    names : sequence of str
        The joints, in order; each must be in one of the files.
    limits : str, Path or iterable of them
        The files; of two that limit the same joint the later one counts. Their default factors are in force.
    unlimited : str or iterable of str, optional
        ``acceleration``, ``jerk`` or ``position`` where a joint without such a limit has none.

    Returns
    -------
    Limits
        Of these joints. Each is taken for a rotary one, because the files do not say what it is.

    Raises
    ------
    InputError
        One line that names the joint that is not in the files, or the limits that are missing.
    """
    read = _limits_files(limits)
    listed = ", ".join(str(file) for file in _listed("limits", limits))
    known = [name for file in read for name in file.joints]
    for name in names:
        if name not in known:
            raise InputError(
                f"{listed}: has no limits of joint {shown(name)}; {known_names(name, known)}"
            )
    factors, free = _factors(read, None, None, None), _quantities(unlimited)
    joints = tuple(
        _in_force(laid_over(Joint(name, JointKind.REVOLUTE), read), factors, free) for name in names
    )
    message = missing_limits(joints)
    if message is not None:
        raise InputError(f"{listed}: {message}; or read the file beside a URDF that has them")
    return Robot(name=listed, joints=joints).limits


def _limits_files(limits: Any) -> list[LimitsFile]:
    """Read all limits files."""
    return [
        parse_limits(decode(read_bytes(file, largest=LARGEST_LIMITS), str(file)), str(file))
        for file in _listed("limits", limits)
    ]


def _factors(
    read: Sequence[LimitsFile],
    velocity: float | None,
    acceleration: float | None,
    jerk: float | None,
) -> dict[str, float]:
    """The factors on the limits of each quantity: those given, or those of the files."""
    by_files = [file.acceleration_scaling for file in read]
    return {
        "velocity": _factor("velocity_scaling", velocity, [file.velocity_scaling for file in read]),
        "acceleration": _factor("acceleration_scaling", acceleration, by_files),
        "jerk": _factor("jerk_scaling", jerk, []),
    }


def _quantities(unlimited: Any) -> list[str]:
    """The quantities that a joint may go without, checked."""
    free = _listed("unlimited", unlimited)
    for quantity in free:
        if quantity not in _FREE:
            raise InputError(f"unlimited: {shown(quantity)}; {known_names(str(quantity), _FREE)}")
    return free


def _listed(key: str, given: Any) -> list[Any]:
    """One value or several, as a list."""
    if given is None or isinstance(given, str | Path):
        return [] if given is None else [given]
    try:
        return list(given)
    except TypeError:
        raise InputError(f"{key}: expected one text or several, got {shown(given)}") from None


def _chosen(tree: Urdf, joints: Sequence[str] | None) -> tuple[str, ...]:
    """The joints asked for, or all that move."""
    if joints is None:
        for joint in tree.joints:
            if joint.type in ("floating", "planar"):
                raise InputError(
                    f"{tree.file}: joint {shown(joint.name)} is {joint.type}, which is not moved here; "
                    f"name the joints to move (joints=...)"
                )
        names = tuple(j.name for j in tree.joints if j.joint is not None and j.mimic is None)
        if not names:
            raise InputError(f"{tree.file}: has no joint that moves")
        return names
    if isinstance(joints, str):
        raise InputError(f"joints: expected a list of names, got {shown(joints)}")
    named = tree.named()
    for index, name in enumerate(joints):
        if name not in named:
            moving = [j.name for j in tree.joints if j.joint is not None and j.mimic is None]
            raise InputError(
                f"joints: {tree.file} has no joint {shown(name)}; {known_names(str(name), moving)}"
            )
        chosen: UrdfJoint = named[name]
        if chosen.joint is None:
            raise InputError(
                f"joints: joint {shown(name)} is {chosen.type}; it does not move along one axis"
            )
        if chosen.mimic is not None:
            raise InputError(
                f"joints: joint {shown(name)} follows joint {shown(chosen.mimic[0])} and cannot be moved alone"
            )
        if name in joints[:index]:
            raise InputError(f"joints: joint {shown(name)} is given twice")
    if not joints:
        raise InputError("joints: at least one is needed")
    return tuple(joints)


def _mimics(tree: Urdf, in_force: Mapping[str, Joint]) -> list[Mimic]:
    """All joints that follow another."""
    found = []
    for joint in tree.joints:
        if joint.mimic is not None and joint.joint is not None:
            leader, multiplier, offset = leader_of(tree, joint)
            found.append(Mimic(in_force[joint.name], leader, multiplier, offset))
    return found


def _in_force(joint: Joint, factors: Mapping[str, float], free: Sequence[str]) -> Joint:
    """A joint with scaled limits; what may be missing is infinite."""
    changes: dict[str, Any] = {}
    for quantity, factor in factors.items():
        value = getattr(joint, quantity)
        if value is not None:
            changes[quantity] = factor * value
        elif quantity in free:
            changes[quantity] = np.inf
    if joint.position is None and "position" in free:
        changes["position"] = UNLIMITED
    return replace(joint, **changes)


def _factor(key: str, given: float | None, defaults: Sequence[float | None]) -> float:
    """The factor given, or else the last one of the files, or else 1."""
    if given is None:
        return next((factor for factor in reversed(defaults) if factor is not None), 1.0)
    if isinstance(given, bool) or not isinstance(given, int | float) or not 0.0 < given <= 1.0:
        raise InputError(f"{key}: {shown(given)} is not a factor above 0, up to 1")
    return float(given)


def _link(tree: Urdf, key: str, name: str | None) -> str | None:
    if name is not None and name not in tree.links:
        raise InputError(
            f"{key}: {tree.file} has no link {shown(name)}; {known_names(str(name), tree.links)}"
        )
    return name
