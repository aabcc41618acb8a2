"""Exact extremes of piecewise polynomials, from the roots of their derivatives and never from samples.

Linear and quadratic derivatives have closed forms; others are roots by eigenvalues, polished by Newton.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.problem.arrays import Array


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
    value = differentiated(pieces, order)
    ends = np.broadcast_to([0.0, 1.0], (*value.shape[:2], 2))
    candidates = np.concatenate([ends, _turning_points(differentiated(value, 1))], axis=2)
    values = evaluated(value, candidates) / durations[:, None, None] ** order
    lowest, highest = values.argmin(axis=2)[..., None], values.argmax(axis=2)[..., None]
    times = breaks[:-1, None, None] + candidates * durations[:, None, None]
    return Extremes(
        low=np.take_along_axis(values, lowest, 2)[..., 0],
        high=np.take_along_axis(values, highest, 2)[..., 0],
        time_low=np.take_along_axis(times, lowest, 2)[..., 0],
        time_high=np.take_along_axis(times, highest, 2)[..., 0],
    )


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
    values = np.zeros_like(points)
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
