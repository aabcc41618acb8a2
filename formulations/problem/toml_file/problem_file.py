"""Problem files (TOML) and the shipped cases, read into a ``Problem``. Every error is one line."""

from __future__ import annotations

import os
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from formulations.arms import Arm, load_arm
from formulations.families import FAMILIES
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, UnsupportedProblem
from formulations.problem.joint_words import METRES, UNITS
from formulations.problem.problem import Problem
from formulations.problem.toml_file.condition_table import conditions_of_table
from formulations.problem.toml_file.keys import PROBLEM_KEYS
from formulations.problem.toml_file.limit_table import limits_of_robot, limits_of_table
from formulations.problem.toml_file.poses import (
    POSED,
    robot_waypoints_of_poses,
    waypoints_of_poses,
)
from formulations.problem.toml_file.robot_files import (
    ROBOT_KEYS,
    URDF_KEYS,
    read_texts,
    require_few,
    robot_of_keys,
    waypoints_from,
)
from formulations.problem.toml_file.toml_text import LARGEST, parse_toml
from formulations.problem.toml_file.toml_values import (
    known_keys,
    nearest,
    read_choice,
    read_matrix,
    read_text,
    shown,
)
from formulations.robot.text.files import decode, read_bytes

if TYPE_CHECKING:
    from formulations.robot import Robot

CASES: tuple[str, ...] = tuple(
    sorted(
        entry.name.removesuffix(".toml")
        for entry in files("formulations.problem.cases").iterdir()
        if entry.name.endswith(".toml")
    )
)


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
    return parse(_text_of(file_or_case), where=str(file_or_case), folder=Path(file_or_case).parent)


def arm_in(file: str | Path) -> Arm | Robot | None:
    """Load the arm whose motion a problem file is about, to draw it.

    Parameters
    ----------
    file : str or Path
        A problem file that ``load`` accepts.

    Returns
    -------
    Arm or Robot or None
        That of the key ``arm`` or ``robot``; None where there is neither.

    Raises
    ------
    InputError
        In one line.
    """
    data = parse_toml(_text_of(file), str(file))
    if "arm" in data:
        return load_arm(data["arm"])
    return robot_of_keys(data, Path(file).parent) if "robot" in data else None


def _text_of(file_or_case: str | Path) -> str:
    """The text of a shipped case or of a file."""
    if str(file_or_case) in CASES:
        return (files("formulations.problem.cases") / f"{file_or_case}.toml").read_text("utf-8")
    path = Path(file_or_case)
    if not os.path.exists(path):  # Path.exists raises for a name that is too long
        raise InputError(f"{path}: no such file, and no case of that name (cases: {', '.join(CASES)})")
    return decode(read_bytes(path, largest=LARGEST), str(path))


def parse(text: str, *, where: str = "problem", folder: str | Path = ".") -> Problem:
    """Read a problem from TOML text.

    Parameters
    ----------
    text : str
        The keys are in ``keys``: ``waypoints``, ``waypoints_file``, or ``robot`` or ``arm`` and ``[[pose]]``;
        ``[limits]``, or ``robot`` and ``limits_file``; ``[conditions]``; and ``name``, ``joints``, ``unit``,
        ``family``, ....
    where : str
        Start of every error line.
    folder : str or Path
        Files that the text names are relative to it.

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
    data = parse_toml(text, where)
    try:
        return _problem(data, Path(folder))
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _problem(data: dict[str, Any], folder: Path) -> Problem:
    known_keys("key", data, tuple(PROBLEM_KEYS))
    texts = {key: read_text(key, data.get(key, "")) for key in ("name", "title", "source")}
    unit = read_choice("unit", data.get("unit", "rad"), UNITS)
    family = data.get("family")
    if family is not None:
        read_choice("family", family, FAMILIES)
    robot = _robot(data, folder)
    if robot is not None:  # a missing limit is asked for first
        limits, limit_unit = limits_of_robot(data.get("limits", {}), unit, robot)
    waypoints, angle, reach = _waypoints(data, folder, unit, robot)
    dof = waypoints.shape[1]
    if robot is not None:
        names, units = robot.names, robot.units
    else:
        names = read_texts("joints", data["joints"]) if "joints" in data else ()
        units = _units(data, names, dof)
        if "limits" not in data:
            raise InputError("limits: missing")
        limits, limit_unit = limits_of_table(data["limits"], unit, names, units, reach)
    conditions = None
    if "conditions" in data:
        conditions = conditions_of_table(data["conditions"], unit, names, limits, len(waypoints))
    problem = Problem(
        waypoints,
        limits,
        name=data.get("name", "problem"),
        family=family,
        title=texts["title"],
        source=texts["source"],
        display_unit=limit_unit,
        names=names,
        units=units,
        unit=angle,
        conditions=conditions,
    )
    if family is not None:
        reason = FAMILIES[family].refusal(problem.n_segments)
        if reason is not None:
            raise UnsupportedProblem(f"family: {reason}")
    return problem


def _robot(data: dict[str, Any], folder: Path) -> Robot | None:
    """The robot, or the joints, whose files are named; None without."""
    named = next((key for key in ("robot", "limits_file", "waypoints_file") if key in data), None)
    if named is not None:
        for key in ("arm", "prismatic") if named == "robot" else ("arm",):
            if key in data:
                raise InputError(f"{key}: given beside {named}; leave one of them out")
        return robot_of_keys(data, folder)
    for key in ROBOT_KEYS:
        if key in data:
            beside = "" if key in URDF_KEYS else ', or a limits_file = "FILE.yaml"'
            raise InputError(f'{key}: needs a robot (key robot = "FILE.urdf"){beside}')
    return None


def _waypoints(
    data: dict[str, Any], folder: Path, unit: str, robot: Robot | None
) -> tuple[Array, str, Array | None]:
    """Waypoints, the unit of their angles, and position limits (dof, 2) of an arm whose poses they are."""
    posed = (
        "pose" if robot is not None else "arm"
    )  # a robot's own kinematics, or those of a shipped arm
    given = [key for key in ("waypoints", "waypoints_file", posed) if key in data]
    if not given:
        raise InputError("waypoints: missing")
    if len(given) > 1:
        beside = " and ".join(given[1:])
        raise InputError(f"{given[0]}: given beside {beside}; leave all but one out")
    if given[0] == posed:
        if robot is not None:
            return robot_waypoints_of_poses(data, robot, unit), "rad", None
        if "pose" not in data:
            raise InputError("pose: missing")
        solved, reach = waypoints_of_poses(data, UNITS[unit])
        return solved, "rad", reach
    for key in POSED[1:]:
        if key in data and not (key == "length" and "waypoints_file" in data):
            raise InputError(f"{key}: needs an arm to be solved for (key robot or arm)")
    if robot is not None and "waypoints_file" in data:
        path = folder / read_text("waypoints_file", data["waypoints_file"])
        length = read_choice("length", data.get("length", "m"), METRES)
        return waypoints_from(path, robot, unit, length), "rad", None
    if isinstance(data["waypoints"], list):
        require_few("waypoints", len(data["waypoints"]))
    points = read_matrix("waypoints", data["waypoints"])
    if robot is not None and points.shape[1] != robot.dof:
        raise InputError(
            f"waypoints: {points.shape[1]} columns for {robot.dof} joints ({', '.join(robot.names)})"
        )
    return points, unit, None


def _units(data: dict[str, Any], names: tuple[str, ...], dof: int) -> tuple[str, ...]:
    """Unit per joint: m for those that the key ``prismatic`` names."""
    sliding = read_texts("prismatic", data.get("prismatic", []))
    for name in sliding:
        if not names:
            raise InputError("prismatic: names joints, so the key joints is needed too")
        if name not in names:
            raise InputError(f"prismatic: no joint {shown(name)}{nearest(name, names)}")
    return tuple("m" if j < len(names) and names[j] in sliding else "rad" for j in range(dof))
