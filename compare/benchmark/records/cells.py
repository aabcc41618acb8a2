"""The text of one cell of ``rows.csv``."""

from __future__ import annotations

import math


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
