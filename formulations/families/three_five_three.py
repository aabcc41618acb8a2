"""3-5-3 spline: a cube, a quintic, a cube (Wang 2025, eq. 3-7; Zhou 2025, eq. 1-7; Zhang 2025, eq. 8-11).

The papers solve one system of fourteen equations per joint, whose matrix is Wang 2025, eq. 5. It splits:
rest at the start leaves one coefficient of the first cube, rest at the end one of the last cube, and the
quintic is the Hermite interpolant between them. ``joint`` writes out the solution. The matrix itself, row by
row as printed, is ``matrix_353`` in tests/formulations/families/test_papers_matrices.py, which compares the
two.
"""

from __future__ import annotations

from typing import Any

from formulations.compiled import compiled
from formulations.families.family import Family, on_symbols


@compiled
def joint(x: Any, t: Any, c: Any) -> None:
    """Solve Wang 2025, eq. 5 for one joint; only + - * /, so that it runs on floats and CasADi symbols.

    Parameters
    ----------
    x : array, shape (4,)
        Waypoints of the joint [rad].
    t : array, shape (3,)
        Durations [s].
    c : array, shape (3, 6)
        Is filled with ascending coefficients on normalised time s = t / T [rad].
    """
    d1 = x[1] - x[0]
    d2 = x[2] - x[1]
    d3 = x[3] - x[2]
    # first cube: from x0 at rest, so only s^3 is left, to x1 (eq. 5, rows 10-12 and 14)
    c[0, 0] = x[0]
    c[0, 3] = d1
    # last cube: from x2 to x3 at rest, x3 - d3 (1 - s)^3 (eq. 5, rows 7-9 and 13)
    c[2, 0] = x[2]
    c[2, 1] = 3.0 * d3
    c[2, 2] = -3.0 * d3
    c[2, 3] = d3
    # quintic: position, velocity and acceleration meet those of the cubes (eq. 5, rows 1-6)
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
    """Fill the splines of a whole population, one piece per segment (see ``Family``)."""
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
    source="Wang 2025, eq. 3-7; Zhou 2025, eq. 1-7; Zhang 2025, eq. 8-11",
    population=population,
    symbols=on_symbols(joint),
    degrees=lambda n_segments: (3, 5, 3),
    refusal=_refusal,
)
