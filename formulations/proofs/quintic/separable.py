"""Quintic: least value of one variable's share of a separable Lagrangian, on each of many cells."""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.arithmetic.intervals import down, up

_PIECES = 8  # parts of a cell, where the share is neither convex nor concave in 1/x


def least_share(a: float, b: float, c: float, lo: Array, hi: Array) -> Array:
    """Bound a x + b / x - c / x^2 from below over x in [lo, hi], for each of many cells.

    In u = 1/x on [p, q]: u^2 <= (p + q) u - p q, so the share is at least a / u + b' u + c p q with
    b' = b - c (p + q). That is monotone or concave, least at an end, unless a, b' > 0: then it is
    convex, and at least 2 sqrt(a b') unless its slope keeps one sign.

    Parameters
    ----------
    a, b, c : float
        Coefficients; c >= 0.
    lo, hi : Array, shape (cells,)
        Ends of the cells, > 0.

    Returns
    -------
    Array, shape (cells,)
        Lower bounds, rounded down.
    """
    first, last = down(1.0 / hi), up(1.0 / lo)
    if c > 0.0:
        steps = np.arange(_PIECES) / _PIECES
        starts = first + (last - first) * steps[:, None]
        p, q = starts, np.vstack([starts[1:], last[None]])
    else:
        p, q = first[None], last[None]
    slope = down(b - up(c * up(p + q)))
    at_p, at_q = (down(down(a / u) + down(slope * u)) for u in (p, q))
    ends = np.minimum(at_p, at_q)
    if a > 0.0:
        middle = down(2.0 * down(np.sqrt(np.maximum(down(a * slope), 0.0))))
        rising = down(slope * down(p * p)) >= a
        falling = up(slope * up(q * q)) <= a
        convex = slope > 0.0
        ends = np.where(convex & rising, at_p, np.where(convex & ~falling & ~rising, middle, ends))
    return np.asarray(down(ends + down(c * down(p * q))).min(axis=0))
