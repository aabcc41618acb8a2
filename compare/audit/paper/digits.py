"""A printed number: its digits, and the range of true numbers that round to them.

In a file, text ("0.8660") is a rounded number, known to within half a unit of its last digit. A plain
number (90) is exact.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from typing import Any

import numpy as np

from formulations import InputError
from formulations.problem.arrays import Array

_SMALLEST, _LARGEST = 1e-12, 1e9  # no paper about an arm prints less or more
_UNIT_ROUNDING = 1e-15  # relative: a rounded number times a unit of angle, in floating point


@dataclass(frozen=True)
class Printed:
    """A number as it is printed, its value, and half a unit of its last digit (0 if it is exact)."""

    text: str
    value: float
    half: float

    @property
    def low(self) -> float:
        """Least number that prints like this."""
        return self.value - self.half

    @property
    def high(self) -> float:
        """Greatest number that prints like this."""
        return self.value + self.half

    def __str__(self) -> str:
        return self.text


def printed(key: str, raw: Any) -> Printed:
    """Read one number of a file.

    Parameters
    ----------
    key : str
        Where it stands, for the message.
    raw : Any
        Text for a rounded number, int or float for an exact one.

    Returns
    -------
    Printed

    Raises
    ------
    InputError
        If it is no finite number; one line that names the key.
    """
    if isinstance(raw, bool) or not isinstance(raw, (str, int, float)):
        raise InputError(f"{key}: expected a number, got {raw!r:.50}")
    try:
        number = Decimal(raw) if isinstance(raw, str) else Decimal(repr(raw))
    except InvalidOperation:
        raise InputError(f"{key}: {raw!r:.50} is not a number") from None
    if not number.is_finite():
        raise InputError(f"{key}: {raw!r:.50} is not finite")
    if number and not _SMALLEST <= abs(number) <= _LARGEST:
        raise InputError(f"{key}: {raw!r:.50} is not from {_SMALLEST:g} to {_LARGEST:g} in size")
    half = 0.0
    if isinstance(raw, str):
        half = float(Decimal((0, (5,), int(number.as_tuple().exponent) - 1)))
    return Printed(str(raw), float(number), half)


def row(key: str, raw: Any, length: int | None = None, why: str = "") -> tuple[Printed, ...]:
    """Read a list of numbers of a file.

    Parameters
    ----------
    key : str
        Where it stands, for the message.
    raw : Any
        The list.
    length : int, optional
        How many numbers there have to be.
    why : str
        The key that says so, for the message.

    Returns
    -------
    tuple of Printed

    Raises
    ------
    InputError
        If it is no list, of another length, or holds something that is no number.
    """
    if not isinstance(raw, list) or not raw:
        raise InputError(f"{key}: expected a list of numbers, got {raw!r:.50}")
    if length is not None and len(raw) != length:
        raise InputError(
            f"{key}: {len(raw)} values where {length} are expected{f' ({why})' if why else ''}"
        )
    return tuple(printed(f"{key}: value {i + 1}", value) for i, value in enumerate(raw))


def values(numbers: Iterable[Printed]) -> Array:
    """Collect the numbers as printed.

    Parameters
    ----------
    numbers : iterable of Printed
        As they are printed.

    Returns
    -------
    Array, shape (n,)
    """
    return np.array([number.value for number in numbers])


def halves(numbers: Iterable[Printed]) -> Array:
    """Collect the half units of the numbers' last digits.

    Parameters
    ----------
    numbers : iterable of Printed
        As they are printed.

    Returns
    -------
    Array, shape (n,)
    """
    return np.array([number.half for number in numbers])


def reach(numbers: Iterable[Printed]) -> Array:
    """Half units, enlarged by the rounding of a change of unit.

    In any unit, value + reach is at least the greatest number that prints alike. The reach of an exact
    number is 0.

    Parameters
    ----------
    numbers : iterable of Printed
        As they are printed.

    Returns
    -------
    Array, shape (n,)
    """
    return np.array([n.half + _UNIT_ROUNDING * abs(n.value) if n.half else 0.0 for n in numbers])
