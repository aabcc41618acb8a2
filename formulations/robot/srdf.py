"""SRDF text -> the joints of a named group, as MoveIt understands it.

A group lists joints, links (each stands for the joint that moves it), chains from a base link to a tip link,
and other groups. Fixed and passive joints and those that follow others are left out of its joints.
"""

from __future__ import annotations

from dataclasses import dataclass

from formulations.problem.errors import InputError
from formulations.robot.text.files import known_names, shown
from formulations.robot.text.xml_tree import Element, attribute, parse_xml, place
from formulations.robot.urdf import Urdf

LARGEST_SRDF = 5_000_000  # bytes
_PARTS = ("joint", "link", "chain", "group", "passive_joint")


@dataclass(frozen=True)
class Group:
    """The joints of a group.

    Attributes
    ----------
    joints : tuple of str
        Joints that are moved, from the base outward.
    base, tip : str or None
        The ends of its chain, where the group is one chain.
    """

    joints: tuple[str, ...]
    base: str | None
    tip: str | None


def parse_group(text: str, file: str, name: str, urdf: Urdf) -> Group:
    """Read one group of an SRDF.

    Parameters
    ----------
    text : str
        The document.
    file : str
        Its name, for messages.
    name : str
        The group.
    urdf : Urdf
        The robot that the SRDF is about.

    Returns
    -------
    Group
        Its joints in the order of the URDF.

    Raises
    ------
    InputError
        There is no such group (the message has the nearest one), it is empty, or it names what the URDF
        does not have.
    """
    root = parse_xml(text, file, root="robot")
    reader = _Reader(file, root, urdf)
    if name not in reader.groups:
        raise InputError(f"{file}: no group {shown(name)}; {known_names(name, reader.groups)}")
    members = reader.members(name, ())
    named = urdf.named()
    joints = tuple(
        joint.name
        for joint in urdf.joints
        if joint.name in members
        and named[joint.name].joint is not None
        and joint.mimic is None
        and joint.name not in reader.passive
    )
    if not joints:
        raise InputError(f"{file}: group {shown(name)} has no joint that moves")
    base, tip = reader.ends(name)
    return Group(joints, base, tip)


class _Reader:
    """The groups of one SRDF."""

    def __init__(self, file: str, root: Element, urdf: Urdf) -> None:
        self.file, self.urdf = file, urdf
        self.joints = urdf.named()
        self.groups: dict[str, Element] = {}
        self.done: dict[str, set[str]] = {}
        for element in root.findall("group"):
            name = attribute(file, element, "name", "<group>")
            if name in self.groups:
                raise InputError(f"{place(file, element)}: group {shown(name)} is given twice")
            self.groups[name] = element
        self.passive = {
            self._known(element, "name", "<passive_joint>", self.joints, "joint")
            for element in root.findall("passive_joint")
        }

    def members(self, name: str, outer: tuple[str, ...]) -> set[str]:
        """Names of all joints of a group, those of its groups included."""
        if name in outer:
            raise InputError(
                f"{place(self.file, self.groups[name])}: group {shown(name)} contains itself"
            )
        if name in self.done:
            return self.done[name]
        if len(outer) >= 32:
            raise InputError(
                f"{place(self.file, self.groups[name])}: groups are more than 32 levels deep"
            )
        found: set[str] = set()
        above = self.urdf.above()
        for part in self.groups[name]:
            what = f"group {shown(name)}: <{shown(part.tag)[1:-1]}>"
            if part.tag == "joint":
                found.add(self._known(part, "name", what, self.joints, "joint"))
            elif part.tag == "link":
                link = self._known(part, "name", what, self.urdf.links, "link")
                found |= {above[link].name} if link in above else set()
            elif part.tag == "chain":
                found |= self._chain(part, what)
            elif part.tag == "group":
                inner = self._known(part, "name", what, self.groups, "group")
                found |= self.members(inner, (*outer, name))
            elif part.tag != "passive_joint":
                raise InputError(
                    f"{place(self.file, part)}: {what}: unknown element; {known_names(str(part.tag), _PARTS)}"
                )
        self.done[name] = found
        return found

    def ends(self, name: str) -> tuple[str | None, str | None]:
        """Base and tip link of a group that is one chain, or one group that is."""
        for _ in range(32):
            parts = list(self.groups[name])
            if len(parts) != 1:
                break
            if parts[0].tag == "chain":
                return parts[0].get("base_link").strip(), parts[0].get("tip_link").strip()
            if parts[0].tag != "group":
                break
            name = parts[0].get("name").strip()
        return None, None

    def _chain(self, part: Element, what: str) -> set[str]:
        """The joints between two links; where neither is above the other, by way of the link above both."""
        base, tip = (
            self._known(part, key, what, self.urdf.links, "link") for key in ("base_link", "tip_link")
        )
        first, second = ({j.name for j in self.urdf.path_to(link)} for link in (base, tip))
        return first ^ second

    def _known(self, element: Element, key: str, what: str, known: object, kind: str) -> str:
        name = attribute(self.file, element, key, what)
        names = list(known)  # type: ignore[call-overload]
        if name not in names:
            raise InputError(
                f"{place(self.file, element)}: {what}: no {kind} {shown(name)}; {known_names(name, names)}"
            )
        return name
