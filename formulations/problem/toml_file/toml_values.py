"""Values of a TOML table as numbers, or one line that names the key, the place and the value.

Keys that are not known are refused with the nearest one that is.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError

Number: TypeAlias = Callable[[str, Any], float]


def known_keys(kind: str, table: dict[str, Any], known: tuple[str, ...]) -> None:
    """Refuse keys of a table that are not known.

    Parameters
    ----------
    kind : str
        What the table is, at the start of the message.
    table : dict
        As ``tomllib`` reads it.
    known : tuple of str
        All keys that may stand there.

    Raises
    ------
    InputError
        Names the key, and the known key that is nearest to it.
    """
    for key in table:
        if key not in known:
            raise InputError(f"{kind}: unknown key {shown(key)}{nearest(str(key), known)}")


def nearest(name: str, known: Sequence[str]) -> str:
    """Say which names there are: the end of a message about an unknown one.

    Parameters
    ----------
    name : str
        The unknown name.
    known : sequence of str
        All known ones.

    Returns
    -------
    str
        ``; did you mean a? (known: a, b)``, without the question where none is near.
    """
    return f"{near_name(name, known)} (known: {', '.join(known)})"


def near_name(name: str, known: Sequence[str]) -> str:
    """Ask whether the nearest name is meant.

    Parameters
    ----------
    name : str
        The unknown name.
    known : sequence of str
        All known ones.

    Returns
    -------
    str
        ``; did you mean a?``; empty where none is near.
    """
    near = difflib.get_close_matches(name[:100], known, n=1, cutoff=0.5)
    return f"; did you mean {near[0]}?" if near else ""


def shown(value: Any) -> str:
    """Show a value as a person would recognise it, cut to one short line.

    Parameters
    ----------
    value : object
        Anything that a TOML file can hold.

    Returns
    -------
    str
    """
    try:
        return f"{value!r:.50}"
    except ValueError:  # a whole number beyond 4300 digits
        return "a number of thousands of digits"


def read_text(key: str, value: Any) -> str:
    """Read text.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.

    Returns
    -------
    str

    Raises
    ------
    InputError
        If the value is something else.
    """
    if not isinstance(value, str):
        raise InputError(f"{key}: expected text, got {shown(value)}")
    return value


def read_choice(key: str, value: Any, choices: Any) -> str:
    """Read one of several words.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.
    choices : iterable of str
        The words that are allowed.

    Returns
    -------
    str

    Raises
    ------
    InputError
        If the value is none of them.
    """
    if not isinstance(value, str) or value not in choices:
        near = near_name(str(value), tuple(choices)) if isinstance(value, str) else ""
        raise InputError(f"{key}: {shown(value)} is not one of {', '.join(choices)}{near}")
    return value


def read_number(key: str, value: Any) -> float:
    """Read a finite number.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.

    Returns
    -------
    float

    Raises
    ------
    InputError
        If the value is no number, too large for a float or not finite.
    """
    number = read_extended(key, value)
    if not math.isfinite(number):
        raise InputError(f"{key}: {number} is not finite (leave the key out if unlimited)")
    return number


def read_extended(key: str, value: Any) -> float:
    """Read a number that may be infinite, as ``inf`` of TOML.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.

    Returns
    -------
    float

    Raises
    ------
    InputError
        If the value is no number, too large for a float or NaN.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"{key}: expected a number, got {shown(value)}")
    try:
        number = float(value)
    except OverflowError:
        raise InputError(f"{key}: {shown(value)} is too large") from None
    if math.isnan(number):
        raise InputError(f"{key}: {number} is not a number")
    return number


def read_interval(
    key: str, value: Any, *, ends: str = "low, high", number: Number = read_number
) -> tuple[float, float]:
    """Read two numbers.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.
    ends : str
        What the two numbers are called in the message.
    number : callable
        Reads each.

    Returns
    -------
    (float, float)

    Raises
    ------
    InputError
        If the value is no list of two numbers.
    """
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(f"{key}: expected [{ends}], got {shown(value)}")
    low, high = (number(f"{key}, value {k + 1}", x) for k, x in enumerate(value))
    return low, high


def read_flag(key: str, value: Any) -> bool:
    """Read true or false.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.

    Returns
    -------
    bool

    Raises
    ------
    InputError
        If the value is something else.
    """
    if not isinstance(value, bool):
        raise InputError(f"{key}: expected true or false, got {shown(value)}")
    return value


def read_count(key: str, value: Any) -> int:
    """Read a whole number from 0 on.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.

    Returns
    -------
    int

    Raises
    ------
    InputError
        If the value is something else.
    """
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise InputError(f"{key}: expected a whole number from 0 on, got {shown(value)}")
    return value


def read_matrix(key: str, rows: Any, row_name: str = "row", column_name: str = "joint") -> Array:
    """Read a list of rows of equal length.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    rows : object
        The value.
    row_name, column_name : str
        What rows and columns are called in the message.

    Returns
    -------
    Array, shape (n_rows, n_columns)

    Raises
    ------
    InputError
        If rows are missing, empty or unequal, or an entry is no finite number.
    """
    if not isinstance(rows, list) or not rows or not all(isinstance(row, list) for row in rows):
        raise InputError(f"{key}: expected a list of rows, got {shown(rows)}")
    width = len(rows[0])
    if width == 0:
        raise InputError(f"{key}: {row_name} 1 is empty")
    for index, row in enumerate(rows):
        if len(row) != width:
            raise InputError(
                f"{key}: {row_name} {index + 1} has {len(row)} values, {row_name} 1 has {width}"
            )
    return np.array(
        [
            [
                read_number(f"{key}: {row_name} {i + 1}, {column_name} {j + 1}", x)
                for j, x in enumerate(row)
            ]
            for i, row in enumerate(rows)
        ]
    )
