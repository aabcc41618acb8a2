"""A row: one necessary condition g <= 0 and its multiplier, as WIDTH plain floats.

KIND says which condition it is; JOINT, SEGMENT, ORDER and PLACE say where it is posed: derivative ORDER
(0: position) of that joint on that piece at normalised time PLACE. SIGN is +1 for the upper limit and -1
for the lower one. The multiplier of g is the float MULTIPLIER / SCALE. SCALE > 0 makes rows comparable
in size; only the choice of multipliers needs it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

KIND, JOINT, SEGMENT, ORDER, PLACE, SIGN, SCALE, MULTIPLIER, WIDTH = 0, 1, 2, 3, 4, 5, 6, 7, 8

# the kinds: a limit inside a piece; the durations add up to L; the least durations of the first and of
# the last cubic of 3-5-3; the jump of the acceleration across a segment on which nothing moves (4-3-4);
# the least time of a part of the motion (4-3-4)
PIECE, TOTAL, FIRST, LAST, JUMP, PART = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0

# A Lagrangian must exceed this (rows are of size 1) to discard a box. Zero would be sound; with the
# margin, a checker that rounds in another way agrees.
MARGIN = 1e-12


def with_derivatives(basis: Any, orders: int) -> Any:
    """Polynomials in the normalised time s, and their derivatives.

    Parameters
    ----------
    basis : array_like, shape (..., degree + 1)
        Ascending coefficients; integers, so that everything stays exact.
    orders : int
        Number of derivatives, beside the polynomials themselves.

    Returns
    -------
    ndarray, shape (orders + 1, ..., degree + 1)
        Coefficients by order of the derivative, padded with zeros.
    """
    first = np.asarray(basis, dtype=np.float64)
    found = np.zeros((orders + 1, *first.shape))
    found[0] = first
    for order in range(1, orders + 1):
        found[order, ..., :-1] = found[order - 1, ..., 1:] * np.arange(1.0, first.shape[-1])
    return found
