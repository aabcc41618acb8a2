"""B-splines: models of the control points over a box of waypoint times.

Interpolation. The control points c of a joint solve N(t) c = x, where N holds the basis functions at the
inner waypoints; the first three and the last three control points are known. ``solve`` finds polynomials
p(e) that fulfil the equations to third order, and encloses what is left, sigma = x - N p. Then

    c = p + zeta,   N zeta = sigma.

Lemma (de Boor). N is totally positive, so the signs of its inverse alternate like a chess board. So with
D = diag(1, -1, 1, ..) the inverse of D N D is >= 0, and if D N D s >= r > 0 then |N^-1| 1 <= s / r. The
polynomials that interpolate the data 1, -1, 1, .. give such an s, with r = 1 - |sigma|.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.b_spline.basis import collocation, knot_tables
from formulations.proofs.b_spline.products import add_terms, fourth_order
from formulations.proofs.b_spline.taylor import (
    GROW,
    LINEAR,
    REST,
    SLOPES,
    VALUE,
    add_scaled,
    clear,
    close,
    size_of,
    spread_of,
    width_of,
)

_WIDE = 0.1  # relative half-width of a distance between knots, above which no model is tried
_DOUBT = 0.9  # most that may be left of the alternating equations


class SplineData(NamedTuple):
    """The task of one attempt.

    forms: SplineForms. x (n+1, dof): waypoints [rad]. blur (n+1, dof): by how much each may differ,
    seen from the first. limit (3, dof): velocity, acceleration, jerk. room_lo, room_hi (dof,): from the
    first waypoint to the position limits, rounded up. least, sign (n, dof): lower bounds of
    |displacement|, and directions. speed, acceleration (dof,): bounds that hold for every motion.
    """

    forms: Any
    x: Any
    blur: Any
    limit: Any
    room_lo: Any
    room_hi: Any
    least: Any
    sign: Any
    speed: Any
    acceleration: Any


class SplineReference(NamedTuple):
    """The models over one box; see ``empty_reference`` for shapes.

    c, h: middle and half-widths of the waypoint times. between, inverse: distances of knots, and their
    inverses. rows: basis functions at the inner waypoints; first, last: which may differ from 0. Y:
    approximate inverse of N in the middle. points, motion: values of the polynomials in the middle, and
    their other terms; the joints, and last the alternating data. sigma: bounds of what is left. known:
    whether a joint's polynomials are at hand. inverted: bounds of |N^-1| 1. basis, residual, work:
    scratch.
    """

    c: Any
    h: Any
    between: Any
    inverse: Any
    rows: Any
    first: Any
    last: Any
    Y: Any
    points: Any
    motion: Any
    sigma: Any
    known: Any
    inverted: Any
    basis: Any
    residual: Any
    work: Any


@compiled
def empty_reference(n: int, degree: int, dof: int) -> SplineReference:
    """Make room for the models over a box.

    Parameters
    ----------
    n, degree, dof : int
        Segments, degree, moving joints.

    Returns
    -------
    SplineReference
        Zeros.
    """
    spans, width, inner = n + 5 - degree, width_of(n - 1), max(n - 1, 1)
    return SplineReference(
        np.zeros(n + 1), np.zeros(n + 1),
        np.zeros((spans + 1, spans + 1, width)), np.zeros((spans + 1, spans + 1, width)),
        np.zeros((inner, n + 5, width)), np.zeros(inner, np.int64), np.zeros(inner, np.int64),
        np.zeros((inner, inner)),
        np.zeros((dof + 1, n + 5)), np.zeros((dof + 1, n + 5, width)), np.zeros((dof + 1, inner)),
        np.zeros(dof + 1, np.bool_), np.zeros(n + 5),
        np.zeros((degree + 1, width)), np.zeros((inner, width)), np.zeros((4, width)),
    )  # fmt: skip


@compiled
def place_reference(forms: Any, lo: Any, hi: Any, ref: Any) -> bool:
    """Model over a box what all joints share.

    Parameters
    ----------
    forms : SplineForms
        Of the spline.
    lo, hi : ndarray, shape (n+1,) [s]
        The box of waypoint times.
    ref : SplineReference
        Is filled; no joint is known yet.

    Returns
    -------
    bool
        False if the box is too wide.
    """
    n, inner = forms.n, forms.n - 1
    for q in range(n + 1):
        ref.c[q], ref.h[q] = lo[q], 0.0
        if lo[q] < hi[q]:
            ref.c[q] = 0.5 * (lo[q] + hi[q])
            ref.h[q] = max(hi[q] - ref.c[q], ref.c[q] - lo[q]) * (1.0 + 2.0**-50)
    for j in range(len(ref.known)):
        ref.known[j] = False
    if not knot_tables(forms, ref.c, ref.h, ref.between, ref.inverse, ref.work):
        return False
    for a in range(forms.spans):
        for b in range(a + 1, min(a + forms.degree, forms.spans) + 1):
            if ref.between[a, b, LINEAR] > _WIDE * ref.between[a, b, VALUE]:
                return False
    if not collocation(forms, lo, hi, ref):
        return False
    if inner == 0:
        return True
    if not _invert(ref.rows, inner, ref.Y):
        return False
    alternating, exact = np.zeros(n + 1), np.zeros(n + 1)
    for i in range(1, n):
        alternating[i] = 1.0 if i % 2 == 1 else -1.0
    last = len(ref.known) - 1
    worst = solve(last, alternating, exact, forms, ref)
    if not worst < _DOUBT:
        return False
    for col in range(3, n + 2):
        size = (abs(ref.points[last, col]) + spread_of(ref.motion[last, col])) * GROW
        ref.inverted[col] = size / (1.0 - worst) * GROW
    return True


@compiled
def _invert(rows: Any, inner: int, out: Any) -> bool:
    """Approximate inverse of N in the middle (Gauss-Jordan; no pivoting, as N is totally positive)."""
    a = np.empty((inner, inner))
    for i in range(inner):
        for k in range(inner):
            a[i, k] = rows[i, k + 3, VALUE]
            out[i, k] = 1.0 if i == k else 0.0
    for p in range(inner):
        if not a[p, p] > 0.0:
            return False
        f = 1.0 / a[p, p]
        for k in range(inner):
            a[p, k] *= f
            out[p, k] *= f
        for i in range(inner):
            f = a[i, p]
            if i != p and f != 0.0:
                for k in range(inner):
                    a[i, k] -= f * a[p, k]
                    out[i, k] -= f * out[p, k]
    return True


@compiled
def solve(j: int, x: Any, blur: Any, forms: Any, ref: Any) -> float:
    """Find polynomials for the control points, and enclose what is left of the equations.

    Parameters
    ----------
    j : int
        Where to put them.
    x, blur : ndarray, shape (n+1,)
        Data at the waypoints, and by how much each may differ from it, seen from the first.
    forms : SplineForms
        Of the spline.
    ref : SplineReference
        Its ``points``, ``motion`` and ``sigma`` of j are filled.

    Returns
    -------
    float
        The largest bound of what is left.
    """
    n, inner, m = forms.n, forms.n - 1, forms.n - 1
    points, motion, Y, R = ref.points[j], ref.motion[j], ref.Y, ref.residual
    for col in range(n + 5):
        points[col] = x[0] if col < 3 else x[n]
        clear(motion[col])
    for col in range(inner):
        y = 0.0
        for i in range(inner):
            right = x[i + 1] - x[col + 1]  # the functions add up to 1: measure from waypoint col + 1
            for f in range(3):
                right -= ref.rows[i, f, VALUE] * (x[0] - x[col + 1])
                right -= ref.rows[i, n + 2 + f, VALUE] * (x[n] - x[col + 1])
            y += Y[col, i] * right
        points[col + 3] = x[col + 1] + y
    ends = (SLOPES, SLOPES + m, SLOPES + m + (m * (m + 1)) // 2, R.shape[1])
    for order in range(1, 4):  # any polynomials will do: what they leave is enclosed below
        for i in range(inner):
            _left_of_order(i, order, ends, x, n, ref, points, motion)
        for col in range(inner):
            for i in range(inner):
                for e in range(ends[order - 1], ends[order]):
                    motion[col + 3, e] += Y[col, i] * R[i, e]
    for col in range(3, n + 2):
        motion[col, REST] = 0.0
        close(m, motion[col])
        motion[col, REST] = 0.0  # exact polynomials
    worst = 0.0
    for i in range(inner):
        clear(R[i])
        a, b = max(ref.first[i], 3), min(ref.last[i], n + 2)
        for col in range(ref.first[i], ref.last[i]):
            add_scaled(x[i + 1] - points[col], ref.rows[i, col], R[i])
        for col in range(a, b):
            add_terms(m, -1.0, ref.rows[i, col], motion[col], R[i])
        R[i, REST] += fourth_order(m, ref.rows[i, a:b], motion[a:b], ref.work[3])
        R[i, REST] += blur[i + 1] + blur[n]
        close(m, R[i])
        ref.sigma[j, i] = (size_of(R[i]) + R[i, REST]) * GROW
        worst = max(worst, ref.sigma[j, i])
    ref.known[j] = True
    return worst


@compiled
def _left_of_order(
    i: int, order: int, ends: Any, x: Any, n: int, ref: Any, points: Any, motion: Any
) -> None:
    """Terms of one order that the polynomials of lower order leave in equation i, not rounded."""
    R, m = ref.residual[i], n - 1
    for e in range(ends[order - 1], ends[order]):
        R[e] = 0.0
    for col in range(ref.first[i], ref.last[i]):
        row, z = ref.rows[i, col], motion[col]
        d = x[i + 1] - points[col]
        for e in range(ends[order - 1], ends[order]):
            R[e] += d * row[e]
        if order == 1 or not 3 <= col <= n + 1:
            continue
        e, row_q = ends[order - 1], ends[1]
        for q in range(m):
            a, p = row[SLOPES + q], z[SLOPES + q]
            if order == 2:
                R[e] -= a * p
                for s in range(q + 1, m):
                    R[e + s - q] -= a * z[SLOPES + s] + row[SLOPES + s] * p
                e += m - q
                continue
            row_r = row_q
            for r in range(q, m):
                aqr, pqr = row[row_q + r - q], z[row_q + r - q]
                ar, pr = row[SLOPES + r], z[SLOPES + r]
                for s in range(r, m):
                    y = a * z[row_r + s - r] + p * row[row_r + s - r]
                    if q < r:
                        y += ar * z[row_q + s - q] + pr * row[row_q + s - q]
                    if r < s:
                        y += row[SLOPES + s] * pqr + z[SLOPES + s] * aqr
                    R[e + s - r] -= y
                e += m - r
                row_r += m - r
            row_q += m - q
