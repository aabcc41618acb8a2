"""One value of a YAML or JSON file, with the place it stands at: typed reading with one-line errors.

Both formats become the same tree of ``TextNode``. A ``TextEntry`` walks down that tree and remembers the file
and the keys on its way, so that every message names file, line, key path and value.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from formulations.problem.errors import InputError
from formulations.robot.text.files import known_names, shown

Scalar: TypeAlias = str | float | bool | None
Value: TypeAlias = dict[str, "TextNode"] | list["TextNode"] | Scalar

LARGEST_NUMBER = 1e9  # nothing that a robot does is beyond; guards all that computes with it
MOST_DEPTH = 32  # levels of a file that is read
MOST_KEYS = 5000  # keys of one mapping
MOST_NODES = 200_000  # values of a file that is read value by value


class TextNode(NamedTuple):
    """A value as a file holds it: what it is, its line (None in JSON), and whether it was in degrees."""

    value: Value
    line: int | None = None
    degrees: bool = False


@dataclass(frozen=True, slots=True)
class TextEntry:
    """A value and where it stands.

    Attributes
    ----------
    node : TextNode
        The value with its line.
    file : str
        Name of the file.
    path : str
        Keys and indices from the top, ``points[2].positions``.
    """

    node: TextNode
    file: str
    path: str = ""

    @property
    def place(self) -> str:
        """File, line and key path: what opens a message."""
        line = "" if self.node.line is None else f"line {self.node.line}"
        return ": ".join(part for part in (self.file, line, self.path) if part)

    def error(self, message: str) -> InputError:
        """An error about this value.

        Parameters
        ----------
        message : str
            What is wrong with it, and what is allowed.

        Returns
        -------
        InputError
            To be raised.
        """
        return InputError(f"{self.place}: {message}")

    @property
    def is_mapping(self) -> bool:
        """Whether the value has keys."""
        return isinstance(self.node.value, dict)

    @property
    def is_list(self) -> bool:
        """Whether the value is a list."""
        return isinstance(self.node.value, list)

    def has(self, *keys: str) -> bool:
        """Whether the value is a mapping with one of these keys or more.

        Parameters
        ----------
        *keys : str
            Keys to look for.

        Returns
        -------
        bool
            False for what is no mapping.
        """
        value = self.node.value
        return isinstance(value, dict) and any(key in value for key in keys)

    def child(self, key: str | int, node: TextNode) -> TextEntry:
        """The entry of a value inside this one.

        Parameters
        ----------
        key : str or int
            Its key or index.
        node : TextNode
            The value.

        Returns
        -------
        TextEntry
            With the key added to the path.
        """
        if isinstance(key, int):
            return TextEntry(node, self.file, f"{self.path}[{key}]")
        name = key if key.isprintable() and len(key) <= 60 else shown(key)
        return TextEntry(node, self.file, f"{self.path}.{name}" if self.path else name)

    def entries(self, known: Iterable[str] | None = None) -> dict[str, TextEntry]:
        """The values of a mapping.

        Parameters
        ----------
        known : iterable of str, optional
            The keys that are allowed; all if left out.

        Returns
        -------
        dict of str to TextEntry
            In the order of the file.

        Raises
        ------
        InputError
            The value is no mapping, or a key is unknown; the message has the nearest known one.
        """
        value = self.node.value
        if not isinstance(value, dict):
            raise self.error(f"expected keys with values, got {self._kind()}")
        found = {key: self.child(key, node) for key, node in value.items()}
        if known is not None:
            allowed = list(known)
            for key, entry in found.items():
                if key not in allowed:
                    raise entry.error(f"unknown key; {known_names(key, allowed)}")
        return found

    def elements(self) -> list[TextEntry]:
        """The values of a list; raises InputError where the value is none."""
        value = self.node.value
        if not isinstance(value, list):
            raise self.error(f"expected a list, got {self._kind()}")
        return [self.child(index, node) for index, node in enumerate(value)]

    def number(self) -> float:
        """The value as a finite number; raises InputError where it is none."""
        value = self.node.value
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self.error(f"expected a number, got {self._kind()}")
        if not math.isfinite(value):
            raise self.error(f"{value} is not a finite number")
        if abs(value) > LARGEST_NUMBER:
            raise self.error(f"{value:g} is beyond {LARGEST_NUMBER:g}, the largest number that is read")
        return float(value)

    def boolean(self) -> bool:
        """The value as true or false; raises InputError where it is neither."""
        if not isinstance(self.node.value, bool):
            raise self.error(f"expected true or false, got {self._kind()}")
        return self.node.value

    def text(self) -> str:
        """The value as text; raises InputError where it is none."""
        if not isinstance(self.node.value, str):
            raise self.error(f"expected text, got {self._kind()}")
        return self.node.value

    def numbers(self, count: int | None = None) -> list[float]:
        """The value as a list of finite numbers.

        Parameters
        ----------
        count : int, optional
            How many there must be.

        Returns
        -------
        list of float
            The numbers.

        Raises
        ------
        InputError
            The value is no such list.
        """
        found = [entry.number() for entry in self.elements()]
        if count is not None and len(found) != count:
            raise self.error(f"{len(found)} numbers where {count} are expected")
        return found

    def _kind(self) -> str:
        value = self.node.value
        if isinstance(value, dict):
            return "keys with values"
        if isinstance(value, list):
            return f"a list of {len(value)}"
        return "nothing" if value is None else shown(value)
