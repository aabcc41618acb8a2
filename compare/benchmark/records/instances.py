"""A problem as plain data, exact to the last bit: what the store keeps, so that it needs no other file."""

from __future__ import annotations

import hashlib
import json
from typing import Any

import numpy as np

from formulations import Limits, Problem
from formulations.problem.arrays import Array

_TEXTS = ("name", "family", "title", "source", "display_unit")
_LIMITS = ("velocity", "acceleration", "jerk", "position")


def plain_problem(problem: Problem) -> dict[str, Any]:
    """Return a problem as plain data.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    dict
        Ready for strict JSON; angles in rad, None for a limit that there is not.
    """
    return {
        **{key: getattr(problem, key) for key in _TEXTS},
        "names": list(problem.names),
        "units": list(problem.units),
        "waypoints": problem.waypoints.tolist(),
        "limits": {key: _listed(getattr(problem.limits, key)) for key in _LIMITS},
    }


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
        position = np.array(limits["position"], dtype=np.float64)  # None becomes NaN
        unlimited = np.array([-np.inf, np.inf])
        arrays = {key: _filled(limits[key], np.inf) for key in _LIMITS[:3]}
        return Problem(
            np.array(data["waypoints"], dtype=np.float64),
            Limits(
                **arrays,
                position=np.where(np.isnan(position), unlimited, position),
                units=tuple(data["units"]),
            ),
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


def _filled(values: list[float | None], value: float) -> Array:
    found = np.array(values, dtype=np.float64)
    return np.where(np.isnan(found), value, found)
