"""Problem files (TOML) and the shipped cases -> Problem. Every error is one line."""

from __future__ import annotations

import math
import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from formulations.arms import joints_of, load_arm, pose_of
from formulations.arms.arm import METRES
from formulations.families import FAMILIES
from formulations.problem.errors import InputError
from formulations.problem.problem import Limits, Problem

CASES: tuple[str, ...] = tuple(
    sorted(
        entry.name.removesuffix(".toml")
        for entry in files("formulations.problem.cases").iterdir()
        if entry.name.endswith(".toml")
    )
)

_POSED = ("arm", "pose", "length", "near")  # instead of waypoints
_KEYS = ("name", "title", "source", "unit", "family", "waypoints", "limits", *_POSED)
_POSE_KEYS = ("position", "rpy")
_LIMIT_KEYS = ("unit", "velocity", "acceleration", "jerk", "position")
_UNITS = {"rad": 1.0, "deg": math.pi / 180.0}
_LARGEST_FILE = 10_000_000  # bytes; a problem file is a few kilobytes


def load(file_or_case: str | Path) -> Problem:
    """The problem in a TOML file, or the shipped case of that name.

    Raises InputError with one line that names the key, the joint and the value.
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
    """A problem from TOML text; ``where`` opens every error line."""
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # ValueError: also whole numbers beyond 4300 digits
        raise InputError(f"{where}: not valid TOML: {error}") from None
    try:
        return _problem(data)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _problem(data: dict[str, Any]) -> Problem:
    _known_keys("key", data, _KEYS)
    for key in ("pose" if "arm" in data else "waypoints", "limits"):
        if key not in data:
            raise InputError(f"{key}: missing")
    for key in ("name", "title", "source"):
        if not isinstance(data.get(key, ""), str):
            raise InputError(f"{key}: expected text, got {_shown(data[key])}")
    unit = _unit("unit", data.get("unit", "rad"))
    family = data.get("family")
    if family is not None and (not isinstance(family, str) or family not in FAMILIES):
        raise InputError(f"family: {_shown(family)} is not one of {', '.join(FAMILIES)}")

    if "arm" in data:
        waypoints, reach = _waypoints_of_poses(data, _UNITS[unit])
    else:
        for key in _POSED[1:]:
            if key in data:
                raise InputError(f"{key}: needs an arm to be solved for (key arm)")
        waypoints, reach = _matrix("waypoints", data["waypoints"]) * _UNITS[unit], None
    dof = waypoints.shape[1]
    table = data["limits"]
    if not isinstance(table, dict):
        raise InputError(f"limits: expected a table, got {_shown(table)}")
    _known_keys("limits", table, _LIMIT_KEYS)
    if "velocity" not in table:
        raise InputError("limits.velocity: missing")
    limit_unit = _unit("limits.unit", table.get("unit", unit))
    scale = _UNITS[limit_unit]
    limits: dict[str, Any] = {}
    for key in ("velocity", "acceleration", "jerk"):
        if key in table:
            limits[key] = _limit(f"limits.{key}", table[key], dof) * scale
    if "position" in table:
        limits["position"] = _matrix("limits.position", table["position"], "joint", "value") * scale
    elif reach is not None:
        limits["position"] = reach
    problem = Problem.of(
        waypoints,
        Limits.of(**limits, dof=dof),
        name=data.get("name", "problem"),
        family=family,
        title=data.get("title", ""),
        source=data.get("source", ""),
        display_unit=limit_unit,
    )
    if family is not None:
        FAMILIES[family].require(problem)
    return problem


def _waypoints_of_poses(data: dict[str, Any], angle: float) -> tuple[Any, Any]:
    """Joint waypoints (n, dof) of ``[[pose]]`` by inverse kinematics; the arm's joint limits (dof, 2).

    angle: rad per unit of the file. Each pose takes the branch nearest to the last one, the first the
    one nearest to ``near``.
    """
    if "waypoints" in data:
        raise InputError("waypoints: given beside arm and pose; leave one of them out")
    if not isinstance(data["arm"], str):
        raise InputError(f"arm: expected a name, got {_shown(data['arm'])}")
    arm = load_arm(data["arm"])
    length = data.get("length", "m")
    if not isinstance(length, str) or length not in METRES:
        raise InputError(f"length: {_shown(length)} is not one of {', '.join(METRES)}")
    near = None
    if "near" in data:
        near = _matrix("near", [data["near"]])[0] * angle
        if len(near) != arm.dof:
            raise InputError(f"near: {len(near)} values for {arm.dof} joints")
    tables = data["pose"]
    if not isinstance(tables, list) or not tables or not all(isinstance(t, dict) for t in tables):
        raise InputError(f"pose: expected tables [[pose]], got {_shown(tables)}")
    poses = []
    for index, table in enumerate(tables):
        where = f"pose {index + 1}"
        _known_keys(where, table, _POSE_KEYS)
        vectors = []
        for key in _POSE_KEYS:
            if key not in table:
                raise InputError(f"{where}: {key}: missing")
            vector = _matrix(f"{where}: {key}", [table[key]], "row", "value")[0]
            if len(vector) != 3:
                raise InputError(f"{where}: {key}: {len(vector)} values where 3 are expected")
            vectors.append(vector)
        poses.append(pose_of(vectors[0] * METRES[length], vectors[1] * angle))
    return joints_of(arm, poses, near), arm.position


def _unit(key: str, value: Any) -> str:
    if not isinstance(value, str) or value not in _UNITS:
        raise InputError(f"{key}: {_shown(value)} is not one of {', '.join(_UNITS)}")
    return value


def _shown(value: Any) -> str:
    """A value as a person would recognise it, cut to one short line."""
    try:
        return f"{value!r:.50}"
    except ValueError:  # a whole number beyond 4300 digits
        return "a number of thousands of digits"


def _known_keys(kind: str, table: dict[str, Any], known: tuple[str, ...]) -> None:
    for key in table:
        if key not in known:
            raise InputError(f"{kind}: unknown key {_shown(key)} (known: {', '.join(known)})")


def _number(key: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"{key}: expected a number, got {_shown(value)}")
    try:
        number = float(value)
    except OverflowError:
        raise InputError(f"{key}: {_shown(value)} is too large") from None
    if not math.isfinite(number):
        raise InputError(f"{key}: {number} is not finite (leave the key out if unlimited)")
    return number


def _limit(key: str, value: Any, dof: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    if not isinstance(value, list):
        return np.full(dof, _number(key, value))
    if len(value) != dof:
        raise InputError(f"{key}: {len(value)} values for {dof} joints")
    return np.array([_number(f"{key}: joint {j + 1}", entry) for j, entry in enumerate(value)])


def _matrix(
    key: str, rows: Any, row_name: str = "row", column_name: str = "joint"
) -> np.ndarray[Any, np.dtype[np.float64]]:
    if not isinstance(rows, list) or not rows or not all(isinstance(row, list) for row in rows):
        raise InputError(f"{key}: expected a list of rows, got {_shown(rows)}")
    width = len(rows[0])
    if width == 0:
        raise InputError(f"{key}: {row_name} 1 is empty")
    for index, row in enumerate(rows):
        if len(row) != width:
            raise InputError(
                f"{key}: {row_name} {index + 1} has {len(row)} values, {row_name} 1 has {width}"
            )
    return np.array(
        [
            [_number(f"{key}: {row_name} {i + 1}, {column_name} {j + 1}", x) for j, x in enumerate(row)]
            for i, row in enumerate(rows)
        ]
    )
