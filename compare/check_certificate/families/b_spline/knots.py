"""Basis functions of B-splines as Taylor models in the times of the inner waypoints.

Times are counted in units of 1 / degree. Then a waypoint's time is degree t_i, and an inner knot is a sum
of ``degree`` of the t_i (a running mean: Lu & Wang 2024, eq. 6); all knots are such sums. The recursion of
Cox and de Boor on the span between knots k and k + 1 raises the degree from d - 1 to d by

    N_j = s_j N_{j-1} + (1 - s_{j+1}) N_j,      s_j = (x - knot_low) / (knot_high - knot_low),

low = k - d + j, high = k + j, each cut to 0 .. spans, j = 1 .. d; and the derivative of a spline by
N_j = d (N_{j-1} / width_j - N_j / width_{j+1}).

Lemma (quotient). a and b > 0 are linear forms, a = b0 (v (1 + x) + y), b = b0 (1 + x), |x| <= X < 1. With
the terms N0 .. N3 of a polynomial N and Q1 = y N0, Q2 = y N1 - x Q1, Q3 = y N2 - x Q2,

    (a / b) N = v N + Q1 + Q2 + Q3 + (y N3 - x Q3) / (1 + x).

For 1 / b: Q0 = N0 / b0, Qk = Nk / b0 - x Q_{k-1}, and N / b = Q0 + .. + Q3 - x Q3 / (1 + x).
The forms are computed with an error of at most ERR degree L each, as their terms are >= 0 and no more than
degree L in all. If a and b are off by A and B, a / b is off by (A + |a / b| B) / least b.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from compare.check_certificate.families.b_spline.taylor import (
    ERR,
    GROW,
    TINY,
    Monomials,
    monomials,
    raised,
    size,
)

WIDEST = 0.25  # most that a distance between knots may vary, relative to its middle


class Forms:
    """Knots of a B-spline with n segments, as sums of waypoint times.

    n, degree, spans: numbers. knots (spans+1, n+1): how often each waypoint's time enters.
    """

    def __init__(self, n: int, degree: int) -> None:
        self.n, self.degree, self.spans = n, degree, n + 5 - degree
        self.of: Monomials = monomials(n - 1)
        self.knots = np.zeros((self.spans + 1, n + 1))
        self.knots[0, 0] = self.knots[-1, n] = degree
        for k in range(1, self.spans):
            for i in range(k - 2, k + degree - 2):
                self.knots[k, min(max(i, 0), n)] += 1.0


class TimeBoxes(NamedTuple):
    """TimeBoxes of waypoint times: c, h (n+1, boxes), middles and half-widths [s]; h is 0 at both ends."""

    c: Any
    h: Any

    def take(self, index: Any) -> TimeBoxes:
        """Choose boxes.

        Parameters
        ----------
        index : ndarray of int
            Their numbers.

        Returns
        -------
        TimeBoxes
            Each as often as its number occurs.
        """
        return TimeBoxes(self.c[:, index], self.h[:, index])


def boxes_of(lo: Any, hi: Any) -> TimeBoxes:
    """Find middles and half-widths, the latter rounded up.

    Parameters
    ----------
    lo, hi : ndarray, shape (n+1, boxes) [s]
        Ends.

    Returns
    -------
    TimeBoxes
        That hold the given ones.
    """
    c = np.where(lo < hi, 0.5 * (lo + hi), lo)
    h = np.where(lo < hi, np.maximum(hi - c, c - lo) * (1.0 + 2.0**-50), 0.0)
    return TimeBoxes(c, h)


def basis(
    forms: Forms, boxes: TimeBoxes, k: Any, order: int, point: tuple[Any, Any]
) -> tuple[Any, Any, Any]:
    """Model derivatives of the basis functions that are not zero on a span.

    Parameters
    ----------
    forms : Forms
        Of the spline.
    boxes : TimeBoxes
        One per element.
    k : ndarray of int, shape (elements,)
        Spans.
    order : int
        Of the derivative.
    point : tuple of ndarray, shapes (elements,) and (n-1, elements)
        Where: a form, as its value in the middle and its slopes.

    Returns
    -------
    terms : ndarray, shape (K, degree+1, elements)
        Of functions k .. k + degree.
    rest : ndarray, shape (degree+1, elements)
        Rests.
    fit : ndarray of bool, shape (elements,)
        Whether all distances between knots are surely positive and vary little.
    """
    degree, inner = forms.degree, slice(1, forms.n)
    values = forms.knots @ boxes.c
    slopes = forms.knots.T[inner, :, None] * boxes.h[inner, None, :]
    element = np.arange(len(k))
    error = ERR * degree * boxes.c[-1]
    terms, rest = np.zeros((forms.of.K, 1, len(k))), np.zeros((1, len(k)))
    terms[0] = 1.0
    fit = np.ones(len(k), bool)
    for d in range(1, degree + 1):
        j = np.arange(1, d + 1)[:, None]
        low, high = np.maximum(k - d + j, 0), np.minimum(k + j, forms.spans)
        b0 = values[high, element] - values[low, element]
        fit &= (b0 > 0.0).all(axis=0)
        b0 = np.where(b0 > 0.0, b0, 1.0)
        x = (slopes[:, high, element] - slopes[:, low, element]) / b0
        X = size(x) * GROW
        least = (b0 * (1.0 - X) - 2.0 * error) * (1.0 - 2.0**-40)
        fit &= ((X <= WIDEST) & (least > 0.5 * b0)).all(axis=0)
        least = np.where(least > 0.0, least, 1.0)
        raise_by = _by_share if d <= degree - order else _by_width
        lower = (point[0] - values[low, element], point[1][:, None, :] - slopes[:, low, element])
        terms, rest = raise_by(forms, d, terms, rest, (b0, x, X, least, error), lower)
    return terms, rest, fit


def _by_share(
    forms: Forms, d: int, terms: Any, rest: Any, width: tuple[Any, ...], lower: tuple[Any, Any]
) -> tuple[Any, Any]:
    """From degree d - 1 to d."""
    of, (b0, x, X, least, error) = forms.of, width
    v = lower[0] / b0
    y = lower[1] / b0 - v * x
    Y = size(y) * GROW
    product = v * terms
    q = np.zeros_like(terms[:0])
    for order, (source, target) in enumerate(
        ((slice(0, 1), of.linear), (of.linear, of.square), (of.square, of.cube)), 1
    ):
        before, q = q, raised(of, order, y, terms[source])
        if order > 1:
            q -= raised(of, order, x, before)
        product[target] += q
    whole, cubes = size(terms), size(terms[of.cube])
    vary = Y / (1.0 - X) * GROW
    # forms are off by ``error`` or, once divided and subtracted, by a few units of their sizes
    share_error = (1.0 + np.abs(v) + vary) * (4.0 * error + ERR * b0 * (1.0 + np.abs(v) + Y)) / least
    fourth = (Y * cubes + X * size(q)) / (1.0 - X)
    rounding = (share_error + ERR * (1.0 + np.abs(v) + Y)) * (whole + rest)
    new, new_rest = np.zeros((of.K, d + 1, terms.shape[2])), np.zeros((d + 1, terms.shape[2]))
    new[:, 1:] = product
    new[:, :-1] += terms - product
    new_rest[1:] = (np.abs(v) + vary) * rest + fourth + rounding
    new_rest[:-1] += (np.abs(1.0 - v) + vary) * rest + fourth + rounding
    new_rest += ERR * size(new)
    return new, new_rest * GROW + TINY


def _by_width(
    forms: Forms, d: int, terms: Any, rest: Any, width: tuple[Any, ...], lower: Any
) -> tuple[Any, Any]:
    """From a derivative of degree d - 1 to the next one of degree d; times are in units of 1 / degree."""
    of, (b0, x, X, least, error) = forms.of, width
    product = terms / b0
    product[of.linear] -= raised(of, 1, x, product[:1])
    product[of.square] -= raised(of, 2, x, product[of.linear])
    product[of.cube] -= raised(of, 3, x, product[of.square])
    whole = size(terms)
    relative = (2.0 * error + ERR * b0) / least
    lost = (rest + (relative + ERR) * (whole + rest)) / least
    lost += X * size(product[of.cube]) / (1.0 - X) + ERR * size(product)
    factor = float(d * forms.degree)
    new, new_rest = np.zeros((of.K, d + 1, terms.shape[2])), np.zeros((d + 1, terms.shape[2]))
    new[:, 1:] = factor * product
    new[:, :-1] -= factor * product
    new_rest[1:] = factor * lost
    new_rest[:-1] += factor * lost
    new_rest += ERR * size(new)
    return new, new_rest * GROW + TINY
