"""The joints of a robot: their kinds, units and limits, and the joints that follow others.

A limit that no file gives is None: it is asked for, never invented.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any


class JointKind(StrEnum):
    """How a joint moves."""

    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"


QUANTITIES = ("velocity", "acceleration", "jerk", "position")
UNLIMITED = (-math.inf, math.inf)
SMALLEST_LIMIT = 1e-9  # rad/s and the like: less is no limit that a motion can be planned with


@dataclass(frozen=True)
class Joint:
    """One joint with its limits.

    Attributes
    ----------
    name : str
        Its name in the URDF.
    kind : JointKind
        How it moves.
    velocity, acceleration, jerk : float or None
        Largest size of the derivatives [rad/s, rad/s^2, rad/s^3; m for a prismatic joint]. None: not known;
        infinite: said to be unlimited.
    position : (float, float) or None
        Lowest and highest position [rad or m]; infinite for a continuous joint.
    removed : frozenset of str
        Quantities whose limit a file took away (``has_jerk_limits: false``).
    """

    name: str
    kind: JointKind
    velocity: float | None = None
    acceleration: float | None = None
    jerk: float | None = None
    position: tuple[float, float] | None = None
    removed: frozenset[str] = field(default=frozenset(), repr=False)

    @property
    def unit(self) -> str:
        """Unit of its position: ``rad`` or ``m``."""
        return "m" if self.kind is JointKind.PRISMATIC else "rad"

    @property
    def missing(self) -> tuple[str, ...]:
        """The quantities whose limit is not known."""
        return tuple(name for name in QUANTITIES if getattr(self, name) is None)


@dataclass(frozen=True)
class Mimic:
    """A joint that follows another: its position is ``multiplier`` times the leader's plus ``offset``.

    Attributes
    ----------
    joint : Joint
        The follower, with limits of its own.
    leader : str
        Name of the joint that it follows; never a follower itself.
    multiplier : float
        Its speed per speed of the leader.
    offset : float
        Its position where the leader's is zero [rad or m].
    """

    joint: Joint
    leader: str
    multiplier: float
    offset: float


def limited_by(leader: Joint, follower: Mimic) -> Joint:
    """The leader with the limits that its follower sets: it moves ``multiplier`` times as fast.

    Parameters
    ----------
    leader : Joint
        The joint that is moved.
    follower : Mimic
        A joint that follows it. Limits of it that are not known set none.

    Returns
    -------
    Joint
        With the smaller limits. A limit of the leader that is not known stays so.
    """
    m = follower.multiplier
    if m == 0.0:
        return leader
    changes: dict[str, Any] = {}
    for name in ("velocity", "acceleration", "jerk"):
        own, others = getattr(leader, name), getattr(follower.joint, name)
        if own is not None and others is not None:
            changes[name] = min(own, others / abs(m))
    if leader.position is not None and follower.joint.position is not None:
        ends = sorted((end - follower.offset) / m for end in follower.joint.position)
        changes["position"] = (max(leader.position[0], ends[0]), min(leader.position[1], ends[1]))
    return replace(leader, **changes)


def missing_limits(joints: tuple[Joint, ...]) -> str | None:
    """Say which limits are missing, of which joints, and how to give them.

    Parameters
    ----------
    joints : tuple of Joint
        The joints that are moved.

    Returns
    -------
    str or None
        One line; None where nothing is missing.
    """
    parts = []
    for quantity in QUANTITIES:
        names = [joint.name for joint in joints if quantity in joint.missing]
        if names:
            parts.append(f"{quantity} of {', '.join(names)}")
    if not parts:
        return None
    removed = sorted(
        {f"has_{q}_limits" for joint in joints for q in joint.removed & set(joint.missing)}
    )
    because = f" ({', '.join(removed)}: false in the limits file)" if removed else ""
    lacking = [q for q in QUANTITIES if any(q in joint.missing for joint in joints)]
    keys = ", ".join("min_position, max_position" if q == "position" else f"max_{q}" for q in lacking)
    free = [q for q in lacking if q != "velocity"]
    none = f"; where a joint has no such limit, say so: unlimited={free!r}" if free else ""
    return (
        f"limits are missing: {'; '.join(parts)}{because}; give {keys} in a joint_limits.yaml, "
        f"or robot.with_limits({lacking[0]}=...){none}"
    )
