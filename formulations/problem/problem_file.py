"""Problem files (TOML) and the shipped cases, read into a ``Problem``. Every error is one line."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any

from formulations.families import FAMILIES
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.joint_words import UNITS
from formulations.problem.poses import POSED, waypoints_of_poses
from formulations.problem.problem import Limits, Problem
from formulations.problem.toml_values import (
    known_keys,
    read_choice,
    read_limit,
    read_matrix,
    read_text,
    shown,
)

CASES: tuple[str, ...] = tuple(
    sorted(
        entry.name.removesuffix(".toml")
        for entry in files("formulations.problem.cases").iterdir()
        if entry.name.endswith(".toml")
    )
)

_KEYS = ("name", "title", "source", "unit", "family", "waypoints", "limits", *POSED)
_LIMIT_KEYS = ("unit", "velocity", "acceleration", "jerk", "position")
_LARGEST_FILE = 10_000_000  # bytes; a problem file is a few kilobytes


def load(file_or_case: str | Path) -> Problem:
    """Load the problem in a TOML file, or a shipped case.

    Parameters
    ----------
    file_or_case : str or Path
        Path of the file, or a name of ``CASES``: sr4c (Wang 2025), bagging (Li 2022), ur5 and
        ur5-corrected (Zhou 2025), z1 (Lu & Wang 2024), cobot (Zhang 2025).

    Returns
    -------
    Problem
        In rad and s, whatever the unit of the file.

    Raises
    ------
    InputError
        In one line that names the file, the key, the joint and the value.

    Examples
    --------
    >>> problem = load("sr4c")
    >>> problem.waypoints.shape, problem.family
    ((4, 6), '3-5-3')
    """
    if str(file_or_case) in CASES:
        text = (files("formulations.problem.cases") / f"{file_or_case}.toml").read_text("utf-8")
        return parse(text, where=str(file_or_case))
    path = Path(file_or_case)
    try:
        if path.stat().st_size > _LARGEST_FILE:
            raise InputError(f"{path}: larger than {_LARGEST_FILE} bytes, not a problem file")
        text = path.read_text("utf-8")
    except FileNotFoundError:
        raise InputError(
            f"{path}: no such file, and no case of that name (cases: {', '.join(CASES)})"
        ) from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: not a UTF-8 text file") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    return parse(text, where=str(path))


def parse(text: str, *, where: str = "problem") -> Problem:
    """Read a problem from TOML text.

    Parameters
    ----------
    text : str
        The keys are in the README: ``waypoints`` or ``arm`` and ``[[pose]]``, ``[limits]``, and ``name``,
        ``title``, ``source``, ``unit``, ``family``.
    where : str
        Start of every error line.

    Returns
    -------
    Problem

    Raises
    ------
    InputError
        In one line that names the key, the joint and the value.

    Examples
    --------
    >>> problem = parse('''
    ... unit = "deg"
    ... waypoints = [[0, 10], [20, -15], [60, 0]]
    ... [limits]
    ... velocity = [90, 120]
    ... acceleration = 300
    ... ''')
    >>> problem.dof, problem.n_segments
    (2, 2)
    """
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # ValueError: also whole numbers beyond 4300 digits
        raise InputError(f"{where}: not valid TOML: {error}") from None
    try:
        return _problem(data)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _problem(data: dict[str, Any]) -> Problem:
    known_keys("key", data, _KEYS)
    for key in ("pose" if "arm" in data else "waypoints", "limits"):
        if key not in data:
            raise InputError(f"{key}: missing")
    texts = {key: read_text(key, data.get(key, "")) for key in ("name", "title", "source")}
    unit = read_choice("unit", data.get("unit", "rad"), UNITS)
    family = data.get("family")
    if family is not None:
        read_choice("family", family, FAMILIES)
    reach = None
    if "arm" in data:
        waypoints, reach = waypoints_of_poses(data, UNITS[unit])
    else:
        for key in POSED[1:]:
            if key in data:
                raise InputError(f"{key}: needs an arm to be solved for (key arm)")
        waypoints = read_matrix("waypoints", data["waypoints"]) * UNITS[unit]
    limits, limit_unit = _limits(data["limits"], unit, waypoints.shape[1], reach)
    problem = Problem.of(
        waypoints,
        limits,
        name=data.get("name", "problem"),
        family=family,
        title=texts["title"],
        source=texts["source"],
        display_unit=limit_unit,
    )
    if family is not None:
        FAMILIES[family].require(problem)
    return problem


def _limits(table: Any, unit: str, dof: int, reach: Array | None) -> tuple[Limits, str]:
    """Limits of the table [limits], and their unit; reach: position limits (dof, 2) where none are given."""
    if not isinstance(table, dict):
        raise InputError(f"limits: expected a table, got {shown(table)}")
    known_keys("limits", table, _LIMIT_KEYS)
    if "velocity" not in table:
        raise InputError("limits.velocity: missing")
    unit = read_choice("limits.unit", table.get("unit", unit), UNITS)
    scale = UNITS[unit]
    limits: dict[str, Any] = {}
    for key in ("velocity", "acceleration", "jerk"):
        if key in table:
            limits[key] = read_limit(f"limits.{key}", table[key], dof) * scale
    if "position" in table:
        limits["position"] = read_matrix("limits.position", table["position"], "joint", "value") * scale
    elif reach is not None:
        limits["position"] = reach
    return Limits.of(**limits, dof=dof), unit
