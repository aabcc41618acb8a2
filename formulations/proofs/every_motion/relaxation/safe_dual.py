"""A lower bound from any multipliers, safe against rounding (Neumaier & Shcherbina 2004).

For  min c x  subject to  A x <= b,  l <= x <= u  and any multipliers y >= 0,

    c x  >=  c x + y (A x - b)  =  (c + A' y) x - b y,                                           (11)

the least of which over the box is known variable by variable.

Nothing is asked of y, so the bound holds whatever the solver returned; it is close if y is.

Rounding. u = 2^-53. A sum of n products, in any order, errs by at most n u / (1 - n u) times the sum of
their moduli (Higham 2002, sec. 3.1). Every sum here gets that allowance, doubled, which covers the
rounding of the allowance itself.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.sparse import csr_array

from formulations.problem.arrays import Array

_UNIT = 2.0**-53


def safe_bound(cost: Array, matrix: csr_array, upper: Array, box: Array, multipliers: Array) -> float:
    """Lower bound of cost x on {matrix x <= upper, box[:, 0] <= x <= box[:, 1]} (11), -inf at worst.

    cost (n,), upper (m,), box (n, 2): finite. multipliers (m,): any; negative ones count as 0.
    """
    y = np.where(multipliers > 0.0, multipliers, 0.0)  # NaN: 0
    if not np.isfinite(y).all():
        return -math.inf
    products = matrix.T @ y
    sizes = abs(matrix).T @ y + np.abs(cost)
    longest = int(np.bincount(matrix.indices).max(initial=0)) + 2
    reduced = cost + products
    spread = 2.0 * longest * _UNIT * sizes + 1e-300
    least = np.minimum.reduce(
        [(reduced + sign * spread) * box[:, side] for sign in (-1.0, 1.0) for side in (0, 1)]
    )
    terms = np.concatenate([least, -upper * y])
    slack = 8.0 * _UNIT * float(np.abs(terms).sum()) + 1e-290
    bound = math.fsum(terms) - slack
    return bound if math.isfinite(bound) else -math.inf
