"""MoveIt's joint_limits.yaml and ros2_control's parameter files -> limits laid over those of the URDF.

What is decided here, as MoveIt decides it unless said otherwise:

- A value of the file replaces that of the URDF, smaller or larger; of several files the later one counts.
- ``max_x`` alone sets a limit. ``has_x_limits: false`` takes it away, and it is then missing, unless the caller
  says that the joint has none. ``has_x_limits: true`` without ``max_x`` keeps what is known.
- Limits are the same in both directions here, so of ``max_acceleration`` and ``max_deceleration`` (of either
  sign, as Pilz writes it negative) the smaller counts for both. MoveIt's time parametrisations ignore the
  latter.
- Position limits hold for a continuous joint too, where MoveIt drops them; soft limits narrow the position.
- Effort, ``k_position``, ``k_velocity`` and ``angle_wraparound`` are checked and not used.
- An unknown key is an error at every depth, but for the other parameters of a ROS node.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from formulations.problem.errors import InputError
from formulations.robot.joints import SMALLEST_LIMIT, UNLIMITED, Joint, JointKind
from formulations.robot.text.entry import TextEntry
from formulations.robot.text.files import known_names, nearest_of, shown
from formulations.robot.text.trees import parse_yaml
from formulations.robot.urdf import MOST_JOINTS

LARGEST_LIMITS = 2_000_000  # bytes

_SWITCHES = tuple(
    f"has_{quantity}_limits"
    for quantity in ("position", "velocity", "acceleration", "deceleration", "jerk", "effort", "soft")
)
_SIZES = {
    f"max_{name}": name for name in ("velocity", "acceleration", "deceleration", "jerk", "effort")
}
_ENDS = ("min_position", "max_position", "soft_lower_limit", "soft_upper_limit")
_UNUSED = ("k_position", "k_velocity", "max_effort")
_KEYS = (*_SWITCHES, *_SIZES, *_ENDS, "k_position", "k_velocity", "angle_wraparound")
_FACTORS = ("default_velocity_scaling_factor", "default_acceleration_scaling_factor")
_TOP = ("joint_limits", *_FACTORS)
_WRAPPER = "robot_description_planning"  # the name space of MoveIt's parameters
_PARAMETERS = "ros__parameters"


@dataclass(frozen=True)
class JointEntry:
    """What a file says about one joint.

    Attributes
    ----------
    entry : TextEntry
        Where it stands.
    values : mapping of str to TextEntry
        Its keys.
    """

    entry: TextEntry
    values: Mapping[str, TextEntry]


@dataclass(frozen=True)
class LimitsFile:
    """What one file says.

    Attributes
    ----------
    joints : mapping of str to JointEntry
        By joint name.
    velocity_scaling, acceleration_scaling : float or None
        Its default factors; None where it has none.
    """

    joints: Mapping[str, JointEntry]
    velocity_scaling: float | None
    acceleration_scaling: float | None


def parse_limits(text: str, file: str) -> LimitsFile:
    """Read a limits file.

    Parameters
    ----------
    text : str
        YAML: ``joint_limits`` and the default factors, alone, below ``robot_description_planning``, or below
        ``NODE: ros__parameters`` of one node or several.
    file : str
        Its name, for messages.

    Returns
    -------
    LimitsFile
        Everything checked but the joint names.

    Raises
    ------
    InputError
        For a key that is unknown or given twice, and a value of the wrong type or sign; the message names
        line, key, value and the nearest known key.
    """
    top = parse_yaml(text, file)
    joints: dict[str, JointEntry] = {}
    factors: dict[str, TextEntry] = {}
    for table in _tables(top):
        for name, entry in table.entries().items():
            if name in _FACTORS:
                _same(factors, name, entry)
                factors[name] = entry
            elif name == "joint_limits":
                given = entry.entries()
                if len(given) > MOST_JOINTS:
                    raise entry.error(f"{len(given)} joints; at most {MOST_JOINTS} are read")
                for joint, limits in given.items():
                    found = JointEntry(limits, limits.entries(_KEYS))
                    _check(joint, found)
                    if joint in joints:
                        _agree(joint, joints[joint], found)
                    joints[joint] = found
    velocity, acceleration = (_factor(factors.get(name)) for name in _FACTORS)
    if not joints and velocity is None and acceleration is None:
        raise InputError(f"{file}: has neither joint_limits nor a scaling factor")
    return LimitsFile(joints, velocity, acceleration)


def _tables(top: TextEntry) -> list[TextEntry]:
    """The tables that hold ``joint_limits`` or factors."""
    nodes = _nodes(top, 3)
    if not nodes:
        return [_checked(top, outermost=True)]
    found = []
    for parameters in nodes:
        for name, entry in parameters.entries().items():
            if name == _WRAPPER:
                found.append(_checked(entry))
            elif name not in _TOP and nearest_of(name, (*_TOP, _WRAPPER), alike=0.85) is not None:
                raise entry.error(f"unknown key; {known_names(name, (*_TOP, _WRAPPER))}")
        if not set(_TOP).isdisjoint(parameters.entries()):
            found.append(parameters)
    if not found:
        raise InputError(f"{top.file}: no node has joint_limits among its {_PARAMETERS}")
    return found


def _nodes(entry: TextEntry, levels: int) -> list[TextEntry]:
    """The parameters of all ROS nodes of a file, in name spaces too."""
    if not entry.is_mapping or levels == 0:
        return []
    entries = entry.entries()
    if _PARAMETERS in entries:
        return [entry.entries((_PARAMETERS,))[_PARAMETERS]]
    return [node for inner in entries.values() for node in _nodes(inner, levels - 1)]


def _checked(table: TextEntry, *, outermost: bool = False) -> TextEntry:
    entries = table.entries((*_TOP, _WRAPPER) if outermost else _TOP)
    if _WRAPPER not in entries:
        return table
    if len(entries) > 1:
        raise entries[_WRAPPER].error("stands beside other keys; put all of them below it")
    return _checked(entries[_WRAPPER])


def _same(known: Mapping[str, TextEntry], name: str, entry: TextEntry) -> None:
    """Two nodes of a file may give a value twice where it is the same one."""
    if name in known and known[name].node.value != entry.node.value:
        raise entry.error(
            f"{shown(entry.node.value)}, but {shown(known[name].node.value)} on line {known[name].node.line}"
        )


def _agree(joint: str, first: JointEntry, second: JointEntry) -> None:
    for key in {**first.values, **second.values}:
        if key not in first.values or key not in second.values:
            raise second.entry.error(
                f"joint {shown(joint)} has {key} in one node alone; line {first.entry.node.line} has the other"
            )
        _same(first.values, key, second.values[key])


def _factor(entry: TextEntry | None) -> float | None:
    if entry is None:
        return None
    value = entry.number()
    if not 0.0 < value <= 1.0:
        raise entry.error(f"{value:g} is not a factor above 0, up to 1")
    return value


def _check(joint: str, found: JointEntry) -> None:
    """Check the types of all values, and the signs of those in force."""
    values = found.values
    for key, entry in values.items():
        if key in _SWITCHES or key == "angle_wraparound":
            entry.boolean()
        else:
            entry.number()
    for key, name in _SIZES.items():
        if key in values and key not in _UNUSED and _in_force(values, name):
            value = values[key].number()
            size = abs(value) if name == "deceleration" else value
            if size < SMALLEST_LIMIT:
                raise values[key].error(
                    f"joint {shown(joint)}: {value:g} is not a limit; it must be {SMALLEST_LIMIT:g} or more "
                    f"(has_{name}_limits: false where there is none)"
                )
    if "angle_wraparound" in values and values["angle_wraparound"].boolean():
        for key in ("min_position", "max_position"):
            if key in values and _in_force(values, "position"):
                raise values[key].error(f"joint {shown(joint)}: given beside angle_wraparound: true")


def _in_force(values: Mapping[str, TextEntry], quantity: str) -> bool:
    switch = values.get(f"has_{quantity}_limits")
    return switch is None or switch.boolean()


def laid_over(joint: Joint, files: Sequence[LimitsFile]) -> Joint:
    """A joint of the URDF with the limits of files laid over its own.

    Parameters
    ----------
    joint : Joint
        As the URDF has it.
    files : sequence of LimitsFile
        In order; the later one counts.

    Returns
    -------
    Joint
        Not scaled.

    Raises
    ------
    InputError
        The position limits cross, or a prismatic joint has limits in degrees.
    """
    for file in files:
        if joint.name in file.joints:
            joint = _over(joint, file.joints[joint.name])
    return joint


def _over(joint: Joint, found: JointEntry) -> Joint:
    values = found.values
    for entry in values.values():
        if entry.node.degrees and joint.kind is JointKind.PRISMATIC:
            raise entry.error(
                f"joint {shown(joint.name)} is prismatic; its limits are in m, not in degrees"
            )
    changes: dict[str, Any] = {}
    removed = set(joint.removed)
    for name in ("velocity", "acceleration", "jerk"):
        if not _in_force(values, name):
            changes[name] = None
            removed.add(name)
        elif f"max_{name}" in values:
            changes[name] = values[f"max_{name}"].number()
    if "max_deceleration" in values and _in_force(values, "deceleration"):
        acceleration = changes.get("acceleration", joint.acceleration)
        if acceleration is not None:
            changes["acceleration"] = min(acceleration, abs(values["max_deceleration"].number()))
    position = joint.position
    if not _in_force(values, "position"):
        position = UNLIMITED if joint.kind is JointKind.CONTINUOUS else None
        removed.add("position")
    else:
        position = _narrowed(joint, found)
    return replace(joint, **changes, position=position, removed=frozenset(removed))


def _narrowed(joint: Joint, found: JointEntry) -> tuple[float, float] | None:
    """Position limits of a file over those known; an end that neither gives leaves both missing."""
    values = found.values
    low, high = joint.position or (None, None)
    if "min_position" in values:
        low = values["min_position"].number()
    if "max_position" in values:
        high = values["max_position"].number()
    if low is None or high is None:
        return None
    if _in_force(values, "soft"):
        low = max(low, values["soft_lower_limit"].number() if "soft_lower_limit" in values else low)
        high = min(high, values["soft_upper_limit"].number() if "soft_upper_limit" in values else high)
    if not low < high:
        raise found.entry.error(
            f"joint {shown(joint.name)}: lowest position {low:g} is not below the highest, {high:g}"
        )
    return low, high


def check_names(file: LimitsFile, known: Mapping[str, Joint | None]) -> None:
    """Refuse limits for joints that the robot does not have.

    Parameters
    ----------
    file : LimitsFile
        A limits file.
    known : mapping of str to Joint or None
        All joints of the URDF; None for those that do not move.

    Raises
    ------
    InputError
        A name is unknown (the message has the nearest known one), or is that of a joint without limits.
    """
    moving = [name for name, joint in known.items() if joint is not None]
    for name, found in file.joints.items():
        if name not in known:
            raise found.entry.error(f"the URDF has no joint {shown(name)}; {known_names(name, moving)}")
        if known[name] is None:
            raise found.entry.error(f"joint {shown(name)} of the URDF does not move along one axis")
