"""Exact extremes of piecewise polynomials, from the roots of their derivatives and never from samples.

A derivative whose Bernstein coefficients on the piece have one sign has no root inside (Descartes' rule of
signs), so that the extremes are at the ends. Most pieces of a densely sampled motion are of this kind. Of the
others, linear and quadratic derivatives have closed forms; the rest are roots by eigenvalues, polished by
Newton.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Any

import numpy as np
from numpy.typing import NDArray

from formulations.problem.arrays import Array

_BLOCK = 1 << 13  # polynomials that are looked at together: they stay in the cache


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
        # a row per power: the steps below then run over contiguous numbers
        rows = np.ascontiguousarray(flat[block].T)
        _extremes_of(differentiated(rows.T, order).T, found[:, block])
    values, times = found.reshape(2, 2, *shape)
    seconds, start = durations[:, None], breaks[:-1, None]
    values /= seconds**order
    times *= seconds
    times += start
    return Extremes(low=values[0], high=values[1], time_low=times[0], time_high=times[1])


def _extremes_of(rows: Array, out: Array) -> None:
    """Least and greatest value on [0, 1], and where they are taken, of polynomials (k, m): into (4, m)."""
    at_start, at_end = rows[0], rows[-1].copy()
    for row in rows[-2::-1]:
        at_end += row
    np.minimum(at_start, at_end, out=out[0])
    np.maximum(at_start, at_end, out=out[1])
    np.less(at_end, at_start, out=out[2])
    np.greater(at_end, at_start, out=out[3])
    slopes = differentiated(rows.T, 1).T
    turning = np.flatnonzero(_may_turn(slopes))
    if len(turning):
        polynomials = rows[:, turning].T
        candidates = _turning_points(slopes[:, turning].T)
        values = evaluated(polynomials, candidates)
        for value, place in zip(values.T, candidates.T, strict=True):
            for k, better in ((0, np.less), (1, np.greater)):
                beats = better(value, out[k, turning])
                chosen = turning[beats]
                out[k, chosen], out[k + 2, chosen] = value[beats], place[beats]


def _may_turn(slopes: Array) -> Array:
    """Whether each of the polynomials (k, m) may have a root in [0, 1], (m,).

    It has none if its Bernstein coefficients are all positive or all negative beyond rounding, nor a
    change of sign if they are all zero.
    """
    degree = len(slopes) - 1
    bernstein = [row / comb(degree, k) for k, row in enumerate(slopes)]
    for step in range(degree):  # sums of binomials times the rows, by additions alone
        for k in range(degree, step, -1):
            bernstein[k] += bernstein[k - 1]
    low, high = bernstein[0].copy(), bernstein[0].copy()
    for row in bernstein[1:]:
        np.minimum(low, row, out=low)
        np.maximum(high, row, out=high)
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


def roots_of(polynomials: Array) -> NDArray[Any]:
    """Find all roots of polynomials of one degree as eigenvalues of their companion matrices.

    Parameters
    ----------
    polynomials : Array, shape (m, degree + 1)
        Ascending coefficients; the last ones are not zero.

    Returns
    -------
    ndarray, shape (m, degree)
        Real or complex roots, in no order.

    Raises
    ------
    numpy.linalg.LinAlgError
        If a quotient of coefficients is not finite.
    """
    degree = polynomials.shape[1] - 1
    companion = np.zeros((len(polynomials), degree, degree))
    companion[:, 1:, :-1] = np.eye(degree - 1)
    companion[:, :, -1] = -polynomials[:, :-1] / polynomials[:, -1:]
    return np.linalg.eigvals(companion)


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
        roots = roots_of(rows[mine, : degree + 1]).real.clip(0.0, 1.0)
        slopes = differentiated(rows[mine], 1)
        for _ in range(3):
            step = evaluated(rows[mine], roots) / evaluated(slopes, roots)
            roots = np.clip(np.where(np.isfinite(step), roots - step, roots), 0.0, 1.0)
        found[mine, :degree] = roots
    return found
