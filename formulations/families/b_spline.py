"""B-spline through the waypoints, degree 3 or 5 (003 eq. 1-12).

The durations are the differences of the parameters at which the waypoints are passed (003 eq. 5 by
chord length is one choice of them), the inner knots their running means (003 eq. 6). Velocity and
acceleration are zero at both ends (003 sec. 3.2), which makes the first three control points equal and
the last three too (003 eq. 9-12), and asks for four more control points and knots than waypoints
do: the running means go on over both ends, where the outermost parameter counts again. 003 leaves
the degree open.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from formulations.families.family import Family, scratch
from formulations.families.polynomial import WIDTH, compiled
from formulations.problem import Array


@compiled
def knots(t: Any, degree: int, u: Any, h: Any) -> None:
    """Parameters of the waypoints u (n + 1,) and lengths of the knot spans h (n + 5 - degree,).

    Inner knot i is the mean of the parameters i - 1 .. i + degree - 2, cut to 0 .. n (003 eq. 6).
    """
    n = len(t)
    u[0] = 0.0 * t[0]
    for k in range(n):
        u[k + 1] = u[k] + t[k]
    inner = n + 4 - degree
    before = u[0]
    for i in range(inner):
        total = u[min(max(i - 1, 0), n)]
        for k in range(i, i + degree - 1):
            total = total + u[min(max(k, 0), n)]
        knot = total / degree
        h[i] = knot - before
        before = knot
    h[inner] = u[n] - before


@compiled
def spans_of(u: Any, h: Any, spans: Any) -> None:
    """Knot span that each inner waypoint lies in, (n + 1,) integers."""
    k, right = 0, h[0]
    for i in range(1, len(u) - 1):
        while u[i] >= right and k < len(h) - 1:
            k += 1
            right += h[k]
        spans[i] = k


@compiled
def basis(h: Any, degree: int, start: Any, out: Any, work: Any) -> None:
    """The degree + 1 basis functions that live on each span, as polynomials of s in [0, 1].

    out: (spans, degree + 1, 6). Cox - de Boor (003 eq. 2) with its factors written out in s.
    start: knots (spans + 1,). work: (6,).
    """
    n_spans = len(h)
    start[0] = 0.0 * h[0]
    for k in range(n_spans):
        start[k + 1] = start[k] + h[k]
    for k in range(n_spans):
        out[k, 0, 0] = 1.0 + 0.0 * h[0]
        for p in range(1, degree + 1):
            # N_{k-p+j, p}, j = 0..p; knots before the first and after the last repeat them
            for j in range(p, -1, -1):
                for i in range(6):
                    work[i] = 0.0 * h[0]
                if j > 0:  # rising factor of the function that starts at knot k - p + j
                    low = start[max(k - p + j, 0)]
                    width = start[min(k + j, n_spans)] - low
                    a, b = (start[k] - low) / width, h[k] / width
                    for i in range(p):
                        work[i] = work[i] + a * out[k, j - 1, i]
                        work[i + 1] = work[i + 1] + b * out[k, j - 1, i]
                if j < p:  # falling factor of the next one
                    high = start[min(k + j + 1, n_spans)]
                    width = high - start[max(k - p + j + 1, 0)]
                    a, b = (high - start[k]) / width, -h[k] / width
                    for i in range(p):
                        work[i] = work[i] + a * out[k, j, i]
                        work[i + 1] = work[i + 1] + b * out[k, j, i]
                for i in range(6):
                    out[k, j, i] = work[i]


@compiled
def collocation(
    u: Any, h: Any, start: Any, spans: Any, degree: int, functions: Any, matrix: Any
) -> None:
    """Values of all control points' functions at the inner waypoints: matrix (n - 1, n + 5)."""
    n = len(u) - 1
    for i in range(n - 1):
        for k in range(n + 5):
            matrix[i, k] = 0.0 * h[0]
        k = spans[i + 1]
        s = (u[i + 1] - start[k]) / h[k]
        for j in range(degree + 1):
            value = functions[k, j, degree]
            for power in range(degree - 1, -1, -1):
                value = value * s + functions[k, j, power]
            matrix[i, k + j] = value


@compiled
def eliminate(matrix: Any) -> None:
    """LU of the columns 3 .. n + 1 in place, without pivoting: the matrix is totally positive."""
    n = len(matrix)
    for k in range(n):
        for i in range(k + 1, min(k + 6, n)):
            factor = matrix[i, k + 3] / matrix[k, k + 3]
            matrix[i, k + 3] = factor
            for j in range(k + 1, min(k + 6, n)):
                matrix[i, j + 3] = matrix[i, j + 3] - factor * matrix[k, j + 3]


@compiled
def joint(x: Any, degree: int, functions: Any, matrix: Any, d: Any, c: Any) -> None:
    """Coefficients of one joint, c (spans, 6), from its waypoints x (n + 1,); d: (n + 5,) scratch."""
    n = len(x) - 1
    # relative to the first waypoint: a joint that stands still does so to the bit, whatever the
    # offset; the first three control points are then zero
    way = x[n] - x[0]
    for k in range(3):  # rest at both ends
        d[k], d[n + 4 - k] = 0.0, way
    for i in range(n - 1):
        d[i + 3] = x[i + 1] - x[0]
        for k in range(3):
            d[i + 3] = d[i + 3] - matrix[i, n + 4 - k] * way
        for k in range(max(i - 5, 0), i):
            d[i + 3] = d[i + 3] - matrix[i, k + 3] * d[k + 3]
    for i in range(n - 2, -1, -1):
        for k in range(i + 1, min(i + 6, n - 1)):
            d[i + 3] = d[i + 3] - matrix[i, k + 3] * d[k + 3]
        d[i + 3] = d[i + 3] / matrix[i, i + 3]
    for k in range(len(c)):
        for power in range(degree + 1):
            total = functions[k, 0, power] * d[k]
            for j in range(1, degree + 1):
                total = total + functions[k, j, power] * d[k + j]
            c[k, power] = total
        c[k, 0] = c[k, 0] + x[0]


@compiled
def population(waypoints: Any, durations: Any, degree: int, lengths: Any, out: Any) -> None:
    """Whole populations, one piece per knot span (see ``Family``)."""
    n = durations.shape[1]
    n_spans = n + 5 - degree
    u, start, d = np.zeros(n + 1), np.zeros(n_spans + 1), np.zeros(n + 5)
    spans = np.zeros(n + 1, dtype=np.int64)
    functions, work = np.zeros((n_spans, degree + 1, 6)), np.zeros(6)
    matrix = np.zeros((max(n - 1, 1), n + 5))
    for i in range(len(durations)):
        h = lengths[i]
        knots(durations[i], degree, u, h)
        spans_of(u, h, spans)
        functions[:] = 0.0
        basis(h, degree, start, functions, work)
        if n > 1:
            collocation(u, h, start, spans, degree, functions, matrix)
            eliminate(matrix)
        for j in range(waypoints.shape[1]):
            joint(waypoints[:, j], degree, functions, matrix, d, out[i, :, j])


def _spans(durations: Array, degree: int) -> NDArray[np.int64]:
    """Knot span of each waypoint for numeric durations, (n + 1,) integers."""
    n = len(durations)
    u, h, spans = np.zeros(n + 1), np.zeros(n + 5 - degree), np.zeros(n + 1, dtype=np.int64)
    knots(durations, degree, u, h)
    spans_of(u, h, spans)
    return spans


def _symbols(waypoints: Array, t: list[Any], near: Array, degree: int) -> tuple[list[Any], list[Any]]:
    """Splines on symbols, for the pattern of knots that ``near`` has (see ``Family``)."""
    n = len(t)
    n_spans = n + 5 - degree
    u, h, start = scratch(n + 1), scratch(n_spans), scratch(n_spans + 1)
    functions, matrix = scratch(n_spans, degree + 1, WIDTH), scratch(max(n - 1, 1), n + 5)
    knots.py_func(t, degree, u, h)
    basis.py_func(h, degree, start, functions, scratch(WIDTH))
    if n > 1:
        collocation.py_func(u, h, start, _spans(near, degree), degree, functions, matrix)
        eliminate.py_func(matrix)
    joints = []
    for x in waypoints.T.tolist():
        c = scratch(n_spans, WIDTH)
        joint.py_func(x, degree, functions, matrix, scratch(n + 5), c)
        joints.append([list(row) for row in c])
    return list(h), joints


def _family(degree: int) -> Family:
    return Family(
        name=f"b-spline-{degree}",
        title=f"B-spline of degree {degree}",
        source="003 eq. 1-12, degree assumed",
        population=lambda x, t, lengths, out: population(x, t, degree, lengths, out),
        symbols=lambda x, t, near: _symbols(x, t, near, degree),
        degrees=lambda n_segments: (degree,) * (n_segments + 5 - degree),
        pattern=lambda durations: tuple(_spans(durations, degree)),
    )


B_SPLINE_3, B_SPLINE_5 = _family(3), _family(5)
