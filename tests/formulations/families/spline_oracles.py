"""What the tests of the families share: problems to draw, plain evaluation, what rounding may do."""

from __future__ import annotations

from typing import Any

import numpy as np
from conftest import Array, durations, problems
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from formulations import FAMILIES, Problem

NAMES = list(FAMILIES)
KNOWN = ("3-5-3", "4-3-4", "quintic", "b-spline-3", "b-spline-5")  # others were added later
B_SPLINES = {"b-spline-3": 3, "b-spline-5": 5}
DENSE = 20_001
POWERS = np.arange(6)


def some_problem(family: str, **options: Any) -> st.SearchStrategy[Problem]:
    """Problems the family has a spline for."""
    segments: Any = 3 if family == "3-5-3" else st.integers(2 if family == "4-3-4" else 1, 6)
    return problems(segments=segments, family=family, **options)


@st.composite
def candidates(
    draw: st.DrawFn, family: str, low: float = -3.0, high: float = 3.0, **options: Any
) -> tuple[Problem, Array]:
    """A problem and durations for it."""
    problem = draw(some_problem(family, **options))
    return problem, draw(durations(problem.n_segments, low, high))


def derivative(c: Array, order: int) -> Array:
    """Ascending coefficients of a derivative, last axis."""
    for _ in range(order):
        c = c[..., 1:] * np.arange(1, c.shape[-1])
    return c


def at(c: Array, s: Any) -> Array:
    """Values (..., m) at points s (m,)."""
    return np.asarray(c @ np.power.outer(np.atleast_1d(s), np.arange(c.shape[-1])).T)


def rounding(c: Array) -> Array:
    """Sum of the terms' sizes: what rounding errors of a value on [0, 1] are measured by."""
    return np.asarray(np.abs(c).sum(axis=-1))


def pieces(problem: Problem, t: Array) -> tuple[Array, Array]:
    """Lengths (n_pieces,) [s] and normalised coefficients (n_pieces, dof, 6) for durations t (n,)."""
    lengths, c = FAMILIES[problem.family].pieces(problem, t[None])
    return lengths[0], c[0]


def dense(c: Array, lengths: Array, order: int) -> Array:
    """Samples (n_pieces, dof, DENSE) of a derivative in time of normalised pieces c."""
    return at(derivative(c, order), np.linspace(0.0, 1.0, DENSE)) / lengths[:, None, None] ** order


def degrees_of(family: str, n: int) -> tuple[int, ...]:
    """Degrees of the pieces as the papers state them; a B-spline has n + 4 - degree inner knots."""
    if family in B_SPLINES:
        return (B_SPLINES[family],) * (n + 5 - B_SPLINES[family])
    known = {"3-5-3": (3, 5, 3), "4-3-4": (4, *[3] * (n - 2), 4), "quintic": (5,) * n}
    return known[family] if family in known else FAMILIES[family].degrees(n)  # one that was added


def b_spline_basis(t: Array, degree: int) -> tuple[Array, BSpline, Array]:
    """Parameters u of the waypoints, the basis on the knots of Lu & Wang 2024, eq. 6, and the knots."""
    n, total = len(t), t.sum()
    u = np.concatenate([[0.0], np.cumsum(t)]) / total
    u[-1] = 1.0
    windows = np.arange(n + 4 - degree)[:, None] + np.arange(-1, degree - 1)
    inner = u[np.clip(windows, 0, n)].mean(axis=1)
    vector = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    return u, BSpline(vector, np.eye(n + 5), degree), vector


def peak_rounding(problem: Problem, t: Array, order: int) -> Array:
    """Bound on the rounding error of the peak of a derivative, (dof,) [rad/s^order].

    Of a piece: 1e-14 of the sum of its terms' sizes, and of the piece's way, as the coefficients are
    differences of terms as large as that, however small they come out. A B-spline has the error of its control
    points beside it. They solve M d = r, M the basis functions at the inner waypoints. Those are between
    0 and 1 and add up to 1, and each comes out of ``degree`` steps of Cox - de Boor with an error of a few
    u, say 8 degree u with the elimination (u = 2^-53; on [100, 1, 0.01, 100] s it is 9 u). So
    |error of d| <= |M^-1| 8 degree u (sum of the |d| that enter a row + the distances in r).
    """
    lengths, c = pieces(problem, t)
    sizes = np.maximum(rounding(derivative(c, order)), rounding(c[..., 1:]))
    slack = 1e-14 * (sizes / lengths[:, None] ** order).max(axis=0)
    if problem.family not in B_SPLINES or len(t) < 2:
        return np.asarray(slack)
    degree, n = B_SPLINES[problem.family], len(t)
    u, basis, _ = b_spline_basis(t, degree)
    rows = basis(u[1:-1])  # (n - 1, n + 5)
    M = rows[:, 3 : n + 2]
    # control points as distances from waypoints: zero for the first three and the last three
    near = problem.waypoints[np.clip(np.arange(n + 5) - 2, 0, n)]
    ways = (rows > 0.0)[:, :, None] * (problem.waypoints[1:-1, None] - near)
    d = np.linalg.solve(M, (rows[:, :, None] * ways).sum(axis=1))
    sizes = (M > 0.0) @ np.abs(d) + np.abs(ways).sum(axis=1)
    error = np.abs(np.linalg.inv(M)) @ (8.0 * degree * 2.0**-53 * sizes)
    grid = np.linspace(0.0, 1.0, 2001)
    slopes = np.abs(basis.derivative(order)(grid)[:, 3 : n + 2]) / t.sum() ** order
    return np.asarray(slack + (slopes @ error).max(axis=0))


def stretch_rounding(problem: Problem, t: Array) -> float:
    """Bound on the relative rounding error of the stretch of durations t."""
    peaks = FAMILIES[problem.family].peaks(problem, t[None])[0].T  # (3, dof)
    limits = problem.limits.derivatives
    least, most = np.zeros_like(peaks), np.zeros_like(peaks)
    for order in (1, 2, 3):
        exact, slack = peaks[order - 1], peak_rounding(problem, t, order)
        most[order - 1] = ((exact + slack) / limits[order - 1]) ** (1.0 / order)
        least[order - 1] = (np.maximum(exact - slack, 0.0) / limits[order - 1]) ** (1.0 / order)
    found = float(FAMILIES[problem.family].stretch(problem, t[None])[0])
    return max(float(most.max()) / found - 1.0, 1.0 - float(least.max()) / found) + 1e-15
