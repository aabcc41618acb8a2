"""3-5-3: which conditions to pose on a box, and their first-order form.

This only proposes rows: the proof does not depend on it (``lagrangian`` judges every row).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.families.polynomial import bracketed_roots, closed_form_roots
from formulations.proofs.conditions import (
    FIRST,
    JOINT,
    KIND,
    LAST,
    ORDER,
    PIECE,
    PLACE,
    SCALE,
    SEGMENT,
    SIGN,
    TOTAL,
)


@compiled
def _middle(d1: float, d2: float, d3: float, r: float, q: float, work: Any) -> None:
    """Middle quintic at (r, q) from its start, and its derivatives in s, into work[0:4]."""
    c = work[0]
    c[0] = 0.0
    c[1] = 3.0 * d1 * r
    c[2] = 3.0 * d1 * r * r
    c[3] = 10.0 * d2 - d1 * r * (18.0 + 9.0 * r) - d3 * q * (12.0 + 3.0 * q)
    c[4] = -15.0 * d2 + d1 * r * (24.0 + 9.0 * r) + d3 * q * (21.0 + 6.0 * q)
    c[5] = 6.0 * d2 - d1 * r * (9.0 + 3.0 * r) - d3 * q * (9.0 + 3.0 * q)
    for order in range(1, 4):
        for i in range(6 - order):
            work[order, i] = (i + 1) * work[order - 1, i + 1]


@compiled
def candidates(form: Any, data: Any, work: Any) -> int:
    """Fill in the rows worth posing at the middle of a box: the extremes of every limited quantity of
    the middle piece, the least durations of the end pieces, and the total.

    Parameters
    ----------
    form : RatioForm
        Its middle is read, its rows are filled (but for the multipliers).
    data : RatioData
        The task.
    work : ndarray, shape (8, 6)
        Room for the polynomials and their roots.

    Returns
    -------
    int
        Number of rows.
    """
    rows, c, d, limit = form.rows, form.c, data.d, data.limit
    n = 0
    for j in range(d.shape[1]):
        _middle(d[0, j], d[1, j], d[2, j], c[0], c[1], work)
        velocity, acceleration, jerk = work[1], work[2], work[3]
        n_jerk = closed_form_roots(jerk, 2, work[4])
        n_acceleration = bracketed_roots(acceleration, 3, work[4], n_jerk, work[5])
        for order in range(4):
            if order == 0:
                if limit[0, j] == np.inf and limit[1, j] == np.inf:
                    continue
                places = work[6]
                count = bracketed_roots(velocity, 4, work[5], n_acceleration, places)
            elif limit[order + 1, j] == np.inf:
                continue
            elif order == 1:
                count, places = n_acceleration, work[5]
            elif order == 2:
                count, places = n_jerk, work[4]
            else:
                places = work[7]
                places[0], places[1] = 0.0, 1.0
                count = 2
                s = -0.5 * jerk[1] / jerk[2] if jerk[2] != 0.0 else 0.0
                if 0.0 < s < 1.0:
                    places[2] = s
                    count = 3
            value, degree = work[order], 5 - order
            for e in range(count):
                s = places[e]
                y = value[degree]
                for i in range(degree - 1, -1, -1):
                    y = y * s + value[i]
                sign = 1.0 if y >= 0.0 else -1.0
                if order == 0:
                    room = limit[0 if sign > 0.0 else 1, j]
                    if room == np.inf:
                        continue
                    size = max(room, 1e-3)
                else:
                    size = limit[order + 1, j] * c[2] ** order
                    if abs(y) < 0.05 * size:
                        continue
                rows[n, KIND], rows[n, JOINT], rows[n, SEGMENT] = PIECE, j, 1
                rows[n, ORDER], rows[n, PLACE], rows[n, SIGN], rows[n, SCALE] = order, s, sign, size
                n += 1
    for x in range(2):
        if data.has[x]:
            rows[n, KIND], rows[n, SCALE] = FIRST if x == 0 else LAST, c[2]
            n += 1
    rows[n, KIND], rows[n, SCALE] = TOTAL, data.L / c[2]
    return n + 1


@compiled
def linearise(form: Any, n: int, data: Any) -> None:
    """Fill in the first-order form of the rows: a_i + g_i . e <= 0 for e in [-1, 1]^3.

    a_i is reduced by what the second-order terms can count against the row.

    Parameters
    ----------
    form : RatioForm
        Its box and rows are read, ``a`` and ``g`` are filled.
    n : int
        Number of rows.
    data : RatioData
        The task.
    """
    c, h, rows, a, g = form.c, form.h, form.rows, form.a, form.g
    d, limit, basis, has, shortest, L = (
        data.d, data.limit, data.basis, data.has, data.shortest, data.L
    )  # fmt: skip
    y = np.empty(5)
    for i in range(n):
        kind, size = rows[i, KIND], rows[i, SCALE]
        g[i, 0] = g[i, 1] = 0.0
        if kind in (FIRST, LAST):
            x = 0 if kind == FIRST else 1
            a[i] = (shortest[2 * x] * c[x] - c[2]) / size
            g[i, x], g[i, 2] = shortest[2 * x] * h[x] / size, -h[2] / size
        elif kind == TOTAL:
            a[i] = 1.0 - L / c[2] - L * h[2] * h[2] / (c[2] * c[2] * (c[2] - h[2]))
            for x in range(2):
                if has[x]:
                    a[i] += 1.0 / c[x]
                    g[i, x] = -h[x] / (c[x] * c[x]) / size
            a[i] /= size
            g[i, 2] = L / (c[2] * c[2]) * h[2] / size
        else:
            j, k, s, sign = int(rows[i, JOINT]), int(rows[i, ORDER]), rows[i, PLACE], rows[i, SIGN]
            for term in range(5):
                v = 0.0
                for p in range(5 - k, -1, -1):
                    v = v * s + basis[k, term, p]
                y[term] = sign * v * d[1 if term == 0 else (0 if term < 3 else 2), j] / size
            a[i] = y[0]
            for x in range(2):
                first, second = y[1 + 2 * x], y[2 + 2 * x]
                a[i] += c[x] * (first + c[x] * second) + min(0.0, second) * h[x] * h[x]
                g[i, x] = (first + 2.0 * c[x] * second) * h[x]
            T = c[2]
            bound, slope, bend = 0.0, 0.0, 0.0
            if k == 0:
                bound = limit[0 if sign > 0.0 else 1, j]
            else:
                most = limit[k + 1, j]
                bound, slope = most * T**k, most * k * T ** (k - 1)
                bend = 0.0 if k == 1 else (most if k == 2 else most * (3.0 * T + h[2]))
            a[i] -= (bound + bend * h[2] * h[2]) / size
            g[i, 2] = -slope * h[2] / size
