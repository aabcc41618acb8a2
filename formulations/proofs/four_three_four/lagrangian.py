"""4-3-...-3-4, what the proof rests on: a Lagrangian bounded below over a box (see four_three_four).

With multipliers l >= 0 of pieces, total and jumps, and mu (of either sign) of the knot equations, v =
v_c + y:

    f = const + sum_j,i rest_ji y_ji
        + sum_k [ alpha_k x_k + kappa_k x_k^2 + (nu - w1)/x_k - w2/x_k^2 + (x_k - c_k) E_k(y) ],

E_k linear in y. f <= 0 at feasible motions; if its least value over x in the box and y in its enclosure
is positive, the box holds none. mu = -(l-weighted P) C makes rest vanish, but for rounding, which is
counted.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.arithmetic.outward import (
    add,
    down,
    horner,
    multiply,
    quadratic_least,
    scale,
    up,
)
from formulations.proofs.four_three_four.velocities import GONE, UNIT, strays, weights
from formulations.proofs.rows import (
    JOINT,
    JUMP,
    KIND,
    MULTIPLIER,
    ORDER,
    PLACE,
    SCALE,
    SEGMENT,
    SIGN,
    TOTAL,
)


def _basis() -> Any:
    """What multiplies d, T v0, T v1 in a piece's position from its start, and its derivatives in s.

    (4, 3, 3, 5): order, piece (first quartic, cubic, last quartic), term, power of s. All integers.
    """
    basis = np.zeros((4, 3, 3, 5))
    basis[0] = [
        [[0, 0, 0, 4, -3], [0, 0, 0, 0, 0], [0, 0, 0, -1, 1]],
        [[0, 0, 3, -2, 0], [0, 1, -2, 1, 0], [0, 0, -1, 1, 0]],
        [[0, 0, 6, -8, 3], [0, 1, -3, 3, -1], [0, 0, 0, 0, 0]],
    ]
    for order in range(1, 4):
        basis[order, ..., :4] = basis[order - 1, ..., 1:] * np.arange(1, 5)
    return basis


BASIS = _basis()


@compiled
def piece_type(m: int, n: int) -> int:
    """0: first quartic, 1: cubic, 2: last quartic."""
    return 0 if m == 0 else (2 if m == n - 1 else 1)


@compiled
def lagrangian(
    rows: Any, n_rows: int, data: Any, n: int, L: float, lo_x: Any, hi_x: Any,
    c: Any, ce: Any, state: Any, C: Any, V_lo: Any, V_hi: Any, form: Any,
) -> float:  # fmt: skip
    """Coefficients of the Lagrangian: returns its constant (a lower bound), fills form (n, 6).

    form[k] = alpha_lo, alpha_hi, kappa_lo, nu, w1, w2: a lower bound of segment k's share is
    alpha (x - c) + kappa x^2 + (nu - w1)/x - w2/x^2 for some alpha in its interval.  A bilinear term
    F x v is split as F c v + F (x - c) v, and v replaced by its enclosure.
    """
    d_lo, d_hi, limit, room_lo, room_hi, basis = data
    dof = d_lo.shape[1]
    weight_lo, weight_hi = np.zeros((dof, n + 1)), np.zeros((dof, n + 1))  # of v
    used = np.zeros(dof, np.bool_)
    eta = np.zeros((dof, n + 1))  # multipliers of the shares S_i of segments beside an open one
    extra = np.zeros(n + 1)
    for k in range(n):
        for i in range(6):
            form[k, i] = 0.0
    const = 0.0
    for r in range(n_rows):
        lam = rows[r, MULTIPLIER] / rows[r, SCALE]  # this float is the multiplier
        if not lam > 0.0:
            continue
        if rows[r, KIND] == TOTAL:
            const = down(const - up(lam * L))
            for k in range(n):
                form[k, 3] = down(form[k, 3] + lam)
            continue
        j, k, order = int(rows[r, JOINT]), int(rows[r, SEGMENT]), int(rows[r, ORDER])
        s, g = rows[r, PLACE], rows[r, SIGN] * lam
        kind = piece_type(k, n)
        used[j] = True
        if rows[r, KIND] == JUMP:
            # both addends carry the multiplier g; the rounded sum must not differ between them: one row
            # at most
            if eta[j, k] != 0.0 or eta[j, k + 1] != 0.0:
                continue
            eta[j, k] = g if k > 0 else 0.0
            eta[j, k + 1] = g if k + 1 < n else 0.0
            const = down(const - up(lam * up(limit[2, j] * up(1.0 / lo_x[k]))))
            continue
        lo, hi = horner(basis[order, kind, 0], 5 - order, s)
        lo, hi = multiply(lo, hi, d_lo[k, j], d_hi[k, j])
        lo, hi = scale(g, lo, hi)
        if order == 0:
            room = room_hi[k, j] if g > 0.0 else room_lo[k, j]
            lo, hi = down(lo - up(lam * room)), up(hi - down(lam * room))
        form[k, 0], form[k, 1] = add(form[k, 0], form[k, 1], lo, hi)
        const = down(const + scale(c[k], lo, hi)[0])  # alpha x = alpha c + alpha (x - c)
        for side in range(2):
            if 0 < k + side < n:
                lo, hi = horner(basis[order, kind, 1 + side], 5 - order, s)
                lo, hi = scale(g, lo, hi)
                weight_lo[j, k + side], weight_hi[j, k + side] = add(
                    weight_lo[j, k + side], weight_hi[j, k + side], lo, hi
                )
        if order == 1:
            const = down(const - up(lam * limit[0, j]))
        elif order == 2:
            form[k, 4] = up(form[k, 4] + up(lam * limit[1, j]))
        elif order == 3:
            form[k, 5] = up(form[k, 5] + up(lam * limit[2, j]))
    mu = np.zeros(n + 1)
    xi_lo, xi_hi = np.zeros(n + 1), np.zeros(n + 1)
    factor_lo, factor_hi, cross = np.zeros((n, 2)), np.zeros((n, 2)), np.zeros((n, 2))
    for j in range(dof):
        if not used[j]:
            continue
        for i in range(n + 1):
            extra[i] = 0.0
        for i in range(1, n):
            for side in range(2):
                if eta[j, i] != 0.0 and state[i, side] == GONE and state[i, 1 - side] == UNIT:
                    m = i - 1 + side
                    wr, pr, wl, pl = weights(m, n)
                    extra[i] += (wl if side == 0 else wr) * eta[j, i] * c[m]
                    extra[i - 1 if side == 0 else i + 1] += 2.0 * eta[j, i] * c[m]
        for m in range(n):
            for side in range(2):
                factor_lo[m, side] = factor_hi[m, side] = cross[m, side] = 0.0
        for e in range(1, n):
            y = 0.0
            for i in range(1, n):
                y -= (0.5 * (weight_lo[j, i] + weight_hi[j, i]) + extra[i]) * C[i, e]
            mu[e] = y if state[e, 0] != GONE or state[e, 1] != GONE else 0.0  # dropped rows
        strays(j, d_lo, d_hi, lo_x, hi_x, state, n, V_lo, V_hi, xi_lo, xi_hi)
        for e in range(1, n):
            const = down(const + scale(mu[e], xi_lo[e], xi_hi[e])[0])
        rest_lo, rest_hi = weight_lo[j], weight_hi[j]
        for i in range(1, n):
            for side in range(2):
                weight, centre = mu[i], ce[i, side]
                if state[i, side] == GONE:
                    if eta[j, i] == 0.0 or state[i, 1 - side] != UNIT:
                        continue
                    weight, centre = eta[j, i], c[i - 1 + side]
                m = i - 1 + side
                wr, pr, wl, pl = weights(m, n)
                w, p = (wl, pl) if side == 0 else (wr, pr)
                other = i - 1 if side == 0 else i + 1
                f_lo, f_hi = scale(weight, w, w)  # factor of x_m v_i (of v_i if UNIT)
                g = 2.0 * weight  # and of v_other
                if state[i, side] != UNIT:
                    # - mu p d x^2, and x v = c v + (x - c) v with v in its enclosure
                    a_lo, a_hi = scale(weight, down(p * d_lo[m, j]), up(p * d_hi[m, j]))
                    form[m, 2] = down(form[m, 2] - a_hi)
                    factor_lo[m, side], factor_hi[m, side] = f_lo, f_hi
                    cross[m, side] = g
                a_lo, a_hi = scale(centre, f_lo, f_hi)
                rest_lo[i], rest_hi[i] = add(rest_lo[i], rest_hi[i], a_lo, a_hi)
                if 0 < other < n:
                    a_lo, a_hi = scale(centre, g, g)
                    rest_lo[other], rest_hi[other] = add(rest_lo[other], rest_hi[other], a_lo, a_hi)
        # (x_m - c_m) times its v-terms: from the row of its right knot (its side 0) and of its left
        # (side 1)
        for m in range(n):
            left, right = m > 0, m < n - 1
            if hi_x[m] == np.inf:
                continue
            if m > 0:
                a_lo, a_hi = (factor_lo[m, 1], factor_hi[m, 1]) if left else (0.0, 0.0)
                if right:
                    a_lo, a_hi = add(a_lo, a_hi, cross[m, 0], cross[m, 0])
                a_lo, a_hi = multiply(a_lo, a_hi, V_lo[j, m], V_hi[j, m])
                form[m, 0], form[m, 1] = add(form[m, 0], form[m, 1], a_lo, a_hi)
            if m < n - 1:
                a_lo, a_hi = (factor_lo[m, 0], factor_hi[m, 0]) if right else (0.0, 0.0)
                if left:
                    a_lo, a_hi = add(a_lo, a_hi, cross[m, 1], cross[m, 1])
                a_lo, a_hi = multiply(a_lo, a_hi, V_lo[j, m + 1], V_hi[j, m + 1])
                form[m, 0], form[m, 1] = add(form[m, 0], form[m, 1], a_lo, a_hi)
        for i in range(1, n):  # the v-terms at x = c: nearly zero by the choice of mu
            lo, hi = multiply(rest_lo[i], rest_hi[i], V_lo[j, i], V_hi[j, i])
            const = down(const + lo)
    return const


@compiled
def share_least(form: Any, k: int, c: Any, lo: Any, hi: Any) -> float:
    """Lower bound of segment k's share over x in [lo, hi] (any c > 0).

    With e = x - c:  1/x = 1/c - e/c^2 + e^2/(c^2 x),  1/x^2 = 1/c^2 - 2e/c^3 + e^2 (2/(c^3 x) + 1/(c^2
    x^2)), exactly; x in [lo, hi] bounds the last factors, and what is left is a quadratic in e.
    """
    if hi == np.inf:  # open: T = 1/x in [0, 1/lo], nothing else depends on x (d = 0, no position row)
        t = up(1.0 / lo)
        return -up(up(form[k, 4] * t) + up(form[k, 5] * up(t * t)))
    b_lo, b_hi, k2, nu, w1, w2 = form[k, 0], form[k, 1], form[k, 2], form[k, 3], form[k, 4], form[k, 5]
    cc_lo, cc_hi = down(c * c), up(c * c)
    v = down(k2 * cc_lo) if k2 >= 0.0 else down(k2 * cc_hi)
    p, q = scale(2.0 * c, k2, k2)
    b_lo, b_hi = add(b_lo, b_hi, p, q)
    if nu > 0.0:
        v = down(v + down(nu / c))
        b_lo, b_hi = down(b_lo - up(nu / cc_lo)), up(b_hi - down(nu / cc_hi))
        k2 = down(k2 + down(nu / up(cc_hi * hi)))
    if w1 > 0.0:
        v = down(v - up(w1 / c))
        b_lo, b_hi = down(b_lo + down(w1 / cc_hi)), up(b_hi + up(w1 / cc_lo))
        k2 = down(k2 - up(w1 / down(cc_lo * lo)))
    if w2 > 0.0:
        ccc_lo, ccc_hi = down(cc_lo * c), up(cc_hi * c)
        v = down(v - up(w2 / cc_lo))
        b_lo, b_hi = down(b_lo + down(2.0 * w2 / ccc_hi)), up(b_hi + up(2.0 * w2 / ccc_lo))
        k2 = down(k2 - up(w2 * up(up(2.0 / down(ccc_lo * lo)) + up(1.0 / down(cc_lo * down(lo * lo))))))
    return down(v + quadratic_least(b_lo, b_hi, k2, down(lo - c), up(hi - c)))
