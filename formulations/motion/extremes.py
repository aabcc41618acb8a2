"""Exact extremes of piecewise polynomials, from the roots of their derivatives and never from samples.

A derivative whose Bernstein coefficients on the piece have one sign has no root inside (Descartes' rule of
signs), so that the extremes are at the ends. Most pieces of a densely sampled motion are of this kind. Of the
others, linear and quadratic derivatives have closed forms; the rest are roots by eigenvalues, polished by
Newton.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

from formulations.problem.arrays import Array

_BLOCK = 1 << 15  # polynomials that are looked at together: they stay in the cache


@dataclass(frozen=True)
class Extremes:
    """Least and greatest value per piece and joint, and when they occur.

    Attributes
    ----------
    low, high : Array, shape (n_pieces, dof)
        The values [rad/s^order].
    time_low, time_high : Array, shape (n_pieces, dof)
        Their times from the start of the motion [s].
    """

    low: Array
    high: Array
    time_low: Array
    time_high: Array


def find_extremes(pieces: Array, durations: Array, breaks: Array, order: int) -> Extremes:
    """Find the exact extremes of a derivative on every piece.

    Parameters
    ----------
    pieces : Array, shape (n_pieces, dof, degree + 1)
        Ascending coefficients on normalised time s = t / T of each piece [rad].
    durations : Array, shape (n_pieces,)
        Duration T of each piece [s].
    breaks : Array, shape (n_pieces + 1,)
        Times at which the pieces meet [s].
    order : int
        Order of the derivative in time; 0 is the position.

    Returns
    -------
    Extremes
    """
    shape = pieces.shape[:2]
    flat = pieces.reshape(-1, pieces.shape[2])
    found = np.empty((4, len(flat)))
    for first in range(0, len(flat), _BLOCK):
        block = slice(first, first + _BLOCK)
        found[:, block] = _extremes_of(differentiated(flat[block], order))
    low, high, when_low, when_high = found.reshape(4, *shape)
    seconds, start = durations[:, None], breaks[:-1, None]
    return Extremes(
        low=low / seconds**order,
        high=high / seconds**order,
        time_low=start + when_low * seconds,
        time_high=start + when_high * seconds,
    )


def _extremes_of(polynomials: Array) -> Array:
    """Least and greatest value on [0, 1] of polynomials (m, k), and where they are taken, (4, m)."""
    at_start = polynomials[:, 0]
    at_end = evaluated(polynomials, np.ones((len(polynomials), 1)))[:, 0]
    found = np.stack(
        [
            np.minimum(at_start, at_end),
            np.maximum(at_start, at_end),
            at_end < at_start,
            at_end > at_start,
        ]
    )
    slopes = differentiated(polynomials, 1)
    rows = np.flatnonzero(_may_turn(slopes))
    if len(rows):
        ends = np.broadcast_to([0.0, 1.0], (len(rows), 2))
        candidates = np.concatenate([ends, _turning_points(slopes[rows])], axis=1)
        values = evaluated(polynomials[rows], candidates)
        each = np.arange(len(rows))
        for k, choice in enumerate((values.argmin(axis=1), values.argmax(axis=1))):
            found[k, rows], found[k + 2, rows] = values[each, choice], candidates[each, choice]
    return found


def _may_turn(slopes: Array) -> Array:
    """Whether each of the polynomials (m, k) may have a root in [0, 1], (m,).

    It has none if its Bernstein coefficients are all positive or all negative beyond rounding, nor a
    change of sign if they are all zero.
    """
    degree = slopes.shape[1] - 1
    to_bernstein = np.array(
        [[comb(i, k) / comb(degree, k) for k in range(degree + 1)] for i in range(degree + 1)]
    )
    bernstein = to_bernstein @ slopes.T
    low, high = bernstein.min(axis=0), bernstein.max(axis=0)
    # a power coefficient is at most 3^degree times the largest Bernstein coefficient
    rounding = (degree + 2) * 3.0**degree * np.finfo(np.float64).eps
    return np.asarray((low < rounding * high) & (high > rounding * low))


def differentiated(polynomials: Array, order: int) -> Array:
    """Differentiate polynomials; at least one coefficient is kept.

    Parameters
    ----------
    polynomials : Array, shape (..., n)
        Ascending coefficients.
    order : int
        How many times.

    Returns
    -------
    Array, shape (..., max(n - order, 1))
    """
    for _ in range(order):
        width = polynomials.shape[-1]
        if width == 1:
            return np.zeros_like(polynomials)
        polynomials = polynomials[..., 1:] * np.arange(1, width)
    return polynomials


def evaluated(polynomials: Array, points: Array) -> Array:
    """Evaluate polynomials by Horner's rule.

    Parameters
    ----------
    polynomials : Array, shape (..., n)
        Ascending coefficients.
    points : Array, shape (..., m)
        Places at which each polynomial is evaluated.

    Returns
    -------
    Array, shape (..., m)
    """
    values = np.zeros(points.shape)
    for k in range(polynomials.shape[-1] - 1, -1, -1):
        values = values * points + polynomials[..., k : k + 1]
    return values


def _turning_points(slopes: Array) -> Array:
    """Points of [0, 1] that include every root of the polynomials (..., k): (..., k - 1).

    Further points do no harm: a value taken anywhere on the piece never exceeds its extreme.
    """
    width = slopes.shape[-1]
    while width > 1 and not slopes[..., width - 1].any():
        width -= 1
    slopes = slopes[..., :width]
    if width == 1:
        return np.zeros((*slopes.shape[:-1], 0))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        if width == 2:
            roots = -slopes[..., :1] / slopes[..., 1:]
        elif width == 3:
            c, b, a = slopes[..., 0], slopes[..., 1], slopes[..., 2]
            h = -0.5 * (b + np.copysign(np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0)), b))
            roots = np.stack([h / a, c / h], axis=-1)
        else:
            flat = slopes.reshape(-1, width)
            roots = _companion_roots(flat).reshape(*slopes.shape[:-1], width - 1)
    return np.clip(np.nan_to_num(roots, nan=0.0), 0.0, 1.0)


def _companion_roots(rows: Array) -> Array:
    """Real parts of all roots of the polynomials (m, k), within [0, 1]: (m, k - 1), 0 where none.

    Eigenvalues of companion matrices, polished by Newton.
    """
    found = np.zeros((len(rows), rows.shape[1] - 1))
    # a leading coefficient within rounding of zero belongs to a root far outside [0, 1]
    size = np.abs(rows).max(axis=1, keepdims=True)
    significant = np.abs(rows) > 1e-15 * size
    degrees = np.where(
        significant.any(axis=1), rows.shape[1] - 1 - significant[:, ::-1].argmax(axis=1), 0
    )
    for degree in np.unique(degrees[degrees > 0]):
        mine = np.flatnonzero(degrees == degree)
        polynomials = rows[mine, : degree + 1]
        companion = np.zeros((len(mine), degree, degree))
        companion[:, 1:, :-1] = np.eye(degree - 1)
        companion[:, :, -1] = -polynomials[:, :-1] / polynomials[:, -1:]
        roots = np.linalg.eigvals(companion).real.clip(0.0, 1.0)
        slopes = differentiated(rows[mine], 1)
        for _ in range(3):
            step = evaluated(rows[mine], roots) / evaluated(slopes, roots)
            roots = np.clip(np.where(np.isfinite(step), roots - step, roots), 0.0, 1.0)
        found[mine, :degree] = roots
    return found
