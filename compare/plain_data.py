"""Plain data that was read from a file, as the types that it must have."""

from __future__ import annotations

import json
import types
from collections.abc import Iterator
from dataclasses import MISSING, fields, is_dataclass
from functools import cache
from itertools import count
from math import isfinite
from pathlib import Path
from typing import Any, NotRequired, Union, get_args, get_origin, get_type_hints, is_typeddict

from formulations import InputError
from formulations.robot.text.files import decode, read_bytes, shown

LARGEST = 20_000_000  # bytes of a file of results
_LARGEST_LINES = 2_000_000_000  # bytes of a file to which lines are appended
_MOST_VALUES = 1_000_000


def read_text(path: Path, *, largest: int = LARGEST) -> str:
    """Read a text file of results.

    Parameters
    ----------
    path : Path
        The file.
    largest : int
        Size that is still read [byte].

    Returns
    -------
    str

    Raises
    ------
    InputError
        The file is missing, too large, or not UTF-8.
    """
    return decode(read_bytes(path, largest=largest), str(path))


def read_json(path: Path, kind: Any, what: str) -> Any:
    """Read a JSON file of results.

    Parameters
    ----------
    path : Path
        The file.
    kind : type
        The type of its content, as for ``typed``.
    what : str
        What the file must be, for the message.

    Returns
    -------
    object
        Of that type.

    Raises
    ------
    InputError
        The file is no JSON, or holds something else.
    """
    return parse_json(read_text(path), kind, f"{path}: not {what}")


def parse_json(text: str, kind: Any, where: str) -> Any:
    """Read JSON text.

    Parameters
    ----------
    text : str
        The text.
    kind : type
        The type of its content, as for ``typed``.
    where : str
        Start of the message.

    Returns
    -------
    object
        Of that type.

    Raises
    ------
    InputError
        The text is no JSON, or holds something else.
    """
    if text.count(",") > _MOST_VALUES:
        raise InputError(f"{where}: more than {_MOST_VALUES} values")
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{where}: {error}") from None
    return typed_or_line(kind, data, where)


def typed_or_line(kind: Any, data: Any, where: str) -> Any:
    """Make plain data what a type says, as ``typed`` does, or say in one line what stands there.

    Parameters
    ----------
    kind : type
        The type.
    data : object
        From JSON.
    where : str
        Start of the message.

    Returns
    -------
    object
        Of that type.

    Raises
    ------
    InputError
        Something else stands there.
    """
    try:
        return typed(kind, data)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{where}: {error}") from None


def whole_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Read the lines of a file to which lines are appended; a last one that was cut short is left out.

    Parameters
    ----------
    path : Path
        A file that need not exist.

    Yields
    ------
    tuple of int and str
        Number of the line, from 1, and its text.

    Raises
    ------
    InputError
        It cannot be read.
    """
    if not path.exists() or not path.stat().st_size:
        return
    text = read_text(path, largest=_LARGEST_LINES)
    start = 0
    for number in count(1):
        end = text.find("\n", start)
        if end < 0:
            return
        yield number, text[start:end]
        start = end + 1


def typed(kind: Any, data: Any, place: str = "") -> Any:
    """Make plain data what a type says.

    Parameters
    ----------
    kind : type
        Any, None, bool, int, float, str; a union; a list, tuple or dict of such; a TypedDict, a NamedTuple or
        a dataclass with such fields. A list is read as a tuple where that is meant. Keys that a TypedDict
        does not have are left as they are, fields that a dataclass does not have are refused.
    data : object
        From JSON.
    place : str
        Keys and indices on the way here, for the message.

    Returns
    -------
    object
        Of that type.

    Raises
    ------
    ValueError
        Something else stands there; the message names the place.
    """
    origin, args = get_origin(kind), get_args(kind)
    if kind is Any:
        return data
    if origin is NotRequired:
        return typed(args[0], data, place)
    if origin in (Union, types.UnionType):
        for one in args:
            try:
                return typed(one, data, place)
            except ValueError as error:
                last = error
        raise last
    if origin is dict:
        found = _table(data, place)
        return {key: typed(args[1], value, _at(place, key)) for key, value in found.items()}
    if origin in (list, tuple):
        if not isinstance(data, list):
            raise ValueError(f"{place}: expected a list, got {shown(data)}")
        if origin is tuple and args[-1] is not Ellipsis:
            return _tuple(args, data, place)
        return origin(typed(args[0], value, _at(place, index)) for index, value in enumerate(data))
    if hasattr(kind, "_fields"):
        return kind(*_tuple([_hints(kind)[name] for name in kind._fields], data, place))
    if is_dataclass(kind) or is_typeddict(kind):
        return _record(kind, _table(data, place), place)
    kind = types.NoneType if kind is None else kind
    if isinstance(data, bool) is not (kind is bool) or not isinstance(
        data, (int, float) if kind is float else kind
    ):
        raise ValueError(f"{place}: expected {_NAMES.get(kind, kind.__name__)}, got {shown(data)}")
    if kind is float:
        try:
            data = float(data)
        except OverflowError:
            data = float("inf")
        if not isfinite(data):
            raise ValueError(f"{place}: {data} is not a finite number")
    return data


_NAMES = {
    str: "text",
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    types.NoneType: "null",
}


@cache
def _hints(kind: Any) -> dict[str, Any]:
    return get_type_hints(kind, include_extras=True)


def _at(place: str, key: str | int) -> str:
    return f"{place}[{key}]" if isinstance(key, int) else f"{place}.{key:.60}".removeprefix(".")


def _table(data: Any, place: str) -> dict[str, Any]:
    if not isinstance(data, dict):
        raise ValueError(f"{place}: expected a table, got {shown(data)}".removeprefix(": "))
    return data


def _tuple(kinds: Any, data: Any, place: str) -> tuple[Any, ...]:
    if not isinstance(data, list) or len(data) != len(kinds):
        raise ValueError(f"{place}: expected a list of {len(kinds)}, got {shown(data)}")
    pairs = zip(kinds, data, strict=True)
    return tuple(typed(kind, value, _at(place, index)) for index, (kind, value) in enumerate(pairs))


def _record(kind: Any, data: dict[str, Any], place: str) -> Any:
    """A TypedDict or a dataclass."""
    hints = _hints(kind)
    if is_typeddict(kind):
        needed = {name for name, hint in hints.items() if get_origin(hint) is not NotRequired}
    else:
        needed = {f.name for f in fields(kind) if f.default is MISSING and f.default_factory is MISSING}
        for key in data:
            if key not in hints:
                raise ValueError(f"{_at(place, key)}: unknown entry")
    for name in hints:
        if name in needed and name not in data:
            raise ValueError(f"{_at(place, name)}: missing")
    found = {key: typed(hints.get(key, Any), value, _at(place, key)) for key, value in data.items()}
    return found if is_typeddict(kind) else kind(**found)
