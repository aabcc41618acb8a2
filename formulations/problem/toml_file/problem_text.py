"""The text of a problem file that states a problem whole, so that reading it gives an equal problem."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from formulations.arms import ARMS, load_arm
from formulations.problem.errors import InputError
from formulations.problem.files import write_text
from formulations.problem.problem import Problem
from formulations.problem.toml_file.plain_conditions import table_of_limits, tables_of_conditions
from formulations.problem.toml_file.problem_file import parse

_LIMITS = ("acceleration", "jerk", "position")


def problem_text(problem: Problem) -> str:
    """Write a problem as TOML, conditions included.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    str
        In ``problem.display_unit`` where its decimals give the same numbers back, else in rad.

    Raises
    ------
    InputError
        Some joints have a limit and others not, and joints without names cannot be told apart in a file.

    Examples
    --------
    >>> import formulations as f
    >>> problem = f.Problem([[0], [90]], {"velocity": 90}, unit="deg")
    >>> print(problem_text(problem))
    name = "problem"
    title = "problem"
    source = ""
    unit = "deg"
    waypoints = [
      [0.0],
      [90.0],
    ]
    <BLANKLINE>
    [limits]
    velocity = [90.0]
    <BLANKLINE>
    """
    if problem.display_unit != "rad":
        text = _text(problem, problem.display_unit)
        if parse(text) == problem:
            return text
    return _text(problem, "rad")


def save(problem: Problem, path: str | Path) -> None:
    """Write a problem file, which ``load`` and every command read.

    Parameters
    ----------
    problem : Problem
        With its conditions.
    path : str or Path
        The file; one that is there is replaced.

    Raises
    ------
    InputError
        The file cannot be written, or its format cannot say what the problem says.

    Examples
    --------
    >>> import formulations as f
    >>> asked = f.Conditions(tolerance={1: [0.1]}, waits={1: 0.5})
    >>> problem = f.Problem([[0.0], [1.0], [0.5]], {"velocity": 1.0}, conditions=asked)
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     f.save(problem, f"{folder}/mine.toml")
    ...     f.load(f"{folder}/mine.toml") == problem
    True
    """
    write_text(Path(path), problem_text(problem))


def _text(problem: Problem, unit: str) -> str:
    scale = np.array(
        [np.pi / 180.0 if unit == "deg" and one == "rad" else 1.0 for one in problem.units]
    )
    lines = [f"{key} = {_toml(getattr(problem, key))}" for key in ("name", "title", "source")]
    if problem.conditions.on_tool:
        lines.append(f"arm = {_toml(_arm_of(problem))}")
    lines.append(f"unit = {_toml(unit)}")
    if problem.family != Problem(problem.waypoints, problem.limits).family:
        lines.append(f"family = {_toml(problem.family)}")
    if problem.names:
        lines.append(f"joints = {_toml(list(problem.names))}")
    sliding = [j for j, one in enumerate(problem.units) if one == "m"]
    if sliding:
        if not problem.names:
            raise InputError("names: missing: a file tells joints that slide by their names")
        lines.append(f"prismatic = {_toml([problem.names[j] for j in sliding])}")
    rows = [f"  {_toml(row)}," for row in (problem.waypoints / scale).tolist()]
    lines += ["waypoints = [", *rows, "]", "", "[limits]"]
    limits = table_of_limits(problem.limits, unit)
    lines += [
        f"{key} = {_toml(_said(problem, key, value))}" for key, value in limits.items() if _any(value)
    ]
    asked = tables_of_conditions(problem, unit)
    tables = {key: asked.pop(key) for key in ("waypoint", "segment") if key in asked}
    if asked:
        lines += ["", "[conditions]", *_pairs(asked)]
    for kind, listed in tables.items():
        for row in listed:
            lines += ["", f"[[conditions.{kind}]]", *_pairs(row)]
    return "\n".join(lines) + "\n"


def _arm_of(problem: Problem) -> str:
    """The shipped arm whose tool the problem limits."""
    for name in ARMS:
        if load_arm(name).tool == problem.tool:
            return name
    raise InputError("tool: it is that of no shipped arm; write the key robot of the file by hand")


def _any(value: list[Any]) -> bool:
    """Whether any joint has this limit."""
    return bool(np.isfinite(np.array(value)).any())


def _said(problem: Problem, key: str, value: list[Any]) -> Any:
    """The limits of one quantity as a list, or by name where some joints have none."""
    if key == "velocity" or np.isfinite(np.array(value)).all():
        return value
    by_name: dict[str, Any] = {}
    for joint, entry in enumerate(value):
        finite = np.isfinite(entry)
        if not finite.any():
            continue
        if not problem.names:
            raise InputError(f"names: missing: a file tells joints without limits.{key} by their names")
        if not finite.all():
            raise InputError(
                f"limits.{key}: {problem.joint_name(joint)}: {entry} is finite at one end only, which no "
                "problem file can say"
            )
        by_name[problem.names[joint]] = entry
    return by_name


def _pairs(table: dict[str, Any]) -> list[str]:
    return [f"{key} = {_toml(value)}" for key, value in table.items()]


def _toml(value: Any) -> str:
    """A value of TOML; floats with all their digits."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(_toml(entry) for entry in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{_toml(key)} = {_toml(entry)}' for key, entry in value.items())}}}"
    return repr(value)
