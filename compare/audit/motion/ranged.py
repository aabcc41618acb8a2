"""Interval arithmetic over the box of half units that rounding to the printed digits leaves open.

A number is a function f of e in [-1, 1]^m, with one e_i per printed number: x_i = printed_i + half_i e_i.
Each ``Ranged`` carries enclosures of its range, of f(0), and of all df/de_i over the whole box. By the
mean value theorem

    f(e) in f(0) + sum_i [-1, 1] df/de_i,

which is sharp to second order in the half units. Every operation is rounded outward, so that an enclosure
is a theorem (except for underflow). The spline families run on these numbers as on floats
(``Family.symbols``).
"""

from __future__ import annotations

from math import inf, nextafter
from typing import Any

import numpy as np

from formulations.problem.arrays import Array

Interval = tuple[float, float]


class Undecided(ArithmeticError):  # noqa: N818
    """The digits leave open which branch a formula takes."""


class Ranged:
    """A number that depends on m rounded ones.

    Attributes
    ----------
    lo, hi : float
        Its range.
    value : tuple of float
        Enclosure of the number at the printed digits.
    slope : Array, shape (2, m)
        Least and greatest derivative with respect to each e_i.
    """

    __slots__ = ("hi", "lo", "slope", "value")
    __array_ufunc__ = None  # a NumPy number on the left leaves the operation to this class

    def __init__(self, value: Interval, slope: Array, lo: float = -inf, hi: float = inf) -> None:
        steepest = np.maximum(-slope[0], slope[1])
        reach = float(steepest.sum()) * (1.0 + 1e-14)
        self.value, self.slope = value, slope
        self.lo = max(lo, nextafter(value[0] - reach, -inf))
        self.hi = min(hi, nextafter(value[1] + reach, inf))

    @staticmethod
    def printed(value: float, half: float, index: int, count: int) -> Ranged:
        """Make a ``Ranged`` of one printed number.

        Parameters
        ----------
        value, half : float
            The number and half a unit of its last digit.
        index, count : int
            Its place among all printed numbers, and how many there are.

        Returns
        -------
        Ranged
        """
        slope = np.zeros((2, count))
        if half:
            slope[:, index] = nextafter(half, 0.0), nextafter(half, inf)
        return Ranged(_out(value, value), slope)

    def _of(self, other: Any) -> Ranged:
        if isinstance(other, Ranged):
            return other
        return Ranged((float(other), float(other)), np.zeros_like(self.slope))

    def __neg__(self) -> Ranged:
        return Ranged((-self.value[1], -self.value[0]), -self.slope[::-1], -self.hi, -self.lo)

    def __add__(self, other: Any) -> Ranged:
        b = self._of(other)
        return Ranged(
            _out(self.value[0] + b.value[0], self.value[1] + b.value[1]),
            _outward(self.slope + b.slope),
            *_out(self.lo + b.lo, self.hi + b.hi),
        )

    def __sub__(self, other: Any) -> Ranged:
        return self + (-self._of(other))

    def __mul__(self, other: Any) -> Ranged:
        if not isinstance(other, Ranged):
            k = float(other)
            if k < 0.0:
                return -(self * -k)
            return Ranged(
                _out(k * self.value[0], k * self.value[1]),
                _outward(k * self.slope),
                *_out(k * self.lo, k * self.hi),
            )
        slope = _scaled(self.slope, other.lo, other.hi) + _scaled(other.slope, self.lo, self.hi)
        return Ranged(
            _product(self.value, other.value),
            _outward(slope),
            *_product((self.lo, self.hi), (other.lo, other.hi)),
        )

    def inverse(self) -> Ranged:
        """1 / f. Raises Undecided if f may vanish."""
        if self.lo <= 0.0 <= self.hi:
            raise Undecided("a divisor may be zero within the printed digits")
        lo, hi = _out(1.0 / self.hi, 1.0 / self.lo)
        square = _product((lo, hi), (lo, hi))
        value = _out(1.0 / self.value[1], 1.0 / self.value[0])
        return Ranged(value, _scaled(-self.slope[::-1], max(square[0], 0.0), square[1]), lo, hi)

    def __truediv__(self, other: Any) -> Ranged:
        return self.__mul__(self._of(other).inverse())

    def __radd__(self, other: Any) -> Ranged:
        return self.__add__(other)

    def __rmul__(self, other: Any) -> Ranged:
        return self.__mul__(other)

    def __rsub__(self, other: Any) -> Ranged:
        return self.__neg__().__add__(other)

    def __rtruediv__(self, other: Any) -> Ranged:
        return self.inverse().__mul__(other)

    def __gt__(self, other: Any) -> bool:
        gap = self - other
        if gap.lo <= 0.0 < gap.hi:
            raise Undecided("a comparison depends on the printed digits")
        return bool(gap.lo > 0.0)


def _out(lo: float, hi: float) -> Interval:
    """One step outward; exact zeros stay."""
    return nextafter(lo, -inf) if lo else 0.0, nextafter(hi, inf) if hi else 0.0


def _product(a: Interval, b: Interval) -> Interval:
    corners = a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]
    return _out(min(corners), max(corners))


def _outward(pair: Array) -> Array:
    """Row 0 one step down, row 1 one up; exact zeros stay."""
    return np.where(pair == 0.0, 0.0, np.nextafter(pair, _OUT))


def _scaled(slope: Array, lo: float, hi: float) -> Array:
    """Product of the intervals of slopes, (2, m), and [lo, hi], rounded outward."""
    if lo < 0.0:
        if hi <= 0.0:
            return _scaled(-slope[::-1], -hi, -lo)
        below, above = (
            np.minimum(slope[0] * hi, slope[1] * lo),
            np.maximum(slope[0] * lo, slope[1] * hi),
        )
    else:
        below = np.where(slope[0] < 0.0, slope[0] * hi, slope[0] * lo)
        above = np.where(slope[1] < 0.0, slope[1] * lo, slope[1] * hi)
    return _outward(np.stack([below, above]))


_OUT = np.array([[-inf], [inf]])
