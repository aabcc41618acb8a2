"""A problem as plain data, exact to the last bit: what the store keeps, so that it needs no other file."""

from __future__ import annotations

import hashlib
import json
from typing import Any

import numpy as np

from formulations import Limits, Problem
from formulations.kinematics.plain_chain import chain_of, plain_chain
from formulations.problem.arrays import Array
from formulations.problem.toml_file.condition_table import conditions_of_table
from formulations.problem.toml_file.plain_conditions import asked_as_json, with_infinities

_TEXTS = ("name", "family", "title", "source", "display_unit")
_LIMITS = ("velocity", "acceleration", "jerk", "position")
_INTERVALS = ("velocity_interval", "acceleration_interval")
_UNLIMITED = np.array([-np.inf, np.inf])


def plain_problem(problem: Problem) -> dict[str, Any]:
    """Return a problem as plain data.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    dict
        Ready for strict JSON; angles in rad, None for a limit that there is not. Conditions stand in it as in
        a problem file; where they are about the tool, the chain to it stands there too.
    """
    intervals = {key: getattr(problem.limits, key) for key in _INTERVALS}
    return {
        **{key: getattr(problem, key) for key in _TEXTS},
        "names": list(problem.names),
        "units": list(problem.units),
        "waypoints": problem.waypoints.tolist(),
        "limits": {
            **{key: _listed(getattr(problem.limits, key)) for key in _LIMITS},
            **{key: _listed(value) for key, value in intervals.items() if value is not None},
        },
        **asked_as_json(problem),
        **tool_as_json(problem),
    }


def tool_as_json(problem: Problem) -> dict[str, Any]:
    """Return the chain to the tool, where conditions are about it.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    dict
        With the key ``tool``, or empty: without such conditions the tool is no part of a problem.
    """
    if problem.tool is None or not problem.conditions.on_tool:
        return {}
    return {"tool": {"names": list(problem.tool.names), **plain_chain(problem.tool)}}


def problem_of(data: dict[str, Any]) -> Problem:
    """Return the problem that plain data states.

    Parameters
    ----------
    data : dict
        As ``plain_problem`` gives it.

    Returns
    -------
    Problem

    Raises
    ------
    ValueError
        If an entry is missing or of another type.
    """
    try:
        limits = data["limits"]
        arrays = {key: _filled(limits[key], np.inf) for key in _LIMITS[:3]}
        intervals = {key: _filled(limits[key], _UNLIMITED) for key in _INTERVALS if key in limits}
        whole = Limits(
            **arrays, position=_filled(limits["position"], _UNLIMITED), units=tuple(data["units"]),
            **intervals,
        )  # fmt: skip
        waypoints = np.array(data["waypoints"], dtype=np.float64)
        asked, tool = with_infinities(data.get("conditions", {})), data.get("tool")
        return Problem(
            waypoints,
            whole,
            conditions=conditions_of_table(asked, "rad", data["names"], whole, len(waypoints)),
            tool=None if tool is None else chain_of(tool, tuple(tool["names"])),
            names=data["names"],
            units=data["units"],
            **{key: data[key] for key in _TEXTS},
        )
    except (KeyError, TypeError) as error:
        raise ValueError(f"not a problem as it is stored: {error!r:.100}") from None


def instance_digest(problem: Problem) -> str:
    """Return a short hash of all that a problem states, its names and title too.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    str
        16 hexadecimal digits.
    """
    text = json.dumps(plain_problem(problem), sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _listed(values: Array) -> Any:
    found = values.astype(object)
    found[~np.isfinite(values)] = None
    return found.tolist()


def _filled(values: list[Any], value: float | Array) -> Array:
    found = np.array(values, dtype=np.float64)  # None becomes NaN
    return np.where(np.isnan(found), value, found)
