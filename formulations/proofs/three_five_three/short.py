"""3-5-3 with a middle segment on which nothing moves: the proof for T2 in [0, tau].

Derivative k >= 1 of the middle piece times T2^(k-1) is, with r = T2/T1 and q = T2/T3,

    d1/T1 (B(s) + C(s) r) + d3/T3 (E(s) + F(s) q),   r in [0, tau/T1], q in [0, tau/T3],

and must not exceed limit T2^(k-1) <= limit tau^(k-1). Both sides stay finite as T2 -> 0. The search
branches on T1 alone, because T3 = L - T1 - T2 follows to within tau. An end segment on which nothing
moves is dropped. Each interval of T1 is discarded by one such derivative, or because T3 would be too
short.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.arithmetic.outward import add, down, horner, multiply, up


@compiled
def short_middle(data: Any, tau: float, leaves: Any) -> int:
    """Prove that no motion has T2 <= tau and total time L.

    Parameters
    ----------
    data : RatioData
        The task.
    tau : float [s]
        Upper end of T2.
    leaves : ndarray, shape (m, 6)
        Is filled with the discards, from the longest T1 down: the interval of T1 (two numbers), joint,
        order (0: T3 is too short), place, sign.

    Returns
    -------
    int
        Number of discards; -1 if m do not suffice, or if an interval stays undecided.
    """
    d, d_lo, d_hi, limit, basis = data.d, data.d_lo, data.d_hi, data.limit, data.basis
    has, shortest, L = data.has, data.shortest, data.L
    dof = d.shape[1]
    stack = np.empty((200, 2))  # T1
    # where only one end moves, the other may take no time, and a single number is left
    stack[0, 0] = 0.0 if not has[0] else (shortest[0] if has[1] else down(L - tau))
    stack[0, 1] = 0.0 if not has[0] else up(L - shortest[2])
    depth, count, boxes = 1, 0, 0
    while depth > 0:
        depth -= 1
        lo, hi = stack[depth, 0], stack[depth, 1]
        boxes += 1
        if boxes > 4 * len(leaves) or count >= len(leaves):
            return -1
        t_lo = max(shortest[2], down(down(L - tau) - hi))
        t_hi = up(L - lo)
        leaf = leaves[count]
        leaf[0], leaf[1], leaf[3] = lo, hi, 0.0
        if t_hi < shortest[2]:
            count += 1
            continue
        x_lo = down(1.0 / hi) if has[0] else 0.0
        x_hi = up(1.0 / lo) if has[0] else 0.0
        z_lo = down(1.0 / t_hi) if has[1] else 0.0
        z_hi = up(1.0 / t_lo) if has[1] else 0.0
        x, z = 0.5 * (x_lo + x_hi), 0.5 * (z_lo + z_hi)
        gone = False
        for j in range(dof):
            for k in range(1, 4):
                if limit[k + 1, j] == np.inf or gone:
                    continue
                best, worst = 0.0, 0.0
                for level in range(3):
                    step = 0.02 * 0.02**level
                    middle = best
                    for i in range(51) if level == 0 else range(-50, 51):
                        s = i * step if level == 0 else min(1.0, max(0.0, middle + i * step))
                        b = e = 0.0
                        for p in range(5 - k, -1, -1):
                            b = b * s + basis[k, 1, p]
                            e = e * s + basis[k, 3, p]
                        y = d[0, j] * x * b + d[2, j] * z * e
                        if abs(y) > abs(worst):
                            best, worst = s, y
                g = 1.0 if worst >= 0.0 else -1.0
                total_lo = 0.0
                for seg in range(2):
                    if not has[seg]:
                        continue
                    u_lo, u_hi = (x_lo, x_hi) if seg == 0 else (z_lo, z_hi)
                    b_lo, b_hi = horner(basis[k, 1 + 2 * seg], 6 - k, best)
                    c_lo, c_hi = horner(basis[k, 2 + 2 * seg], 6 - k, best)
                    c_lo, c_hi = multiply(c_lo, c_hi, 0.0, up(tau * u_hi))
                    b_lo, b_hi = add(b_lo, b_hi, c_lo, c_hi)
                    b_lo, b_hi = multiply(b_lo, b_hi, d_lo[2 * seg, j], d_hi[2 * seg, j])
                    b_lo, b_hi = multiply(b_lo, b_hi, u_lo, u_hi)
                    total_lo = down(total_lo + (b_lo if g > 0.0 else -b_hi))
                most = limit[k + 1, j]
                for _ in range(k - 1):
                    most = up(most * tau)
                if down(total_lo - most) > 0.0:
                    gone = True
                    leaf[2], leaf[3], leaf[4], leaf[5] = j, k, best, g
        if gone:
            count += 1
            continue
        if hi - lo < 1e-13 * L or depth > 196:
            return -1
        middle = 0.5 * (lo + hi)
        stack[depth, 0], stack[depth, 1] = lo, middle
        stack[depth + 1, 0], stack[depth + 1, 1] = middle, hi
        depth += 2
    return count
