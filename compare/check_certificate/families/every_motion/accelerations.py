"""The acceleration at a waypoint, from the durations of the two segments that meet there.

A joint comes by d in T seconds, |jerk| <= J, and leaves by e in U seconds, |jerk| <= K. Seen from the waypoint
with velocity v and acceleration a, both positions are those of constant acceleration but for a cubic term:

    e = v U + a U^2 / 2 +- K U^3 / 6,        d = v T - a T^2 / 2 +- J T^3 / 6.

T times the first minus U times the second has no v: a T U (T + U) / 2 differs from e T - d U by at most
T U (J T^2 + K U^2) / 6. So a <= N / D, N = 2 (e T - d U) + T U (J T^2 + K U^2) / 3, D = T U (T + U). With
T = l + x (h - l) and U likewise, N and D are mixtures of their Bernstein coefficients of degree 3 with
the same weights. Those of D are positive, so N / D is at most the greatest ratio.
"""

from __future__ import annotations

from itertools import product
from math import comb
from typing import Any

from compare.check_certificate.balls import R, most

_DEGREE = 3


def weights(T: tuple[Any, Any], U: tuple[Any, Any]) -> list[tuple[Any, ...]]:
    """Compute the Bernstein coefficients that do not depend on the joint.

    Parameters
    ----------
    T, U : tuple of two arb [s]
        Intervals of the durations, above 0.

    Returns
    -------
    list of tuple of arb
        Those of 2 T, 2 U, T^3 U / 3 and T U^3 / 3, each divided by that of D.
    """
    t, u = [bernstein(p, *T) for p in range(4)], [bernstein(p, *U) for p in range(4)]
    found = []
    for i, k in product(range(_DEGREE + 1), repeat=2):
        below = t[2][i] * u[1][k] + t[1][i] * u[2][k]
        above = (
            2 * t[1][i] * u[0][k],
            2 * t[0][i] * u[1][k],
            t[3][i] * u[1][k] / 3,
            t[1][i] * u[3][k] / 3,
        )
        found.append(tuple(x / below for x in above))
    return found


def greatest(d: Any, e: Any, J: tuple[Any, Any], of_both: list[tuple[Any, ...]]) -> Any:
    """Bound the acceleration at a waypoint from above.

    Parameters
    ----------
    d, e : arb [rad]
        Displacements before and after the waypoint.
    J : tuple of two arb [rad/s^3]
        Jerk limits before and after.
    of_both : list of tuple of arb
        The ``weights`` of both durations.

    Returns
    -------
    arb [rad/s^2]
    """
    return most(*(e * x - d * y + J[0] * z + J[1] * w for x, y, z, w in of_both))


def bernstein(power: int, low: Any, high: Any) -> list[Any]:
    """Compute the Bernstein coefficients of degree 3 of x^power over an interval.

    Parameters
    ----------
    power : int
    low, high : arb

    Returns
    -------
    list of arb
    """
    # (low + s (high - low))^power in powers of s, and s^i as a sum over the Bernstein polynomials
    inner = [comb(power, i) * low ** (power - i) * (high - low) ** i for i in range(power + 1)]
    return [
        sum((inner[i] * R(comb(k, i)) / comb(_DEGREE, i) for i in range(min(power, k) + 1)), R(0))
        for k in range(_DEGREE + 1)
    ]
