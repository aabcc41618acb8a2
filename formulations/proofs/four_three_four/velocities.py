"""4-3-...-3-4: enclosure of the velocities at the inner waypoints over a box of x (see
four_three_four).

For any matrix C, reference v_c and c in the box, from A(x) v = b(x):

    v - v_c = C [ (b(x) - b(c)) - (A(x) - A(c)) v + b(c) - A(c) v_c ] + (I - C A(c)) (v - v_c)

and (b(x) - b(c)) - (A(x) - A(c)) v = sum_m (x_m - c_m) (slopes linear in x_m and v), so a sweep maps an
enclosure of v (to begin with |v| <= V) to a narrower one. It need hold for feasible motions only, so
cutting it by the limits is sound: nothing here is a mean-value form.

An open segment (nothing moves on it, x_m without upper end): the rows of its knots are divided by x_m
and hold its v-terms (UNIT) beside a stray interval for the neighbour's share (GONE), O(T_m).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.arithmetic.outward import add, down, multiply, scale, up

VARIES, UNIT, GONE = 0, 1, 2


@compiled
def weights(m: int, n: int) -> tuple[float, float, float, float]:
    """Of segment m in the row of its left knot (wr, pr) and of its right knot (wl, pl): 4 and 6, but
    for the quartic end pieces 6 and 12.
    """
    wr, pr = (6.0, 12.0) if m == n - 1 else (4.0, 6.0)
    wl, pl = (6.0, 12.0) if m == 0 else (4.0, 6.0)
    return wr, pr, wl, pl


@compiled
def centres(c: Any, is_open: Any, n: int, ce: Any, state: Any) -> None:
    """Coefficient at the centre, ce (n+1, 2), of the segments before and after each knot, and their
    state.

    VARIES: as in the knot's equation, the coefficient is x_m. UNIT, GONE: see above. Both segments
    open: the row is dropped (GONE, GONE).
    """
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


@compiled
def strays(
    j: int,
    d_lo: Any,
    d_hi: Any,
    lo: Any,
    hi: Any,
    state: Any,
    n: int,
    V_lo: Any,
    V_hi: Any,
    xi_lo: Any,
    xi_hi: Any,
) -> None:
    """What joint j's divided rows hold beside their UNIT terms, (n+1,); 0 for ordinary rows.

    xi = T_open x_m (w v_i + 2 v_other - p d_m x_m), T_open in [0, 1 / lo_open].
    """
    for i in range(1, n):
        xi_lo[i] = xi_hi[i] = 0.0
        for side in range(2):
            if state[i, side] != GONE or state[i, 1 - side] != UNIT:
                continue
            m, opened = i - 1 + side, i - side
            wr, pr, wl, pl = weights(m, n)
            w, p = (wl, pl) if side == 0 else (wr, pr)
            other = i - 1 if side == 0 else i + 1
            a_lo, a_hi = scale(w, V_lo[j, i], V_hi[j, i])
            a_lo, a_hi = add(a_lo, a_hi, 2.0 * V_lo[j, other], 2.0 * V_hi[j, other])
            b_lo, b_hi = multiply(lo[m], hi[m], d_lo[m, j], d_hi[m, j])
            b_lo, b_hi = scale(-p, b_lo, b_hi)
            a_lo, a_hi = add(a_lo, a_hi, b_lo, b_hi)
            a_lo, a_hi = multiply(a_lo, a_hi, lo[m], hi[m])
            xi_lo[i], xi_hi[i] = multiply(a_lo, a_hi, 0.0, up(1.0 / lo[opened]))


@compiled
def inverse(ce: Any, n: int, out: Any) -> None:
    """Approximate inverse of A(c), (n+1, n+1) with zero borders (Gauss-Jordan, diagonally dominant)."""
    a = np.zeros((n + 1, n + 1))
    for i in range(1, n):
        wl = 6.0 if i == 1 else 4.0
        wr = 6.0 if i == n - 1 else 4.0
        a[i, i] = wl * ce[i, 0] + wr * ce[i, 1]
        if i > 1:
            a[i, i - 1] = 2.0 * ce[i, 0]
        if i < n - 1:
            a[i, i + 1] = 2.0 * ce[i, 1]
        if a[i, i] == 0.0:  # dropped row: any matrix will do
            a[i, i] = 1.0
    for i in range(n + 1):
        for k in range(n + 1):
            out[i, k] = 0.0
    for i in range(1, n):
        out[i, i] = 1.0
    for p in range(1, n):
        f = 1.0 / a[p, p]
        for k in range(1, n):
            a[p, k] *= f
            out[p, k] *= f
        for i in range(1, n):
            if i != p and a[i, p] != 0.0:
                f = a[i, p]
                for k in range(1, n):
                    a[i, k] -= f * a[p, k]
                    out[i, k] -= f * out[p, k]


@compiled
def inverse_rest(ce: Any, C: Any, n: int, out: Any) -> None:
    """Upper bounds of |I - C A(c)|, (n+1, n+1)."""
    for i in range(1, n):
        for e in range(1, n):
            lo, hi = (1.0, 1.0) if i == e else (0.0, 0.0)
            for k in range(max(1, e - 1), min(n - 1, e + 1) + 1):  # - C_ik A_kl
                if k == e:
                    wl = 6.0 if e == 1 else 4.0
                    wr = 6.0 if e == n - 1 else 4.0
                    a_lo = down(down(wl * ce[e, 0]) + down(wr * ce[e, 1]))
                    a_hi = up(up(wl * ce[e, 0]) + up(wr * ce[e, 1]))
                elif k == e + 1:
                    a_lo = a_hi = 2.0 * ce[k, 0]
                else:
                    a_lo = a_hi = 2.0 * ce[k, 1]
                p, q = scale(-C[i, k], a_lo, a_hi)
                lo, hi = add(lo, hi, p, q)
            out[i, e] = max(abs(lo), abs(hi))


@compiled
def velocities(d: Any, ce: Any, C: Any, n: int, v: Any) -> None:
    """Approximate v_c = C b(c), (dof, n+1)."""
    for j in range(d.shape[1]):
        for i in range(n + 1):
            v[j, i] = 0.0
        for m in range(n):
            _wr, pr, _wl, pl = weights(m, n)
            for i in range(1, n):
                if m > 0:
                    v[j, i] += pr * C[i, m] * d[m, j] * ce[m, 1] ** 2
                if m < n - 1:
                    v[j, i] += pl * C[i, m + 1] * d[m, j] * ce[m + 1, 0] ** 2


@compiled
def enclose(
    j: int, d: Any, d_lo: Any, d_hi: Any, lo: Any, hi: Any, c: Any, ce: Any, state: Any,
    C: Any, rest: Any, vc: Any, n: int, V_lo: Any, V_hi: Any, G: Any, R: Any, xi_lo: Any, xi_hi: Any,
) -> bool:  # fmt: skip
    """One sweep for joint j: narrows V_lo, V_hi (dof, n+1); returns False if nothing is left.

    Also the floating-point slopes G (dof, n+1, n) of v at c and the second-order remainders R (dof,
    n+1) that feed the linear program (no proof rests on these two).
    """
    y_lo, y_hi = np.zeros(n + 1), np.zeros(n + 1)
    for i in range(1, n):
        s = 0.0  # (I - C A(c)) (v - v_c)
        for e in range(1, n):
            y = max(abs(up(V_hi[j, e] - vc[j, e])), abs(down(V_lo[j, e] - vc[j, e])))
            s = up(s + up(rest[i, e] * y))
        y_lo[i], y_hi[i] = -s, s
        R[j, i] = 0.0
    strays(j, d_lo, d_hi, lo, hi, state, n, V_lo, V_hi, xi_lo, xi_hi)
    # residuals b(c) - A(c) v_c - xi
    for e in range(1, n):
        p, q = -xi_hi[e], -xi_lo[e]
        if xi_hi[e] > xi_lo[e]:
            for i in range(1, n):
                R[j, i] += abs(C[i, e]) * max(abs(p), abs(q))
        for side in range(2):
            m = e - 1 + side
            wr, pr, wl, pl = weights(m, n)
            w, f = (wl, pl) if side == 0 else (wr, pr)
            other = vc[j, e - 1] if side == 0 else vc[j, e + 1]
            s_lo, s_hi = multiply(down(f * d_lo[m, j]), up(f * d_hi[m, j]), ce[e, side], ce[e, side])
            t = w * vc[j, e]
            e_lo, e_hi = add(down(t), up(t), 2.0 * other, 2.0 * other)
            s_lo, s_hi = add(s_lo, s_hi, -e_hi, -e_lo)
            s_lo, s_hi = scale(ce[e, side], s_lo, s_hi)
            p, q = add(p, q, s_lo, s_hi)
        for i in range(1, n):
            s_lo, s_hi = scale(C[i, e], p, q)
            y_lo[i], y_hi[i] = add(y_lo[i], y_hi[i], s_lo, s_hi)
    for m in range(n):
        if hi[m] == np.inf:  # open: constant coefficients
            for i in range(1, n):
                G[j, i, m] = 0.0
            continue
        wr, pr, wl, pl = weights(m, n)
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
        for i in range(1, n):
            p_lo, p_hi = scale(C[i, m], a_lo, a_hi)
            q_lo, q_hi = scale(C[i, m + 1], b_lo, b_hi)
            s_lo, s_hi = add(p_lo, p_hi, q_lo, q_hi)
            g = C[i, m] * a + C[i, m + 1] * b
            G[j, i, m] = g
            R[j, i] += half * max(abs(s_lo - g), abs(s_hi - g))
            s_lo, s_hi = multiply(s_lo, s_hi, e_lo, e_hi)
            y_lo[i], y_hi[i] = add(y_lo[i], y_hi[i], s_lo, s_hi)
    for i in range(1, n):
        least = max(V_lo[j, i], down(vc[j, i] + y_lo[i]))
        most = min(V_hi[j, i], up(vc[j, i] + y_hi[i]))
        if not least <= most:
            if least > most + 1e-12 * abs(most):
                return False
            # empty, but by so little that a checker might not see it: any interval encloses nothing
            least, most = most, least
        V_lo[j, i], V_hi[j, i] = least, most
    return True
