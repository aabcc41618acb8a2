"""3-5-3, what the proof rests on: lower bounds of a separable Lagrangian over a box of (r, q).

With multipliers l >= 0 of the conditions g <= 0 (see ``bound``), f = sum l g splits into
f1(r) + f2(q) + f3(T) + const. f1 and f2 are quadratics plus nu / x, bounded to third order; f3 is
concave, so it is least at an end of T's range. Lemma: where f > 0 there is no feasible motion, whatever
the multipliers, because at a feasible motion every g is at most 0.
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
from formulations.proofs.conditions import (
    FIRST,
    JOINT,
    KIND,
    LAST,
    MULTIPLIER,
    ORDER,
    PLACE,
    SCALE,
    SIGN,
    TOTAL,
)


@compiled
def _separable_least(b_lo: float, b_hi: float, k_lo: float, nu: float, lo: float, hi: float) -> float:
    """Lower bound of b x + k x^2 + nu / x on [lo, hi] > 0, for b in [b_lo, b_hi], k >= k_lo, nu >= 0.

    About c in [lo, hi], with d = x - c: 1/x = 1/c - d/c^2 + d^2/(c^2 x) exactly, so
    nu/x >= nu (1/c - d/c^2 + d^2/(c^2 hi)), and what is left is a quadratic in d.
    """
    c = min(max(0.5 * (lo + hi), lo), hi)
    cc_lo, cc_hi = down(c * c), up(c * c)
    value = down(down(b_lo * c) + (down(k_lo * cc_lo) if k_lo >= 0.0 else down(k_lo * cc_hi)))
    s_lo, s_hi = scale(2.0 * c, k_lo, k_lo)
    s_lo, s_hi = add(s_lo, s_hi, b_lo, b_lo)  # b x >= b_lo x as x > 0: from here b is b_lo
    k = k_lo
    if nu > 0.0:
        value = down(value + down(nu / c))
        s_lo, s_hi = down(s_lo - up(nu / cc_lo)), up(s_hi - down(nu / cc_hi))
        k = down(k + down(nu / up(cc_hi * hi)))
    return down(value + quadratic_least(s_lo, s_hi, k, down(lo - c), up(hi - c)))


@compiled
def middle_range(box: Any, data: Any) -> tuple[float, float]:
    """Range of T = L / (1 + 1/r + 1/q) over a box; T increases in both variables.

    Parameters
    ----------
    box : Box
        Of (r, q).
    data : RatioData
        The task.

    Returns
    -------
    tuple of two floats [s]
        Lower and upper bound.
    """
    most, least = 1.0, 1.0
    for x in range(2):
        if data.has[x]:
            least, most = down(least + down(1.0 / box.hi[x])), up(most + up(1.0 / box.lo[x]))
    return down(data.L / most), up(data.L / least)


@compiled
def excess(rows: Any, n: int, box: Any, data: Any) -> float:
    """Lower bound of f = sum_i l_i g_i over a box; if positive, no feasible motion is in the box.

    Parameters
    ----------
    rows : ndarray, shape (at least n, WIDTH)
        Conditions with their multipliers.
    n : int
        Number of rows.
    box : Box
        Of (r, q).
    data : RatioData
        The task.

    Returns
    -------
    float
        The bound, rounded down.
    """
    d_lo, d_hi, limit, basis = data.d_lo, data.d_hi, data.limit, data.basis
    t_lo, t_hi = middle_range(box, data)
    const, nu = 0.0, 0.0
    c_lo, c_hi = np.zeros((2, 2)), np.zeros((2, 2))  # of r, r^2, q, q^2
    w1, w2, w3 = 0.0, 0.0, 0.0  # f3 = -(w1 T + w2 T^2 + w3 T^3) - nu L / T
    for i in range(n):
        m = rows[i, MULTIPLIER] / rows[i, SCALE]  # this rounded float is the multiplier
        if not m > 0.0:
            continue
        kind = rows[i, KIND]
        if kind in (FIRST, LAST):
            x = 0 if kind == FIRST else 1
            t = data.shortest[2 * x]
            c_lo[x, 0], c_hi[x, 0] = add(c_lo[x, 0], c_hi[x, 0], down(m * t), up(m * t))
            w1 = up(w1 + m)
        elif kind == TOTAL:
            nu = nu + m  # again, the rounded sum is the multiplier
        else:
            j, k = int(rows[i, JOINT]), int(rows[i, ORDER])
            s, g = rows[i, PLACE], rows[i, SIGN] * m
            a, b = horner(basis[k, 0], 6 - k, s)
            a, b = multiply(a, b, d_lo[1, j], d_hi[1, j])
            const = down(const + scale(g, a, b)[0])
            for x in range(2):
                if d_lo[2 * x, j] == 0.0 and d_hi[2 * x, j] == 0.0:
                    continue
                for power in range(2):
                    a, b = horner(basis[k, 1 + 2 * x + power], 6 - k, s)
                    a, b = multiply(a, b, d_lo[2 * x, j], d_hi[2 * x, j])
                    a, b = scale(g, a, b)
                    c_lo[x, power], c_hi[x, power] = add(c_lo[x, power], c_hi[x, power], a, b)
            if k == 0:
                const = down(const - up(m * limit[0 if rows[i, SIGN] > 0.0 else 1, j]))
            elif k == 1:
                w1 = up(w1 + up(m * limit[2, j]))
            elif k == 2:
                w2 = up(w2 + up(m * limit[3, j]))
            else:
                w3 = up(w3 + up(m * limit[4, j]))
    total = down(const + nu)
    for x in range(2):
        if data.has[x]:
            least = _separable_least(c_lo[x, 0], c_hi[x, 0], c_lo[x, 1], nu, box.lo[x], box.hi[x])
            total = down(total + least)
    at_lo = _middle_share(w1, w2, w3, nu, data.L, t_lo)
    return down(total + min(at_lo, _middle_share(w1, w2, w3, nu, data.L, t_hi)))


@compiled
def _middle_share(w1: float, w2: float, w3: float, nu: float, L: float, t: float) -> float:
    """Lower bound of f3 at T = t."""
    return down(-up(up(up(up(up(w3 * t) + w2) * t) + w1) * t) - up(up(nu * L) / t))
