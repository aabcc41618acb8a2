"""B-splines in rational numbers, by the definitions: an oracle for the checker's models."""

from __future__ import annotations

from fractions import Fraction

Q = Fraction


def knots(t: list[Q], degree: int) -> list[Q]:
    """All knots for waypoint times t_0 .. t_n; the inner ones are running means."""
    n = len(t) - 1
    inner = [
        sum((t[min(max(i, 0), n)] for i in range(k - 2, k + degree - 2)), Q(0)) / degree
        for k in range(1, n + 5 - degree)
    ]
    return [t[0]] * (degree + 1) + inner + [t[-1]] * (degree + 1)


def function(u: list[Q], i: int, d: int, span: int, x: Q, order: int = 0) -> Q:
    """Derivative of the polynomial that basis function i of degree d is between knots span, span + 1."""
    if d == 0:
        return Q(int(i == span and order == 0))
    total = Q(0)
    for start, sign in ((i, 1), (i + 1, -1)):
        width = u[start + d] - u[start]
        if width == 0:
            continue
        lower = function(u, start, d - 1, span, x, max(order - 1, 0))
        if order:
            total += sign * d * lower / width
        else:
            total += ((x - u[i]) if sign > 0 else (u[i + d + 1] - x)) / width * lower
    return total


def span_of(u: list[Q], degree: int, x: Q) -> int:
    return max(k for k in range(degree, len(u) - degree - 1) if u[k] <= x or k == degree)


def control_points(t: list[Q], degree: int, x: list[Q]) -> list[Q]:
    """Solve the interpolation by elimination."""
    n, u = len(t) - 1, knots(t, degree)
    rows = []
    for i in range(1, n):
        k = span_of(u, degree, t[i])
        values = [function(u, f, degree, k, t[i]) for f in range(n + 5)]
        ends = sum(values[:3]) * x[0] + sum(values[-3:]) * x[n]
        rows.append([*values[3 : n + 2], x[i] - ends])
    for p in range(n - 1):
        rows[p] = [y / rows[p][p] for y in rows[p]]
        for i in range(n - 1):
            if i != p:
                rows[i] = [y - rows[i][p] * z for y, z in zip(rows[i], rows[p], strict=True)]
    return [x[0]] * 3 + [row[-1] for row in rows] + [x[n]] * 3


def derivative(t: list[Q], degree: int, c: list[Q], span: int, place: Q, order: int) -> Q:
    """Of the spline at a share of a knot span; spans count from 0."""
    u, k = knots(t, degree), span + degree
    at = u[k] + place * (u[k + 1] - u[k])
    return sum((function(u, i, degree, k, at, order) * c[i] for i in range(k - degree, k + 1)), Q(0))
