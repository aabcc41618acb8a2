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
def value(q: Any, degree: int, s: float) -> float:
    """Evaluate a polynomial.

    Parameters
    ----------
    q : array
        Coefficients, ascending.
    degree : int
        Degree of q.
    s : float
        Where.

    Returns
    -------
    float
        q(s).
    """
    y = q[degree]
    for i in range(degree - 1, -1, -1):
        y = y * s + q[i]
    return y


@compiled
def derivative(q: Any, degree: int, out: Any) -> None:
    """Differentiate a polynomial.

    Parameters
    ----------
    q : array
        Coefficients, ascending.
    degree : int
        Degree of q.
    out : array
        Is filled with the coefficients of the derivative.
    """
    for i in range(degree):
        out[i] = (i + 1) * q[i + 1]


@compiled
def _roots(q0: float, q1: float, q2: float) -> tuple[int, float, float]:
    """Find the roots in (0, 1) of q0 + q1 s + q2 s^2, ascending; their number comes first."""
    if q2 == 0.0:
        r = -q0 / q1 if q1 != 0.0 else 0.0
        return (1, r, r) if 0.0 < r < 1.0 else (0, r, r)
    discriminant = q1 * q1 - 4.0 * q2 * q0
    if discriminant < 0.0:
        return 0, 0.0, 0.0
    # the form that does not cancel: r1 = h / q2, r2 = q0 / h
    h = -0.5 * (q1 + (sqrt(discriminant) if q1 >= 0.0 else -sqrt(discriminant)))
    r1 = h / q2
    r2 = q0 / h if h != 0.0 else r1
    if r1 > r2:
        r1, r2 = r2, r1
    if not 0.0 < r1 < 1.0:
        return (1, r2, r2) if 0.0 < r2 < 1.0 and r2 != r1 else (0, r1, r2)
    return (2, r1, r2) if 0.0 < r2 < 1.0 and r2 != r1 else (1, r1, r2)


@compiled
def closed_form_roots(q: Any, degree: int, roots: Any) -> int:
    """Find the roots in (0, 1) of a polynomial of degree 0, 1 or 2, ascending.

    Parameters
    ----------
    q : array
        Coefficients, ascending.
    degree : int
        Degree of q.
    roots : array
        Is filled with the roots.

    Returns
    -------
    int
        Number of roots.
    """
    count, first, second = _roots(q[0], q[1] if degree > 0 else 0.0, q[2] if degree > 1 else 0.0)
    if count > 0:
        roots[0] = first
    if count > 1:
        roots[1] = second
    return count


@compiled
def bracketed_roots(q: Any, degree: int, turns: Any, n_turns: int, roots: Any) -> int:
    """Find the roots in (0, 1) of q, which is monotone between its turning points, by safeguarded Newton.

    Parameters
    ----------
    q : array
        Coefficients, ascending.
    degree : int
        Degree of q.
    turns : array
        Turning points of q in (0, 1), ascending.
    n_turns : int
        Their number.
    roots : array
        Is filled with the roots.

    Returns
    -------
    int
        Number of roots.
    """
    count = 0
    low, f_low = 0.0, q[0]
    for k in range(n_turns + 1):
        high = turns[k] if k < n_turns else 1.0
        f_high = value(q, degree, high)
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
    peak = max(abs(q[0]), abs(value(q, degree, 1.0)))
    for k in range(n_turns):
        peak = max(peak, abs(value(q, degree, turns[k])))
    return peak


@compiled
def _velocity_hull(c1: float, c2: float, c3: float, c4: float, c5: float) -> float:
    """Bound |p'| on [0, 1] by its largest Bernstein coefficient, p of degree 5 at most."""
    v1, v2, v3, v4 = 2.0 * c2, 3.0 * c3, 4.0 * c4, 5.0 * c5
    return max(
        abs(c1),
        abs(c1 + 0.25 * v1),
        abs(c1 + 0.5 * v1 + v2 / 6.0),
        abs(c1 + 0.75 * v1 + 0.5 * v2 + 0.25 * v3),
        abs(c1 + v1 + v2 + v3 + v4),
    )


@compiled
def _acceleration_hull(c2: float, c3: float, c4: float, c5: float) -> float:
    """Bound |p''| on [0, 1] by its largest Bernstein coefficient."""
    a0, a1, a2, a3 = 2.0 * c2, 6.0 * c3, 12.0 * c4, 20.0 * c5
    return max(
        abs(a0),
        abs(a0 + a1 / 3.0),
        abs(a0 + (2.0 * a1 + a2) / 3.0),
        abs(a0 + a1 + a2 + a3),
    )


@compiled
def _jerk_peak(c3: float, c4: float, c5: float) -> float:
    """Compute the exact peak on [0, 1] of the third derivative, a quadratic."""
    j0, j1, j2 = 6.0 * c3, 24.0 * c4, 60.0 * c5
    peak = max(abs(j0), abs(j0 + j1 + j2))
    s = -0.5 * j1 / j2 if j2 != 0.0 else 0.0
    return max(peak, abs(j0 + s * (j1 + s * j2))) if 0.0 < s < 1.0 else peak


@compiled
def _acceleration_peak(c2: float, c3: float, c4: float, c5: float) -> float:
    """Compute the exact peak on [0, 1] of the second derivative; it turns where the jerk is zero."""
    a0, a1, a2, a3 = 2.0 * c2, 6.0 * c3, 12.0 * c4, 4.0 * (5.0 * c5)
    count, r1, r2 = _roots(a1, 2.0 * a2, 3.0 * a3)
    peak = max(abs(a0), abs(a3 + a2 + a1 + a0))
    if count > 0:
        peak = max(peak, abs(((a3 * r1 + a2) * r1 + a1) * r1 + a0))
    if count > 1:
        peak = max(peak, abs(((a3 * r2 + a2) * r2 + a1) * r2 + a0))
    return peak


@compiled
def _velocity_peak(c: Any, degree: int, work: Any) -> float:
    """Compute the exact peak on [0, 1] of the first derivative; it turns where the acceleration is zero."""
    velocity, acceleration, jerk, jerk_roots, roots = work[0], work[1], work[2], work[4], work[5]
    derivative(c, degree, velocity)
    derivative(velocity, degree - 1, acceleration)
    if degree < 5:
        n_roots = closed_form_roots(acceleration, degree - 2, roots)
    else:
        derivative(acceleration, 3, jerk)
        n_jerk = closed_form_roots(jerk, 2, jerk_roots)
        n_roots = bracketed_roots(acceleration, 3, jerk_roots, n_jerk, roots)
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
                acceleration = _acceleration_peak(c[2], c[3], c[4], c[5])
                out[i, j, 0] = max(out[i, j, 0], _velocity_peak(c, degrees[k], work) * rate)
                out[i, j, 1] = max(out[i, j, 1], acceleration * rate * rate)
                out[i, j, 2] = max(out[i, j, 2], _jerk_peak(c[3], c[4], c[5]) * rate * rate * rate)


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
    work = np.zeros((7, WIDTH))
    worst = 0
    for i in range(len(out)):
        out[i], worst = least_factor(i, coefficients, degrees, durations, limits, worst, work)


@compiled
def least_factor(
    i: int, coefficients: Any, degrees: Any, durations: Any, limits: Any, first: int, work: Any
) -> tuple[float, int]:
    """Compute the least factor of one candidate; see ``stretch``.

    Coefficients are read one by one: a view of them costs as much as the proof that a peak may be skipped.

    Parameters
    ----------
    i : int
        The candidate.
    coefficients, degrees, durations, limits : array
        As in ``stretch``.
    first : int
        The joint to start with.
    work : array, shape (7, WIDTH)
        Scratch.

    Returns
    -------
    factor : float
    worst : int
        The joint that decides.
    """
    _, n_segments, dof, _ = coefficients.shape
    factor, worst = 0.0, first
    j = first
    for _ in range(dof):
        for k in range(n_segments):
            c1, c2, c3 = coefficients[i, k, j, 1], coefficients[i, k, j, 2], coefficients[i, k, j, 3]
            c4, c5 = coefficients[i, k, j, 4], coefficients[i, k, j, 5]
            duration = durations[i, k]
            allowed_v = limits[0, j] * duration
            allowed_a = limits[1, j] * duration * duration
            allowed_j = limits[2, j] * duration * duration * duration
            needed = factor
            # written so that NaN counts as larger
            if allowed_j < inf and not _jerk_peak(c3, c4, c5) <= needed * needed * needed * allowed_j:
                needed = np.cbrt(_jerk_peak(c3, c4, c5) / allowed_j)
            if (
                allowed_a < inf
                and not _acceleration_hull(c2, c3, c4, c5) <= needed * needed * allowed_a
            ):
                peak = _acceleration_peak(c2, c3, c4, c5)
                if not peak <= needed * needed * allowed_a:
                    needed = sqrt(peak / allowed_a)
            if not _velocity_hull(c1, c2, c3, c4, c5) <= needed * allowed_v:
                peak = _velocity_peak(coefficients[i, k, j], degrees[k], work)
                if not peak <= needed * allowed_v:
                    needed = peak / allowed_v
            if not needed <= factor:
                factor, worst = needed, j
        j = j + 1 if j + 1 < dof else 0
    return factor, worst
