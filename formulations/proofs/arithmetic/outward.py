"""Arithmetic rounded outward, and the least value of a quadratic on an interval.

Lemma. Let y = fl(a op b), op one of + - * /, rounded to nearest, and u = 2^-53. IEEE 754 gives
|y - (a op b)| <= u |y| + 2^-1075. ``down`` subtracts e = fl(4 u |y| + 1e-300) >= (1 - u) (4 u |y| +
1e-300); the subtraction itself errs by at most u (|y| + e), so the result is <= y - u |y| - 2^-1075 <=
a op b. ``up`` is the mirror image. Infinities become NaN, and every test that accepts a proof reads
``x > margin``, which is false for NaN.
"""

from __future__ import annotations

from typing import Any

from formulations.compiled import compiled

GROW, TINY = 2.0**-51, 1e-300


@compiled
def down(y: float) -> float:
    """Round down: a float <= the exact result whose nearest rounding is y.

    Parameters
    ----------
    y : float
        The rounded result of one operation.

    Returns
    -------
    float
        A lower bound.
    """
    return y - (abs(y) * GROW + TINY)


@compiled
def up(y: float) -> float:
    """Round up: a float >= the exact result whose nearest rounding is y.

    Parameters
    ----------
    y : float
        The rounded result of one operation.

    Returns
    -------
    float
        An upper bound.
    """
    return y + (abs(y) * GROW + TINY)


@compiled
def add(a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Enclose [a, b] + [c, d].

    Parameters
    ----------
    a, b, c, d : float
        Ends of the addends.

    Returns
    -------
    tuple of two floats
        Ends of the sum.
    """
    return down(a + c), up(b + d)


@compiled
def multiply(a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Enclose [a, b] [c, d].

    Parameters
    ----------
    a, b, c, d : float
        Ends of the factors.

    Returns
    -------
    tuple of two floats
        Ends of the product.
    """
    p, q, r, s = a * c, a * d, b * c, b * d
    return down(min(min(p, q), min(r, s))), up(max(max(p, q), max(r, s)))


@compiled
def scale(k: float, a: float, b: float) -> tuple[float, float]:
    """Enclose k [a, b].

    Parameters
    ----------
    k, a, b : float
        A factor, and the ends of an interval.

    Returns
    -------
    tuple of two floats
        Ends of the product.
    """
    p, q = k * a, k * b
    return (down(p), up(q)) if p <= q else (down(q), up(p))


@compiled
def horner(c: Any, n: int, s: float) -> tuple[float, float]:
    """Enclose the sum of c[i] s^i for i < n, by Horner's rule.

    Parameters
    ----------
    c : ndarray, shape (at least n,)
        Ascending coefficients, exact.
    n : int
        Their number.
    s : float
        Where, exact.

    Returns
    -------
    tuple of two floats
        Ends of the value.
    """
    lo, hi = c[n - 1], c[n - 1]
    for i in range(n - 2, -1, -1):
        lo, hi = multiply(lo, hi, s, s)
        lo, hi = add(lo, hi, c[i], c[i])
    return lo, hi


@compiled
def quadratic_least(b_lo: float, b_hi: float, k: float, d_lo: float, d_hi: float) -> float:
    """Bound b d + k d^2 from below over d in [d_lo, d_hi], where b in [b_lo, b_hi] may vary with d.

    If k <= 0, it is concave in d and least at an end of the interval. If k > 0, it is at least
    -b^2 / (4 k), and least at an end where the derivative keeps one sign for every b. Both hold for each
    fixed b, hence for any b(d); the values at the ends take the b that is worst there.

    Parameters
    ----------
    b_lo, b_hi, k, d_lo, d_hi : float
        Ends of b, the curvature, and ends of d.

    Returns
    -------
    float
        The bound, rounded down.
    """
    at_lo = down(min(down(b_lo * d_lo), down(b_hi * d_lo)) + _square_low(k, d_lo))
    at_hi = down(min(down(b_lo * d_hi), down(b_hi * d_hi)) + _square_low(k, d_hi))
    if k <= 0.0:
        return min(at_lo, at_hi)
    if down(b_lo + down(2.0 * k * d_lo)) >= 0.0:
        return at_lo
    if up(b_hi + up(2.0 * k * d_hi)) <= 0.0:
        return at_hi
    if not down(4.0 * k) > 0.0:  # k so small that it may vanish: drop k d^2 >= 0
        return min(min(down(b_lo * d_lo), down(b_hi * d_lo)), min(down(b_lo * d_hi), down(b_hi * d_hi)))
    b = max(abs(b_lo), abs(b_hi))
    return -up(up(b * b) / down(4.0 * k))


@compiled
def _square_low(k: float, d: float) -> float:
    """Lower bound of k d^2."""
    return down(k * down(d * d)) if k >= 0.0 else down(k * up(d * d))
