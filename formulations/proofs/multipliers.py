"""Multipliers for a discard, from a linear program of a few rows and columns.

To first order about the centre of a box, the conditions are a_i + g_i . e <= 0 with e in [-1, 1]^n. The
multipliers worth trying make the least value of their weighted sum over e as large as possible. The
proof does not depend on this: the Lagrangian, rounded outward, judges whatever multipliers come out.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled


@compiled
def minimax(a: Any, g: Any, m: int, n: int, lam: Any, iterations: int) -> float:
    """Solve  max_l sum l_i a_i - sum_k |sum_i l_i g_ik|,  l >= 0, sum l = 1,  by the primal simplex method.

    This is the dual of  min over e in [-1, 1]^n of max_i a_i + g_i . e.

    Parameters
    ----------
    a : ndarray, shape (at least m,)
        Values at the centre.
    g : ndarray, shape (at least m, n)
        Slopes.
    m, n : int
        Rows and variables.
    lam : ndarray, shape (at least m,)
        Is filled with the multipliers l.
    iterations : int
        Most simplex steps.

    Returns
    -------
    float
        The value reached, not rounded.
    """
    size = n + 1
    # i < m: l_i;  m + k: u_k (column +e_k);  m + n + k: w_k (column -e_k)
    basis = np.empty(size, np.int64)
    inverse = np.zeros((size, size))
    best = 0
    for i in range(m):
        if a[i] > a[best]:
            best = i
    # rows: n gradient rows  sum l g + u - w = 0, then the convexity row
    for k in range(n):
        v = g[best, k]
        basis[k] = m + k if v <= 0.0 else m + n + k
        s = 1.0 if v <= 0.0 else -1.0
        inverse[k, k] = s
        inverse[k, n] = -s * v
    basis[n] = best
    inverse[n, n] = 1.0
    x = np.empty(size)
    for k in range(n):
        x[k] = abs(g[best, k])
    x[n] = 1.0
    price = np.empty(size)
    column = np.empty(size)
    for _ in range(iterations):
        for c in range(size):
            y = 0.0
            for r in range(size):
                cost = a[basis[r]] if basis[r] < m else -1.0
                y += cost * inverse[r, c]
            price[c] = y
        enter, gain = -1, 1e-13
        for i in range(m):
            rc = a[i] - price[n]
            for k in range(n):
                rc -= price[k] * g[i, k]
            if rc > gain:
                gain, enter = rc, i
        for k in range(n):
            rc = -1.0 - price[k]
            if rc > gain:
                gain, enter = rc, m + k
            rc = -1.0 + price[k]
            if rc > gain:
                gain, enter = rc, m + n + k
        if enter < 0:
            break
        for r in range(size):
            if enter < m:
                y = inverse[r, n]
                for k in range(n):
                    y += inverse[r, k] * g[enter, k]
            elif enter < m + n:
                y = inverse[r, enter - m]
            else:
                y = -inverse[r, enter - m - n]
            column[r] = y
        leave, ratio = -1, np.inf
        for r in range(size):
            if column[r] > 1e-11 and x[r] / column[r] < ratio:
                leave, ratio = r, x[r] / column[r]
        if leave < 0:
            break
        pivot = column[leave]
        for c in range(size):
            inverse[leave, c] /= pivot
        x[leave] = ratio
        for r in range(size):
            if r != leave and column[r] != 0.0:
                for c in range(size):
                    inverse[r, c] -= column[r] * inverse[leave, c]
                x[r] = max(0.0, x[r] - column[r] * ratio)
        basis[leave] = enter
    for i in range(m):
        lam[i] = 0.0
    value = 0.0
    for r in range(size):
        if basis[r] < m:
            lam[basis[r]] = max(0.0, x[r])
            value += a[basis[r]] * x[r]
        else:
            value -= x[r]
    return value
