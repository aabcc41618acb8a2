"""B-spline through the waypoints, of degree 3 or 5 (Lu & Wang 2024, eq. 1-12; they do not print the degree).

The durations are the differences of the parameters at which the waypoints are passed; chord lengths (eq. 4,
5) are one choice of them: ``optima/family/chord_lengths.py``. The inner knots are running means of these
parameters (eq. 6). Velocity and acceleration are zero at both ends (sec. 3.2). Therefore the first three
control points are equal, and so are the last three (eq. 9-12), and there are four more control points and
knots than the waypoints alone would need: the running means continue over both ends, where the outermost
parameter is repeated.

Equation numbers in this file are those of Lu & Wang 2024.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray

from formulations.compiled import compiled
from formulations.families.family import Family, scratch
from formulations.families.polynomial import WIDTH
from formulations.problem.arrays import Array


@compiled
def apart(steps: Any, out: Any) -> None:
    """Compute the signed distances out[a, b] from point a to point b, (n + 1, n + 1), from n steps.

    Each is a sum of steps. A difference of two sums would lose its digits where a step is tiny beside
    the others.
    """
    n = len(steps)
    for a in range(n + 1):
        out[a, a] = 0.0 * steps[0]
        for b in range(a, n):
            out[a, b + 1] = out[a, b] + steps[b]
            out[b + 1, a] = -out[a, b + 1]


@compiled
def knots(gaps: Any, degree: int, reach: Any, h: Any) -> None:
    """Compute the distances reach[i, k] from waypoint i to knot k, (n + 1, spans + 1), and the spans h.

    gaps: distances between the waypoints, (n + 1, n + 1). Inner knot k is the mean of the parameters
    k - 2 .. k + degree - 3, each index cut to 0 .. n (eq. 6). The outer knots are the two ends.
    """
    n, n_spans = len(gaps) - 1, len(h)
    for i in range(n + 1):
        reach[i, 0], reach[i, n_spans] = gaps[i, 0], gaps[i, n]
        for k in range(1, n_spans):
            total = gaps[i, min(max(k - 2, 0), n)]
            for m in range(k - 1, k + degree - 2):
                total = total + gaps[i, min(max(m, 0), n)]
            reach[i, k] = total / degree
    for k in range(1, n_spans - 1):  # neighbouring means share all but one term each
        h[k] = gaps[max(k - 2, 0), min(k + degree - 2, n)] / degree
    h[0], h[n_spans - 1] = reach[0, 1], -reach[n, n_spans - 1]


@compiled
def spans_of(reach: Any, spans: Any) -> None:
    """Find the knot span that each inner waypoint lies in, (n + 1,) integers."""
    k = 0
    for i in range(1, len(reach) - 1):
        while reach[i, k + 1] <= 0.0 and k < reach.shape[1] - 2:
            k += 1
        spans[i] = k


@compiled
def basis(h: Any, between: Any, degree: int, out: Any, work: Any) -> None:
    """Compute the degree + 1 basis functions that are not zero on each span, as polynomials of s in [0, 1].

    This is the recursion of Cox and de Boor (eq. 2) with its factors written out in s. out: (spans,
    degree + 1, 6). between: distances between the knots, (spans + 1, spans + 1). work: (6,) scratch.
    """
    n_spans = len(h)
    for k in range(n_spans):
        out[k, 0, 0] = 1.0 + 0.0 * h[0]
        for p in range(1, degree + 1):
            # N_{k-p+j, p}, j = 0..p; knots before the first and after the last repeat them
            for j in range(p, -1, -1):
                for i in range(6):
                    work[i] = 0.0 * h[0]
                if j > 0:  # rising factor of the function that starts at knot k - p + j
                    low = max(k - p + j, 0)
                    width = between[low, min(k + j, n_spans)]
                    a, b = between[low, k] / width, h[k] / width
                    for i in range(p):
                        work[i] = work[i] + a * out[k, j - 1, i]
                        work[i + 1] = work[i + 1] + b * out[k, j - 1, i]
                if j < p:  # falling factor of the next one
                    high = min(k + j + 1, n_spans)
                    width = between[max(k - p + j + 1, 0), high]
                    a, b = between[k, high] / width, -h[k] / width
                    for i in range(p):
                        work[i] = work[i] + a * out[k, j, i]
                        work[i + 1] = work[i + 1] + b * out[k, j, i]
                for i in range(6):
                    out[k, j, i] = work[i]


@compiled
def collocation(reach: Any, between: Any, spans: Any, degree: int, values: Any, matrix: Any) -> None:
    """Compute the basis functions at the inner waypoints.

    values, (n - 1, degree + 1): those that are not zero on the span of each waypoint. matrix, (n - 1,
    n + 5): the same in the columns of all control points. The recursion of Cox and de Boor runs on the
    distances themselves, because 1 - s has few digits left near the end of a span.
    """
    n, n_spans = len(reach) - 1, len(between) - 1
    for i in range(n - 1):
        k = spans[i + 1]
        values[i, 0] = 1.0 + 0.0 * between[0, 0]
        for p in range(1, degree + 1):
            for j in range(p, -1, -1):
                value = 0.0 * between[0, 0]
                if j > 0:
                    low = max(k - p + j, 0)
                    width = between[low, min(k + j, n_spans)]
                    value = value - reach[i + 1, low] / width * values[i, j - 1]
                if j < p:
                    high = min(k + j + 1, n_spans)
                    width = between[max(k - p + j + 1, 0), high]
                    value = value + reach[i + 1, high] / width * values[i, j]
                values[i, j] = value
        for j in range(n + 5):
            matrix[i, j] = 0.0 * between[0, 0]
        for j in range(degree + 1):
            matrix[i, k + j] = values[i, j]


@compiled
def eliminate(matrix: Any) -> None:
    """Factorise the columns 3 .. n + 1 in place; a totally positive matrix needs no pivoting."""
    n = len(matrix)
    for k in range(n):
        for i in range(k + 1, min(k + 6, n)):
            factor = matrix[i, k + 3] / matrix[k, k + 3]
            matrix[i, k + 3] = factor
            for j in range(k + 1, min(k + 6, n)):
                matrix[i, j + 3] = matrix[i, j + 3] - factor * matrix[k, j + 3]


@compiled
def joint(
    x: Any, degree: int, functions: Any, spans: Any, values: Any, matrix: Any, d: Any, c: Any
) -> None:
    """Compute the coefficients of one joint, c (spans, 6), from its waypoints x (n + 1,).

    The unknown d[j] is the distance of control point j from waypoint j - 2, cut to 0 .. n. Thus a joint
    that does not move has d = 0 exactly, and neither an offset nor a very short segment costs digits.
    """
    n = len(x) - 1
    for j in range(n + 5):  # rest at both ends: the first three and the last three are zero (eq. 9-12)
        d[j] = 0.0
    for i in range(n - 1):
        for j in range(degree + 1):
            near = x[min(max(spans[i + 1] + j - 2, 0), n)]
            d[i + 3] = d[i + 3] + values[i, j] * (x[i + 1] - near)
        for k in range(max(i - 5, 0), i):
            d[i + 3] = d[i + 3] - matrix[i, k + 3] * d[k + 3]
    for i in range(n - 2, -1, -1):
        for k in range(i + 1, min(i + 6, n - 1)):
            d[i + 3] = d[i + 3] - matrix[i, k + 3] * d[k + 3]
        d[i + 3] = d[i + 3] / matrix[i, i + 3]
    for k in range(len(c)):
        origin = x[min(max(k - 2, 0), n)]
        for power in range(degree + 1):
            total = functions[k, 0, power] * d[k]
            for j in range(1, degree + 1):
                way = x[min(max(k + j - 2, 0), n)] - origin
                total = total + functions[k, j, power] * (way + d[k + j])
            c[k, power] = total
        c[k, 0] = origin + c[k, 0]


@compiled
def population(waypoints: Any, durations: Any, degree: int, lengths: Any, out: Any) -> None:
    """Fill the splines of a whole population, one piece per knot span (see ``Family``).

    Parameters
    ----------
    waypoints : ndarray, shape (n+1, dof) [rad]
        The waypoints.
    durations : ndarray, shape (m, n) [s]
        Of each candidate.
    degree : int
        3 or 5.
    lengths : ndarray, shape (m, n_spans) [s]
        Is filled: lengths of the knot spans.
    out : ndarray, shape (m, n_spans, dof, 6)
        Is filled: coefficients on normalised time, ascending.
    """
    n = durations.shape[1]
    n_spans = n + 5 - degree
    gaps, between = np.zeros((n + 1, n + 1)), np.zeros((n_spans + 1, n_spans + 1))
    reach, d = np.zeros((n + 1, n_spans + 1)), np.zeros(n + 5)
    spans = np.zeros(n + 1, dtype=np.int64)
    functions, work = np.zeros((n_spans, degree + 1, 6)), np.zeros(6)
    values, matrix = np.zeros((max(n - 1, 1), degree + 1)), np.zeros((max(n - 1, 1), n + 5))
    for i in range(len(durations)):
        h = lengths[i]
        apart(durations[i], gaps)
        knots(gaps, degree, reach, h)
        spans_of(reach, spans)
        apart(h, between)
        functions[:] = 0.0
        basis(h, between, degree, functions, work)
        if n > 1:
            collocation(reach, between, spans, degree, values, matrix)
            eliminate(matrix)
        for j in range(waypoints.shape[1]):
            joint(waypoints[:, j], degree, functions, spans, values, matrix, d, out[i, :, j])


def _spans(durations: Array, degree: int) -> NDArray[np.int64]:
    """Find the knot span of each waypoint for numeric durations, (n + 1,) integers."""
    n = len(durations)
    gaps, spans = np.zeros((n + 1, n + 1)), np.zeros(n + 1, dtype=np.int64)
    reach, h = np.zeros((n + 1, n + 6 - degree)), np.zeros(n + 5 - degree)
    apart(durations, gaps)
    knots(gaps, degree, reach, h)
    spans_of(reach, spans)
    return spans


def _shared(t: list[Any], degree: int, spans: NDArray[np.int64]) -> tuple[Any, Any, Any, Any]:
    """Compute what all joints share (spans, basis functions, equations) on floats or symbols t."""
    n = len(t)
    n_spans = n + 5 - degree
    gaps, between = scratch(n + 1, n + 1), scratch(n_spans + 1, n_spans + 1)
    reach, h, functions = (
        scratch(n + 1, n_spans + 1),
        scratch(n_spans),
        scratch(n_spans, degree + 1, WIDTH),
    )
    values, matrix = scratch(max(n - 1, 1), degree + 1), scratch(max(n - 1, 1), n + 5)
    apart.py_func(t, gaps)
    knots.py_func(gaps, degree, reach, h)
    apart.py_func(h, between)
    basis.py_func(h, between, degree, functions, scratch(WIDTH))
    if n > 1:
        collocation.py_func(reach, between, spans, degree, values, matrix)
        eliminate.py_func(matrix)
    return h, functions, values, matrix


@lru_cache(maxsize=64)
def _built(n: int, degree: int, pattern: tuple[int, ...]) -> casadi.Function:
    """Build ``_shared`` as a CasADi function of the durations, once per pattern of knots."""
    t = casadi.SX.sym("t", n)
    parts = _shared(casadi.vertsplit(t), degree, np.array(pattern))
    return casadi.Function("shared", [t], [casadi.vertcat(*part.ravel()) for part in parts])


def _symbols(waypoints: Array, t: list[Any], near: Array, degree: int) -> tuple[list[Any], list[Any]]:
    """Compute the splines on symbols, for the pattern of knots that ``near`` has (see ``Family``)."""
    n = len(t)
    n_spans, rows = n + 5 - degree, max(n - 1, 1)
    spans = _spans(near, degree)
    if isinstance(t[0], casadi.SX):
        shapes = (n_spans,), (n_spans, degree + 1, WIDTH), (rows, degree + 1), (rows, n + 5)
        columns = _built(n, degree, tuple(spans))(casadi.vertcat(*t))
        h, functions, values, matrix = map(_cells, columns, shapes)
    else:
        h, functions, values, matrix = _shared(t, degree, spans)
    joints = []
    for x in waypoints.T.tolist():
        c = scratch(n_spans, WIDTH)
        joint.py_func(x, degree, functions, spans, values, matrix, scratch(n + 5), c)
        joints.append([list(row) for row in c])
    return list(h), joints


def _cells(column: Any, shape: tuple[int, ...]) -> Any:
    """Turn a column of symbols into an array that Python's loops can run on."""
    cells = scratch(column.numel())
    cells[:] = casadi.vertsplit(column)
    return cells.reshape(shape)


def _family(degree: int) -> Family:
    return Family(
        name=f"b-spline-{degree}",
        title=f"B-spline of degree {degree}",
        source="Lu & Wang 2024, eq. 1-12, degree assumed",
        population=lambda x, t, lengths, out: population(x, t, degree, lengths, out),
        symbols=lambda x, t, near: _symbols(x, t, near, degree),
        degrees=lambda n_segments: (degree,) * (n_segments + 5 - degree),
        pattern=lambda durations: tuple(_spans(durations, degree)),
    )


B_SPLINE_3, B_SPLINE_5 = _family(3), _family(5)
