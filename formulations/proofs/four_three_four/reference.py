"""4-3-...-3-4: the reference of a box, the point about which velocities and rows are expanded.

All of it is floating point, but for ``_inverse_rest``, which the enclosure of the velocities rests on.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled, inlined
from formulations.proofs.arithmetic.outward import add, down, scale, up
from formulations.proofs.four_three_four.data import GONE, UNIT, VARIES
from formulations.proofs.four_three_four.ends import side_of, unknown_knots, weights


@compiled
def place_reference(reference: Any, box: Any, data: Any, velocities: Any) -> None:
    """Place the reference at the middle of a box, and fill in what follows from it.

    Parameters
    ----------
    reference : Reference
        Is filled.
    box : Box
        Of x; a segment is open where it has no upper end.
    data : RateData
        The task.
    velocities : VelocityEnclosure
        Its middle is taken at the free ends.
    """
    c, is_open = reference.c, reference.is_open
    for k in range(data.n):
        is_open[k] = box.hi[k] == np.inf
        c[k] = box.lo[k] if is_open[k] else 0.5 * (box.lo[k] + box.hi[k])
        reference.half[k] = 0.0 if is_open[k] else 0.5 * (box.hi[k] - box.lo[k])
    _coefficients(reference, data)
    _inverse(reference.ce, data, reference.C)
    _inverse_rest(reference.ce, reference.C, data, reference.rest)
    _velocities(reference, data, velocities)


@inlined
def _coefficients(reference: Any, data: Any) -> None:
    """Coefficient at the reference of the segments before and after each knot, and their state.

    VARIES: as in the knot's equation, the coefficient is x_m. UNIT, GONE: the equation was divided by
    the x of an open segment. If both segments are open, the equation is dropped (GONE, GONE); a free end
    has none.
    """
    n = data.n
    c, is_open, ce, state = reference.c, reference.is_open, reference.ce, reference.state
    for i in (0, n):
        ce[i, 0] = ce[i, 1] = 0.0
        state[i, 0] = state[i, 1] = GONE
    for i in range(1, n):
        left, right = is_open[i - 1], is_open[i]
        ce[i, 0], ce[i, 1] = c[i - 1], c[i]
        state[i, 0] = state[i, 1] = VARIES
        if left and right:
            ce[i, 0] = ce[i, 1] = 0.0
            state[i, 0] = state[i, 1] = GONE
        elif left:
            ce[i, 0], ce[i, 1] = 1.0, 0.0
            state[i, 0], state[i, 1] = UNIT, GONE
        elif right:
            ce[i, 0], ce[i, 1] = 0.0, 1.0
            state[i, 0], state[i, 1] = GONE, UNIT


@inlined
def _inverse(ce: Any, data: Any, out: Any) -> None:
    """Approximate inverse of A(c), (n+1, n+1) with zero borders (Gauss-Jordan, diagonally dominant)."""
    n = data.n
    first, last = unknown_knots(data.ends)
    a = np.zeros((n + 1, n + 1))
    for i in range(first, last + 1):
        wl, wr = side_of(i, 0, data.ends)[1], side_of(i, 1, data.ends)[1]
        a[i, i] = wl * ce[i, 0] + wr * ce[i, 1]
        if i > first:
            a[i, i - 1] = 2.0 * ce[i, 0]
        if i < last:
            a[i, i + 1] = 2.0 * ce[i, 1]
        if a[i, i] == 0.0:  # dropped equation: any matrix will do
            a[i, i] = 1.0
    for i in range(n + 1):
        for k in range(n + 1):
            out[i, k] = 0.0
    for i in range(first, last + 1):
        out[i, i] = 1.0
    for p in range(first, last + 1):
        f = 1.0 / a[p, p]
        for k in range(first, last + 1):
            a[p, k] *= f
            out[p, k] *= f
        for i in range(first, last + 1):
            if i != p and a[i, p] != 0.0:
                f = a[i, p]
                for k in range(first, last + 1):
                    a[i, k] -= f * a[p, k]
                    out[i, k] -= f * out[p, k]


@inlined
def _inverse_rest(ce: Any, C: Any, data: Any, out: Any) -> None:
    """Upper bounds of |I - C A(c)|, (n+1, n+1)."""
    first, last = unknown_knots(data.ends)
    for i in range(first, last + 1):
        for e in range(first, last + 1):
            lo, hi = (1.0, 1.0) if i == e else (0.0, 0.0)
            for k in range(max(first, e - 1), min(last, e + 1) + 1):  # - C_ik A_ke
                if k == e:
                    wl, wr = side_of(e, 0, data.ends)[1], side_of(e, 1, data.ends)[1]
                    a_lo = down(down(wl * ce[e, 0]) + down(wr * ce[e, 1]))
                    a_hi = up(up(wl * ce[e, 0]) + up(wr * ce[e, 1]))
                elif k == e + 1:
                    a_lo = a_hi = 2.0 * ce[k, 0]
                else:
                    a_lo = a_hi = 2.0 * ce[k, 1]
                p, q = scale(-C[i, k], a_lo, a_hi)
                lo, hi = add(lo, hi, p, q)
            out[i, e] = max(abs(lo), abs(hi))


@inlined
def _velocities(reference: Any, data: Any, velocities: Any) -> None:
    """Approximate v_c = C b(c), (dof, n+1); at a free end b is the middle of the enclosure."""
    V_lo, V_hi = velocities.lo, velocities.hi
    first, last = unknown_knots(data.ends)
    n, d, ce, C, v = data.n, data.d, reference.ce, reference.C, reference.vc
    for j in range(d.shape[1]):
        for i in range(n + 1):
            v[j, i] = 0.0
        for end in range(0, n + 1, n):
            if first <= end <= last:
                middle = 0.5 * (V_lo[j, end] + V_hi[j, end])
                for i in range(first, last + 1):
                    v[j, i] += C[i, end] * middle
        for m in range(n):
            _wr, pr, _wl, pl = weights(m, data.ends)
            for i in range(first, last + 1):
                if m > 0:
                    v[j, i] += pr * C[i, m] * d[m, j] * ce[m, 1] ** 2
                if m < n - 1:
                    v[j, i] += pl * C[i, m + 1] * d[m, j] * ce[m + 1, 0] ** 2
