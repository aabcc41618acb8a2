"""Motions of other programs as exact polynomial pieces."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from math import factorial

import numpy as np
from numpy.polynomial import Polynomial

from formulations import Trajectory
from formulations.problem.arrays import Array


def from_derivatives(value: Callable[[float, int], Array], breaks: Array, degree: int) -> Trajectory:
    """Make pieces of a piecewise polynomial that can only be evaluated.

    Taylor's series about the middle of each piece is exact, and is moved to the start of the piece.

    Parameters
    ----------
    value : callable
        ``(time, order)``: the derivative of that order, shape (dof,) [rad/s^order].
    breaks : Array, shape (n_pieces + 1,) [s]
        Where its polynomials meet, increasing.
    degree : int
        Of its polynomials.

    Returns
    -------
    Trajectory
    """
    pieces = []
    for start, end in itertools.pairwise(breaks):
        middle = 0.5 * (start + end)
        terms = [np.asarray(value(middle, k)).ravel() / factorial(k) for k in range(degree + 1)]
        pieces.append([shifted(series, start - middle) for series in np.stack(terms, axis=1)])
    return Trajectory(np.diff(breaks), np.array(pieces))


def along(path: Trajectory, pace: Trajectory) -> Trajectory:
    """Make the motion q(s(t)) of a path q(s) and a parameter s(t).

    Parameters
    ----------
    path : Trajectory
        Its time is the path parameter.
    pace : Trajectory
        One joint: the path parameter over time [s], increasing from 0 to the end of the path.

    Returns
    -------
    Trajectory
        Exact pieces, which meet where those of the path or of the pace meet.
    """
    degree = (path.coefficients.shape[2] - 1) * (pace.coefficients.shape[2] - 1)
    durations, pieces = [], []
    for _start, duration, series in zip(
        pace.breaks, pace.durations, pace.coefficients[:, 0], strict=False
    ):
        s = Polynomial(series)
        low, high = s(0.0), s(duration)
        crossed = path.breaks[(path.breaks > low) & (path.breaks < high)]
        cuts = np.array([0.0, *(_time_at(s, value, duration) for value in crossed), duration])
        for begin, end in itertools.pairwise(cuts):
            if end - begin <= 1e-12 * pace.seconds:  # rounding between two breaks at the same place
                continue
            at = s(0.5 * (begin + end))
            index = int(np.clip(np.searchsorted(path.breaks, at) - 1, 0, len(path.durations) - 1))
            inner = s(Polynomial([begin, 1.0])) - path.breaks[index]
            rows = np.zeros((path.dof, degree + 1))
            for joint, outer in enumerate(path.coefficients[index]):
                found = Polynomial(outer)(inner).coef
                rows[joint, : len(found)] = found
            durations.append(end - begin)
            pieces.append(rows)
    return Trajectory(np.array(durations), np.array(pieces))


def shifted(series: Array, by: float) -> Array:
    """Move a polynomial along its axis.

    Parameters
    ----------
    series : Array, shape (n,)
        Coefficients of p, ascending.
    by : float

    Returns
    -------
    Array, shape (n,)
        Coefficients of p(t + by).
    """
    found = np.zeros(len(series))
    moved = Polynomial(series)(Polynomial([by, 1.0])).coef
    found[: len(moved)] = moved
    return found


def _time_at(s: Polynomial, value: float, duration: float) -> float:
    """When an increasing polynomial has a value between those at 0 and at the duration."""
    roots = (s - value).roots()
    real = roots.real[np.abs(roots.imag) < 1e-9 * (1.0 + np.abs(roots.real))]
    return float(np.clip(real[np.abs(real - 0.5 * duration).argmin()], 0.0, duration))
