"""Taylor models of third order, as plain arrays in compiled code.

A model of f over a box with middle c and half-widths h, in e_q = (x_q - c_q) / h_q of [-1, 1], says

    f  in  value + sum_q g_q e_q + sum_{q<=r} Q_qr e_q e_r + sum_{q<=r<=s} C_qrs e_q e_r e_s + [-rest, rest].

As an array: value, sum of |g|, sum of |Q|, sum of |C|, rest, then g, Q and C in the order of the sums.

Rounding. A coefficient that is computed below is a sum of m <= 100 products of floats. Its error is at
most (m + 8) u times the sum of their sizes, u = 2^-53; ``ERROR`` = 128 u times the sizes of the models
that enter is added to the rest. The rest is itself a sum of products of floats >= 0: ``GROW`` exceeds the
relative error of such a sum, and ``TINY`` what underflow loses.
"""

from __future__ import annotations

from typing import Any

from numba import njit

from formulations.compiled import compiled

VALUE, LINEAR, SQUARE, CUBE, REST, SLOPES = 0, 1, 2, 3, 4, 5
ERROR, GROW, TINY = 2.0**-46, 1.0 + 2.0**-41, 1e-300

# sums of absolute values may be added in any order: ``GROW`` covers them all
_summed = njit(cache=True, error_model="numpy", fastmath={"reassoc"})


@compiled
def width_of(n: int) -> int:
    """Length of a model.

    Parameters
    ----------
    n : int
        Number of variables.

    Returns
    -------
    int
        Number of floats.
    """
    return SLOPES + n + (n * (n + 1)) // 2 + (n * (n + 1) * (n + 2)) // 6


@compiled
def size_of(a: Any) -> float:
    """Sum of the absolute values of the coefficients.

    Parameters
    ----------
    a : ndarray, shape (width,)
        A model.

    Returns
    -------
    float
        Not rounded.
    """
    return abs(a[VALUE]) + a[LINEAR] + a[SQUARE] + a[CUBE]


@compiled
def spread_of(a: Any) -> float:
    """By how much a model differs from its value in the middle at most.

    Parameters
    ----------
    a : ndarray, shape (width,)
        A model.

    Returns
    -------
    float
        Rounded up.
    """
    return (a[LINEAR] + a[SQUARE] + a[CUBE] + a[REST]) * GROW


@compiled
def clear(a: Any) -> None:
    """Make a model zero.

    Parameters
    ----------
    a : ndarray, shape (width,)
        Is filled.
    """
    for i in range(len(a)):
        a[i] = 0.0


@compiled
def copy_model(target: Any, source: Any) -> None:
    """Copy a model.

    Parameters
    ----------
    target, source : ndarray, shape (width,)
        The model to fill, and the one to copy.
    """
    for i in range(len(source)):
        target[i] = source[i]


@_summed
def sum_of_sizes(a: Any, first: int, last: int) -> float:
    """Sum of absolute values, added in any order.

    Parameters
    ----------
    a : ndarray
        Values.
    first, last : int
        Which of them: first .. last - 1.

    Returns
    -------
    float
        Not rounded.
    """
    total = 0.0
    for i in range(first, last):
        total += abs(a[i])
    return total


@compiled
def close(n: int, a: Any) -> None:
    """End a sum of models: fill in the sums of sizes, round the rest up.

    Parameters
    ----------
    n : int
        Number of variables.
    a : ndarray, shape (width,)
        The sum.
    """
    square, cube = SLOPES + n, SLOPES + n + (n * (n + 1)) // 2
    a[LINEAR] = sum_of_sizes(a, SLOPES, square)
    a[SQUARE] = sum_of_sizes(a, square, cube)
    a[CUBE] = sum_of_sizes(a, cube, len(a))
    a[REST] = a[REST] * GROW + TINY


@compiled
def add_scaled(k: float, a: Any, out: Any) -> None:
    """Add k a to a sum.

    Parameters
    ----------
    k : float
        A factor, exact.
    a : ndarray, shape (width,)
        A model.
    out : ndarray, shape (width,)
        The sum, to be closed.
    """
    rest = out[REST] + abs(k) * (a[REST] + ERROR * size_of(a))
    for i in range(len(a)):
        out[i] += k * a[i]
    out[REST] = rest
