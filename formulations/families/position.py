"""Compiled position limits of polynomial pieces: how far a candidate leaves them, and whether it does."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.families.polynomial import (
    WIDTH,
    bracketed_roots,
    closed_form_roots,
    derivative,
    value,
)


@compiled
def position_excess(coefficients: Any, degrees: Any, bounds: Any, out: Any) -> None:
    """Compute how far each candidate leaves its position bounds; no stretch changes it.

    Parameters
    ----------
    coefficients, degrees : array
        As in ``polynomial.peaks``.
    bounds : array, shape (dof, 2)
        Least and greatest position of each joint [rad].
    out : array, shape (n,)
        Is filled with the largest excess [rad], 0 for a candidate that stays inside.
    """
    n, n_segments, dof, _ = coefficients.shape
    work = np.zeros((7, WIDTH))
    for i in range(n):
        worst = 0.0
        for j in range(dof):
            low, high = bounds[j]
            if low == -inf and high == inf:
                continue
            for k in range(n_segments):
                worst = max(worst, _piece_excess(coefficients[i, k, j], degrees[k], low, high, work))
        out[i] = worst


@compiled
def _piece_excess(c: Any, degree: int, low: float, high: float, work: Any) -> float:
    """Compute how far a piece leaves an interval after its start, exactly; 0 if it stays inside."""
    velocity, acceleration, jerk = work[0], work[1], work[2]
    derivative(c, degree, velocity)
    derivative(velocity, degree - 1, acceleration)
    if degree == 3:
        n_roots = closed_form_roots(velocity, 2, work[5])
    else:
        if degree == 4:
            n_turns = closed_form_roots(acceleration, 2, work[4])
        else:
            derivative(acceleration, 3, jerk)
            n_jerk = closed_form_roots(jerk, 2, work[3])
            n_turns = bracketed_roots(acceleration, 3, work[3], n_jerk, work[4])
        n_roots = bracketed_roots(velocity, degree - 1, work[4], n_turns, work[5])
    worst = 0.0
    for r in range(n_roots + 1):
        x = value(c, degree, work[5, r] if r < n_roots else 1.0)
        worst = max(worst, low - x, x - high)
    return worst


@compiled
def _inside(b0: float, b1: float, b2: float, b3: float, low: float, high: float) -> bool:
    """Whether four numbers lie in an interval; false for NaN."""
    return low <= b0 <= high and low <= b1 <= high and low <= b2 <= high and low <= b3 <= high


@compiled
def stays_inside(i: int, coefficients: Any, degrees: Any, bounds: Any, work: Any) -> bool:
    """Tell whether one candidate leaves its position bounds by no more than the slack.

    Most pieces are cleared by their Bernstein coefficients, which may use half of the slack: the other half
    is far more than rounding. The others are judged as in ``position_excess``.

    Parameters
    ----------
    i : int
        The candidate.
    coefficients, degrees : array
        As in ``position_excess``.
    bounds : array, shape (dof, 3)
        Least and greatest position of each joint, and the slack [rad].
    work : array, shape (7, WIDTH)
        Scratch.

    Returns
    -------
    bool
    """
    _, n_segments, dof, _ = coefficients.shape
    for j in range(dof):
        low, high, slack = bounds[j, 0], bounds[j, 1], bounds[j, 2]
        if low == -inf and high == inf:
            continue
        least, most = low - 0.5 * slack, high + 0.5 * slack
        for k in range(n_segments):
            c0, c1, c2 = coefficients[i, k, j, 0], coefficients[i, k, j, 1], coefficients[i, k, j, 2]
            c3, c4, c5 = coefficients[i, k, j, 3], coefficients[i, k, j, 4], coefficients[i, k, j, 5]
            b1, b2 = c0 + 0.2 * c1, c0 + 0.4 * c1 + 0.1 * c2
            b3 = c0 + 0.6 * c1 + 0.3 * c2 + 0.1 * c3
            b4 = c0 + 0.8 * c1 + 0.6 * c2 + 0.4 * c3 + 0.2 * c4
            b5 = c0 + c1 + c2 + c3 + c4 + c5
            if _inside(b1, b2, b3, b4, least, most) and _inside(c0, c0, b5, b5, least, most):
                continue
            if _piece_excess(coefficients[i, k, j], degrees[k], low, high, work) > slack:
                return False
    return True
