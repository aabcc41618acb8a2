"""Lower bounds of sums of limits over boxes of waypoint times.

A limit on derivative ``order`` of a joint at a share of a knot span reads g = sign A c - limit <= 0, where A
holds derivatives of the basis functions. With c = p + zeta and N zeta = sigma (``interpolation``),

    A c = A p + w sigma + (A - w N) zeta,   |zeta| <= |N^-1| 1 max |sigma|,

for any w; w = A N^-1 to first order in e makes the last term small. If a sum of g with multipliers >= 0 is
positive all over a box, every B-spline with times in it breaks a limit.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from compare.check_certificate.families.b_spline.interpolation import Interpolation, interpolation
from compare.check_certificate.families.b_spline.knots import Forms, TimeBoxes, basis, boxes_of
from compare.check_certificate.families.b_spline.taylor import (
    ERR,
    GROW,
    TINY,
    Monomials,
    size,
    sum_of_products,
)


class SplineLimits(NamedTuple):
    """What a B-spline must keep, of the moving joints: arrays of floats.

    x (n+1, joints): waypoints [rad]. level (4, joints, 2): the limit per order, joint, and sign -1 or
    1, rounded up; positions are measured from the first waypoint. It is inf where there is none.
    """

    x: Any
    level: Any


class SumRows(NamedTuple):
    """SumRows of sums; arrays of one length, sorted by the sum that they belong to.

    total, joint, span, order, sign: int. place, multiplier: float.
    """

    total: Any
    joint: Any
    span: Any
    order: Any
    sign: Any
    place: Any
    multiplier: Any


class Sums(NamedTuple):
    """Models of sums: terms (K, sums), rest (sums,), fit (sums,), and the boxes they hold on."""

    terms: Any
    rest: Any
    fit: Any
    boxes: TimeBoxes


@np.errstate(all="ignore")  # what overflows is not finite in the end and proves nothing
def sums_of(forms: Forms, limits: SplineLimits, lo: Any, hi: Any, rows: SumRows) -> Sums:
    """Model sums of limits, each over a box of its own.

    Parameters
    ----------
    forms : Forms
        Of the spline.
    limits : SplineLimits
        The task.
    lo, hi : ndarray, shape (n+1, sums) [s]
        The boxes.
    rows : SumRows
        The rows; every sum has some.

    Returns
    -------
    Sums
        ``fit`` is False where there is no model.
    """
    count, boxes = lo.shape[1], boxes_of(lo, hi)
    wanted = np.zeros((count, limits.x.shape[1]), bool)
    wanted[rows.total, rows.joint] = True
    known = interpolation(forms, lo, hi, boxes, limits.x, wanted)
    terms, rest = np.zeros((len(rows.total), forms.of.K)), np.zeros(len(rows.total))
    fit = known.fit.copy()
    for order in range(4):
        of_order = np.flatnonzero(rows.order == order)
        for some in np.array_split(of_order, -(-len(of_order) // count)) if len(of_order) else ():
            part = SumRows(*(values[some] for values in rows))
            terms[some], rest[some], good = _limits_of_order(forms, limits, boxes, order, part, known)
            np.logical_and.at(fit, part.total, good)
    scaled = rows.multiplier[:, None] * terms
    starts = np.searchsorted(rows.total, np.arange(count))
    whole = np.add.reduceat(size(scaled, axis=1), starts)
    rest = np.add.reduceat(rows.multiplier * rest, starts) * GROW + ERR * whole + TINY
    return Sums(np.add.reduceat(scaled, starts, axis=0).T, rest, fit, boxes)


def _limits_of_order(
    forms: Forms,
    limits: SplineLimits,
    boxes: TimeBoxes,
    order: int,
    rows: SumRows,
    known: Interpolation,
) -> tuple[Any, Any, Any]:
    """Model limits on one derivative: terms (rows, K), rest (rows,), fit (rows,)."""
    n, of = forms.n, forms.of
    there, element = boxes.take(rows.total), np.arange(len(rows.total))
    ends = forms.knots[rows.span].T, forms.knots[rows.span + 1].T
    form = ends[0] + rows.place * (ends[1] - ends[0])
    point = (form * there.c).sum(axis=0), form[1:n] * there.h[1:n]
    a, a_rest, fit = basis(forms, there, rows.span, order, point)
    a = np.where(fit[:, None, None], a.transpose(2, 1, 0), 0.0)
    a_rest = np.where(fit[:, None], a_rest.T, 0.0)
    near = rows.span[:, None] + np.arange(forms.degree + 1)
    p = known.points[rows.total[:, None], rows.joint[:, None], near]
    motion = known.motion[rows.total[:, None], rows.joint[:, None], near]
    # derivatives of the functions add up to 0, the functions to 1: any origin will do for the former
    origin = p[:, 0] if order else limits.x[0, rows.joint]
    away = p - origin[:, None]
    terms, rest = sum_of_products(of, a[:, None], a_rest[:, None], away[:, None, :], motion)
    terms, rest = rows.sign[:, None] * terms[:, 0], rest[:, 0]
    full, full_rest = np.zeros((len(element), n + 5, of.K)), np.zeros((len(element), n + 5))
    full[element[:, None], near], full_rest[element[:, None], near] = a, a_rest
    inner = slice(3, n + 2)
    rest = rest + _beyond(of, full[:, inner], full_rest[:, inner], rows, known, inner)
    level = limits.level[order, rows.joint, (rows.sign + 1) // 2]
    terms[:, 0] -= level
    rest = rest + ERR * (level + np.abs(terms[:, 0]))
    return terms, rest * GROW, fit


def _beyond(
    of: Monomials, a: Any, a_rest: Any, rows: SumRows, known: Interpolation, inner: slice
) -> Any:
    """Bound |w sigma| + |A - w N| |N^-1| 1 max |sigma|; a (rows, n-1, K), inner functions alone."""
    m, count, lower = of.m, len(a), of.square.stop
    N, N_rest = known.rows[rows.total][:, :, inner], known.rest[rows.total][:, :, inner]
    Y, sigma = known.Y[rows.total], known.sigma[rows.total, rows.joint]
    w = np.matmul(a[:, None, :, 0], Y)  # (rows, 1, n-1)
    wN = np.matmul(w, N.reshape(count, m, m * of.K)).reshape(count, m, of.K)
    bend = np.matmul((a - wN)[..., of.linear].swapaxes(1, 2), Y)  # (rows, m, n-1): slopes of w
    left = a - wN
    turned = np.matmul(bend, N[..., :lower].reshape(count, m, m * lower))
    turned = turned.reshape(count, m, m, lower).swapaxes(1, 2)  # (rows, l, m, terms)
    left[..., of.linear] -= turned[..., 0]
    left[..., of.square] -= of.squares_of(turned[..., of.linear])
    left[..., of.cube] -= of.cubes_of(turned[..., of.square])
    w, vary = np.abs(w[:, 0, :]), size(bend, axis=1)
    beyond = size(left, axis=2) + a_rest
    sizes = size(N, axis=3)
    beyond += ((w + vary)[:, :, None] * (N_rest + ERR * sizes)).sum(axis=1)
    beyond += (vary[:, :, None] * size(N[..., of.cube], axis=3)).sum(axis=1) + ERR * size(a, axis=2)
    zeta = known.inverse[rows.total] * sigma.max(axis=1, initial=0.0)[:, None]
    return (((w + vary) * sigma).sum(axis=1) + (beyond * zeta).sum(axis=1)) * GROW


@np.errstate(all="ignore")
def least_of(of: Monomials, sums: Sums, which: Any, k: Any, lo: Any, hi: Any) -> Any:
    """Bound sums from below over slabs of their boxes.

    |e_q e_r| <= (e_q^2 + e_r^2) / 2 and |e_q e_r e_s| <= (e_q^2 + e_r^2 + e_s^2) / 3 on the box, so a
    sum of quadratics in one variable each lies below the model.

    Parameters
    ----------
    of : Monomials
        The variables.
    sums : Sums
        Of limits.
    which : ndarray of int, shape (discards,)
        Which sum.
    k : ndarray of int, shape (discards,)
        The waypoint whose time is restricted; 0: none.
    lo, hi : ndarray, shape (discards,) [s]
        To what.

    Returns
    -------
    ndarray, shape (discards,)
        Lower bounds; -inf where a sum has no model.
    """
    terms, rest = sums.terms[:, which], sums.rest[which]
    below, above = np.full((of.m, len(which)), -1.0), np.ones((of.m, len(which)))
    some = np.flatnonzero((k > 0) & (sums.boxes.h[k, which] > 0.0))
    c, h = (values[k[some], which[some]] for values in sums.boxes)
    below[k[some] - 1, some] = np.maximum((lo[some] - c) / h - 2.0**-50, -1.0)
    above[k[some] - 1, some] = np.minimum((hi[some] - c) / h + 2.0**-50, 1.0)
    bend = -GROW * (of.share.T @ np.abs(terms[of.cube]))
    for (q, r), square in zip(of.of_square, terms[of.square], strict=True):
        if q == r:
            bend[q] += square
        else:
            bend[q] -= 0.5 * np.abs(square)
            bend[r] -= 0.5 * np.abs(square)
    slope = terms[of.linear]
    least = np.minimum(slope * below + bend * below**2, slope * above + bend * above**2)
    place = -0.5 * slope / np.where(bend > 0.0, bend, 1.0)
    vertex = (bend > 0.0) & (below < place) & (place < above)
    least = np.where(vertex, 0.5 * slope * place, least)
    bound = terms[0] + least.sum(axis=0) - (rest + ERR * size(terms)) * GROW - TINY
    return np.where(sums.fit[which] & np.isfinite(bound), bound, -np.inf)
