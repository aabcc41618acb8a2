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


def greatest(d: Any, e: Any, J: tuple[Any, Any], T: tuple[Any, Any], U: tuple[Any, Any]) -> Any:
    """Bound the acceleration at a waypoint from above.

    Parameters
    ----------
    d, e : arb [rad]
        Displacements before and after the waypoint.
    J : tuple of two arb [rad/s^3]
        Jerk limits before and after.
    T, U : tuple of two arb [s]
        Intervals of the durations, above 0.

    Returns
    -------
    arb [rad/s^2]
    """
    t, u = [bernstein(p, *T) for p in range(4)], [bernstein(p, *U) for p in range(4)]
    ratios = []
    for i, k in product(range(_DEGREE + 1), repeat=2):
        jerk = (J[0] * t[3][i] * u[1][k] + J[1] * t[1][i] * u[3][k]) / 3
        above = 2 * (e * t[1][i] * u[0][k] - d * t[0][i] * u[1][k]) + jerk
        ratios.append(above / (t[2][i] * u[1][k] + t[1][i] * u[2][k]))
    return most(*ratios)


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
