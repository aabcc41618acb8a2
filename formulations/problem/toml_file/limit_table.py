"""The table ``[limits]`` of a problem file: alone, or laid over the limits of a robot's own files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.joint_words import UNITS, factors, joint_label, shown_unit
from formulations.problem.limits import LIMITED, Limits
from formulations.problem.toml_file.keys import LIMIT_KEYS
from formulations.problem.toml_file.toml_values import known_keys, read_choice, read_number, shown

if TYPE_CHECKING:
    from formulations.robot import Robot


def limits_of_table(
    table: Any, unit: str, names: Sequence[str], units: Sequence[str], reach: Array | None
) -> tuple[Limits, str]:
    """Read the table where it holds all limits.

    Parameters
    ----------
    table : object
        As ``tomllib`` reads it.
    unit : {"rad", "deg"}
        Unit of angles of the file.
    names, units : sequence of str
        Names (empty where there are none) and units of the joints.
    reach : Array, shape (dof, 2), or None
        Position limits where the table has none [rad].

    Returns
    -------
    limits : Limits
    unit : str
        Unit of angles in the table.

    Raises
    ------
    InputError
        In one line that names the key, the joint and the value.
    """
    unit = _unit(table, unit)
    if "velocity" not in table:
        raise InputError("limits.velocity: missing")
    given = _values(table, names, len(units))
    filled: dict[str, Any] = {}
    for key in LIMITED[:3]:
        if key in given:
            filled[key] = [given[key].get(joint, np.inf) for joint in range(len(units))]
    if "position" in given:
        free = (-np.inf, np.inf)
        filled["position"] = [given["position"].get(joint, free) for joint in range(len(units))]
    elif reach is not None:
        filled["position"] = reach / factors(units, unit)[:, None]
    return Limits.of(**filled, dof=len(units), unit=unit, units=units, names=names), unit


def limits_of_robot(table: Any, unit: str, robot: Robot) -> tuple[Limits, str]:
    """Lay the table over the limits of a robot.

    Parameters
    ----------
    table : object
        As ``tomllib`` reads it; what it does not give stays as it is.
    unit : {"rad", "deg"}
        Unit of angles of the file.
    robot : Robot
        With the limits of its files.

    Returns
    -------
    limits : Limits
    unit : str
        Unit of angles in the table.

    Raises
    ------
    InputError
        In one line that names the key, the joint and the value, or every limit that is still missing.
    """
    unit = _unit(table, unit)
    scales = factors(robot.units, unit)
    changes: dict[str, Any] = {}
    for key, by_joint in _values(table, robot.names, robot.dof).items():
        order = (LIMITED.index(key) + 1) % len(LIMITED)
        changes[key] = {}
        for joint, value in by_joint.items():
            low, high = value if order == 0 else (0.0, value)
            if not low < high:
                what = f"[{low:g}, {high:g}]" if order == 0 else f"{value:g}"
                fault = "empty" if order == 0 else "not positive"
                raise InputError(
                    f"limits.{key}: {joint_label(robot.names, joint)}: {what} "
                    f"{shown_unit(robot.units[joint], unit, order)} is {fault}"
                )
            scaled = np.asarray(value) * scales[joint]
            changes[key][robot.names[joint]] = tuple(scaled) if order == 0 else float(scaled)
    return robot.with_limits(**changes).limits, unit


def _unit(table: Any, unit: str) -> str:
    if not isinstance(table, dict):
        raise InputError(f"limits: expected a table, got {shown(table)}")
    known_keys("limits", table, tuple(LIMIT_KEYS))
    return read_choice("limits.unit", table.get("unit", unit), UNITS)


def _values(table: dict[str, Any], names: Sequence[str], dof: int) -> dict[str, dict[int, Any]]:
    """By quantity and joint: the number, or (least, greatest) position, as written."""
    found = {}
    for key in LIMITED:
        if key in table:
            found[key] = _by_joint(f"limits.{key}", table[key], names, dof, pair=key == "position")
    return found


def _by_joint(key: str, value: Any, names: Sequence[str], dof: int, *, pair: bool) -> dict[int, Any]:
    """One quantity: a number for all joints, a list with an entry per joint, or a table by joint name."""
    if isinstance(value, dict):
        if not names:
            raise InputError(f"{key}: a table by joint needs names of joints (key joints)")
        known_keys(key, value, tuple(names))
        entries = {names.index(name): entry for name, entry in value.items()}
        rows = list(entries)
        if not pair:
            return {j: read_number(f"{key}: {joint_label(names, j)}", entries[j]) for j in rows}
        return dict(zip(rows, _pairs(key, [entries[j] for j in rows], rows, names), strict=True))
    if pair:
        pairs = _pairs(key, value, list(range(dof)), names)
        if len(pairs) != dof:
            raise InputError(
                f"{key}: {len(pairs)} intervals; expected [low, high] for each of {dof} joints"
            )
        return dict(enumerate(pairs))
    if not isinstance(value, list):
        return dict.fromkeys(range(dof), read_number(key, value))
    if len(value) != dof:
        raise InputError(f"{key}: {len(value)} values for {dof} joints")
    return {j: read_number(f"{key}: {joint_label(names, j)}", entry) for j, entry in enumerate(value)}


def _pairs(key: str, value: Any, joints: list[int], names: Sequence[str]) -> list[tuple[float, float]]:
    """Intervals [low, high]; joints: whose they are, for messages."""
    if not isinstance(value, list) or not value or not all(isinstance(row, list) for row in value):
        raise InputError(f"{key}: expected [low, high] per joint, got {shown(value)}")
    found = []
    for index, row in enumerate(value):
        joint = joints[index] if index < len(joints) else index
        where = f"{key}: {joint_label(names if joint < len(names) else (), joint)}"
        if len(row) != 2:
            raise InputError(f"{where}: expected [low, high], got {shown(row)}")
        low, high = (read_number(f"{where}, value {k + 1}", x) for k, x in enumerate(row))
        found.append((low, high))
    return found
