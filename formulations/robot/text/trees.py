"""YAML and JSON text -> a tree of values with lines.

PyYAML is used for its stream of events alone (MIT licence, the C parser libyaml, a line for every event;
ruamel.yaml gives no more here): the tree is built from them with a bound on depth and size, so that neither
deep nesting nor aliases within aliases can take time or memory. Numbers follow YAML 1.2 and yaml-cpp, which
ROS reads with, so ``1e3`` is a number. The tags ``!degrees`` and ``!radians`` of the ROS limit files are
known; no other tag is.
"""

from __future__ import annotations

import json
import math
from typing import Any, NoReturn

from formulations.problem.errors import InputError
from formulations.robot.text.entry import MOST_DEPTH, MOST_KEYS, MOST_NODES, Scalar, TextEntry, TextNode
from formulations.robot.text.files import number_of, shown

_WORDS: dict[str, bool | None] = {
    "": None, "~": None, "null": None, "true": True, "yes": True, "on": True,
    "false": False, "no": False, "off": False,
}  # fmt: skip
_INFINITE = {".inf": math.inf, "+.inf": math.inf, "-.inf": -math.inf, ".nan": math.nan}


def parse_yaml(text: str, file: str) -> TextEntry:
    """Read YAML text.

    Parameters
    ----------
    text : str
        One document.
    file : str
        Name of the file, for messages.

    Returns
    -------
    TextEntry
        The document.

    Raises
    ------
    InputError
        The text is not YAML, or has aliases, tags, repeated keys or more than 32 levels.
    """
    try:
        import yaml
    except ImportError:
        raise InputError(
            f"{file}: YAML needs the package PyYAML: pip install 'timebound[robot]'"
        ) from None
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    _require_few(
        file, text.count("\n") // 2 + text.count(",") // 2, MOST_NODES
    )  # both, if a list is long
    builder = _Builder(file)
    try:
        for event in yaml.parse(text, Loader=loader):
            builder.take(event)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = "" if mark is None else f"line {mark.line + 1}: "
        reason = getattr(error, "problem", None) or getattr(error, "reason", None) or "cannot be parsed"
        raise InputError(f"{file}: {line}not valid YAML: {reason}") from None
    except (ValueError, RecursionError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{file}: not valid YAML: {type(error).__name__}") from None
    if builder.root is None or builder.root.value is None:
        raise InputError(f"{file}: holds no values")
    return TextEntry(builder.root, file)


def parse_json(text: str, file: str, *, most: int = MOST_NODES) -> TextEntry:
    """Read JSON text.

    Parameters
    ----------
    text : str
        One value.
    file : str
        Name of the file, for messages.
    most : int, optional
        How many values are read.

    Returns
    -------
    TextEntry
        The value; its lines are unknown.

    Raises
    ------
    InputError
        The text is not JSON, or has repeated keys or more than 32 levels.
    """

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        if len(pairs) > MOST_KEYS:
            raise InputError(f"{file}: {len(pairs)} keys in one place; at most {MOST_KEYS} are read")
        found = dict(pairs)
        if len(found) < len(pairs):
            keys = [key for key, _ in pairs]
            twice = next(key for key in keys if keys.count(key) > 1)
            raise InputError(f"{file}: key {shown(twice)} is given twice")
        return found

    _require_few(file, text.count(","), most)
    try:
        data = json.loads(text, object_pairs_hook=unique, parse_int=float)
    except json.JSONDecodeError as error:
        raise InputError(f"{file}: line {error.lineno}: not valid JSON: {error.msg}") from None
    except RecursionError:
        raise InputError(f"{file}: more than {MOST_DEPTH} levels deep") from None
    return TextEntry(_nodes(data, file, MOST_DEPTH), file)


def _require_few(file: str, count: int, most: int) -> None:
    """Refuse a file with too many values before one of them is read."""
    if count > most:
        raise InputError(f"{file}: more than {most} values")


def _nodes(data: Any, file: str, levels: int) -> TextNode:
    if levels == 0:
        raise InputError(f"{file}: more than {MOST_DEPTH} levels deep")
    if isinstance(data, dict):
        return TextNode({key: _nodes(value, file, levels - 1) for key, value in data.items()})
    if isinstance(data, list):
        return TextNode([_nodes(value, file, levels - 1) for value in data])
    return TextNode(data)


class _Builder:
    """Builds the tree of one document from the events of a YAML parser."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.root: TextNode | None = None
        self.open: list[
            tuple[dict[str, TextNode] | list[TextNode], int, list[str]]
        ] = []  # value, line, its key
        self.count = 0
        self.documents = 0

    def take(self, event: Any) -> None:
        """Take the next event."""
        name = type(event).__name__
        if name == "ScalarEvent":
            self._scalar(event)
        elif name in ("MappingStartEvent", "SequenceStartEvent"):
            self._untagged(event)
            if len(self.open) >= MOST_DEPTH:
                self._fail(event, f"more than {MOST_DEPTH} levels deep")
            self._counted(event)
            self.open.append(({} if name == "MappingStartEvent" else [], self._line(event), []))
        elif name in ("MappingEndEvent", "SequenceEndEvent"):
            value, line, _ = self.open.pop()
            self._add(event, TextNode(value, line))
        elif name == "AliasEvent":
            self._fail(
                event, f"alias {shown('*' + event.anchor)}: aliases are not read; write the value"
            )
        elif name == "DocumentStartEvent":
            self.documents += 1
            if self.documents > 2:
                self._fail(event, "a third document begins; one is read")

    def _scalar(self, event: Any) -> None:
        self._counted(event)
        line = self._line(event)
        if self.open and isinstance(self.open[-1][0], dict) and not self.open[-1][2]:
            self._untagged(event)
            key = event.value
            if key in self.open[-1][0]:
                self._fail(event, f"key {shown(key)} is given twice")
            if len(self.open[-1][0]) >= MOST_KEYS:
                self._fail(event, f"more than {MOST_KEYS} keys in one place")
            if key == "<<":
                self._fail(event, "merge keys << are not read; write the values")
            self.open[-1][2].append(key)
            return
        degrees = event.tag == "!degrees"
        if degrees or event.tag == "!radians":
            number = number_of(event.value)
            if number is None:
                self._fail(event, f"{event.tag}: expected a number, got {shown(event.value)}")
            self._add(event, TextNode(math.radians(number) if degrees else number, line, degrees))
            return
        self._untagged(event)
        plain = event.style in (None, "")
        self._add(event, TextNode(_scalar_of(event.value) if plain else event.value, line))

    def _add(self, event: Any, node: TextNode) -> None:
        if not self.open:
            if self.root is not None and self.documents > 1:
                if node.value is None:  # what is behind a last ---
                    return
                self._fail(event, "a second document begins; one is read")
            self.root = node
            return
        value, _, key = self.open[-1]
        if isinstance(value, list):
            value.append(node)
        elif key:
            value[key.pop()] = node
        else:
            self._fail(event, "a key must be a name, not a list or a mapping")

    def _untagged(self, event: Any) -> None:
        if event.anchor is not None:
            self._fail(event, f"anchor {shown('&' + event.anchor)}: anchors are not read")
        if event.tag is not None and event.tag != "!":
            self._fail(event, f"tag {shown(event.tag)}; known: !degrees, !radians")

    def _counted(self, event: Any) -> None:
        self.count += 1
        if self.count > MOST_NODES:
            self._fail(event, f"more than {MOST_NODES} values")

    def _line(self, event: Any) -> int:
        return int(event.start_mark.line) + 1

    def _fail(self, event: Any, message: str) -> NoReturn:
        raise InputError(f"{self.file}: line {self._line(event)}: {message}")


def _scalar_of(text: str) -> Scalar:
    """What a plain scalar means: nothing, a truth, a number, or else text."""
    word = text if text in ("", "~") else text.lower()
    if word in _WORDS and text in (word, word.capitalize(), word.upper()):
        return _WORDS[word]
    if word in _INFINITE:
        return _INFINITE[word]
    number = number_of(text)
    return text if number is None else number
