"""Conditions as the tables that ``condition_table`` reads: plain data for files and stores."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.condition_values import EndState
from formulations.problem.joint_words import factors
from formulations.problem.limits import Limits
from formulations.problem.toml_file.torque_table import table_of_torque

if TYPE_CHECKING:
    from formulations.problem.problem import Problem


def tables_of_conditions(problem: Problem, unit: str = "rad") -> dict[str, Any]:
    """Return the conditions of a problem as the table ``[conditions]`` holds them.

    Parameters
    ----------
    problem : Problem
    unit : {"rad", "deg"}
        Unit of angles; in rad the numbers are those of the problem to the last bit.

    Returns
    -------
    dict
        Numbers, texts, lists and tables; infinite numbers are floats.
    """
    asked, scales = problem.conditions, factors(problem.units, unit)
    found: dict[str, Any] = {}
    zones = {k: (np.asarray(zone) / scales).tolist() for k, zone in sorted(asked.tolerance.items())}
    inner = [zones.get(k) for k in range(1, problem.n_segments)]
    if inner and inner[0] is not None and all(zone == inner[0] for zone in inner):
        found["tolerance"] = inner[0]
        zones = {k: zone for k, zone in zones.items() if k in (0, problem.n_segments)}
    if asked.stops:
        found["stops"] = sorted(int(k) for k in asked.stops)
    if asked.cyclic:
        found["cyclic"] = True
    if asked.total is not None:
        found["total"] = float(asked.total)
    if asked.tool_speed is not None:
        found["tool_speed"] = float(asked.tool_speed)
    for key in ("start_velocity", "end_velocity", "start_acceleration", "end_acceleration"):
        if getattr(asked, key) is not None:
            found[key] = _state(getattr(asked, key), scales)
    found |= table_of_torque(asked.torque)
    rows = {
        "tolerance": zones,
        "pass": {k: float(time) for k, time in asked.passage.items()},
        "window": {k: _interval(given) for k, given in asked.windows.items()},
        "wait": {k: float(time) for k, time in asked.waits.items()},
        "tool_radius": {k: float(radius) for k, radius in asked.tool_zones.items()},
    }
    found |= _numbered("waypoint", "at", rows)
    times = {k: _interval(given) for k, given in asked.segment_times.items()}
    limits = {k: table_of_limits(given, unit) for k, given in asked.segment_limits.items()}
    speeds = {k: float(speed) for k, speed in asked.segment_tool_speed.items()}
    return found | _numbered("segment", "from", {"time": times, "tool_speed": speeds, "limits": limits})


def table_of_limits(limits: Limits, unit: str = "rad") -> dict[str, Any]:
    """Return limits as the table ``[limits]`` holds them, every one of them.

    Parameters
    ----------
    limits : Limits
    unit : {"rad", "deg"}
        Unit of angles.

    Returns
    -------
    dict
        Lists by quantity; infinite numbers stand for a limit that there is not.
    """
    scales = factors(limits.units or ("rad",) * len(limits.velocity), unit)
    derivatives = {
        key: (both / scales if interval is None else interval / scales[:, None]).tolist()
        for key, both, interval in (
            ("velocity", limits.velocity, limits.velocity_interval),
            ("acceleration", limits.acceleration, limits.acceleration_interval),
            ("jerk", limits.jerk, None),
        )
    }
    return {**derivatives, "position": (limits.position / scales[:, None]).tolist()}


def asked_as_json(problem: Problem) -> dict[str, Any]:
    """Return the conditions of a problem for strict JSON, in rad and m.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    dict
        With the key ``conditions``, whose table is that of a problem file, and "inf" for infinite numbers;
        empty where the problem has none.
    """
    asked = without_infinities(tables_of_conditions(problem))
    return {"conditions": asked} if asked else {}


def without_infinities(value: Any) -> Any:
    """Write infinite numbers as text, for strict JSON.

    Parameters
    ----------
    value : object
        Plain data.

    Returns
    -------
    object
        With "inf" and "-inf" in their place.
    """
    if isinstance(value, dict):
        return {key: without_infinities(one) for key, one in value.items()}
    if isinstance(value, list):
        return [without_infinities(one) for one in value]
    return repr(value) if isinstance(value, float) and math.isinf(value) else value


def with_infinities(value: Any) -> Any:
    """Read infinite numbers that ``without_infinities`` has written.

    Parameters
    ----------
    value : object
        Plain data.

    Returns
    -------
    object
    """
    if isinstance(value, dict):
        return {key: with_infinities(one) for key, one in value.items()}
    if isinstance(value, list):
        return [with_infinities(one) for one in value]
    return float(value) if isinstance(value, str) and value in ("inf", "-inf") else value


def _state(value: EndState, scales: Array) -> Any:
    return value if isinstance(value, str) else (np.asarray(value) / scales).tolist()


def _interval(given: Any) -> list[float]:
    return [float(one) for one in given]


def _numbered(kind: str, number: str, rows: Mapping[str, Mapping[int, Any]]) -> dict[str, Any]:
    """What is asked by key and number, as a list of tables in the order of the numbers."""
    numbers = sorted({int(k) for by_number in rows.values() for k in by_number})
    listed = [
        {number: k, **{key: by_number[k] for key, by_number in rows.items() if k in by_number}}
        for k in numbers
    ]
    return {kind: listed} if listed else {}
