"""4-3-...-3-4: enclosure of the velocities at the inner waypoints over a box of x (see ``bound``).

Lemma. For any matrix C, any v_c and any c in the box, A(x) v = b(x) gives

    v - v_c = C [ (b(x) - b(c)) - (A(x) - A(c)) v + b(c) - A(c) v_c ] + (I - C A(c)) (v - v_c)

and (b(x) - b(c)) - (A(x) - A(c)) v = sum_m (x_m - c_m) (slopes linear in x_m and v). So a sweep maps an
enclosure of v (at first |v| <= V) to a narrower one. The enclosure need hold for feasible motions only,
so cutting it by the limits is sound.

An open segment m (nothing moves on it, x_m has no upper end): the equations of its knots are divided by
x_m. They then hold its v-terms with coefficient 1 (UNIT), and the share of the other neighbour becomes a
stray interval of size O(T_m) (GONE).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled, inlined
from formulations.proofs.arithmetic.outward import add, down, multiply, scale, up
from formulations.proofs.four_three_four.data import GONE, UNIT, VARIES
from formulations.proofs.four_three_four.ends import side_of, unknown_knots, weights


@compiled
def strays(j: int, data: Any, box: Any, state: Any, velocities: Any) -> None:
    """Enclose what the divided equations of a joint hold beside their UNIT terms; 0 for the others.

    T_open x_m (w v_i + 2 v_other - p d_m x_m), with T_open in [0, 1 / lo_open].

    Parameters
    ----------
    j : int
        The joint.
    data : RateData
        The task.
    box : Box
        Of x.
    state : ndarray, shape (n+1, 2)
        Of the reference.
    velocities : VelocityEnclosure
        Its strays are filled.
    """
    n, lo, hi, d_lo, d_hi = data.n, box.lo, box.hi, data.d_lo, data.d_hi
    V_lo, V_hi = velocities.lo, velocities.hi
    stray_lo, stray_hi = velocities.stray_lo, velocities.stray_hi
    for i in range(1, n):
        stray_lo[i] = stray_hi[i] = 0.0
        for side in range(2):
            if state[i, side] != GONE or state[i, 1 - side] != UNIT:
                continue
            m, w, p, other = side_of(i, side, data.ends)
            opened = i - side
            a_lo, a_hi = scale(w, V_lo[j, i], V_hi[j, i])
            a_lo, a_hi = add(a_lo, a_hi, 2.0 * V_lo[j, other], 2.0 * V_hi[j, other])
            b_lo, b_hi = multiply(lo[m], hi[m], d_lo[m, j], d_hi[m, j])
            b_lo, b_hi = scale(-p, b_lo, b_hi)
            a_lo, a_hi = add(a_lo, a_hi, b_lo, b_hi)
            a_lo, a_hi = multiply(a_lo, a_hi, lo[m], hi[m])
            stray_lo[i], stray_hi[i] = multiply(a_lo, a_hi, 0.0, up(1.0 / lo[opened]))


@inlined
def _residuals(j: int, data: Any, reference: Any, velocities: Any, y_lo: Any, y_hi: Any) -> None:
    """Add C (b(c) - A(c) v_c - strays) to y, and the strays to the remainder."""
    n, C, vc, ce = data.n, reference.C, reference.vc, reference.ce
    stray_lo, stray_hi, R = velocities.stray_lo, velocities.stray_hi, velocities.remainder
    d_lo, d_hi = data.d_lo, data.d_hi
    first, last = unknown_knots(data.ends)
    for e in range(1, n):
        p, q = -stray_hi[e], -stray_lo[e]
        if stray_hi[e] > stray_lo[e]:
            for i in range(first, last + 1):
                R[j, i] += abs(C[i, e]) * max(abs(p), abs(q))
        for side in range(2):
            m, w, f, at = side_of(e, side, data.ends)
            other = vc[j, at]
            s_lo, s_hi = multiply(down(f * d_lo[m, j]), up(f * d_hi[m, j]), ce[e, side], ce[e, side])
            t = w * vc[j, e]
            e_lo, e_hi = add(down(t), up(t), 2.0 * other, 2.0 * other)
            s_lo, s_hi = add(s_lo, s_hi, -e_hi, -e_lo)
            s_lo, s_hi = scale(ce[e, side], s_lo, s_hi)
            p, q = add(p, q, s_lo, s_hi)
        for i in range(first, last + 1):
            s_lo, s_hi = scale(C[i, e], p, q)
            y_lo[i], y_hi[i] = add(y_lo[i], y_hi[i], s_lo, s_hi)


@inlined
def _slopes(j: int, data: Any, box: Any, reference: Any, velocities: Any, y_lo: Any, y_hi: Any) -> None:
    """Add C times the sum of (x_m - c_m) slopes to y; fill the floating-point slopes and remainders."""
    n, lo, hi, d, d_lo, d_hi = data.n, box.lo, box.hi, data.d, data.d_lo, data.d_hi
    c, C, vc, state = reference.c, reference.C, reference.vc, reference.state
    V_lo, V_hi, G, R = velocities.lo, velocities.hi, velocities.slopes, velocities.remainder
    first, last = unknown_knots(data.ends)
    for m in range(n):
        if hi[m] == np.inf:  # open: constant coefficients
            for i in range(first, last + 1):
                G[j, i, m] = 0.0
            continue
        wr, pr, wl, pl = weights(m, data.ends)
        e_lo, e_hi = down(lo[m] - c[m]), up(hi[m] - c[m])
        half = max(-e_lo, e_hi)
        x_lo, x_hi = down(c[m] + lo[m]), up(c[m] + hi[m])
        x_lo, x_hi = multiply(x_lo, x_hi, d_lo[m, j], d_hi[m, j])
        a_lo = a_hi = b_lo = b_hi = a = b = 0.0
        if m > 0 and state[m, 1] == VARIES:
            a_lo = down(down(pr * x_lo) - up(up(wr * V_hi[j, m]) + 2.0 * V_hi[j, m + 1]))
            a_hi = up(up(pr * x_hi) - down(down(wr * V_lo[j, m]) + 2.0 * V_lo[j, m + 1]))
            a = 2.0 * pr * d[m, j] * c[m] - (wr * vc[j, m] + 2.0 * vc[j, m + 1])
        if m < n - 1 and state[m + 1, 0] == VARIES:
            b_lo = down(down(pl * x_lo) - up(2.0 * V_hi[j, m] + up(wl * V_hi[j, m + 1])))
            b_hi = up(up(pl * x_hi) - down(2.0 * V_lo[j, m] + down(wl * V_lo[j, m + 1])))
            b = 2.0 * pl * d[m, j] * c[m] - (2.0 * vc[j, m] + wl * vc[j, m + 1])
        for i in range(first, last + 1):
            p_lo, p_hi = scale(C[i, m], a_lo, a_hi)
            q_lo, q_hi = scale(C[i, m + 1], b_lo, b_hi)
            s_lo, s_hi = add(p_lo, p_hi, q_lo, q_hi)
            g = C[i, m] * a + C[i, m + 1] * b
            G[j, i, m] = g
            R[j, i] += half * max(abs(s_lo - g), abs(s_hi - g))
            s_lo, s_hi = multiply(s_lo, s_hi, e_lo, e_hi)
            y_lo[i], y_hi[i] = add(y_lo[i], y_hi[i], s_lo, s_hi)


@compiled
def enclose(j: int, data: Any, box: Any, reference: Any, velocities: Any) -> bool:
    """Narrow the enclosures of one joint's velocities by one sweep.

    Parameters
    ----------
    j : int
        The joint.
    data : RateData
        The task.
    box : Box
        Of x.
    reference : Reference
        A point of the box.
    velocities : VelocityEnclosure
        Is narrowed; its slopes and remainders are filled.

    Returns
    -------
    bool
        False if no velocity is left: the box holds no feasible motion.
    """
    vc, rest, R = reference.vc, reference.rest, velocities.remainder
    V_lo, V_hi = velocities.lo, velocities.hi
    first, last = unknown_knots(data.ends)
    y_lo, y_hi = np.zeros(data.n + 1), np.zeros(data.n + 1)
    for i in range(first, last + 1):
        s = 0.0  # (I - C A(c)) (v - v_c)
        for e in range(first, last + 1):
            y = max(abs(up(V_hi[j, e] - vc[j, e])), abs(down(V_lo[j, e] - vc[j, e])))
            s = up(s + up(rest[i, e] * y))
        y_lo[i], y_hi[i] = -s, s
        R[j, i] = 0.0
    strays(j, data, box, reference.state, velocities)
    _residuals(j, data, reference, velocities, y_lo, y_hi)
    _slopes(j, data, box, reference, velocities, y_lo, y_hi)
    for i in range(first, last + 1):
        least = max(V_lo[j, i], down(vc[j, i] + y_lo[i]))
        most = min(V_hi[j, i], up(vc[j, i] + y_hi[i]))
        if not least <= most:
            if least > most + 1e-12 * abs(most):
                return False
            # empty, but by so little that a checker might not see it: any interval encloses nothing
            least, most = most, least
        V_lo[j, i], V_hi[j, i] = least, most
    return True
