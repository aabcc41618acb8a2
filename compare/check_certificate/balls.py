"""Balls and intervals of balls: the arithmetic that every step of a proof is checked in."""

from __future__ import annotations

from typing import Any

from flint import arb, arb_mat, ctx

from compare.check_certificate.answers import Refused

BITS = 128
ctx.prec = BITS

R: Any = arb
Interval = tuple[Any, Any]


def least(*numbers: Any) -> Any:
    """The least of several numbers."""
    value = numbers[0]
    for x in numbers[1:]:
        value = value.min(x)
    return value


def most(*numbers: Any) -> Any:
    """The greatest of several numbers."""
    value = numbers[0]
    for x in numbers[1:]:
        value = value.max(x)
    return value


def times(k: Any, a: Interval) -> Interval:
    """K [a, b]."""
    p, q = k * a[0], k * a[1]
    return p.min(q), p.max(q)


def plus(a: Interval, b: Interval) -> Interval:
    """[a] + [b]."""
    return a[0] + b[0], a[1] + b[1]


def product(a: Interval, b: Interval) -> Interval:
    """[a] [b]."""
    each = (a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1])
    return least(*each), most(*each)


def least_quadratic(slopes: Interval, k: Any, lo: Any, hi: Any) -> Any:
    """Least b d + k d^2 over d in [lo, hi] and b in its interval: at an end, as it is linear in b."""
    k, values = k.lower(), []
    for b in slopes:
        values += [(b + k * lo) * lo, (b + k * hi) * hi]
        if k > 0:
            place = -b / (2 * k)
            if not (place < lo or place > hi):
                values.append(-b * b / (4 * k))
    return least(*values)


def least_share(a: Interval, k: Any, nu: Any, w1: Any, w2: Any, c: Any, lo: Any, hi: Any) -> Any:
    """Lower bound of a (x - c) + k x^2 + (nu - w1)/x - w2/x^2 over x in [lo, hi], by divided
    differences.

    1/x = 1/c - e/c^2 + e^2/(c^2 x), 1/x^2 = 1/c^2 - 2e/c^3 + e^2 (2/(c^3 x) + 1/(c^2 x^2)), e = x - c.
    """
    const = k * c * c + (nu - w1) / c - w2 / (c * c)
    slope = 2 * c * k - (nu - w1) / (c * c) + 2 * w2 / (c * c * c)
    bend = (
        k + nu / (c * c * hi) - w1 / (c * c * lo) - w2 * (2 / (c * c * c * lo) + 1 / (c * c * lo * lo))
    )
    return const + least_quadratic((a[0] + slope, a[1] + slope), bend, lo - c, hi - c)


def derivative(coefficients: list[int], order: int, s: Any) -> Any:
    """A derivative in s of sum c_i s^i."""
    c = list(coefficients)
    for _ in range(order):
        c = [i * x for i, x in enumerate(c)][1:]
    value = R(0)
    for x in reversed(c):
        value = value * s + x
    return value


def inverse_of(rows: list[list[Any]]) -> list[list[Any]]:
    """The inverse of a square matrix."""
    try:
        inverse: list[list[Any]] = arb_mat(rows).inv().tolist()
    except ZeroDivisionError:
        raise Refused("the equations of the velocities have no certain solution") from None
    return inverse
