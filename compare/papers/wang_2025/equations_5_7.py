"""Wang 2025, eq. 5 to 7: the linear system of the 3-5-3 spline, solved for the printed times."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.polynomial.polynomial import polyval

from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.measure import spline
from compare.papers.verdicts import held, smooth
from compare.papers.wang_2025.motions import PLAN, RULE, motions
from compare.papers.words import seconds
from formulations import load
from formulations.problem.arrays import Array

_FIRST, _DEGREE = (3, 9, 13), (3, 5, 3)  # column of each constant term in k of eq. 6; degrees
BY_EQ_4, AS_PRINTED = "by eq. 4", "as printed"
READINGS = {BY_EQ_4: "k21", AS_PRINTED: "k20"}


def matrix(times: Array, *, as_printed: bool = False) -> Array:
    """Write the matrix A of eq. 5.

    Parameters
    ----------
    times : Array, shape (3,) [s]
        Of the segments.
    as_printed : bool
        Whether the -1 of row 2 stands at k20, where our text of the paper has it, and not at k21.

    Returns
    -------
    Array, shape (14, 14)
        Unknowns in the order of eq. 6: k13, ..., k10, k25, ..., k20, k33, ..., k30.
    """
    a = np.zeros((14, 14))
    for piece, (first, degree, t) in enumerate(zip(_FIRST, _DEGREE, times, strict=True)):
        # rows 1 to 9: values at the end of a segment less those at the start of the next
        for order in range(3):
            row = 3 * piece + order
            for power in range(order, degree + 1):
                factor = np.prod(np.arange(power, power - order, -1.0))
                a[row, first - power] = factor * t ** (power - order)
            if piece < 2:
                a[row, _FIRST[piece + 1] - order] = -(1.0, 1.0, 2.0)[order]
    for row, column in enumerate((3, 2, 1, 13, 9), start=9):  # rows 10 to 14
        a[row, column] = 1.0
    if as_printed:
        a[1, [8, 9]] = a[1, [9, 8]]
    return a


def solve(waypoints: Array, times: Array) -> list[Array]:
    """Solve eq. 7 for the coefficients of one joint, with the matrix that eq. 4 demands.

    Parameters
    ----------
    waypoints : Array, shape (4,) [rad]
        Its angles.
    times : Array, shape (3,) [s]
        Of the segments.

    Returns
    -------
    list of Array
        Ascending coefficients of each segment.
    """
    start, first, second, end = waypoints
    right = np.array([0, 0, 0, 0, 0, 0, end, 0, 0, start, 0, 0, second, first], dtype=float)
    k = np.linalg.solve(matrix(times), right)
    return [k[i - d : i + 1][::-1] for i, d in zip(_FIRST, _DEGREE, strict=True)]


def make_system(full: bool) -> dict[str, Any]:
    """Solve every joint for both printed motions, and compare with the family's spline."""
    problem, rows = load("sr4c"), []
    for name, motion in motions([PLAN, RULE]).items():
        times, trajectory = np.array(motion["durations"]), spline(problem, motion["durations"])
        apart = 0.0
        for j, waypoints in enumerate(problem.waypoints.T):
            pieces = zip(solve(waypoints, times), trajectory.coefficients[:, j], times, strict=True)
            for mine, theirs, t in pieces:
                at = np.linspace(0.0, t, 50)
                apart = max(apart, float(np.abs(polyval(at, mine) - polyval(at, theirs)).max()))
        ranks = {
            r: int(np.linalg.matrix_rank(matrix(times, as_printed=r == AS_PRINTED))) for r in READINGS
        }
        rows.append(
            {"motion": name, "seconds": motion["seconds"], "ranks": ranks, "apart": np.degrees(apart)}
        )
    return {"rows": rows, "size": len(matrix(np.ones(3)))}


def show_system(data: dict[str, Any]) -> Shown:
    """Show the rank of either reading, and how far the solution lies from the family's spline."""
    rows, size = data["rows"], data["size"]
    header = ["motion", "time [s]", *(f"rank, -1 at {column}" for column in READINGS.values()),
              "solution apart from the family's spline [deg]"]  # fmt: skip
    lines = [
        [
            r["motion"],
            seconds(r["seconds"]),
            *(f"{rank} of {size}" for rank in r["ranks"].values()),
            f"{r['apart']:.1e}",
        ]
        for r in rows
    ]
    same = smooth(*(r["apart"] for r in rows))
    singular = any(r["ranks"][AS_PRINTED] < size for r in rows)
    remarks = [
        f"With the -1 of row 2 at {READINGS[BY_EQ_4]}, as eq. 4 demands, the system gives "
        f"{'the' if same else 'another motion than the'} spline that all items use (at most "
        f"{max(r['apart'] for r in rows):.1e} deg apart over all joints).",
        f"With the -1 at {READINGS[AS_PRINTED]} the matrix is {'singular' if singular else 'regular'}"
        + (
            ": that cannot be meant." if singular else ", and the velocity jumps at the first waypoint."
        ),
    ]
    by_eq_4, as_printed = (f"with the -1 of row 2 at {READINGS[r]}" for r in (BY_EQ_4, AS_PRINTED))
    verdicts = [
        ItemVerdict(f"that the system gives the 3-5-3 spline, {by_eq_4}", held(same)),
        ItemVerdict(f"that it has one solution, {as_printed}, as our text has it", held(not singular)),
    ]
    return Shown([Table(header, lines, "", (1, 2, 3, 4))], remarks, verdicts)


EQUATIONS_5_7 = Item(
    "Eqs 5-7",
    "the linear system of the 3-5-3 spline",
    make_system,
    show_system,
    "In our text of the paper the -1 of row 2 stands one column too far right, and the vector of eq. 7 has 15 "
    "entries for 14 rows (one zero too many). Either may be an error of the text recognition. Both readings of "
    "row 2 are tried; eq. 7 is read with 14 entries.",
    cost=0.5,
)
