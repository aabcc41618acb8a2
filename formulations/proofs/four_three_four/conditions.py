"""4-3-...-3-4: which conditions to pose on a box, and their first-order form.

This only proposes rows: the proof does not depend on it (``lagrangian`` judges every row).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled, inlined
from formulations.families.polynomial import closed_form_roots
from formulations.proofs.conditions import (
    JOINT,
    JUMP,
    KIND,
    ORDER,
    PART,
    PIECE,
    PLACE,
    SCALE,
    SEGMENT,
    SIGN,
    TOTAL,
)
from formulations.proofs.events import copy
from formulations.proofs.four_three_four.ends import (
    end_of,
    piece_type,
    side_of,
    unknown_knots,
    variable_of,
)


@compiled
def _share_beside(j: int, i: int, side: int, data: Any, reference: Any) -> float:
    """What the segment beside the open one adds to knot i's equation at c (side 0: the one before)."""
    m, w, p, other = side_of(i, side, data.ends)
    c, v = reference.c, reference.vc
    return c[m] * (w * v[j, i] + 2.0 * v[j, other] - p * data.d[m, j] * c[m])


@compiled
def _places(order: int, k: int, ends_of: Any, value: Any, is_open: Any, places: Any, work: Any) -> int:
    """Where derivative ``order`` of piece k, the polynomial value, can be extreme; returns the number.

    A knot is looked at on one piece only, except for the jerk, which jumps there, and except beside an
    open piece, whose own row would be slack.
    """
    kind, n = piece_type(k, ends_of), ends_of[0]
    top = (3 if kind == 1 else 4) - order
    found = 0
    if order > 0 and (kind != 0 or order == 3):
        places[0] = 0.0
        found = 1
    ends = is_open[k + 1] if k + 1 < n else kind == 1
    if (order == 3 and kind != 1) or (0 < order < 3 and ends):
        places[found] = 1.0
        found += 1
    if top == 4:
        # measured from the end at rest, the slope is 3 a z^2 + 4 b z^3
        if kind == 0:
            a, b = value[3], value[4]
        else:
            a, b = -(value[3] + 4.0 * value[4]), value[4]
        z = -0.75 * a / b if b != 0.0 else -1.0
        if 0.0 < z < 1.0:
            places[found] = z if kind == 0 else 1.0 - z
            found += 1
    elif top >= 2:
        for i in range(top):
            work[i] = (i + 1) * value[i + 1]
        found += closed_form_roots(work, top - 1, places[found:])
    return found


@compiled
def candidates(rows: Any, data: Any, reference: Any) -> int:
    """Fill in the rows worth posing at the reference: the extremes of every limited quantity of every
    piece, the jumps across open segments, and the total.

    Parameters
    ----------
    rows : ndarray, shape (m, WIDTH)
        Is filled, but for the multipliers.
    data : RateData
        The task.
    reference : Reference
        A point of the box.

    Returns
    -------
    int
        Number of rows.
    """
    n, d, limit, basis = data.n, data.d, data.limit, data.basis
    room_lo, room_hi = data.room_lo, data.room_hi
    c, is_open, vc = reference.c, reference.is_open, reference.vc
    first, last = unknown_knots(data.ends)
    value, places, work = np.zeros(5), np.zeros(8), np.zeros(5)
    count = 0
    for j in range(d.shape[1]):
        for k in range(n):
            kind = piece_type(k, data.ends)
            for order in range(4):
                if order == 0:
                    if is_open[k] or (room_lo[k, j] == np.inf and room_hi[k, j] == np.inf):
                        continue
                elif limit[order - 1, j] == np.inf:
                    continue
                for i in range(5):
                    value[i] = (
                        basis[order, kind, 0, i] * d[k, j] * c[k]
                        + basis[order, kind, 1, i] * vc[j, k]
                        + basis[order, kind, 2, i] * vc[j, k + 1]
                    )
                for e in range(_places(order, k, data.ends, value, is_open, places, work)):
                    s = places[e]
                    y = value[4]
                    for i in range(3, -1, -1):
                        y = y * s + value[i]
                    sign = 1.0 if y >= 0.0 else -1.0
                    if order == 0:
                        room = room_hi[k, j] if sign > 0.0 else room_lo[k, j]
                        if room == np.inf:
                            continue
                        size = max(room, 1e-3) * c[k]
                    else:
                        size = limit[order - 1, j] / c[k] ** (order - 1)
                        if abs(y) < 0.1 * size:
                            continue
                    rows[count, KIND], rows[count, JOINT], rows[count, SEGMENT] = PIECE, j, k
                    rows[count, ORDER], rows[count, PLACE] = order, s
                    rows[count, SIGN], rows[count, SCALE] = sign, size
                    count += 1
    for k in range(n):
        if not is_open[k] or (k > 0 and is_open[k - 1]) or (k + 1 < n and is_open[k + 1]):
            continue
        if (k == 0 and first == 0) or (k + 1 == n and last == n):  # a is unknown at free ends
            continue
        for j in range(d.shape[1]):
            if limit[2, j] == np.inf:
                continue
            y = 0.0
            for side in range(2):
                if 0 < k + side < n:
                    y += _share_beside(j, k + side, side, data, reference)
            rows[count, KIND], rows[count, JOINT], rows[count, SEGMENT] = JUMP, j, k
            rows[count, ORDER], rows[count, PLACE] = 3, 0.0
            rows[count, SIGN] = 1.0 if y >= 0.0 else -1.0
            rows[count, SCALE] = abs(y) + limit[2, j] / c[k] + 1e-300
            count += 1
    rows[count, KIND], rows[count, SCALE] = TOTAL, 0.0
    for k in range(n):
        rows[count, SCALE] += 1.0 / c[k]
    count += 1
    for i in range(len(data.parts)):
        rows[count, KIND], rows[count, SEGMENT], rows[count, SCALE] = PART, i, data.parts[i, 2]
        count += 1
    return count


@inlined
def _highest(row: Any, data: Any, box: Any, velocities: Any) -> float:
    """By how much a limit inside a piece may be exceeded for some x and v in their enclosures, or 1."""
    j, k, order = int(row[JOINT]), int(row[SEGMENT]), int(row[ORDER])
    if order == 0:
        return 1.0
    s, sign, kind = row[PLACE], row[SIGN], piece_type(k, data.ends)
    y = 0.0
    for term in range(3):
        w = 0.0
        for p in range(4 - order, -1, -1):
            w = w * s + data.basis[order, kind, term, p]
        w *= sign
        if term == 0:
            w *= data.d[k, j]
            y += 0.0 if w == 0.0 else max(w * box.lo[k], w * box.hi[k])
        else:
            y += max(w * velocities.lo[j, k + term - 1], w * velocities.hi[j, k + term - 1])
    return float(y - data.limit[order - 1, j] / box.hi[k] ** (order - 1))


@compiled
def linearise(form: Any, count: int, data: Any, box: Any, reference: Any, velocities: Any) -> int:
    """Fill in the first-order form of the rows: a_i + g_i . e <= 0 for e in [-1, 1]^n.

    Rows that no point of the box can violate are dropped.

    Parameters
    ----------
    form : RateForm
        Its rows are read, ``a`` and ``g`` are filled.
    count : int
        Number of rows.
    data : RateData
        The task.
    box : Box
        Of x.
    reference : Reference
        A point of the box.
    velocities : VelocityEnclosure
        With slopes and remainders about it.

    Returns
    -------
    int
        Number of rows that are left.
    """
    rows, a, g = form.rows, form.a, form.g
    n, d, limit, basis, lo = data.n, data.d, data.limit, data.basis, box.lo
    V_lo, V_hi, dof, variables = velocities.lo, velocities.hi, d.shape[1], g.shape[1]
    first, last = unknown_knots(data.ends)
    c, half, is_open, vc = reference.c, reference.half, reference.is_open, reference.vc
    G, R, C = velocities.slopes, velocities.remainder, reference.C
    kept = 0
    for r in range(count):
        size = rows[r, SCALE]
        for k in range(variables):
            g[kept, k] = 0.0
        if rows[r, KIND] == TOTAL:
            y = -data.L
            for k in range(n):
                if not is_open[k]:
                    y += 1.0 / c[k]
                    g[kept, k] = -1.0 / (c[k] * c[k])
        elif rows[r, KIND] == PART:
            part = data.parts[int(rows[r, SEGMENT])]
            y = part[2]
            for k in range(int(part[0]), int(part[1])):
                if is_open[k]:
                    y -= 1.0 / lo[k]
                else:
                    y -= 1.0 / c[k] + half[k] * half[k] / (c[k] * c[k] * lo[k])
                    g[kept, k] = 1.0 / (c[k] * c[k])
        elif rows[r, KIND] == JUMP:
            j, k, sign = int(rows[r, JOINT]), int(rows[r, SEGMENT]), rows[r, SIGN]
            y = -limit[2, j] / lo[k]
            for side in range(2):
                i = k + side
                if not 0 < i < n:
                    continue
                m, w, p, other = side_of(i, side, data.ends)
                y += sign * _share_beside(j, i, side, data, reference)
                y -= c[m] * (w * R[j, i] + 2.0 * R[j, other])
                g[kept, m] += sign * (w * vc[j, i] + 2.0 * vc[j, other] - 2.0 * p * d[m, j] * c[m])
                for q in range(n):
                    g[kept, q] += sign * c[m] * (w * G[j, i, q] + 2.0 * G[j, other, q])
        else:
            j, k, order = int(rows[r, JOINT]), int(rows[r, SEGMENT]), int(rows[r, ORDER])
            s, sign = rows[r, PLACE], rows[r, SIGN]
            kind = piece_type(k, data.ends)
            y = 0.0
            for term in range(3):
                w = 0.0
                for p in range(4 - order, -1, -1):
                    w = w * s + basis[order, kind, term, p]
                w *= sign
                if term == 0:
                    w *= d[k, j]
                    if order == 0:
                        w -= data.room_hi[k, j] if sign > 0.0 else data.room_lo[k, j]
                    y += w * c[k]
                    g[kept, k] += w
                elif first <= k + term - 1 <= last:
                    i = k + term - 1
                    y += w * vc[j, i] - abs(w) * R[j, i]
                    for m in range(n):
                        g[kept, m] += w * G[j, i, m]
                    for end in range(0, n + 1, n):
                        if first <= end <= last:
                            g[kept, variable_of(j, end, data.ends, dof)] += w * C[i, end]
            x, e = c[k], half[k]
            if order == 0:
                pass
            elif order == 1:
                y -= limit[0, j]
            elif is_open[k]:
                y -= limit[order - 1, j] / lo[k] ** (order - 1)
            elif order == 2:
                y -= limit[1, j] * (1.0 / x + e * e / (x * x * lo[k]))
                g[kept, k] += limit[1, j] / (x * x)
            elif order == 3:
                bend = 2.0 / (x * x * x * lo[k]) + 1.0 / (x * lo[k]) ** 2
                y -= limit[2, j] * (1.0 / (x * x) + e * e * bend)
                g[kept, k] += 2.0 * limit[2, j] / (x * x * x)
        a[kept] = y / size
        most = a[kept]
        for k in range(n):
            g[kept, k] *= half[k] / size
            most += abs(g[kept, k])
        for k in range(n, variables):
            if g[kept, k] != 0.0:
                j, i = end_of(k, data.ends, dof)
                g[kept, k] *= 0.5 * (V_hi[j, i] - V_lo[j, i]) / size
                most += abs(g[kept, k])
        if variables > n and rows[r, KIND] == PIECE and most > 0.0:
            # velocities at free ends vary so much that the first order says little
            most = _highest(rows[r], data, box, velocities)
        if most > 0.0:
            if kept != r:
                copy(rows[kept], rows[r])
            kept += 1
    return kept
