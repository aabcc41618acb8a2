"""The table ``[limits]`` of a problem file: alone, or laid over other limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.joint_words import UNITS, factors, joint_label, shown_unit
from formulations.problem.limits import LIMITED, Limits
from formulations.problem.toml_file.joint_values import by_joint, intervals_by_joint
from formulations.problem.toml_file.keys import LIMIT_KEYS
from formulations.problem.toml_file.toml_values import (
    Number,
    known_keys,
    read_choice,
    read_extended,
    read_interval,
    read_number,
    shown,
)

if TYPE_CHECKING:
    from formulations.robot import Robot

Limit: TypeAlias = float | tuple[float, float]


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
    unit = _unit("limits", table, unit)
    if "velocity" not in table:
        raise InputError("limits.velocity: missing")
    given = _values("limits", table, names, len(units))
    filled: dict[str, Any] = {}
    for key in LIMITED[:3]:
        if key in given:
            filled[key] = _alike([given[key].get(joint, np.inf) for joint in range(len(units))])
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
    unit = _unit("limits", table, unit)
    given = _values("limits", table, robot.names, robot.dof)
    changes = _in_si("limits", given, unit, robot.names, robot.units)
    moduli: dict[str, Any] = {
        key: {
            robot.names[joint]: value if key == "position" else float(np.abs(value).max())
            for joint, value in by_number.items()
        }
        for key, by_number in changes.items()
    }
    whole = robot.with_limits(**moduli).limits  # a missing limit is asked for
    return _with(whole, changes, robot.names, robot.units), unit


def limits_over(key: str, table: Any, unit: str, whole: Limits, names: Sequence[str]) -> Limits:
    """Lay the limits of a segment over those of its problem.

    Parameters
    ----------
    key : str
        Where the table stands, for the message.
    table : object
        As ``tomllib`` reads it; what it does not give stays as it is. ``inf`` takes a limit away.
    unit : {"rad", "deg"}
        Unit of angles of the file.
    whole : Limits
        Of the problem.
    names : sequence of str
        Of the joints; empty where there are none.

    Returns
    -------
    Limits

    Raises
    ------
    InputError
        In one line that names the key, the joint and the value.
    """
    unit = _unit(key, table, unit)
    units = whole.units or ("rad",) * len(whole.velocity)
    given = _values(key, table, names, len(units), read_extended)
    return _with(whole, _in_si(key, given, unit, names, units), names, units)


def _unit(key: str, table: Any, unit: str) -> str:
    if not isinstance(table, dict):
        raise InputError(f"{key}: expected a table, got {shown(table)}")
    known_keys(key, table, tuple(LIMIT_KEYS))
    return read_choice(f"{key}.unit", table.get("unit", unit), UNITS)


def _values(
    key: str, table: dict[str, Any], names: Sequence[str], dof: int, number: Number = read_number
) -> dict[str, dict[int, Limit]]:
    """By quantity and joint: the number, or (least, greatest) value, as written."""
    found: dict[str, dict[int, Limit]] = {}
    for quantity in LIMITED:
        if quantity not in table:
            continue
        where, value = f"{key}.{quantity}", table[quantity]
        if quantity == "position":
            found[quantity] = dict(intervals_by_joint(where, value, names, dof, number))
            continue

        def read(place: str, entry: Any, *, both: bool = quantity != "jerk") -> Limit:
            if both and isinstance(entry, list):
                return read_interval(place, entry, ends="least, greatest", number=number)
            return number(place, entry)

        found[quantity] = by_joint(where, value, names, dof, read)
    return found


def _in_si(
    key: str,
    given: dict[str, dict[int, Limit]],
    unit: str,
    names: Sequence[str],
    units: Sequence[str],
) -> dict[str, dict[int, Limit]]:
    """The same in rad and m; a limit that cannot be is refused in the unit that it was written in."""
    scales = factors(units, unit)
    found: dict[str, dict[int, Limit]] = {}
    for quantity, by_number in given.items():
        order = (LIMITED.index(quantity) + 1) % len(LIMITED)
        found[quantity] = {}
        for joint, value in by_number.items():
            low, high = _pair(value)
            fine = low < high if order == 0 else low < 0.0 < high
            if not fine:
                shown_value = f"[{low:g}, {high:g}]" if isinstance(value, tuple) else f"{value:g}"
                fault = "is empty" if order == 0 else "does not hold 0 inside"
                if not isinstance(value, tuple):
                    fault = "is not positive"
                raise InputError(
                    f"{key}.{quantity}: {joint_label(names, joint)}: {shown_value} "
                    f"{shown_unit(units[joint], unit, order)} {fault}"
                )
            scale = float(scales[joint])
            pair = isinstance(value, tuple)
            found[quantity][joint] = (low * scale, high * scale) if pair else high * scale
    return found


def _with(
    whole: Limits,
    changes: dict[str, dict[int, Limit]],
    names: Sequence[str],
    units: Sequence[str],
) -> Limits:
    """Limits with some replaced [rad and m]."""
    speeds, steepest = (np.array(one) for one in whole.intervals)
    merged: dict[str, Any] = {
        "velocity": speeds,
        "acceleration": steepest,
        "jerk": np.array(whole.jerk),
        "position": np.array(whole.position),
    }
    for quantity, by_number in changes.items():
        for joint, value in by_number.items():
            both_ways = quantity in LIMITED[:2]
            merged[quantity][joint] = _pair(value) if both_ways else value
    return Limits.of(**merged, dof=len(units), units=units, names=names)


def _alike(values: list[Limit]) -> list[Any]:
    """All of them as pairs where one is."""
    if not any(isinstance(value, tuple) for value in values):
        return values
    return [_pair(value) for value in values]


def _pair(value: Limit) -> tuple[float, float]:
    """The limits in the two directions."""
    return value if isinstance(value, tuple) else (-value, value)
