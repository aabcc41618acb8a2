"""Ball arithmetic (python-flint's arb), and intervals with balls as ends: every check is made in it."""

from __future__ import annotations

from typing import Any

from flint import arb, arb_mat, ctx

from compare.check_certificate.answers import Refused

BITS = 128
ctx.prec = BITS

R: Any = arb
Interval = tuple[Any, Any]


def least(*numbers: Any) -> Any:
    """Take the least of several numbers.

    Parameters
    ----------
    numbers : arb
        At least one.

    Returns
    -------
    arb
        The least.
    """
    value = numbers[0]
    for x in numbers[1:]:
        value = value.min(x)
    return value


def most(*numbers: Any) -> Any:
    """Take the greatest of several numbers.

    Parameters
    ----------
    numbers : arb
        At least one.

    Returns
    -------
    arb
        The greatest.
    """
    value = numbers[0]
    for x in numbers[1:]:
        value = value.max(x)
    return value


def times(k: Any, a: Interval) -> Interval:
    """Enclose k [a, b].

    Parameters
    ----------
    k : arb
        A factor.
    a : Interval
        An interval.

    Returns
    -------
    Interval
        Their product.
    """
    p, q = k * a[0], k * a[1]
    return p.min(q), p.max(q)


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
    return a[0] + b[0], a[1] + b[1]


def product(a: Interval, b: Interval) -> Interval:
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
    each = (a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1])
    return least(*each), most(*each)


def least_quadratic(slopes: Interval, k: Any, lo: Any, hi: Any) -> Any:
    """Bound b d + k d^2 from below over d in [lo, hi] and b in an interval.

    It is linear in b, so an end of the interval is least.

    Parameters
    ----------
    slopes : Interval
        Of b.
    k, lo, hi : arb
        Curvature, and ends of d.

    Returns
    -------
    arb
        The bound.
    """
    k, values = k.lower(), []
    for b in slopes:
        values += [(b + k * lo) * lo, (b + k * hi) * hi]
        if k > 0:
            place = -b / (2 * k)
            if not (place < lo or place > hi):
                values.append(-b * b / (4 * k))
    return least(*values)


def least_share(a: Interval, k: Any, nu: Any, w1: Any, w2: Any, c: Any, lo: Any, hi: Any) -> Any:
    """Bound a (x - c) + k x^2 + (nu - w1)/x - w2/x^2 from below over x in [lo, hi].

    With e = x - c, exactly: 1/x = 1/c - e/c^2 + e^2/(c^2 x) and
    1/x^2 = 1/c^2 - 2e/c^3 + e^2 (2/(c^3 x) + 1/(c^2 x^2)). What is left is a quadratic in e.

    Parameters
    ----------
    a : Interval
        Of the slope.
    k, nu, w1, w2 : arb
        Coefficients; nu, w1, w2 >= 0.
    c, lo, hi : arb
        The x that it is expanded about, and ends of x; all > 0.

    Returns
    -------
    arb
        The bound.
    """
    const = k * c * c + (nu - w1) / c - w2 / (c * c)
    slope = 2 * c * k - (nu - w1) / (c * c) + 2 * w2 / (c * c * c)
    bend = (
        k + nu / (c * c * hi) - w1 / (c * c * lo) - w2 * (2 / (c * c * c * lo) + 1 / (c * c * lo * lo))
    )
    return const + least_quadratic((a[0] + slope, a[1] + slope), bend, lo - c, hi - c)


def derivative(coefficients: list[int], order: int, s: Any) -> Any:
    """Evaluate a derivative in s of sum c_i s^i.

    Parameters
    ----------
    coefficients : list of int
        The c_i, ascending.
    order : int
        Of the derivative.
    s : arb
        Where.

    Returns
    -------
    arb
        The value.
    """
    c = list(coefficients)
    for _ in range(order):
        c = [i * x for i, x in enumerate(c)][1:]
    value = R(0)
    for x in reversed(c):
        value = value * s + x
    return value


def inverse_of(rows: list[list[Any]]) -> list[list[Any]]:
    """Invert a square matrix.

    Parameters
    ----------
    rows : list of list of arb
        The matrix.

    Returns
    -------
    list of list of arb
        Its inverse. Refuses the certificate if the matrix may be singular.
    """
    try:
        inverse: list[list[Any]] = arb_mat(rows).inv().tolist()
    except ZeroDivisionError:
        raise Refused("the equations of the velocities have no certain solution") from None
    return inverse
