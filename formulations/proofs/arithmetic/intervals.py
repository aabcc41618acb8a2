"""Interval arithmetic on whole arrays, rounded outward by the lemma in ``outward``.

An interval is a pair (lo, hi) of arrays that broadcast. Sums of many floats use a second lemma: m
floats added in any order err by at most 2 m u times the sum of their sizes (u = 2^-53, m u < 0.01).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.problem.arrays import Array

Interval = tuple[Array, Array]

_GROW, _TINY = 2.0**-51, 1e-300
_UNIT = 2.0**-52


def down(y: Any) -> Array:
    """Floats <= the exact results whose nearest roundings are y."""
    return np.asarray(y - (np.abs(y) * _GROW + _TINY))


def up(y: Any) -> Array:
    """Floats >= the exact results whose nearest roundings are y."""
    return np.asarray(y + (np.abs(y) * _GROW + _TINY))


def exact(a: Any) -> Interval:
    """Floats as intervals."""
    values = np.asarray(a, dtype=np.float64)
    return values, values


def plus(a: Interval, b: Interval) -> Interval:
    """[a] + [b]."""
    return down(a[0] + b[0]), up(a[1] + b[1])


def times(a: Interval, b: Interval) -> Interval:
    """[a] [b]."""
    products = (a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1])
    least = np.minimum(np.minimum(*products[:2]), np.minimum(*products[2:]))
    most = np.maximum(np.maximum(*products[:2]), np.maximum(*products[2:]))
    return down(least), up(most)


def polynomial(coefficients: Array, s: Any) -> Interval:
    """Sum of coefficients[..., i] s^i for exactly given floats, by Horner."""
    value = exact(coefficients[..., -1])
    for i in range(coefficients.shape[-1] - 2, -1, -1):
        value = plus(times(value, exact(s)), exact(coefficients[..., i]))
    return value


def least_sum(terms: Array, index: Any, size: int) -> Array:
    """Lower bounds of the sums of terms (m,) that share an index (m,): (size,)."""
    total, sizes = np.zeros(size), np.zeros(size)
    np.add.at(total, index, terms)
    np.add.at(sizes, index, np.abs(terms))
    return total - sum_error(len(terms), sizes)


def sum_error(count: int, sizes: Any) -> Array:
    """How far a float sum of so many terms is from the exact one, from the sum of their sizes."""
    return np.asarray((count + 2) * _UNIT * sizes * 1.01 + _TINY)
