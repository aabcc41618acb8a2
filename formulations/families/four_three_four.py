"""4-3-...-3-4 spline: a quartic at each end and any number of cubics between (Li 2022, eq. 8-9).

Li 2022 solves one system of 4 n + 2 equations per joint (eq. 9). Here the unknowns are the velocities at the
inner waypoints alone. Equal accelerations on both sides of each one make a diagonally dominant tridiagonal
system, in which an end segment has weight 6 and an inner one weight 4. The printed matrix is ``matrix_434``
in tests/formulations/families/test_papers_matrices.py, which compares the two.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.families.family import Family, on_symbols


@compiled
def joint(x: Any, t: Any, c: Any, work: Any) -> None:
    """Solve Li 2022, eq. 9 for one joint; only + - * /, so that it runs on floats and CasADi symbols.

    Parameters
    ----------
    x : array, shape (n + 1,)
        Waypoints of the joint [rad].
    t : array, shape (n,)
        Durations [s].
    c : array, shape (n, 6)
        Is filled with ascending coefficients on normalised time s = t / T [rad].
    work : array, shape (2, n)
        Scratch: ratios of the elimination, and the velocities at the waypoints.
    """
    n = len(t)
    ratio, v = work[0], work[1]
    # forward sweep over the inner waypoints k = 1..n-1 (Thomas)
    for k in range(1, n):
        left, right = 1.0 / t[k - 1], 1.0 / t[k]
        # quartic start piece: p''(1) = 6 v T - 12 d; cubic: p''(1) = 2 v0 T + 4 v1 T - 6 d
        weight_left, pull_left = (6.0, 12.0) if k == 1 else (4.0, 6.0)
        weight_right, pull_right = (6.0, 12.0) if k == n - 1 else (4.0, 6.0)
        diagonal = weight_left * left + weight_right * right
        pull = pull_left * (x[k] - x[k - 1]) * left * left
        pull = pull + pull_right * (x[k + 1] - x[k]) * right * right
        if k > 1:
            diagonal = diagonal - 2.0 * left * ratio[k - 1]
            pull = pull - 2.0 * left * v[k - 1]
        ratio[k] = 2.0 * right / diagonal
        v[k] = pull / diagonal
    for k in range(n - 2, 0, -1):
        v[k] = v[k] - ratio[k] * v[k + 1]
    # first quartic: rest at s = 0 leaves s^3 and s^4
    d, w = x[1] - x[0], v[1] * t[0]
    c[0, 0] = x[0]
    c[0, 3] = 4.0 * d - w
    c[0, 4] = w - 3.0 * d
    for k in range(1, n - 1):
        d, w, u = x[k + 1] - x[k], v[k] * t[k], v[k + 1] * t[k]
        c[k, 0] = x[k]
        c[k, 1] = w
        c[k, 2] = 3.0 * d - 2.0 * w - u
        c[k, 3] = w + u - 2.0 * d
    # last quartic: the mirror image, x_n - a (1 - s)^3 - b (1 - s)^4
    d, w = x[n] - x[n - 1], v[n - 1] * t[n - 1]
    a, b = 4.0 * d - w, w - 3.0 * d
    c[n - 1, 0] = x[n - 1]
    c[n - 1, 1] = 3.0 * a + 4.0 * b
    c[n - 1, 2] = -3.0 * a - 6.0 * b
    c[n - 1, 3] = a + 4.0 * b
    c[n - 1, 4] = -b


@compiled
def population(waypoints: Any, durations: Any, lengths: Any, out: Any) -> None:
    """Fill the splines of a whole population, one piece per segment (see ``Family``)."""
    lengths[:] = durations
    work = np.zeros((2, durations.shape[1]))
    for i in range(len(durations)):
        for j in range(waypoints.shape[1]):
            joint(waypoints[:, j], durations[i], out[i, :, j], work)


def _refusal(n_segments: int) -> str | None:
    if n_segments < 2:
        return "4-3-4 needs at least 2 segments (3 waypoints): one quartic cannot rest at both ends"
    return None


FOUR_THREE_FOUR = Family(
    name="4-3-4",
    title="4-3-...-3-4 spline",
    source="Li 2022, eq. 8-9",
    population=population,
    symbols=on_symbols(joint, work=2),
    degrees=lambda n_segments: (4, *(3,) * (n_segments - 2), 4),
    refusal=_refusal,
)
