"""XML text -> elements with lines, for URDF and SRDF.

lxml parses with everything off that could reach outside the text: no document type, hence no entities, no
network and no other file. Numbers are read here once, so that every message names file, line, element and
attribute.
"""

from __future__ import annotations

import math
from typing import Any, TypeAlias

from formulations.problem.errors import InputError
from formulations.robot.text.entry import LARGEST_NUMBER
from formulations.robot.text.files import number_of, shown

Element: TypeAlias = Any  # lxml has no types of its own

_MOST_MARKS = 200_000  # elements, their ends and attributes
_XACRO = "is a xacro file; expand it first: xacro {file} > robot.urdf"


def parse_xml(text: str, file: str, *, root: str) -> Element:
    """Read XML text.

    Parameters
    ----------
    text : str
        One document.
    file : str
        Name of the file, for messages.
    root : str
        Name that the outermost element must have.

    Returns
    -------
    Element
        The outermost element.

    Raises
    ------
    InputError
        The text is not XML, has a document type, is a xacro file, or begins with another element.
    """
    try:
        from lxml import etree
    except ImportError:
        raise InputError(
            f"{file}: XML needs the package lxml: pip install 'timebound[robot]'"
        ) from None
    marks = text.count("<") + text.count("=")
    if marks > _MOST_MARKS:
        raise InputError(f"{file}: {marks} elements and attributes; at most {_MOST_MARKS} are read")
    for forbidden in ("<!DOCTYPE", "<!ENTITY"):
        if forbidden in text:
            line = text.count("\n", 0, text.index(forbidden)) + 1
            raise InputError(f"{file}: line {line}: {forbidden} is not read; leave it out")
    parser = etree.XMLParser(
        encoding="utf-8",  # whatever the text declares: it was decoded before
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
        remove_blank_text=True,
    )
    try:
        found = etree.fromstring(text.encode("utf-8"), parser)
    except etree.XMLSyntaxError as error:
        if "xacro" in (error.msg or ""):
            raise InputError(f"{file}: {_XACRO.format(file=file)}") from None
        line = error.lineno or 1
        raise InputError(f"{file}: line {line}: not valid XML: {one_line(error.msg)}") from None
    except (ValueError, RecursionError):
        raise InputError(f"{file}: not valid XML") from None
    if any("xacro" in (namespace_of(element) or "") for element in found.iter()):
        raise InputError(f"{file}: {_XACRO.format(file=file)}")
    if found.tag != root:
        raise InputError(
            f"{place(file, found)}: expected the element <{root}>, got <{shown(found.tag)[1:-1]}>"
        )
    return found


def one_line(reason: str | None) -> str:
    """The first part of a parser's own message, in one short line.

    Parameters
    ----------
    reason : str or None
        What the parser says.

    Returns
    -------
    str
        At most 100 printable characters of it.
    """
    text = "".join(c if c.isprintable() else " " for c in (reason or "cannot be parsed"))
    return text.split(", line ")[0][:100]


def namespace_of(element: Element) -> str | None:
    """The XML namespace of an element.

    Parameters
    ----------
    element : Element
        Any element.

    Returns
    -------
    str or None
        None where it has none.
    """
    tag = element.tag
    return tag[1:].split("}")[0] if isinstance(tag, str) and tag.startswith("{") else None


def place(file: str, element: Element) -> str:
    """Where an element stands: what opens a message.

    Parameters
    ----------
    file : str
        Name of the file.
    element : Element
        The element.

    Returns
    -------
    str
        File and line.
    """
    return file if element.sourceline is None else f"{file}: line {element.sourceline}"


def attribute(file: str, element: Element, name: str, what: str) -> str:
    """An attribute that must be there.

    Parameters
    ----------
    file : str
        Name of the file.
    element : Element
        The element that has it.
    name : str
        The attribute.
    what : str
        The element as a message names it, ``joint 'panda_joint1': <mimic>``.

    Returns
    -------
    str
        Its value without spaces around it.

    Raises
    ------
    InputError
        The attribute is missing or empty.
    """
    value = (element.get(name) or "").strip()
    if not value:
        raise InputError(f"{place(file, element)}: {what}: attribute {name} is missing")
    return str(value)


def numbers(
    file: str,
    element: Element,
    name: str,
    what: str,
    count: int,
    *,
    largest: float = LARGEST_NUMBER,
) -> list[float] | None:
    """Numbers of an attribute.

    Parameters
    ----------
    file : str
        Name of the file.
    element : Element
        The element that has it.
    name : str
        The attribute.
    what : str
        The element as a message names it.
    count : int
        How many numbers it holds, with spaces between.
    largest : float, optional
        The largest size that is read.

    Returns
    -------
    list of float or None
        None where the attribute is not there.

    Raises
    ------
    InputError
        The attribute holds anything else, or a number that is not finite or beyond 1e9.
    """
    text = element.get(name)
    if text is None:
        return None
    where = f"{place(file, element)}: {what}: {name}"
    if "${" in text or "$(" in text:
        raise InputError(f"{where}: {shown(text)}: {_XACRO.format(file=file)}")
    parts = text.split()
    found = [number_of(part) for part in parts]
    if len(found) != count:
        wanted = "a number" if count == 1 else f"{count} numbers"
        raise InputError(f"{where}: expected {wanted}, got {shown(text)}")
    values: list[float] = []
    for part, value in zip(parts, found, strict=True):
        if value is None or not math.isfinite(value):
            raise InputError(f"{where}: {shown(part)} is not a finite number")
        if abs(value) > largest:
            raise InputError(f"{where}: {value:g} is beyond {largest:g}, the largest that is read")
        values.append(value)
    return values


def number(
    file: str, element: Element, name: str, what: str, *, largest: float = LARGEST_NUMBER
) -> float | None:
    """One number of an attribute; as ``numbers``.

    Parameters
    ----------
    file : str
        Name of the file.
    element : Element
        The element that has it.
    name : str
        The attribute.
    what : str
        The element as a message names it.
    largest : float, optional
        The largest size that is read.

    Returns
    -------
    float or None
        None where the attribute is not there.

    Raises
    ------
    InputError
        The attribute holds anything else.
    """
    found = numbers(file, element, name, what, 1, largest=largest)
    return None if found is None else found[0]
