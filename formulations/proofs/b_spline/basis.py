"""B-splines: waypoint times and knots as linear forms, and models of the basis functions.

The variables are the times t_1 .. t_{n-1} of the inner waypoints; t_0 = 0 and t_n = L. A waypoint time is
one of them, and an inner knot is the mean of ``degree`` of them (Lu & Wang 2024, eq. 6). So all times are
counted here in units of 1 / degree, in which every coefficient of these forms is an integer. The basis
functions follow from the recursion of Cox and de Boor (eq. 2), whose factors are ratios of such forms.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.b_spline.products import add_product, quotient, share_out
from formulations.proofs.b_spline.taylor import (
    ERROR,
    REST,
    SLOPES,
    VALUE,
    add_scaled,
    clear,
    close,
    copy_model,
    size_of,
)


class SplineForms(NamedTuple):
    """Knots and waypoint times of a B-spline.

    n, degree, spans: numbers. times (n+1, n+1), knots (spans+1, n+1): coefficients of t_0 .. t_n.
    """

    n: int
    degree: int
    spans: int
    times: Any
    knots: Any


def forms_of(n: int, degree: int) -> SplineForms:
    """Write down the linear forms.

    Parameters
    ----------
    n, degree : int
        Number of segments; 3 or 5.

    Returns
    -------
    SplineForms
        In units of 1 / degree.
    """
    spans = n + 5 - degree
    knots = np.zeros((spans + 1, n + 1))
    knots[0, 0] = knots[spans, n] = degree
    for k in range(1, spans):
        for m in range(k - 2, k + degree - 2):
            knots[k, min(max(m, 0), n)] += 1.0
    return SplineForms(n, degree, spans, degree * np.eye(n + 1), knots)


@compiled
def distance(start: Any, end: Any, c: Any, h: Any, out: Any) -> None:
    """Model the time from one linear form to another.

    Parameters
    ----------
    start, end : ndarray, shape (n+1,)
        Coefficients.
    c, h : ndarray, shape (n+1,) [s]
        Middle and half-width of each waypoint's time; h is 0 at both ends.
    out : ndarray, shape (width,)
        Is filled.
    """
    n = len(c) - 1
    clear(out)
    total = 0.0
    for i in range(n + 1):
        k = end[i] - start[i]
        out[VALUE] += k * c[i]
        total += abs(k) * (c[i] + h[i])
        if 0 < i < n:
            out[SLOPES + i - 1] = k * h[i]
    out[REST] = ERROR * total
    close(n - 1, out)


@compiled
def knot_tables(forms: Any, c: Any, h: Any, between: Any, inverse: Any, work: Any) -> bool:
    """Model the distances between knots, and their inverses.

    Parameters
    ----------
    forms : SplineForms
        Of the spline.
    c, h : ndarray, shape (n+1,) [s]
        As in ``distance``.
    between, inverse : ndarray, shape (spans+1, spans+1, width)
        Are filled above the diagonal.
    work : ndarray, shape (4, width)
        Scratch.

    Returns
    -------
    bool
        False if a distance may vanish.
    """
    one = work[3]
    clear(one)
    one[VALUE] = 1.0
    for a in range(forms.spans):
        for b in range(a + 1, min(a + forms.degree, forms.spans) + 1):
            distance(forms.knots[a], forms.knots[b], c, h, between[a, b])
            if not quotient(forms.n - 1, one, between[a, b], inverse[a, b]):
                return False
    return True


@compiled
def basis_row(forms: Any, k: int, order: int, point: Any, ref: Any, out: Any) -> bool:
    """Model a derivative of the basis functions that are not zero on a span.

    Parameters
    ----------
    forms : SplineForms
        Of the spline.
    k, order : int
        The span, and the order of the derivative.
    point : ndarray, shape (n+1,)
        Where, a linear form.
    ref : SplineReference
        With the tables of the knots.
    out : ndarray, shape (degree+1, width)
        Is filled: functions k .. k + degree.

    Returns
    -------
    bool
        False if a distance between knots may vanish.
    """
    n, degree, last = forms.n - 1, forms.degree, forms.spans
    share, number, product = ref.work[0], ref.work[1], ref.work[2]
    for j in range(degree + 1):
        clear(out[j])
    out[0, VALUE] = 1.0
    for d in range(1, degree + 1):
        for j in range(d, 0, -1):
            low, high = max(k - d + j, 0), min(k + j, last)
            clear(product)
            if d <= degree - order:
                distance(forms.knots[low], point, ref.c, ref.h, number)
                if not quotient(n, number, ref.between[low, high], share):
                    return False
                share_out(n, share, out[j - 1], out[j], product)
            else:
                add_product(n, float(d * degree), ref.inverse[low, high], out[j - 1], product)
                close(n, product)
                add_scaled(1.0, product, out[j])
                close(n, out[j])
                clear(out[j - 1])
                add_scaled(-1.0, product, out[j - 1])
                close(n, out[j - 1])
    return True


@compiled
def _span_range(forms: Any, i: int, lo: Any, hi: Any) -> tuple[int, int]:
    """First and last span in which waypoint i lies for some times in the box."""
    first, last = 0, forms.spans - 1
    slack = 1e-12 * forms.degree * hi[forms.n]  # for rounding
    for k in range(1, forms.spans):
        least, most = -slack, slack
        for q in range(forms.n + 1):
            a = forms.times[i, q] - forms.knots[k, q]
            least += min(a * lo[q], a * hi[q])
            most += max(a * lo[q], a * hi[q])
        if least > 0.0:
            first = k
        if most < 0.0:
            last = min(last, k - 1)
    return first, last


@compiled
def _span_at(forms: Any, i: int, first: int, last: int, c: Any) -> int:
    """Span of waypoint i at the middle of the box."""
    found = first
    for k in range(first + 1, last + 1):
        y = 0.0
        for q in range(forms.n + 1):
            y += (forms.times[i, q] - forms.knots[k, q]) * c[q]
        if y > 0.0:
            found = k
    return found


@compiled
def collocation(forms: Any, lo: Any, hi: Any, ref: Any) -> bool:
    """Model the basis functions at the inner waypoints.

    A waypoint may cross a knot inside the box. There the polynomials of two spans differ by little (a
    power ``degree`` of its distance to the knot), so the model of one of them is widened by that.

    Parameters
    ----------
    forms : SplineForms
        Of the spline.
    lo, hi : ndarray, shape (n+1,) [s]
        The box.
    ref : SplineReference
        Its ``rows`` (n-1, n+5, width), ``first`` and ``last`` (n-1,) are filled.

    Returns
    -------
    bool
        False if a distance between knots may vanish.
    """
    n, degree, out = forms.n, forms.degree, ref.basis
    for i in range(1, n):
        a, b = _span_range(forms, i, lo, hi)
        middle = _span_at(forms, i, a, b, ref.c)
        rows = ref.rows[i - 1]
        for col in range(n + 5):
            clear(rows[col])
        ref.first[i - 1], ref.last[i - 1] = a, b + degree + 1
        if not basis_row(forms, middle, 0, forms.times[i], ref, out):
            return False
        for j in range(degree + 1):
            copy_model(rows[middle + j], out[j])
        for k in range(a, b + 1):
            if k == middle:
                continue
            if not basis_row(forms, k, 0, forms.times[i], ref, out):
                return False
            for col in range(a, b + degree + 1):
                far, row = size_of(rows[col]), rows[col]
                if 0 <= col - k <= degree:
                    other = out[col - k]
                    far = abs(other[VALUE] - row[VALUE])
                    for e in range(SLOPES, len(row)):
                        far += abs(other[e] - row[e])
                    far += other[REST] + ERROR * (size_of(other) + size_of(row))
                row[REST] = max(row[REST], far * (1.0 + ERROR))
    return True
