"""A printed number: the digits as they stand, and what rounding to them leaves open.

In a file, text ("0.8660") is a rounded number, known to within half a unit of its last digit; a plain
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


@dataclass(frozen=True)
class Printed:
    """value and half unit of the last digit; the true number lies within [low, high]."""

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
    """A number of a file; InputError that names the key if it is none."""
    if isinstance(raw, bool) or not isinstance(raw, (str, int, float)):
        raise InputError(f"{key}: expected a number, got {raw!r:.50}")
    try:
        number = Decimal(raw) if isinstance(raw, str) else Decimal(repr(raw))
    except InvalidOperation:
        raise InputError(f"{key}: {raw!r:.50} is not a number") from None
    if not number.is_finite():
        raise InputError(f"{key}: {raw!r:.50} is not finite")
    half = 0.0
    if isinstance(raw, str):
        half = float(Decimal((0, (5,), int(number.as_tuple().exponent) - 1)))
    return Printed(str(raw), float(number), half)


def row(key: str, raw: Any, length: int | None = None) -> tuple[Printed, ...]:
    """A list of numbers of a file, of the given length if there is one."""
    if not isinstance(raw, list) or not raw:
        raise InputError(f"{key}: expected a list of numbers, got {raw!r:.50}")
    if length is not None and len(raw) != length:
        raise InputError(f"{key}: {len(raw)} values where {length} are expected")
    return tuple(printed(f"{key}: value {i + 1}", value) for i, value in enumerate(raw))


def values(numbers: Iterable[Printed]) -> Array:
    """The numbers as printed, (n,)."""
    return np.array([number.value for number in numbers])


def reach(numbers: Iterable[Printed]) -> Array:
    """Their half units and the rounding of a change of unit, (n,); 0 for an exact number.

    printed value + reach is not below the greatest number that prints alike, in any unit.
    """
    return np.array([n.half + 1e-15 * abs(n.value) if n.half else 0.0 for n in numbers])


def halves(numbers: Iterable[Printed]) -> Array:
    """Their half units, (n,)."""
    return np.array([number.half for number in numbers])
