"""Numbers and lists of a file that may be wrong or hostile."""

from __future__ import annotations

from math import isfinite
from typing import Any

from compare.check_certificate.answers import BadInput
from compare.check_certificate.balls import R


def real(text: Any) -> float:
    """Read a finite float from its hexadecimal text.

    Parameters
    ----------
    text : object
        From the file.

    Returns
    -------
    float
        Exact.
    """
    if not isinstance(text, str) or len(text) > 40:
        raise BadInput(f"expected a hexadecimal float, got {text!r:.40}")
    try:
        value = float.fromhex(text)
    except (ValueError, OverflowError):
        raise BadInput(f"not a hexadecimal float: {text!r:.40}") from None
    if not isfinite(value):
        raise BadInput(f"not finite: {text!r:.40}")
    return value


def number(text: Any) -> Any:
    """Read a finite float from its hexadecimal text, as a ball.

    Parameters
    ----------
    text : object
        From the file.

    Returns
    -------
    arb
        The number, exact.
    """
    return R(real(text))


def index(value: Any, below: int) -> int:
    """Read an integer in 0 .. below - 1.

    Parameters
    ----------
    value : object
        From the file.
    below : int
        The first integer that is too large.

    Returns
    -------
    int
        The integer.
    """
    if type(value) is not int or not 0 <= value < below:
        raise BadInput(f"expected an integer from 0 to {below - 1}, got {value!r:.40}")
    return value


def items(value: Any, least: int, most: int) -> list[Any]:
    """Read a list of bounded length.

    Parameters
    ----------
    value : object
        From the file.
    least, most : int
        The least and the greatest length.

    Returns
    -------
    list
        The list.
    """
    if not isinstance(value, list) or not least <= len(value) <= most:
        raise BadInput(f"expected a list of {least} to {most} entries, got {value!r:.40}")
    return value
