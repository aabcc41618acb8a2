"""The safe dual bound: a lower bound from any multipliers, valid whatever the solver and rounding did.

For  min c x  subject to  A x <= b,  l <= x <= u  and any multipliers y >= 0,

    c x  >=  c x + y (A x - b)  =  (c + A' y) x - b y,                                           (11)

and the least value of the right hand side over the box is found variable by variable. The bound holds
for every y; it is close to the optimum if y is close to the optimal multipliers.

Rounding. u = 2^-53. A sum of n products, in any order, errs by at most n u / (1 - n u) times the sum of
their moduli (Higham 2002, sec. 3.1). Every sum here gets twice that allowance, which covers the rounding
of the allowance itself.

References
----------
Neumaier & Shcherbina 2004, "Safe bounds in linear and mixed-integer linear programming", Mathematical
Programming 99, pp. 283-296.
Higham 2002, "Accuracy and Stability of Numerical Algorithms", 2nd edition, SIAM.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.sparse import csr_array

from formulations.problem.arrays import Array

_UNIT = 2.0**-53


def safe_bound(cost: Array, matrix: csr_array, upper: Array, box: Array, multipliers: Array) -> float:
    """Bound cost x from below on {matrix x <= upper, box[:, 0] <= x <= box[:, 1]} by (11).

    Parameters
    ----------
    cost : Array, shape (n,)
    matrix : csr_array, shape (m, n)
    upper : Array, shape (m,)
    box : Array, shape (n, 2)
        All finite, as the other numbers of the program.
    multipliers : Array, shape (m,)
        Any numbers; those that are negative or NaN count as 0.

    Returns
    -------
    float
        Minus infinity where the numbers overflow.
    """
    y = np.where(multipliers > 0.0, multipliers, 0.0)
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
