"""Quintic spline: one quintic per segment, C2 (the rival of 003, inner conditions left open).

Read here as the textbook rule: at an inner waypoint the velocity is 0 where the joint turns, else the
mean of the mean velocities on both sides, and the acceleration is 0 (Biagiotti & Melchiorri 2008,
sec. 4.1 and 2.1.6). Both vanish at the ends.
"""

from __future__ import annotations

from typing import Any

from formulations.compiled import compiled
from formulations.families.family import Family, on_symbols


@compiled
def joint(x: Any, t: Any, c: Any) -> None:
    """Coefficients of one joint on normalised time, c (n, 6), from x (n+1,) and durations t (n,)."""
    n = len(t)
    for k in range(n):
        d = x[k + 1] - x[k]
        # velocities at both ends, times T_k
        before, after = 0.0 * t[k], 0.0 * t[k]
        if k > 0 and d * (x[k] - x[k - 1]) > 0.0:
            before = 0.5 * (d + (x[k] - x[k - 1]) * t[k] / t[k - 1])
        if k < n - 1 and d * (x[k + 2] - x[k + 1]) > 0.0:
            after = 0.5 * (d + (x[k + 2] - x[k + 1]) * t[k] / t[k + 1])
        c[k, 0] = x[k]
        c[k, 1] = before
        c[k, 3] = 10.0 * d - 6.0 * before - 4.0 * after
        c[k, 4] = -15.0 * d + 8.0 * before + 7.0 * after
        c[k, 5] = 6.0 * d - 3.0 * before - 3.0 * after


@compiled
def population(waypoints: Any, durations: Any, lengths: Any, out: Any) -> None:
    """Whole populations, one piece per segment (see ``Family``)."""
    lengths[:] = durations
    for i in range(len(durations)):
        for j in range(waypoints.shape[1]):
            joint(waypoints[:, j], durations[i], out[i, :, j])


QUINTIC = Family(
    name="quintic",
    title="quintic spline, velocities by the mean rule",
    source="the rival of 003, inner conditions assumed",
    population=population,
    symbols=on_symbols(joint),
    degrees=lambda n_segments: (5,) * n_segments,
)
