"""What a key of a paper's TOML file is, and the check that a file holds no other keys than the known ones.

A key that is not known is refused, since a key that nobody reads switches off a check in silence.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from formulations import InputError
from formulations.robot.text.files import shown

TYPES: dict[str, Any] = {
    "text": str,
    "whole number": int,
    "number": (int, float, str),
    "list": list,
    "number or list": (int, float, str, list),
}
_LONGEST = 100  # characters of a key that are compared with the known ones


@dataclass(frozen=True)
class Key:
    """One key of a file.

    Attributes
    ----------
    kind : str
        A key of ``TYPES``.
    meaning : str
        One sentence.
    example : str
        A value, as it stands in TOML.
    unit : str
        Of its numbers; empty where it has none.
    needed : bool
        Whether a file without it is refused.
    shown : bool
        Whether the template sets it; otherwise it stands there as a comment.
    """

    kind: str
    meaning: str
    example: str
    unit: str = ""
    needed: bool = False
    shown: bool = False


@dataclass(frozen=True)
class KeyTable:
    """A table of a file, or an array of tables.

    Attributes
    ----------
    meaning : str
        One sentence.
    keys : dict
        Key or KeyTable by name.
    many : bool
        Whether it is an array of tables, [[name]].
    needed, shown : bool
        As for a key.
    """

    meaning: str
    keys: Mapping[str, Key | KeyTable]
    many: bool = False
    needed: bool = False
    shown: bool = False


def check_keys(data: Mapping[str, Any], known: Mapping[str, Key | KeyTable], place: str = "") -> None:
    """Refuse unknown and missing keys and values of another type, at every depth.

    Parameters
    ----------
    data : mapping
        A file or one of its tables, as TOML gives it.
    known : mapping
        Key or KeyTable by name: what may stand there.
    place : str
        Where the table stands, for the message: "table: Table 2: ".

    Raises
    ------
    InputError
        For an unknown key, with the nearest known one, for a missing one, or for a value of another type.
    """
    for key, value in data.items():
        if key not in known:
            (near,) = difflib.get_close_matches(key[:_LONGEST], known, n=1, cutoff=0.0)
            raise InputError(
                f"{place}unknown key {shown(key)}; did you mean {near!r}? (known: {', '.join(known)})"
            )
        expected = known[key]
        if isinstance(expected, Key):
            if not isinstance(value, TYPES[expected.kind]) or isinstance(value, bool):
                raise InputError(
                    f"{place}{key}: expected {_with_article(expected.kind)}, got {value!r:.50}"
                )
        elif not expected.many:
            if not isinstance(value, dict):
                raise InputError(f"{place}{key}: expected a table [{key}], got {value!r:.50}")
            check_keys(value, expected.keys, f"{place}{key}: ")
        else:
            if not isinstance(value, list) or not all(isinstance(table, dict) for table in value):
                raise InputError(f"{place}{key}: expected tables [[{key}]], got {value!r:.50}")
            for number, table in enumerate(value, start=1):
                name = table.get("where", table.get("name", f"number {number}"))
                check_keys(table, expected.keys, f"{place}{key}: {name!s:.50}: ")
    for key, entry in known.items():
        if entry.needed and key not in data:
            raise InputError(f"{place}{key}: missing")


def _with_article(kind: str) -> str:
    return kind if kind == "text" else f"a {kind}"
