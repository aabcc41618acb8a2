"""Numbers known to lie in an interval, with the operations that the kinematics need, rounded outward."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.arithmetic.intervals import down, exact, plus, times, up

_LIBRARY = 2.0**-48  # more than the error of NumPy's sine and cosine, which is a few units of 2^-53


@dataclass(frozen=True)
class Enclosed:
    """Arrays of intervals [low, high] that broadcast."""

    low: Array
    high: Array
    __array_ufunc__ = None  # an array times one of these asks this class

    @staticmethod
    def of(value: Any) -> Enclosed:
        """Take floats as exact numbers.

        Parameters
        ----------
        value : array_like or Enclosed

        Returns
        -------
        Enclosed
        """
        return value if isinstance(value, Enclosed) else Enclosed(*exact(value))

    @property
    def _ends(self) -> tuple[Array, Array]:
        return self.low, self.high

    def __add__(self, other: Any) -> Enclosed:
        return Enclosed(*plus(self._ends, Enclosed.of(other)._ends))

    __radd__ = __add__

    def __neg__(self) -> Enclosed:
        return Enclosed(-self.high, -self.low)

    def __sub__(self, other: Any) -> Enclosed:
        return self + -Enclosed.of(other)

    def __rsub__(self, other: Any) -> Enclosed:
        return -self + other

    def __mul__(self, other: Any) -> Enclosed:
        return Enclosed(*times(self._ends, Enclosed.of(other)._ends))

    __rmul__ = __mul__

    @property
    def size(self) -> Array:
        """Upper bound on the modulus."""
        return np.maximum(np.abs(self.low), np.abs(self.high))


def sine(x: Enclosed) -> Enclosed:
    """Enclose the sine of a narrow interval.

    Parameters
    ----------
    x : Enclosed

    Returns
    -------
    Enclosed
    """
    return _around(np.sin, x)


def cosine(x: Enclosed) -> Enclosed:
    """Enclose the cosine of a narrow interval.

    Parameters
    ----------
    x : Enclosed

    Returns
    -------
    Enclosed
    """
    return _around(np.cos, x)


def _around(function: Any, x: Enclosed) -> Enclosed:
    """Both functions change by no more than their argument."""
    middle = 0.5 * x.low + 0.5 * x.high
    off = up(np.maximum(up(x.high - middle), up(middle - x.low)) + _LIBRARY)
    value = function(middle)
    return Enclosed(np.maximum(down(value - off), -1.0), np.minimum(up(value + off), 1.0))


@dataclass(frozen=True)
class Sloped:
    """A value with its derivative in one direction: forward differentiation, enclosed."""

    value: Enclosed
    slope: Enclosed

    def __add__(self, other: Any) -> Sloped:
        if isinstance(other, Sloped):
            return Sloped(self.value + other.value, self.slope + other.slope)
        return Sloped(self.value + other, self.slope)

    def __rsub__(self, other: float) -> Sloped:
        return Sloped(other - self.value, -self.slope)

    def __mul__(self, other: Any) -> Sloped:
        if isinstance(other, Sloped):
            return Sloped(self.value * other.value, self.slope * other.value + self.value * other.slope)
        return Sloped(self.value * other, self.slope * other)


def sloped_sine(x: Sloped) -> Sloped:
    """Enclose the sine and its slope.

    Parameters
    ----------
    x : Sloped

    Returns
    -------
    Sloped
    """
    return Sloped(sine(x.value), cosine(x.value) * x.slope)


def sloped_cosine(x: Sloped) -> Sloped:
    """Enclose the cosine and its slope.

    Parameters
    ----------
    x : Sloped

    Returns
    -------
    Sloped
    """
    return Sloped(cosine(x.value), -(sine(x.value) * x.slope))
