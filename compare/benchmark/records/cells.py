"""The text of one cell of ``rows.csv``, and back: strict in both directions."""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import StrEnum
from typing import Any


def cell_text(value: object) -> str:
    """Return a value of a row as the text of its cell, always one line.

    Parameters
    ----------
    value : str, int, float, bool, tuple of float or None

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If a number is not finite.
    """
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        return " ".join(cell_text(part) for part in value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"{value!r} is not a finite number")
        return repr(float(value))
    return one_line(str(value))


def one_line(text: str) -> str:
    """Return text that any file can hold, on one line.

    Parameters
    ----------
    text : str
        Text of a foreign program: it may hold line ends, or halves of characters.

    Returns
    -------
    str
    """
    return " ".join(text.splitlines()).encode("utf-8", "backslashreplace").decode("utf-8")


def parser_of(kind: Any) -> Callable[[str], Any]:
    """Return the function that reads the text of a cell.

    Parameters
    ----------
    kind : type
        Type of the column: str, int, float, bool, a StrEnum, a tuple of float, or float or bool with None.

    Returns
    -------
    callable, str to value
        It raises ValueError for text that does not fit.

    Raises
    ------
    KeyError
        If no column has this type.
    """
    if isinstance(kind, type) and issubclass(kind, StrEnum):
        return kind
    by_type: dict[Any, Callable[[str], Any]] = {
        str: str,
        int: int,
        float: _number,
        float | None: _optional(_number),
        bool: _yes_or_no,
        bool | None: _optional(_yes_or_no),
        tuple[float, ...]: lambda cell: tuple(_number(part) for part in cell.split()),
    }
    return by_type[kind]


def _optional(parse: Callable[[str], Any]) -> Callable[[str], Any]:
    return lambda cell: None if cell == "" else parse(cell)


def _number(cell: str) -> float:
    value = float(cell)
    if not math.isfinite(value):
        raise ValueError(f"{cell!r} is not a finite number")
    return value


def _yes_or_no(cell: str) -> bool:
    if cell not in ("yes", "no"):
        raise ValueError(f"{cell!r} is neither yes nor no")
    return cell == "yes"
