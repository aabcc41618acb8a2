"""3-5-3 spline: a cube, a quintic, a cube (000 eq. 3-7; 002 eq. 1-7; 004 eq. 8-11).

The fourteen conditions of the papers' 14x14 matrix fall apart: rest at the start leaves one free
coefficient in the first cube, rest at the end one in the last, and the quintic is the Hermite
interpolant between them.
"""

from __future__ import annotations

from typing import Any

from formulations.compiled import compiled
from formulations.families.family import Family, on_symbols


@compiled
def joint(x: Any, t: Any, c: Any) -> None:
    """Coefficients of one joint on normalised time, c (3, 6), from waypoints x (4,), durations t (3,).

    Plain arithmetic alone: the same lines serve floats, populations and CasADi symbols.
    """
    d1 = x[1] - x[0]
    d2 = x[2] - x[1]
    d3 = x[3] - x[2]
    # first cube: rest at s = 0, so only s^3 is left (000 eq. 4, rows 1-4)
    c[0, 0] = x[0]
    c[0, 3] = d1
    # last cube: rest at s = 1, x3 - d3 (1 - s)^3
    c[2, 0] = x[2]
    c[2, 1] = 3.0 * d3
    c[2, 2] = -3.0 * d3
    c[2, 3] = d3
    # quintic: position, velocity and acceleration meet the cubes (000 eq. 4, rows 5-12)
    r, q = t[1] / t[0], t[1] / t[2]
    v0, a0 = 3.0 * d1 * r, 6.0 * d1 * r * r  # times T2 and T2^2
    v1, a1 = 3.0 * d3 * q, -6.0 * d3 * q * q
    rest = d2 - v0 - 0.5 * a0
    slope = v1 - v0 - a0
    bend = a1 - a0
    c[1, 0] = x[1]
    c[1, 1] = v0
    c[1, 2] = 0.5 * a0
    c[1, 3] = 10.0 * rest - 4.0 * slope + 0.5 * bend
    c[1, 4] = -15.0 * rest + 7.0 * slope - bend
    c[1, 5] = 6.0 * rest - 3.0 * slope + 0.5 * bend


@compiled
def population(waypoints: Any, durations: Any, lengths: Any, out: Any) -> None:
    """Whole populations, one piece per segment (see ``Family``)."""
    lengths[:] = durations
    for i in range(len(durations)):
        for j in range(waypoints.shape[1]):
            joint(waypoints[:, j], durations[i], out[i, :, j])


def _refusal(n_segments: int) -> str | None:
    if n_segments != 3:
        return f"3-5-3 needs exactly 3 segments (4 waypoints), the problem has {n_segments}"
    return None


THREE_FIVE_THREE = Family(
    name="3-5-3",
    title="3-5-3 spline",
    source="000 eq. 3-7; 002 eq. 1-7; 004 eq. 8-11",
    population=population,
    symbols=on_symbols(joint),
    degrees=lambda n_segments: (3, 5, 3),
    refusal=_refusal,
)
