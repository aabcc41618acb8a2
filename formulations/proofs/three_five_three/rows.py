"""3-5-3, heuristic: which conditions to pose on a box, and their first-order form.

Nothing rests on it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.families.polynomial import _bracketed_roots, _closed_form_roots
from formulations.proofs.rows import (
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
def candidates(rows: Any, d: Any, limit: Any, c: Any, has: Any, L: float, work: Any) -> int:
    """Rows worth posing at c = (r, q, T): every extreme of every limited quantity, ends and total.

    d: (3, dof) displacements; limit as in ``excess``; work: (8, 6). Returns their number.
    """
    n = 0
    for j in range(d.shape[1]):
        _middle(d[0, j], d[1, j], d[2, j], c[0], c[1], work)
        velocity, acceleration, jerk = work[1], work[2], work[3]
        n_jerk = _closed_form_roots(jerk, 2, work[4])
        n_acceleration = _bracketed_roots(acceleration, 3, work[4], n_jerk, work[5])
        for order in range(4):
            if order == 0:
                if limit[0, j] == np.inf and limit[1, j] == np.inf:
                    continue
                places = work[6]
                count = _bracketed_roots(velocity, 4, work[5], n_acceleration, places)
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
        if has[x]:
            rows[n, KIND], rows[n, SCALE] = FIRST if x == 0 else LAST, c[2]
            n += 1
    rows[n, KIND], rows[n, SCALE] = TOTAL, L / c[2]
    return n + 1


@compiled
def linear(
    rows: Any,
    n: int,
    d: Any,
    data: Any,
    has: Any,
    shortest: Any,
    L: float,
    c: Any,
    h: Any,
    a: Any,
    g: Any,
) -> None:
    """First-order form about c = (r, q, T) of half-widths h: rows a_i + g_i . e <= 0, e in [-1, 1]^3.

    The part of second order that counts against the row is taken off a_i.
    """
    limit, basis = data[2], data[3]
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
