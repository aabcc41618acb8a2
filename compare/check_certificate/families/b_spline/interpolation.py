"""Control points of B-splines as polynomials in the times of the inner waypoints, and what these miss.

The control points c of a joint solve N c = x, N the basis functions at the inner waypoints; the first three
and the last three control points are the outer waypoints. Any polynomials p are taken that nearly solve
this, and N (x - p) = sigma is enclosed (the functions add up to 1, so x is subtracted from every p_l):

    c = p + zeta,   N zeta = sigma.

Lemma. N is totally positive (Karlin, Total Positivity, 1968; de Boor, Total positivity of the spline
collocation matrix, 1976). If N v has the signs + - + .. strictly, then N is regular, because the image of a
totally positive matrix of rank r holds no vector with r or more changes of sign (Gantmacher & Krein, 1950);
and the signs of the inverse alternate like a chess board. So with D = diag(1, -1, ..), D N^-1 D >= 0. If
(D N v)_i >= r > 0 for all i, then D v >= r D N^-1 D 1 = r |N^-1| 1. The polynomials for the data + - + ..
give such a v, with r = 1 - the largest bound of their sigma.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from compare.check_certificate.families.b_spline.knots import Forms, TimeBoxes, basis
from compare.check_certificate.families.b_spline.taylor import (
    ERR,
    GROW,
    TINY,
    size,
    sum_of_products,
)

_DOUBT = 0.9  # most that may be left of the alternating equations


class Interpolation(NamedTuple):
    """What is known of the control points over many boxes.

    rows (boxes, n-1, n+5, K), rest (boxes, n-1, n+5): models of N. Y (boxes, n-1, n-1): about the
    inverse of N in the middle. inverse (boxes, n-1): bounds of |N^-1| 1. fit (boxes,): whether all
    this holds. points (boxes, joints, n+5), motion (boxes, joints, n+5, K): the polynomials; sigma
    (boxes, joints, n-1): what they miss.
    """

    rows: Any
    rest: Any
    Y: Any
    inverse: Any
    fit: Any
    points: Any
    motion: Any
    sigma: Any


def interpolation(
    forms: Forms, lo: Any, hi: Any, boxes: TimeBoxes, x: Any, wanted: Any
) -> Interpolation:
    """Solve for the control points of some joints over many boxes.

    Parameters
    ----------
    forms : Forms
        Of the spline.
    lo, hi : ndarray, shape (n+1, boxes) [s]
        The boxes.
    boxes : TimeBoxes
        The same.
    x : ndarray, shape (n+1, joints) [rad]
        Waypoints.
    wanted : ndarray of bool, shape (boxes, joints)
        Which joints; zeros stand in for the others.

    Returns
    -------
    Interpolation
        Over the boxes.
    """
    n, (count, joints) = forms.n, wanted.shape
    rows, rest, fit = collocation(forms, lo, hi, boxes)
    inner = slice(3, n + 2)
    rows[~fit], rest[~fit] = 0.0, 0.0
    rows[~fit, :, inner, 0] = np.eye(n - 1)
    Y = _about_inverse(rows[:, :, inner, 0])
    alternating = np.zeros(n + 1)
    alternating[1:n] = (-1.0) ** np.arange(n - 1)
    points, motion, sigma = _solve(forms, rows, rest, Y, alternating)
    worst = sigma.max(axis=1, initial=0.0)
    fit = fit & (worst < _DOUBT)
    far = (np.abs(points[:, inner]) + size(motion[:, inner], axis=2)) * GROW
    inverse = far / np.where(fit, 1.0 - worst, 1.0)[:, None] * GROW
    found = Interpolation(
        rows, rest, Y, inverse, fit,
        np.zeros((count, joints, n + 5)), np.zeros((count, joints, n + 5, forms.of.K)),
        np.zeros((count, joints, n - 1)),
    )  # fmt: skip
    for j in range(joints):
        some = np.flatnonzero(wanted[:, j])
        if len(some):
            solution = _solve(forms, rows[some], rest[some], Y[some], x[:, j])
            for into, values in zip((found.points, found.motion, found.sigma), solution, strict=True):
                into[some, j] = values
    return found


def _about_inverse(matrices: Any) -> Any:
    """Inverses of matrices in floats; zeros, which prove nothing, for one that is singular in floats."""
    try:
        return np.linalg.inv(matrices)
    except np.linalg.LinAlgError:
        if len(matrices) == 1:
            return np.zeros_like(matrices)
        return np.concatenate([_about_inverse(one[None]) for one in matrices])


def collocation(forms: Forms, lo: Any, hi: Any, boxes: TimeBoxes) -> tuple[Any, Any, Any]:
    """Model the basis functions at the inner waypoints.

    Where a waypoint may lie in several spans, the model of the polynomial in one of them is widened to
    hold those of the others.

    Parameters
    ----------
    forms, lo, hi, boxes
        As in ``interpolation``.

    Returns
    -------
    rows : ndarray, shape (boxes, n-1, n+5, K)
        Terms.
    rest : ndarray, shape (boxes, n-1, n+5)
        Rests.
    fit : ndarray of bool, shape (boxes,)
        Whether there are such models.
    """
    n, degree, count = forms.n, forms.degree, lo.shape[1]
    rows = np.zeros((count, n - 1, n + 5, forms.of.K))
    rest = np.zeros((count, n - 1, n + 5))
    fit = np.ones(count, bool)
    first, last, middle = _spans(forms, lo, hi, boxes)

    def at(box: Any, i: Any, k: Any) -> tuple[Any, Any]:
        there = boxes.take(box)
        element = np.arange(len(box))
        slopes = np.zeros((n - 1, len(box)))
        slopes[i, element] = degree * there.h[i + 1, element]
        point = degree * there.c[i + 1, element], slopes
        terms, rests, good = basis(forms, there, k, 0, point)
        np.logical_and.at(fit, box, good)
        where = element[:, None], k[:, None] + np.arange(degree + 1)
        full, full_rest = np.zeros((len(box), n + 5, forms.of.K)), np.zeros((len(box), n + 5))
        full[where], full_rest[where] = terms.transpose(2, 1, 0), rests.T
        return full, full_rest

    for i in range(n - 1):
        rows[:, i], rest[:, i] = at(np.arange(count), np.full(count, i), middle[i])
    for k in range(forms.spans):
        which, box = np.nonzero((first <= k) & (k <= last) & (middle != k))
        if len(box):
            other, other_rest = at(box, which, np.full(len(box), k))
            row = rows[box, which]
            far = size(other - row, axis=2) + other_rest
            far += ERR * (size(other, axis=2) + size(row, axis=2))
            rest[box, which] = np.maximum(rest[box, which], far * GROW)
    return rows, rest, fit


def _spans(forms: Forms, lo: Any, hi: Any, boxes: TimeBoxes) -> tuple[Any, Any, Any]:
    """First and last span that each inner waypoint may lie in, and the one in the middle of the box."""
    n = forms.n
    slack = 1e-12 * forms.degree * hi[n]  # for rounding
    first, last, middle = (np.zeros((n - 1, lo.shape[1]), int) for _ in range(3))
    last += forms.spans - 1
    for i in range(1, n):
        for k in range(1, forms.spans):
            form = forms.degree * np.eye(n + 1)[i] - forms.knots[k]
            up, down = np.maximum(form, 0.0), np.minimum(form, 0.0)
            first[i - 1][up @ lo + down @ hi > slack] = k
            most = up @ hi + down @ lo
            last[i - 1] = np.where(most < -slack, np.minimum(last[i - 1], k - 1), last[i - 1])
            middle[i - 1][form @ boxes.c > 0.0] = k
    return first, last, np.clip(middle, first, last)


def _solve(forms: Forms, rows: Any, rest: Any, Y: Any, x: Any) -> tuple[Any, Any, Any]:
    """Polynomials for the data x (n+1,) at the waypoints, and bounds of what they miss."""
    of, n, count = forms.of, forms.n, len(rows)
    inner = slice(3, n + 2)
    points = np.empty((count, n + 5))
    points[:] = x[np.clip(np.arange(-2, n + 3), 0, n)]
    motion = np.zeros((count, n + 5, of.K))
    for _ in range(3):  # Newton steps
        away = x[None, 1:n, None] - points[:, None, :]
        missed = (away * rows[..., 0]).sum(axis=2)
        points[:, inner] += np.matmul(Y, missed[:, :, None])[:, :, 0]
    away = x[None, 1:n, None] - points[:, None, :]
    missed = np.matmul(away[:, :, None, :], rows)[:, :, 0, :]
    inward = rows[:, :, inner].swapaxes(2, 3)  # (boxes, n-1, K, n-1)
    m, k = of.m, of.square.stop - of.square.start
    flat = [
        inward[:, :, s].reshape(count, m * width, m) for s, width in ((of.linear, m), (of.square, k))
    ]
    p1 = motion[:, inner, of.linear] = np.matmul(Y, missed[..., of.linear])
    bent = of.squares_of(np.matmul(flat[0], p1).reshape(count, n - 1, m, m))
    p2 = motion[:, inner, of.square] = np.matmul(Y, missed[..., of.square] - bent)
    full = np.matmul(flat[0], p2).reshape(count, n - 1, m, k)
    full += np.matmul(flat[1], p1).reshape(count, n - 1, k, m).swapaxes(2, 3)
    motion[:, inner, of.cube] = np.matmul(Y, missed[..., of.cube] - of.cubes_of(full))
    # any polynomials will do: from here on it is a matter of proof
    terms, more = sum_of_products(of, rows, rest, away, -motion)
    return points, motion, (size(terms, axis=2) + more) * GROW + TINY
