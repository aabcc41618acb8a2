"""4-3-...-3-4, what the proof rests on: lower bounds of a Lagrangian over a box (see ``bound``).

Lemma. With multipliers l >= 0 of pieces, total and jumps, and mu (of either sign) of the knot equations,
v = v_c + y:

    f = const + sum_j,i rest_ji y_ji
        + sum_k [ alpha_k x_k + kappa_k x_k^2 + (nu - w1)/x_k - w2/x_k^2 + (x_k - c_k) E_k(y) ],

E_k linear in y. f <= 0 at feasible motions; so if its least value over x in the box and y in its
enclosure is positive, the box holds none. mu = -(l-weighted P) C makes ``rest`` vanish up to rounding,
and the rounding is counted.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled, inlined
from formulations.proofs.arithmetic.outward import (
    add,
    down,
    horner,
    multiply,
    quadratic_least,
    scale,
    up,
)
from formulations.proofs.conditions import (
    JOINT,
    JUMP,
    KIND,
    MULTIPLIER,
    ORDER,
    PART,
    PLACE,
    SCALE,
    SEGMENT,
    SIGN,
    TOTAL,
)
from formulations.proofs.four_three_four.data import GONE, UNIT
from formulations.proofs.four_three_four.ends import piece_type, side_of, unknown_knots
from formulations.proofs.four_three_four.velocities import strays


@compiled
def sum_rows(
    rows: Any, n_rows: int, data: Any, box: Any, reference: Any, velocities: Any, sums: Any
) -> float:
    """Add up the rows of a Lagrangian.

    A lower bound of segment k's share is alpha (x - c) + kappa x^2 + (nu - w1)/x - w2/x^2 for some alpha
    in its interval. A bilinear term F x v is split as F c v + F (x - c) v, and v is replaced by its
    enclosure.

    Parameters
    ----------
    rows : ndarray, shape (at least n_rows, WIDTH)
        Conditions with their multipliers.
    n_rows : int
        Their number.
    data : RateData
        The task.
    box : Box
        Of x.
    reference : Reference
        A point of the box.
    velocities : VelocityEnclosure
        Over the box.
    sums : LagrangianSums
        Its shares are filled.

    Returns
    -------
    float
        Lower bound of the constant.
    """
    shares, n = sums.shares, data.n
    dof = data.d_lo.shape[1]
    for j in range(dof):
        sums.used[j] = False
        for i in range(n + 1):
            sums.weight_lo[j, i] = sums.weight_hi[j, i] = sums.eta[j, i] = 0.0
    for k in range(n):
        for i in range(6):
            shares[k, i] = 0.0
    const = 0.0
    for r in range(n_rows):
        lam = rows[r, MULTIPLIER] / rows[r, SCALE]  # this float is the multiplier
        if not lam > 0.0:
            continue
        if rows[r, KIND] == TOTAL:
            const = down(const - up(lam * data.L))
            for k in range(n):
                shares[k, 3] = down(shares[k, 3] + lam)
        elif rows[r, KIND] == PART:
            part = data.parts[int(rows[r, SEGMENT])]
            const = down(const + down(lam * part[2]))
            for k in range(int(part[0]), int(part[1])):
                shares[k, 4] = up(shares[k, 4] + lam)
        elif rows[r, KIND] == JUMP:
            const = _add_jump(const, rows[r], data, box, sums)
        else:
            const = _add_piece(const, rows[r], data, reference, sums)
    for j in range(dof):
        if sums.used[j]:
            const = _add_knots(const, j, data, box, reference, velocities, sums)
    return const


@inlined
def _add_jump(const: float, row: Any, data: Any, box: Any, sums: Any) -> float:
    """Add a jump across an open segment; returns the new constant."""
    lam = row[MULTIPLIER] / row[SCALE]
    j, k, g = int(row[JOINT]), int(row[SEGMENT]), row[SIGN] * lam
    sums.used[j] = True
    # both addends carry the multiplier g, and a rounded sum could differ between them: one row at most
    if sums.eta[j, k] != 0.0 or sums.eta[j, k + 1] != 0.0:
        return const
    sums.eta[j, k] = g if k > 0 else 0.0
    sums.eta[j, k + 1] = g if k + 1 < data.n else 0.0
    return down(const - up(lam * up(data.limit[2, j] * up(1.0 / box.lo[k]))))


@inlined
def _add_piece(const: float, row: Any, data: Any, reference: Any, sums: Any) -> float:
    """Add a limit inside a piece; returns the new constant."""
    shares, limit = sums.shares, data.limit
    lam = row[MULTIPLIER] / row[SCALE]
    j, k, order = int(row[JOINT]), int(row[SEGMENT]), int(row[ORDER])
    s, g = row[PLACE], row[SIGN] * lam
    terms = data.basis[order, piece_type(k, data.ends)]
    sums.used[j] = True
    first, last = unknown_knots(data.ends)
    lo, hi = horner(terms[0], 5 - order, s)
    lo, hi = multiply(lo, hi, data.d_lo[k, j], data.d_hi[k, j])
    lo, hi = scale(g, lo, hi)
    if order == 0:
        room = data.room_hi[k, j] if g > 0.0 else data.room_lo[k, j]
        lo, hi = down(lo - up(lam * room)), up(hi - down(lam * room))
    shares[k, 0], shares[k, 1] = add(shares[k, 0], shares[k, 1], lo, hi)
    const = down(const + scale(reference.c[k], lo, hi)[0])  # alpha x = alpha c + alpha (x - c)
    for side in range(2):
        i = k + side
        if first <= i <= last:
            lo, hi = horner(terms[1 + side], 5 - order, s)
            lo, hi = scale(g, lo, hi)
            sums.weight_lo[j, i], sums.weight_hi[j, i] = add(
                sums.weight_lo[j, i], sums.weight_hi[j, i], lo, hi
            )
    if order == 1:
        const = down(const - up(lam * limit[0, j]))
    elif order == 2:
        shares[k, 4] = up(shares[k, 4] + up(lam * limit[1, j]))
    elif order == 3:
        shares[k, 5] = up(shares[k, 5] + up(lam * limit[2, j]))
    return const


@inlined
def _choose_mu(j: int, data: Any, reference: Any, sums: Any) -> None:
    """Multipliers of the knot equations of a joint that make the v-terms at c vanish, up to rounding."""
    n, c, state, C = data.n, reference.c, reference.state, reference.C
    extra, mu, etas = sums.extra, sums.mu, sums.eta
    weight_lo, weight_hi = sums.weight_lo, sums.weight_hi
    first, last = unknown_knots(data.ends)
    for i in range(n + 1):
        extra[i] = 0.0
    for i in range(1, n):
        for side in range(2):
            eta = etas[j, i]
            if eta != 0.0 and state[i, side] == GONE and state[i, 1 - side] == UNIT:
                m, w, _, other = side_of(i, side, data.ends)
                extra[i] += w * eta * c[m]
                extra[other] += 2.0 * eta * c[m]
    for e in range(1, n):
        y = 0.0
        for i in range(first, last + 1):
            y -= (0.5 * (weight_lo[j, i] + weight_hi[j, i]) + extra[i]) * C[i, e]
        dropped = state[e, 0] == GONE and state[e, 1] == GONE
        mu[e] = 0.0 if dropped else y


@inlined
def _add_knots(
    const: float, j: int, data: Any, box: Any, reference: Any, velocities: Any, sums: Any
) -> float:
    """Add the knot equations of a joint, and all terms in its velocities; returns the new constant."""
    n, c, state, shares, mu = data.n, reference.c, reference.state, sums.shares, sums.mu
    factor_lo, factor_hi, cross = sums.factor_lo, sums.factor_hi, sums.cross
    d_lo, d_hi, eta, ce = data.d_lo, data.d_hi, sums.eta, reference.ce
    V_lo, V_hi = velocities.lo, velocities.hi
    first, last = unknown_knots(data.ends)
    stray_lo, stray_hi = velocities.stray_lo, velocities.stray_hi
    for m in range(n):
        for side in range(2):
            factor_lo[m, side] = factor_hi[m, side] = cross[m, side] = 0.0
    _choose_mu(j, data, reference, sums)
    strays(j, data, box, state, velocities)
    for e in range(1, n):
        const = down(const + scale(mu[e], stray_lo[e], stray_hi[e])[0])
    rest_lo, rest_hi = sums.weight_lo[j], sums.weight_hi[j]
    for i in range(1, n):
        for side in range(2):
            weight, centre = mu[i], ce[i, side]
            if state[i, side] == GONE:
                if eta[j, i] == 0.0 or state[i, 1 - side] != UNIT:
                    continue
                weight, centre = eta[j, i], c[i - 1 + side]
            m, w, p, other = side_of(i, side, data.ends)
            f_lo, f_hi = scale(weight, w, w)  # factor of x_m v_i (of v_i if UNIT)
            g = 2.0 * weight  # and of v_other
            if state[i, side] != UNIT:
                # - mu p d x^2, and x v = c v + (x - c) v with v in its enclosure
                a_lo, a_hi = scale(weight, down(p * d_lo[m, j]), up(p * d_hi[m, j]))
                shares[m, 2] = down(shares[m, 2] - a_hi)
                factor_lo[m, side], factor_hi[m, side] = f_lo, f_hi
                cross[m, side] = g
            a_lo, a_hi = scale(centre, f_lo, f_hi)
            rest_lo[i], rest_hi[i] = add(rest_lo[i], rest_hi[i], a_lo, a_hi)
            if first <= other <= last:
                a_lo, a_hi = scale(centre, g, g)
                rest_lo[other], rest_hi[other] = add(rest_lo[other], rest_hi[other], a_lo, a_hi)
    _add_bilinear(j, data, box, velocities, sums)
    for i in range(first, last + 1):  # the v-terms at x = c: nearly zero by the choice of mu
        least = multiply(rest_lo[i], rest_hi[i], V_lo[j, i], V_hi[j, i])[0]
        const = down(const + least)
    return const


@inlined
def _add_bilinear(j: int, data: Any, box: Any, velocities: Any, sums: Any) -> None:
    """Add (x_m - c_m) times its v-terms: from the equation of its right knot (its side 0) and of its
    left one (side 1).
    """
    n, shares, V_lo, V_hi = data.n, sums.shares, velocities.lo, velocities.hi
    factor_lo, factor_hi, cross = sums.factor_lo, sums.factor_hi, sums.cross
    first, last = unknown_knots(data.ends)
    for m in range(n):
        left, right = m >= first, m < last
        if box.hi[m] == np.inf:
            continue
        if left:
            a_lo, a_hi = factor_lo[m, 1], factor_hi[m, 1]
            if cross[m, 0] != 0.0:
                a_lo, a_hi = add(a_lo, a_hi, cross[m, 0], cross[m, 0])
            a_lo, a_hi = multiply(a_lo, a_hi, V_lo[j, m], V_hi[j, m])
            shares[m, 0], shares[m, 1] = add(shares[m, 0], shares[m, 1], a_lo, a_hi)
        if right:
            a_lo, a_hi = factor_lo[m, 0], factor_hi[m, 0]
            if cross[m, 1] != 0.0:
                a_lo, a_hi = add(a_lo, a_hi, cross[m, 1], cross[m, 1])
            a_lo, a_hi = multiply(a_lo, a_hi, V_lo[j, m + 1], V_hi[j, m + 1])
            shares[m, 0], shares[m, 1] = add(shares[m, 0], shares[m, 1], a_lo, a_hi)


@compiled
def share_least(share: Any, c: float, lo: float, hi: float) -> float:
    """Lower bound of one segment's share over x in [lo, hi].

    With e = x - c, exactly: 1/x = 1/c - e/c^2 + e^2/(c^2 x) and
    1/x^2 = 1/c^2 - 2e/c^3 + e^2 (2/(c^3 x) + 1/(c^2 x^2)). x in [lo, hi] bounds the last factors, and
    what is left is a quadratic in e.

    Parameters
    ----------
    share : ndarray, shape (6,)
        A row of ``LagrangianSums.shares``.
    c : float
        Any positive number; the x that the share is expanded about.
    lo, hi : float
        Ends of x.

    Returns
    -------
    float
        The bound, rounded down.
    """
    if hi == np.inf:  # open: T = 1/x in [0, 1/lo], nothing else depends on x (d = 0, no position row)
        t = up(1.0 / lo)
        return -up(up(share[4] * t) + up(share[5] * up(t * t)))
    b_lo, b_hi, k2, nu, w1, w2 = share[0], share[1], share[2], share[3], share[4], share[5]
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
