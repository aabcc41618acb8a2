"""Waypoints that no motion can pass are refused."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.joint_words import factors, shown_unit

if TYPE_CHECKING:
    from formulations.problem.problem import Problem

POSITION_TOLERANCE = 1e-4  # rad a printed waypoint may lie outside its limit: rounding of tables
LARGEST_WAYPOINT = 1e6  # rad or m; beyond, ten digits after the point are no longer kept


def require_inside(problem: Problem, given: Array, angle: str) -> None:
    """Refuse waypoints that are not finite, or lie outside the position limits.

    Parameters
    ----------
    problem : Problem
    given : Array, shape (n_waypoints, dof)
        The waypoints as written.
    angle : {"rad", "deg"}
        Unit of angles in ``given``.

    Raises
    ------
    InputError
        In one line with row, joint and value.
    """
    points, limits = problem.waypoints, problem.limits

    def at(row: Any, joint: Any) -> str:
        return f"waypoints: row {row + 1}, {problem.joint_name(joint)}: {given[row, joint]:.6g}"

    if not np.isfinite(points).all():
        row, joint = np.argwhere(~np.isfinite(points))[0]
        raise InputError(f"{at(row, joint)} is not finite")
    if (np.abs(points) > LARGEST_WAYPOINT).any():
        row, joint = np.argwhere(np.abs(points) > LARGEST_WAYPOINT)[0]
        unit, most = problem.units[joint], LARGEST_WAYPOINT / factors(problem.units, angle)[joint]
        raise InputError(
            f"{at(row, joint)} {shown_unit(unit, angle)} is beyond {most:.3g}, the largest allowed"
        )
    outside = np.maximum(limits.position[:, 0] - points, points - limits.position[:, 1])
    if not (outside > POSITION_TOLERANCE).any():
        return
    row, joint = np.unravel_index(int(outside.argmax()), outside.shape)
    low, high = limits.position[joint] / factors(problem.units, angle)[joint]
    unit = shown_unit(problem.units[joint], angle)
    turned = points * factors(problem.units, "deg")
    fits = ((turned >= limits.position[:, 0]) & (turned <= limits.position[:, 1])).all()
    hint = '; in degrees all would be inside: unit = "deg"?' if fits and unit == "rad" else ""
    raise InputError(
        f"{at(row, joint)} {unit} lies outside limits.position [{low:.6g}, {high:.6g}] {unit}{hint}"
    )
