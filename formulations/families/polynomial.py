"""Compiled exact extremes of polynomial pieces of degree 3 to 5, and the least feasible stretch.

A piece is p(s) = sum c[i] s^i on normalised time s = t / T in [0, 1]; velocity is p'(s)/T,
acceleration p''(s)/T^2, jerk p'''(s)/T^3. The roots of each derivative are bracketed by those of the
next one, the last of which is linear or quadratic. Nothing is sampled.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any

import numpy as np

from formulations.compiled import compiled

WIDTH = 6  # coefficients per piece: degree 5 at most


@compiled
def _value(q: Any, degree: int, s: float) -> float:
    y = q[degree]
    for i in range(degree - 1, -1, -1):
        y = y * s + q[i]
    return y


@compiled
def _derivative(q: Any, degree: int, out: Any) -> None:
    for i in range(degree):
        out[i] = (i + 1) * q[i + 1]


@compiled
def _closed_form_roots(q: Any, degree: int, roots: Any) -> int:
    """Roots in (0, 1) of a polynomial of degree 1 or 2, ascending."""
    count = 0
    if degree == 2 and q[2] != 0.0:
        discriminant = q[1] * q[1] - 4.0 * q[2] * q[0]
        if discriminant < 0.0:
            return 0
        # the form that does not cancel: r1 = h / q2, r2 = q0 / h
        h = -0.5 * (q[1] + (sqrt(discriminant) if q[1] >= 0.0 else -sqrt(discriminant)))
        r1 = h / q[2]
        r2 = q[0] / h if h != 0.0 else r1
        if r1 > r2:
            r1, r2 = r2, r1
        if 0.0 < r1 < 1.0:
            roots[0] = r1
            count = 1
        if 0.0 < r2 < 1.0 and r2 != r1:
            roots[count] = r2
            count += 1
    elif q[1] != 0.0:
        r = -q[0] / q[1]
        if 0.0 < r < 1.0:
            roots[0] = r
            count = 1
    return count


@compiled
def _bracketed_roots(q: Any, degree: int, turns: Any, n_turns: int, roots: Any) -> int:
    """Find the roots in (0, 1) of q, which is monotone between its turning points, by safeguarded Newton."""
    count = 0
    low, f_low = 0.0, q[0]
    for k in range(n_turns + 1):
        high = turns[k] if k < n_turns else 1.0
        f_high = _value(q, degree, high)
        if f_high == 0.0 and high < 1.0:
            roots[count] = high
            count += 1
        elif f_low * f_high < 0.0:
            a, b = low, high
            x = a + (b - a) * f_low / (f_low - f_high)
            for _ in range(60):
                y, slope = q[degree], 0.0
                for i in range(degree - 1, -1, -1):
                    slope = slope * x + y
                    y = y * x + q[i]
                if y * f_low > 0.0:
                    a = x
                else:
                    b = x
                step = y / slope if slope != 0.0 else inf
                new = x - step
                if not (a < new < b):
                    new = 0.5 * (a + b)
                if abs(new - x) <= 1e-9:  # quadratic convergence: the next error is its square
                    x = new
                    break
                x = new
            roots[count] = x
            count += 1
        low, f_low = high, f_high
    return count


@compiled
def _peak(q: Any, degree: int, turns: Any, n_turns: int) -> float:
    peak = max(abs(q[0]), abs(_value(q, degree, 1.0)))
    for k in range(n_turns):
        peak = max(peak, abs(_value(q, degree, turns[k])))
    return peak


@compiled
def _velocity_hull(c: Any) -> float:
    """Bound |p'| on [0, 1] by its largest Bernstein coefficient, p of degree 5 at most."""
    v1, v2, v3, v4 = 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 5.0 * c[5]
    return max(
        abs(c[1]),
        abs(c[1] + 0.25 * v1),
        abs(c[1] + 0.5 * v1 + v2 / 6.0),
        abs(c[1] + 0.75 * v1 + 0.5 * v2 + 0.25 * v3),
        abs(c[1] + v1 + v2 + v3 + v4),
    )


@compiled
def _acceleration_hull(c: Any) -> float:
    """Bound |p''| on [0, 1] by its largest Bernstein coefficient."""
    a0, a1, a2, a3 = 2.0 * c[2], 6.0 * c[3], 12.0 * c[4], 20.0 * c[5]
    return max(
        abs(a0),
        abs(a0 + a1 / 3.0),
        abs(a0 + (2.0 * a1 + a2) / 3.0),
        abs(a0 + a1 + a2 + a3),
    )


@compiled
def _jerk_peak(c: Any) -> float:
    """Compute the exact peak on [0, 1] of the third derivative, a quadratic."""
    j0, j1, j2 = 6.0 * c[3], 24.0 * c[4], 60.0 * c[5]
    peak = max(abs(j0), abs(j0 + j1 + j2))
    s = -0.5 * j1 / j2 if j2 != 0.0 else 0.0
    return max(peak, abs(j0 + s * (j1 + s * j2))) if 0.0 < s < 1.0 else peak


@compiled
def _acceleration_peak(c: Any, degree: int, work: Any) -> float:
    """Compute the exact peak on [0, 1] of the second derivative; it turns where the jerk is zero.

    The derivatives are left in work[0:3], the jerk's roots in work[4] and their number in work[6, 0].
    """
    velocity, acceleration, jerk, jerk_roots = work[0], work[1], work[2], work[4]
    _derivative(c, degree, velocity)
    _derivative(velocity, degree - 1, acceleration)
    _derivative(acceleration, degree - 2, jerk)
    n_jerk = _closed_form_roots(jerk, degree - 3, jerk_roots) if degree > 3 else 0
    work[6, 0] = n_jerk
    return _peak(acceleration, degree - 2, jerk_roots, n_jerk)


@compiled
def _velocity_peak(degree: int, work: Any) -> float:
    """Compute the exact peak of the first derivative, after ``_acceleration_peak`` of the same piece."""
    velocity, acceleration, jerk_roots, roots = work[0], work[1], work[4], work[5]
    if degree < 5:
        n_roots = _closed_form_roots(acceleration, degree - 2, roots)
    else:
        n_roots = _bracketed_roots(acceleration, 3, jerk_roots, int(work[6, 0]), roots)
    return _peak(velocity, degree - 1, roots, n_roots)


@compiled
def peaks(coefficients: Any, degrees: Any, durations: Any, out: Any) -> None:
    """Compute the exact peaks of |velocity|, |acceleration| and |jerk| of a whole population.

    Parameters
    ----------
    coefficients : array, shape (n, n_pieces, dof, WIDTH)
        Ascending, on normalised time [rad].
    degrees : array of int, shape (n_pieces,)
        Degree of each piece.
    durations : array, shape (n, n_pieces)
        Lengths of the pieces [s].
    out : array, shape (n, dof, 3)
        Is filled with the peaks [rad/s, rad/s^2, rad/s^3].
    """
    n, n_segments, dof, _ = coefficients.shape
    work = np.zeros((7, WIDTH))
    out[:] = 0.0
    for i in range(n):
        for j in range(dof):
            for k in range(n_segments):
                c, rate = coefficients[i, k, j], 1.0 / durations[i, k]
                acceleration = _acceleration_peak(c, degrees[k], work)
                velocity = _velocity_peak(degrees[k], work)
                out[i, j, 0] = max(out[i, j, 0], velocity * rate)
                out[i, j, 1] = max(out[i, j, 1], acceleration * rate * rate)
                out[i, j, 2] = max(out[i, j, 2], _jerk_peak(c) * rate * rate * rate)


@compiled
def stretch(coefficients: Any, degrees: Any, durations: Any, limits: Any, out: Any) -> None:
    """Compute the least factor on all durations that makes each candidate keep its derivative limits.

    A stretch by f divides velocity by f, acceleration by f^2 and jerk by f^3. A quantity is skipped if its
    Bernstein coefficients prove that it cannot raise the factor found so far. The search starts with the
    joint that decided for the candidate before, so that most quantities are skipped.

    Parameters
    ----------
    coefficients, degrees, durations : array
        As in ``peaks``.
    limits : array, shape (3, dof)
        Limits of velocity, acceleration and jerk [rad/s, rad/s^2, rad/s^3], infinite if there is none.
    out : array, shape (n,)
        Is filled with the factors.
    """
    n, n_segments, dof, _ = coefficients.shape
    work = np.zeros((7, WIDTH))
    worst = 0
    for i in range(n):
        factor, first = 0.0, worst
        for turn in range(dof):
            j = (first + turn) % dof
            for k in range(n_segments):
                c, degree, duration = coefficients[i, k, j], degrees[k], durations[i, k]
                allowed_v = limits[0, j] * duration
                allowed_a = limits[1, j] * duration * duration
                allowed_j = limits[2, j] * duration * duration * duration
                needed = factor
                # written so that NaN counts as larger
                if allowed_j < inf and not _jerk_peak(c) <= needed * needed * needed * allowed_j:
                    needed = np.cbrt(_jerk_peak(c) / allowed_j)
                resolved = False
                if allowed_a < inf and not _acceleration_hull(c) <= needed * needed * allowed_a:
                    peak = _acceleration_peak(c, degree, work)
                    resolved = True
                    if not peak <= needed * needed * allowed_a:
                        needed = sqrt(peak / allowed_a)
                if not _velocity_hull(c) <= needed * allowed_v:
                    if not resolved:
                        _acceleration_peak(c, degree, work)
                    peak = _velocity_peak(degree, work)
                    if not peak <= needed * allowed_v:
                        needed = peak / allowed_v
                if not needed <= factor:
                    factor, worst = needed, j
        out[i] = factor


@compiled
def position_excess(coefficients: Any, degrees: Any, bounds: Any, out: Any) -> None:
    """Compute how far each candidate leaves its position bounds; no stretch changes it.

    Parameters
    ----------
    coefficients, degrees : array
        As in ``peaks``.
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
            if bounds[j, 0] == -inf and bounds[j, 1] == inf:
                continue
            for k in range(n_segments):
                c, degree = coefficients[i, k, j], degrees[k]
                velocity, acceleration, jerk = work[0], work[1], work[2]
                _derivative(c, degree, velocity)
                _derivative(velocity, degree - 1, acceleration)
                if degree == 3:
                    n_roots = _closed_form_roots(velocity, 2, work[5])
                else:
                    if degree == 4:
                        n_turns = _closed_form_roots(acceleration, 2, work[4])
                    else:
                        _derivative(acceleration, 3, jerk)
                        n_jerk = _closed_form_roots(jerk, 2, work[3])
                        n_turns = _bracketed_roots(acceleration, 3, work[3], n_jerk, work[4])
                    n_roots = _bracketed_roots(velocity, degree - 1, work[4], n_turns, work[5])
                for r in range(n_roots + 1):
                    x = _value(c, degree, work[5, r] if r < n_roots else 1.0)
                    worst = max(worst, bounds[j, 0] - x, x - bounds[j, 1])
        out[i] = worst
