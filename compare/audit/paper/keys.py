"""The format of a paper's TOML file: every key that is read, and what it holds.

``FORMAT`` is the reference of the format: a dictionary is a table, a list with a dictionary is an array
of tables. A key that is not in it is refused, since a key that nobody reads switches off a check in
silence.
"""

from __future__ import annotations

import difflib
from typing import Any

from formulations import InputError

NUMBER = (int, float, str)
_NAMES: dict[Any, str] = {str: "text", int: "a whole number", list: "a list", NUMBER: "a number"}

# what the papers' tables and figures need beside the audit; each says where in the paper it stands
SETTINGS: dict[str, Any] = {
    "swarm": {
        "where": str,
        "population": int,
        "iterations": int,
        "dimensions": int,
        "alpha": NUMBER,  # peak of the tent map
        "inertia": list,  # first and last
        "factors": list,  # learning factors, first and last
        "mutation": list,  # probabilities, least and greatest
        "first_interval": NUMBER,  # s
        "low": NUMBER,  # edges of the search box, s
        "high": NUMBER,
    },
    "tent": {"where": str, "alpha": NUMBER, "population": int, "bins": int},
    "chaos": {
        "where": str,
        "beta": NUMBER,
        "population": int,
        "dimensions": int,
        "low": NUMBER,
        "high": NUMBER,
    },
    "ablation": {"where": str, "population": int, "dimensions": int, "iterations": int, "runs": int},
    "ablation_factors": {"where": str, "functions": list, "PSO1": list, "PSO2": list, "PSO3": list},
    "first_plan": {"where": str, "times": list},  # s
    "box": {"where": str, "seconds": list},
    "descent": {"where": str, "steady_after": int, "left_local_optimum": int},  # iterations
    "converged": {"where": str, "improved": int, "PSO": int, "WOA": int},  # iterations
    "arm": {"where": str, "d1": NUMBER},
}

FORMAT: dict[str, Any] = {
    "case": str,  # the case of formulations with this task; names a shipped paper
    "title": str,
    "source": str,
    "notes": str,
    "family": str,  # of FAMILIES
    "arm": str,  # of ARMS
    "limited": list,  # the derivatives that the paper limits
    "waypoints": {"where": str, "unit": str, "rows": list, "count": int},
    "limits": [
        {
            "name": str,
            "unit": str,
            "joint": int,
            "velocity": object,
            "acceleration": object,
            "jerk": object,
            "position": list,
        }
    ],
    "table": [
        {
            "where": str,
            "by": str,
            "limits": str,
            "joints": list,
            "times": list,
            "totals": list,
            "longest": list,
            "longest_where": str,
            "total": NUMBER,
        }
    ],
    "totals": [{"where": str, "by": str, "limits": str, "joint": int, "values": list, "mean": NUMBER}],
    "claim": [{"where": str, "says": str, "rule": str, "of": list, "equals": NUMBER}],
    "point": [{"where": str, "waypoint": int, "length": str, "position": list, "rpy": list}],
    "variant": [{"name": str, "waypoint": int, "joint": int, "value": NUMBER}],
    "left_out": [{"where": str, "what": str, "why": str}],
    "settings": SETTINGS,
}


def check_keys(data: dict[str, Any], known: dict[str, Any] = FORMAT, place: str = "") -> None:
    """Refuse what ``FORMAT`` does not know, at every depth.

    Parameters
    ----------
    data : dict
        A file or one of its tables, as TOML gives it.
    known : dict
        The part of ``FORMAT`` that describes it.
    place : str
        Where the table stands, for the message: "table: Table 2: ".

    Raises
    ------
    InputError
        For an unknown key, with the nearest known one, or for a value of another type.
    """
    for key, value in data.items():
        if key not in known:
            (near,) = difflib.get_close_matches(key, known, n=1, cutoff=0.0)
            raise InputError(
                f"{place}unknown key {key!r}; did you mean {near!r}? (known: {', '.join(known)})"
            )
        expected = known[key]
        if isinstance(expected, dict):
            if not isinstance(value, dict):
                raise InputError(f"{place}{key}: expected a table [{key}]")
            check_keys(value, expected, f"{place}{key}: ")
        elif isinstance(expected, list):
            if not isinstance(value, list) or not all(isinstance(table, dict) for table in value):
                raise InputError(f"{place}{key}: expected tables [[{key}]]")
            for number, table in enumerate(value, start=1):
                name = table.get("where", table.get("name", f"number {number}"))
                check_keys(table, expected[0], f"{place}{key}: {name}: ")
        elif not isinstance(value, expected) or isinstance(value, bool):
            raise InputError(f"{place}{key}: expected {_NAMES[expected]}, got {value!r:.50}")
