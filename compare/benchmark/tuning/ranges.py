"""Which constants of an algorithm are tuned, and in which ranges: read off its published parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

_FACTOR = 4.0  # a constant may become so many times larger or smaller
_TOLERANCE = 1e-6  # smaller constants are tolerances at which a local search stops, and stay
_FIXED = ("population", "popsize")  # the protocol says how large a population is


@dataclass(frozen=True)
class Range:
    """The values that a constant may have; ``whole``: whole numbers alone."""

    low: float
    high: float
    whole: bool
    logarithmic: bool


def ranges_of(parameters: Mapping[str, Any]) -> dict[str, Range]:
    """Return the range of each constant that is tuned.

    Parameters
    ----------
    parameters : mapping of str to Any
        As published.

    Returns
    -------
    dict of str to Range
        Numbers alone: switches and words say which variant of the algorithm it is. A number is tuned
        between a quarter and four times of what is published, on a logarithmic scale; zero between 0
        and 1.
    """
    found = {}
    for name, value in parameters.items():
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not number or name in _FIXED or 0.0 < abs(value) < _TOLERANCE:
            continue
        if isinstance(value, int):
            found[name] = Range(
                max(1, round(value / _FACTOR)), max(2, round(value * _FACTOR)), True, True
            )
        elif value > 0.0:
            found[name] = Range(value / _FACTOR, value * _FACTOR, False, True)
        else:
            found[name] = Range(value * _FACTOR, 1.0 if value == 0.0 else value / _FACTOR, False, False)
    return found
