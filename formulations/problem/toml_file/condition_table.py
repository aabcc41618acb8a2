"""The table ``[conditions]`` of a problem file: what is asked for beyond waypoints and limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.condition_values import EndState
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError
from formulations.problem.joint_words import factors, joint_label, shown_unit
from formulations.problem.limits import Limits
from formulations.problem.toml_file.joint_values import by_joint
from formulations.problem.toml_file.keys import CONDITION_KEYS, SEGMENT_KEYS, WAYPOINT_KEYS
from formulations.problem.toml_file.limit_table import limits_over
from formulations.problem.toml_file.toml_values import (
    known_keys,
    read_count,
    read_extended,
    read_flag,
    read_interval,
    read_number,
    shown,
)
from formulations.problem.toml_file.torque_table import torque_of_table

_FREE: Literal["free"] = "free"


def conditions_of_table(
    table: Any,
    unit: str,
    names: Sequence[str],
    limits: Limits,
    n_waypoints: int,
    urdf: Path | None = None,
) -> Conditions:
    """Read the table.

    Parameters
    ----------
    table : object
        As ``tomllib`` reads it.
    unit : {"rad", "deg"}
        Unit of angles of the file.
    names : sequence of str
        Of the joints; empty where there are none.
    limits : Limits
        Of the problem; those of segments lie over them.
    n_waypoints : int
        Number of waypoints.
    urdf : Path, optional
        The URDF of the problem's robot, whose dynamics torque limits are about.

    Returns
    -------
    Conditions
        Whether they fit the problem is not yet known.

    Raises
    ------
    InputError
        In one line that names the key, the joint and the value.
    """
    _require_table("conditions", table, CONDITION_KEYS)
    joints = _Joints(unit, tuple(names), limits)
    inner = joints.tolerances("conditions.tolerance", table.get("tolerance"))
    found: dict[str, Any] = {
        "tolerance": {} if inner is None else dict.fromkeys(range(1, n_waypoints - 1), inner),
        "stops": _stops(table.get("stops", [])),
        "cyclic": read_flag("conditions.cyclic", table.get("cyclic", False)),
        "torque": torque_of_table(table, names, len(limits.velocity), urdf),
    }
    if "total" in table:
        found["total"] = read_number("conditions.total", table["total"])
    if "tool_speed" in table:
        found["tool_speed"] = read_number("conditions.tool_speed", table["tool_speed"])
    for order, quantity in ((1, "velocity"), (2, "acceleration")):
        for key in (f"start_{quantity}", f"end_{quantity}"):
            found[key] = joints.state(f"conditions.{key}", table.get(key), order)
    _add_waypoints(found, _by_number("waypoint", table, "at", WAYPOINT_KEYS), joints)
    _add_segments(found, _by_number("segment", table, "from", SEGMENT_KEYS), joints)
    return Conditions(**found)


@dataclass(frozen=True)
class _Joints:
    """Reads values of the joints, which are written in the unit of the file."""

    unit: str
    names: tuple[str, ...]
    limits: Limits

    @property
    def units(self) -> tuple[str, ...]:
        return self.limits.units or ("rad",) * len(self.limits.velocity)

    def amounts(self, key: str, value: Any) -> Array:
        """A number per joint, (dof,) [rad or m, s]; 0 for joints that a table leaves out."""
        found = np.zeros(len(self.units))
        for joint, number in by_joint(key, value, self.names, len(found), read_number).items():
            found[joint] = number
        return found * factors(self.units, self.unit)

    def tolerances(self, key: str, value: Any) -> Array | None:
        """A zone, (dof,) [rad or m]; None where none is given."""
        if value is None:
            return None
        found = self.amounts(key, value)
        if (found < 0.0).any():
            joint = int((found < 0.0).argmax())
            amount = found[joint] / factors(self.units, self.unit)[joint]
            raise InputError(
                f"{key}: {joint_label(self.names, joint)}: {amount:g} "
                f"{shown_unit(self.units[joint], self.unit)} is no distance"
            )
        return found

    def state(self, key: str, value: Any, order: int) -> EndState:
        """A velocity or an acceleration at an end."""
        if value is None or value == _FREE:
            return None if value is None else _FREE
        if isinstance(value, str):
            unit = shown_unit("rad", self.unit, order)
            raise InputError(f'{key}: {shown(value)} is neither "free" nor numbers in {unit}')
        return self.amounts(key, value)


def _require_table(key: str, table: Any, known: dict[str, str]) -> None:
    if not isinstance(table, dict):
        raise InputError(f"{key}: expected a table, got {shown(table)}")
    known_keys(key, table, tuple(known))


def _stops(value: Any) -> frozenset[int]:
    if not isinstance(value, list):
        raise InputError(f"conditions.stops: expected a list of waypoints, got {shown(value)}")
    found = [read_count("conditions.stops", entry) for entry in value]
    for entry in found:
        if found.count(entry) > 1:
            raise InputError(f"conditions.stops: waypoint {entry} is given twice")
    return frozenset(found)


def _by_number(
    kind: str, table: dict[str, Any], number: str, known: dict[str, str]
) -> dict[int, dict[str, Any]]:
    """Tables ``[[conditions.KIND]]`` by the waypoint or segment that they are about."""
    rows = table.get(kind, [])
    if not isinstance(rows, list):
        raise InputError(f"conditions.{kind}: expected tables [[conditions.{kind}]], got {shown(rows)}")
    found: dict[int, dict[str, Any]] = {}
    for place, row in enumerate(rows, start=1):
        key = f"conditions.{kind} {place}"
        _require_table(key, row, known)
        if number not in row:
            raise InputError(f"{key}: {number}: missing")
        index = read_count(f"{key}: {number}", row[number])
        if index in found:
            raise InputError(f"{key}: {number} = {index}: {kind} {index} is given twice")
        if len(row) == 1:
            others = ", ".join(one for one in known if one != number)
            raise InputError(f"{key}: {number} = {index}: asks for nothing (known: {others})")
        found[index] = row
    return found


def _add_waypoints(found: dict[str, Any], rows: dict[int, dict[str, Any]], joints: _Joints) -> None:
    """Lay what is asked for at single waypoints over what is asked for at all."""
    passage, windows, waits, balls, stops = {}, {}, {}, {}, set(found["stops"])
    for index, row in rows.items():
        where = f"conditions.waypoint {index}"
        if "tolerance" in row:
            found["tolerance"][index] = joints.tolerances(f"{where}.tolerance", row["tolerance"])
        if "pass" in row:
            passage[index] = read_number(f"{where}.pass", row["pass"])
        if "window" in row:
            windows[index] = read_interval(
                f"{where}.window", row["window"], ends="earliest, latest", number=read_extended
            )
        if "wait" in row:
            waits[index] = read_number(f"{where}.wait", row["wait"])
        if "stop" in row and read_flag(f"{where}.stop", row["stop"]):
            stops.add(index)
        if "tool_radius" in row:
            balls[index] = read_number(f"{where}.tool_radius", row["tool_radius"])
    found |= {"passage": passage, "windows": windows, "waits": waits, "stops": frozenset(stops)}
    found["tool_zones"] = balls


def _add_segments(found: dict[str, Any], rows: dict[int, dict[str, Any]], joints: _Joints) -> None:
    times, limits, speeds = {}, {}, {}
    for index, row in rows.items():
        where = f"conditions.segment {index}"
        if "time" in row and "least_time" in row:
            raise InputError(f"{where}.least_time: given beside time; leave one of them out")
        if "time" in row:
            times[index] = read_interval(
                f"{where}.time", row["time"], ends="least, greatest", number=read_extended
            )
        if "least_time" in row:
            times[index] = read_number(f"{where}.least_time", row["least_time"]), math.inf
        if "tool_speed" in row:
            speeds[index] = read_number(f"{where}.tool_speed", row["tool_speed"])
        if "limits" in row:
            key = f"{where}.limits"
            limits[index] = limits_over(key, row["limits"], joints.unit, joints.limits, joints.names)
    found |= {"segment_times": times, "segment_limits": limits, "segment_tool_speed": speeds}
