"""Interval arithmetic on whole arrays, rounded outward by the lemma in ``outward``.

An interval is a pair (lo, hi) of arrays that broadcast. Sums of many floats use a second lemma: the sum
of m floats, in any order, is off by at most 2 m u times the sum of their sizes (u = 2^-53, m u < 0.01).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.arithmetic.outward import GROW, TINY

Interval = tuple[Array, Array]

_TWO_UNITS = 2.0**-52  # 2 u


def down(y: Any) -> Array:
    """Round down: floats <= the exact results whose nearest roundings are y.

    Parameters
    ----------
    y : array_like
        Rounded results of one operation each.

    Returns
    -------
    Array
        Lower bounds.
    """
    return np.asarray(y - (np.abs(y) * GROW + TINY))


def up(y: Any) -> Array:
    """Round up: floats >= the exact results whose nearest roundings are y.

    Parameters
    ----------
    y : array_like
        Rounded results of one operation each.

    Returns
    -------
    Array
        Upper bounds.
    """
    return np.asarray(y + (np.abs(y) * GROW + TINY))


def exact(a: Any) -> Interval:
    """Take floats as intervals of one point.

    Parameters
    ----------
    a : array_like
        Exact numbers.

    Returns
    -------
    Interval
        Both ends are a.
    """
    values = np.asarray(a, dtype=np.float64)
    return values, values


def plus(a: Interval, b: Interval) -> Interval:
    """Enclose [a] + [b].

    Parameters
    ----------
    a, b : Interval
        The addends.

    Returns
    -------
    Interval
        Their sum.
    """
    return down(a[0] + b[0]), up(a[1] + b[1])


def times(a: Interval, b: Interval) -> Interval:
    """Enclose [a] [b].

    Parameters
    ----------
    a, b : Interval
        The factors.

    Returns
    -------
    Interval
        Their product.
    """
    products = (a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1])
    least = np.minimum(np.minimum(*products[:2]), np.minimum(*products[2:]))
    most = np.maximum(np.maximum(*products[:2]), np.maximum(*products[2:]))
    return down(least), up(most)


def polynomial(coefficients: Array, s: Any) -> Interval:
    """Enclose the sum of coefficients[..., i] s^i, by Horner's rule.

    Parameters
    ----------
    coefficients : Array, shape (..., degree + 1)
        Ascending coefficients, exact.
    s : array_like
        Where, exact.

    Returns
    -------
    Interval
        The values.
    """
    value = exact(coefficients[..., -1])
    for i in range(coefficients.shape[-1] - 2, -1, -1):
        value = plus(times(value, exact(s)), exact(coefficients[..., i]))
    return value


def least_sum(terms: Array, index: Any, size: int) -> Array:
    """Bound from below the sums of the terms that share an index.

    Parameters
    ----------
    terms : Array, shape (m,)
        The terms.
    index : array_like of int, shape (m,)
        Which sum each belongs to.
    size : int
        Number of sums.

    Returns
    -------
    Array, shape (size,)
        Lower bounds.
    """
    total, sizes = np.zeros(size), np.zeros(size)
    np.add.at(total, index, terms)
    np.add.at(sizes, index, np.abs(terms))
    return total - sum_error(len(terms), sizes)


def sum_error(count: int, sizes: Any) -> Array:
    """Bound the error of a float sum.

    Parameters
    ----------
    count : int
        Number of terms.
    sizes : array_like
        Sums of their absolute values.

    Returns
    -------
    Array
        How far the sums are from the exact ones at most.
    """
    return np.asarray((count + 2) * _TWO_UNITS * sizes * 1.01 + TINY)
