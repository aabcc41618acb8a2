"""3-5-3: what the compiled functions of the proof share, as named tuples."""

from __future__ import annotations

from typing import Any, NamedTuple

from formulations.proofs.conditions import with_derivatives

# what multiplies d2, d1 r, d1 r^2, d3 q, d3 q^2 in the middle quintic, (order, term, power of s)
BASIS = with_derivatives(
    [
        [0, 0, 0, 10, -15, 6],
        [0, 3, 0, -18, 24, -9],
        [0, 0, 3, -9, 9, -3],
        [0, 0, 0, -12, 21, -9],
        [0, 0, 0, -3, 6, -3],
    ],
    3,
)


class RatioData(NamedTuple):
    """The task of one attempt.

    d, d_lo, d_hi: displacements and their enclosures, (3, dof) [rad]. limit (5, dof): room above and
    below the second waypoint, rounded up [rad], velocity, acceleration, jerk. basis: ``BASIS``. has (2,):
    whether r and q exist, that is, whether anything moves on the first and on the last segment.
    shortest (3,): lower bounds of the durations [s]. L: the total time [s].
    """

    d: Any
    d_lo: Any
    d_hi: Any
    limit: Any
    basis: Any
    has: Any
    shortest: Any
    L: float


class RatioForm(NamedTuple):
    """Rows and their first-order form a_i + g_i . e <= 0, e in [-1, 1]^3, about the middle of a box.

    c, h (3,): middle and half-widths of the box of (r, q, T). rows (m, WIDTH), a (m,), g (m, 3), and
    multipliers (m,).
    """

    c: Any
    h: Any
    rows: Any
    a: Any
    g: Any
    multipliers: Any
