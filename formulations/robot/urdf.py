"""URDF text -> links and joints with limits, in SI units.

yourdfpy reads the joints: MIT licence, released this year, and it takes what URDF leaves optional, where urchin
asks for an effort and a velocity of every limit; both bring the mesh library trimesh. It is given a copy of
the text that was checked here and holds links and joints only, so it opens no mesh and can meet nothing that it
does not know. What it leaves out is added: URDF 1.2's acceleration and jerk, and the soft limits of
<safety_controller>, which narrow the position limits as in MoveIt.
"""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from typing import Any

from formulations.problem.errors import InputError
from formulations.robot.joints import SMALLEST_LIMIT, UNLIMITED, Joint, JointKind
from formulations.robot.text.entry import LARGEST_NUMBER
from formulations.robot.text.files import known_names, shown
from formulations.robot.text.xml_tree import Element, attribute, number, numbers, parse_xml, place

LARGEST_URDF = 5_000_000  # bytes; a humanoid with all its parts has a fifth of a million
MOST_JOINTS = 1000

_MOVING = tuple(str(kind) for kind in JointKind)
_COPIED = ("link", "xyz", "rpy", "velocity", "lower", "upper", "joint", "multiplier", "offset")
_TYPES = (*_MOVING, "fixed", "floating", "planar")

Rows = tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class UrdfJoint:
    """A joint of the tree, moving or not.

    Attributes
    ----------
    name, type, parent, child : str
        Its name, URDF type, and the links that it joins.
    origin : Rows
        Pose of the joint in the parent link (4, 4) [m].
    axis : tuple of float
        Unit vector of the axis in the joint's frame.
    joint : Joint or None
        Its limits; None for the types that are not moved here.
    mimic : (str, float, float) or None
        Joint that it follows, multiplier and offset.
    """

    name: str
    type: str
    parent: str
    child: str
    origin: Rows
    axis: tuple[float, ...]
    joint: Joint | None
    mimic: tuple[str, float, float] | None


@dataclass(frozen=True)
class Urdf:
    """A robot as its URDF describes it: links, and joints from the base outward.

    Attributes
    ----------
    name : str
        Name of the robot.
    file : str
        Where it was read from, for messages.
    root : str
        The link that no joint moves.
    links : tuple of str
        All links.
    joints : tuple of UrdfJoint
        All joints, depth first from the root.
    """

    name: str
    file: str
    root: str
    links: tuple[str, ...]
    joints: tuple[UrdfJoint, ...]

    def named(self) -> dict[str, UrdfJoint]:
        """The joints by name."""
        return {joint.name: joint for joint in self.joints}

    def above(self) -> dict[str, UrdfJoint]:
        """The joint that moves each link but the root, by the link's name."""
        return {joint.child: joint for joint in self.joints}

    def path_to(self, link: str) -> list[UrdfJoint]:
        """The joints between the root and a link.

        Parameters
        ----------
        link : str
            One of ``links``.

        Returns
        -------
        list of UrdfJoint
            From the root outward.
        """
        above, path = self.above(), []
        while link in above:
            path.append(above[link])
            link = above[link].parent
        return path[::-1]


def parse_urdf(text: str, file: str) -> Urdf:
    """Read URDF text.

    Parameters
    ----------
    text : str
        The document; meshes and other files it names are not opened.
    file : str
        Its name, for messages.

    Returns
    -------
    Urdf
        Links, joints and limits.

    Raises
    ------
    InputError
        The text is no URDF: the message names line, joint, attribute and value.
    """
    root = parse_xml(text, file, root="robot")
    links = _named(file, root, "link")
    joints = _named(file, root, "joint")
    if not joints:
        raise InputError(f"{file}: has no joints")
    if len(joints) > MOST_JOINTS:
        raise InputError(f"{file}: {len(joints)} joints; at most {MOST_JOINTS} are read")
    for name, element in joints.items():
        _check(file, name, element, links, joints)
    base, order = _ordered(file, links, joints)
    read = _read_by_library(file, links, joints)
    name = (root.get("name") or "robot").strip()
    return Urdf(
        name=name,
        file=file,
        root=base,
        links=tuple(links),
        joints=tuple(_joint(file, joints[key], read[key]) for key in order),
    )


def _named(file: str, root: Element, tag: str) -> dict[str, Element]:
    """The elements of a kind right under the root, by name."""
    found: dict[str, Element] = {}
    for element in root.findall(tag):
        name = attribute(file, element, "name", f"<{tag}>")
        if name in found:
            raise InputError(f"{place(file, element)}: {tag} {shown(name)} is given twice")
        found[name] = element
    return found


def _check(
    file: str, name: str, element: Element, links: dict[str, Element], joints: dict[str, Element]
) -> None:
    """Check all of a joint that is read, so that no library meets what it does not know."""
    what = f"joint {shown(name)}"
    kind = attribute(file, element, "type", what)
    if kind not in _TYPES:
        raise InputError(
            f"{place(file, element)}: {what}: type {shown(kind)}: {known_names(kind, _TYPES)}"
        )
    for tag in ("parent", "child", "origin", "axis", "limit", "mimic", "safety_controller"):
        found = element.findall(tag)
        if len(found) > 1:
            raise InputError(f"{place(file, found[1])}: {what}: <{tag}> is given twice")
        if not found:
            if tag in ("parent", "child"):
                raise InputError(f"{place(file, element)}: {what}: <{tag}> is missing")
            continue
        inner, where = found[0], f"{what}: <{tag}>"
        if tag in ("parent", "child"):
            link = attribute(file, inner, "link", where)
            if link not in links:
                raise InputError(
                    f"{place(file, inner)}: {where}: no link {shown(link)}; {known_names(link, links)}"
                )
        elif tag == "mimic":
            leader = attribute(file, inner, "joint", where)
            if leader not in joints:
                raise InputError(
                    f"{place(file, inner)}: {where}: no joint {shown(leader)}; "
                    f"{known_names(leader, joints)}"
                )
        for key in ("xyz", "rpy"):
            if tag in ("origin", "axis"):
                numbers(file, inner, key, where, 3)
        for key in ("velocity", "acceleration", "jerk"):
            if tag == "limit":
                number(file, inner, key, where)
        for key in ("lower", "upper"):
            if tag == "limit" and kind != JointKind.CONTINUOUS:
                number(file, inner, key, where, largest=math.inf)
        for key in ("soft_lower_limit", "soft_upper_limit", "multiplier", "offset"):
            if tag in ("mimic", "safety_controller"):
                number(file, inner, key, where)
    axis = element.find("axis")
    if axis is not None and kind in _MOVING:
        direction = numbers(file, axis, "xyz", f"{what}: <axis>", 3) or [1.0, 0.0, 0.0]
        if math.hypot(*direction) < 1e-6:
            raise InputError(
                f"{place(file, axis)}: {what}: <axis>: xyz {shown(axis.get('xyz'))} is zero"
            )


def _ordered(file: str, links: dict[str, Element], joints: dict[str, Element]) -> tuple[str, list[str]]:
    """The root link and the names of the joints, depth first from it; the joints must be a tree."""
    below: dict[str, list[str]] = {name: [] for name in links}
    moved: dict[str, str] = {}
    for name, element in joints.items():
        parent, child = (element.find(tag).get("link").strip() for tag in ("parent", "child"))
        if child in moved:
            raise InputError(
                f"{place(file, element)}: joint {shown(name)}: link {shown(child)} is already moved "
                f"by joint {shown(moved[child])}"
            )
        moved[child] = name
        below[parent].append(name)
    roots = [name for name in links if name not in moved]
    if len(roots) != 1:
        what = "has no root link: its joints go in a circle" if not roots else "has several root links"
        raise InputError(f"{file}: {what}{': ' + ', '.join(map(shown, roots[:5])) if roots else ''}")
    order: list[str] = []
    todo = below[roots[0]][::-1]
    while todo:
        name = todo.pop()
        order.append(name)
        todo += below[joints[name].find("child").get("link").strip()][::-1]
    if len(order) < len(joints):
        stray = next(name for name in joints if name not in set(order))
        raise InputError(
            f"{place(file, joints[stray])}: joint {shown(stray)} is not tied to the root link"
        )
    return roots[0], order


def _read_by_library(
    file: str, links: dict[str, Element], joints: dict[str, Element]
) -> dict[str, Any]:
    """The joints of yourdfpy by name, read from a copy of the text without anything but links and joints."""
    try:
        import yourdfpy
    except ImportError:
        raise InputError(
            f"{file}: URDF needs the package yourdfpy: pip install 'timebound[robot]'"
        ) from None
    from lxml import etree

    plain = etree.Element("robot", name="robot")
    for name in links:
        etree.SubElement(plain, "link", name=name)
    for name, element in joints.items():
        copy = etree.SubElement(plain, "joint", name=name, type=element.get("type").strip())
        for tag in ("parent", "child", "origin", "axis", "limit", "mimic"):
            inner = element.find(tag)
            if inner is not None:
                keys = set(_COPIED)
                if element.get("type").strip() == JointKind.CONTINUOUS:
                    keys = keys - {"lower", "upper"}
                kept = {
                    key: inner.get(key).strip() for key in sorted(keys) if inner.get(key) is not None
                }
                etree.SubElement(copy, tag, kept)
    model = yourdfpy.URDF.load(
        io.BytesIO(etree.tostring(plain)), build_scene_graph=False, load_meshes=False
    )
    return {joint.name: joint for joint in model.robot.joints}


def _joint(file: str, element: Element, read: Any) -> UrdfJoint:
    """One joint from what the library read and what it leaves out."""
    origin = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    if read.origin is not None:
        origin = tuple(tuple(float(x) for x in row) for row in read.origin)  # type: ignore[assignment]
    length = math.hypot(*read.axis)
    mimic = read.mimic and (read.mimic.joint, float(read.mimic.multiplier), float(read.mimic.offset))
    return UrdfJoint(
        name=read.name,
        type=read.type,
        parent=read.parent,
        child=read.child,
        origin=origin,
        axis=tuple(float(x) / length for x in read.axis) if length > 0.0 else (1.0, 0.0, 0.0),
        joint=_limits(file, element, read) if read.type in _MOVING else None,
        mimic=mimic or None,
    )


def _limits(file: str, element: Element, read: Any) -> Joint:
    """The limits of a moving joint; a velocity of zero, which exporters write for want of one, is none."""
    what = f"joint {shown(read.name)}: <limit>"
    limit = element.find("limit")
    found: dict[str, float | None] = {"velocity": None, "acceleration": None, "jerk": None}
    if limit is not None:
        found["velocity"] = read.limit.velocity
        for key in ("acceleration", "jerk"):
            found[key] = number(file, limit, key, what)
        for key, value in found.items():
            if value is not None and (value < 0.0 or 0.0 < value < SMALLEST_LIMIT):
                reason = (
                    "is negative"
                    if value < 0.0
                    else f"is below {SMALLEST_LIMIT:g}: no limit to plan with"
                )
                raise InputError(f"{place(file, limit)}: {what}: {key} {value:g} {reason}")
            found[key] = value or None
    kind = JointKind(read.type)
    position = UNLIMITED if kind is JointKind.CONTINUOUS else _interval(file, element, read, what)
    return Joint(read.name, kind, found["velocity"], found["acceleration"], found["jerk"], position)


def _interval(file: str, element: Element, read: Any, what: str) -> tuple[float, float] | None:
    """Lowest and highest position; None where the URDF leaves one out or has them equal."""
    limit = element.find("limit")
    if limit is None or read.limit.lower is None or read.limit.upper is None:
        return None
    low, high = float(read.limit.lower), float(read.limit.upper)
    if low == high:
        return None
    low = -math.inf if low <= -LARGEST_NUMBER else low  # Gazebo writes 1e16 for want of a limit
    high = math.inf if high >= LARGEST_NUMBER else high
    safety = element.find("safety_controller")
    if safety is not None:
        where = f"joint {shown(read.name)}: <safety_controller>"
        soft_low = number(file, safety, "soft_lower_limit", where)
        soft_high = number(file, safety, "soft_upper_limit", where)
        low = low if soft_low is None else max(low, soft_low)
        high = high if soft_high is None else min(high, soft_high)
    if not low < high:
        raise InputError(f"{place(file, limit)}: {what}: lower {low:g} is not below upper {high:g}")
    return low, high
