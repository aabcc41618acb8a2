"""B-splines: which conditions to pose on a box, and their models.

A condition is a limit on derivative ``order`` (0: position) of one joint at a share s of a knot span. For
every B-spline of the box it reads  sign A(t) c(t) - limit <= 0, where A holds derivatives of the basis
functions. With c = p + zeta and N zeta = sigma (``control_points``) and any w(e),

    A zeta = w sigma + (A - w N) zeta.

w = A N^-1 to first order makes the second term small.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.families.b_spline import population
from formulations.proofs.b_spline.basis import basis_row
from formulations.proofs.b_spline.control_points import solve
from formulations.proofs.b_spline.products import add_terms, fourth_order
from formulations.proofs.b_spline.taylor import (
    CUBE,
    ERROR,
    GROW,
    REST,
    SLOPES,
    SQUARE,
    VALUE,
    add_scaled,
    clear,
    close,
    size_of,
)
from formulations.proofs.conditions import JOINT, KIND, ORDER, PIECE, PLACE, SCALE, SEGMENT, SIGN

_GRID = 8  # places per span that are looked at
_FINE = 1024.0  # places are multiples of 1 / this, so that their linear forms are exact
_SLACK = -0.6  # conditions that keep more than this share of their limit are left out


@compiled
def candidates(rows: Any, scores: Any, data: Any, c: Any, lengths: Any, pieces: Any) -> int:
    """Fill in the conditions at the extremes of the motion in the middle of the box.

    Parameters
    ----------
    rows : ndarray, shape (m, WIDTH)
        Is filled, but for the multipliers.
    scores : ndarray, shape (m,)
        Is filled: by how much each is violated there, relative to its scale.
    data : SplineData
        The task.
    c : ndarray, shape (n+1,) [s]
        The middle.
    lengths, pieces : ndarray
        Scratch for the spline of one candidate (see ``Family``).

    Returns
    -------
    int
        Number of conditions.
    """
    forms = data.forms
    durations, values = np.empty((1, forms.n)), np.zeros(_GRID + 1)
    for q in range(forms.n):
        durations[0, q] = c[q + 1] - c[q]
    population(data.x, durations, forms.degree, lengths, pieces)
    count = 0
    for j in range(data.x.shape[1]):
        for order in range(min(forms.degree, 3) + 1):
            for side in range(2):
                sign = 1.0 - 2.0 * side
                level, size = _level(data, j, order, sign)
                if level == np.inf:
                    continue
                for k in range(forms.spans):
                    _values(pieces[0, k, j], forms.degree, order, lengths[0, k], values)
                    for g in range(_GRID + 1):
                        values[g] *= sign
                    if order == 0:
                        for g in range(_GRID + 1):
                            values[g] -= sign * data.x[0, j]
                    for g in range(_GRID + 1):
                        place, y = _extreme(values, g, k + 1 < forms.spans and order < forms.degree)
                        score = (y - level) / size
                        if place < 0.0 or not score > _SLACK or count >= len(rows):
                            continue
                        rows[count, KIND], rows[count, JOINT], rows[count, SEGMENT] = PIECE, j, k
                        rows[count, ORDER], rows[count, PLACE] = order, place
                        rows[count, SIGN], rows[count, SCALE] = sign, size
                        scores[count] = score
                        count += 1
    return count


@compiled
def _level(data: Any, j: int, order: int, sign: float) -> tuple[float, float]:
    """Limit of a condition and its scale; the position is measured from the first waypoint."""
    if order > 0:
        return data.limit[order - 1, j], data.limit[order - 1, j]
    below, above = data.room_lo[j], data.room_hi[j]
    size = 0.5 * (below + above)
    if size == np.inf:
        size = max(1.0, min(below, above))
    return (above if sign > 0.0 else below), size


@compiled
def _values(c: Any, degree: int, order: int, length: float, values: Any) -> None:
    """Values of a derivative of one piece on the grid."""
    for g in range(_GRID + 1):
        s, y = g / _GRID, 0.0
        for i in range(degree, order - 1, -1):
            f = 1.0
            for e in range(order):
                f *= i - e
            y = y * s + f * c[i]
        values[g] = y / length**order


@compiled
def _extreme(values: Any, g: int, skip_end: bool) -> tuple[float, float]:
    """Place and value of the maximum about grid point g, by a parabola; the place is -1 if there is none.

    The end of a span is the start of the next one.
    """
    y = values[g]
    if (g > 0 and y < values[g - 1]) or (g < _GRID and y <= values[g + 1]):
        return -1.0, y
    at = min(max(g, 1), _GRID - 1)
    p, q, r = values[at - 1], values[at], values[at + 1]
    bend, place = p - 2.0 * q + r, float(g)
    if bend < 0.0:
        step = 0.5 * (p - r) / bend
        if abs(at + step - g) < 1.0 and 0.0 < at + step < _GRID:
            place, y = at + step, max(y, q - 0.125 * (p - r) ** 2 / bend)
    if place == _GRID and skip_end:
        return -1.0, y
    return np.floor(place / _GRID * _FINE + 0.5) / _FINE, y


@compiled
def condition_model(row: Any, data: Any, ref: Any, out: Any) -> bool:
    """Model a condition over the box: what may not be positive.

    Parameters
    ----------
    row : ndarray, shape (WIDTH,)
        The condition; it is not divided by its scale.
    data : SplineData
        The task.
    ref : SplineReference
        Over the box; the joint's polynomials are added if they are not known.
    out : ndarray, shape (width,)
        Is filled.

    Returns
    -------
    bool
        False if there is no model.
    """
    forms = data.forms
    n, degree, m = forms.n, forms.degree, forms.n - 1
    j, k, order = int(row[JOINT]), int(row[SEGMENT]), int(row[ORDER])
    s, sign = row[PLACE], row[SIGN]
    if not ref.known[j]:
        solve(j, data.x[:, j], data.blur[:, j], forms, ref)
    point = np.empty(n + 1)
    for q in range(n + 1):
        point[q] = forms.knots[k, q] + s * (forms.knots[k + 1, q] - forms.knots[k, q])
    if not basis_row(forms, k, order, point, ref, ref.basis):
        return False
    clear(out)
    # derivatives of the functions add up to 0, the functions to 1: any origin will do
    origin = ref.points[j, k] if order > 0 else data.x[0, j]
    for i in range(degree + 1):
        add_scaled(sign * (ref.points[j, k + i] - origin), ref.basis[i], out)
        if k + i > n + 1:
            out[REST] += (size_of(ref.basis[i]) + ref.basis[i, REST]) * data.blur[n, j]
    first, last = max(3 - k, 0), min(n + 1 - k, degree) + 1
    if first < last:
        a, p = ref.basis[first:last], ref.motion[j, k + first : k + last]
        for i in range(len(a)):
            add_terms(m, sign, a[i], p[i], out)
        out[REST] += fourth_order(m, a, p, ref.work[3])
        out[REST] += _beyond_polynomials(j, k, degree, n, ref)
    level = _level(data, j, order, sign)[0]
    out[VALUE] -= level
    out[REST] += ERROR * level
    close(m, out)
    return True


@compiled
def _beyond_polynomials(j: int, k: int, degree: int, n: int, ref: Any) -> float:
    """Bound |A zeta| by w(e) sigma + (A - w(e) N) zeta, w to first order."""
    m, rows, Y = n - 1, ref.rows, ref.Y
    w, slopes_w, slopes = np.zeros(m), np.zeros((m, m)), np.zeros((m, m))
    for col in range(m):
        if 0 <= col + 3 - k <= degree:
            for i in range(m):
                w[i] += ref.basis[col + 3 - k, VALUE] * Y[col, i]
    for col in range(m):
        for q in range(m):
            if 0 <= col + 3 - k <= degree:
                slopes[col, q] = ref.basis[col + 3 - k, SLOPES + q]
            for i in range(m):
                slopes[col, q] -= w[i] * rows[i, col + 3, SLOPES + q]
    for i in range(m):
        for q in range(m):
            for col in range(m):
                slopes_w[i, q] += slopes[col, q] * Y[col, i]
    lost, worst, vary = 0.0, 0.0, np.zeros(m)
    for i in range(m):
        for q in range(m):
            vary[i] += abs(slopes_w[i, q])
        lost += (abs(w[i]) + vary[i]) * ref.sigma[j, i]
        worst = max(worst, ref.sigma[j, i])
    left = ref.work[3]  # A - w N, but for its cubes
    for col in range(m):
        clear(left)
        beyond, whole = 0.0, 0.0
        if 0 <= col + 3 - k <= degree:
            a = ref.basis[col + 3 - k]
            for e in range(SLOPES + m + (m * (m + 1)) // 2):
                left[e] = a[e]
            beyond, whole = a[CUBE] + a[REST], size_of(a)
        for i in range(m):
            row = rows[i, col + 3]
            left[VALUE] -= w[i] * row[VALUE]
            e = SLOPES + m
            for q in range(m):
                left[SLOPES + q] -= w[i] * row[SLOPES + q] + slopes_w[i, q] * row[VALUE]
                left[e] -= w[i] * row[e] + slopes_w[i, q] * row[SLOPES + q]
                e += 1
                for r in range(q + 1, m):
                    left[e] -= (
                        w[i] * row[e]
                        + slopes_w[i, q] * row[SLOPES + r]
                        + slopes_w[i, r] * row[SLOPES + q]
                    )
                    e += 1
            size = abs(w[i]) + vary[i]
            beyond += size * (row[CUBE] + row[REST]) + vary[i] * row[SQUARE]
            whole += size * size_of(row)
        left[REST] = 0.0
        close(m, left)
        beyond += size_of(left) + ERROR * whole
        lost += beyond * ref.inverted[col + 3] * worst
    return lost * GROW
