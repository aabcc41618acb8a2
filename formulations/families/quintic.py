"""Quintic spline: one quintic per segment, twice continuously differentiable.

Lu & Wang 2024 compare their B-spline with it, but do not say which velocity and acceleration it has at the
inner waypoints. The rule here is that of Biagiotti & Melchiorri 2008, sec. 4.1 and 2.1.6: the velocity is 0
where the joint turns and otherwise the mean of the mean velocities of both segments; the acceleration is 0.
Both are 0 at the ends.
"""

from __future__ import annotations

from typing import Any

from formulations.compiled import compiled
from formulations.families.family import Family, on_symbols


@compiled
def joint(x: Any, t: Any, c: Any) -> None:
    """Compute the quintics of one joint; only + - * /, so that it runs on floats and CasADi symbols.

    Parameters
    ----------
    x : array, shape (n + 1,)
        Waypoints of the joint [rad].
    t : array, shape (n,)
        Durations [s].
    c : array, shape (n, 6)
        Is filled with ascending coefficients on normalised time s = t / T [rad].
    """
    n = len(t)
    for k in range(n):
        d = x[k + 1] - x[k]
        # velocities at both ends of the segment, times T_k
        before, after = 0.0 * t[k], 0.0 * t[k]
        if k > 0 and d * (x[k] - x[k - 1]) > 0.0:
            before = 0.5 * (d + (x[k] - x[k - 1]) * t[k] / t[k - 1])
        if k < n - 1 and d * (x[k + 2] - x[k + 1]) > 0.0:
            after = 0.5 * (d + (x[k + 2] - x[k + 1]) * t[k] / t[k + 1])
        c[k, 0] = x[k]
        c[k, 1] = before
        # Hermite interpolant without accelerations at its ends
        c[k, 3] = 10.0 * d - 6.0 * before - 4.0 * after
        c[k, 4] = -15.0 * d + 8.0 * before + 7.0 * after
        c[k, 5] = 6.0 * d - 3.0 * before - 3.0 * after


@compiled
def population(waypoints: Any, durations: Any, lengths: Any, out: Any) -> None:
    """Fill the splines of a whole population, one piece per segment (see ``Family``)."""
    lengths[:] = durations
    for i in range(len(durations)):
        for j in range(waypoints.shape[1]):
            joint(waypoints[:, j], durations[i], out[i, :, j])


QUINTIC = Family(
    name="quintic",
    title="quintic spline, velocities by the mean rule",
    source="compared with in Lu & Wang 2024, inner conditions assumed",
    population=population,
    symbols=on_symbols(joint),
    degrees=lambda n_segments: (5,) * n_segments,
)
