"""The least value of a Taylor model over its box."""

from __future__ import annotations

from typing import Any

from formulations.compiled import compiled
from formulations.proofs.b_spline.taylor import CUBE, ERROR, GROW, REST, SLOPES, VALUE, size_of


@compiled
def least_separable(n: int, a: Any, least: Any, own: Any) -> float:
    """Bound a model from below by a sum of quadratics in one variable each: |e_q e_r| <= (e_q^2 + e_r^2) / 2.

    Parameters
    ----------
    n : int
        Number of variables.
    a : ndarray, shape (width,)
        The model.
    least, own : ndarray, shape (n,)
        Are filled: the least value of each quadratic on [-1, 1], and its curvature.

    Returns
    -------
    float
        The bound; the rest of the model charges the rounding.
    """
    i = SLOPES + n
    for q in range(n):
        own[q] = 0.0
    for q in range(n):
        own[q] += a[i]
        i += 1
        for r in range(q + 1, n):
            half = 0.5 * abs(a[i])
            own[q] -= half
            own[r] -= half
            i += 1
    total = a[VALUE] - a[CUBE]
    for q in range(n):
        least[q] = least_on(a[SLOPES + q], own[q], -1.0, 1.0)
        total += least[q]
    return total - (a[REST] + ERROR * size_of(a)) * GROW


@compiled
def least_on(g: float, d: float, lo: float, hi: float) -> float:
    """Least value of g e + d e^2.

    Parameters
    ----------
    g, d : float
        Slope and curvature.
    lo, hi : float
        Ends of e, within [-1, 1].

    Returns
    -------
    float
        Not rounded.
    """
    y = min(g * lo + d * lo * lo, g * hi + d * hi * hi)
    if d > 0.0:
        e = -0.5 * g / d
        if lo < e < hi:
            y = -0.25 * g * g / d
    return y
