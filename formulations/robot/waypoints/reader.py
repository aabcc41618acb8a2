"""One file of waypoints -> joint positions in the order of the robot's joints, whatever the format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, OutOfReach
from formulations.problem.joint_words import METRES, UNITS
from formulations.problem.problem import POSITION_TOLERANCE
from formulations.robot.robot import Robot
from formulations.robot.text.entry import TextEntry
from formulations.robot.text.files import decode, known_names, read_bytes, shown
from formulations.robot.text.trees import parse_json, parse_yaml
from formulations.robot.waypoints.csv_table import PREFIX, joint_columns, parse_table
from formulations.robot.waypoints.poses import (
    Poses,
    has_pose_columns,
    poses_of_entry,
    poses_of_table,
)
from formulations.robot.waypoints.trajectory import (
    MESSAGE,
    WRAPPERS,
    trajectory_joints,
    trajectory_positions,
)

LARGEST_WAYPOINTS = 20_000_000  # bytes
SUFFIXES = (".csv", ".txt", ".json", ".yaml", ".yml")


def waypoints_of(path: str | Path, robot: Robot, *, unit: str = "rad", length: str = "m") -> Array:
    """Read waypoints of a robot.

    Parameters
    ----------
    path : str or Path
        A table (.csv, .txt) of joint positions or poses; or a JointTrajectory or poses (.json, .yaml, .yml).
    robot : Robot
        Whose waypoints they are.
    unit : str, optional
        Unit of the angles in the file: ``rad`` or ``deg``. Positions of prismatic joints are lengths.
    length : str, optional
        Unit of the lengths in the file: ``m`` or ``mm``.

    Returns
    -------
    Array, shape (n_waypoints, dof)
        Joint positions in the order of the robot's joints [rad or m].

    Raises
    ------
    InputError
        One line that names file, line, joint and value. OutOfReach, which is one, for a pose that the robot
        cannot reach.
    """
    for key, value, known in (("unit", unit, UNITS), ("length", length, METRES)):
        if value not in known:
            raise InputError(f"{key}: {shown(value)} is not one of {', '.join(known)}")
    _suffix(path)
    return parse_waypoints(
        read_bytes(path, largest=LARGEST_WAYPOINTS), str(path), robot, unit=unit, length=length
    )


def joint_names_in(path: str | Path) -> tuple[str, ...] | None:
    """Read which joints a file of waypoints names.

    Parameters
    ----------
    path : str or Path
        As for ``waypoints_of``.

    Returns
    -------
    tuple of str, or None
        In the order of the file; None where it names none: a table without a header, or poses.

    Raises
    ------
    InputError
        One line that names the file.
    """
    file = str(path)
    text = decode(read_bytes(path, largest=LARGEST_WAYPOINTS), file)
    if _suffix(path) in (".csv", ".txt"):
        header = parse_table(text, file).header
        return None if header is None else tuple(column.removeprefix(PREFIX) for column in header)
    top: TextEntry = (parse_json if file.lower().endswith(".json") else parse_yaml)(text, file)
    return None if top.has("poses") else trajectory_joints(top)


def _suffix(path: str | Path) -> str:
    """The ending of a file that can be read."""
    suffix = Path(path).suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(
            f"{path}: waypoints are read from {', '.join(SUFFIXES)}, not from {shown(suffix)}"
        )
    return suffix


def parse_waypoints(
    data: bytes, file: str, robot: Robot, *, unit: str = "rad", length: str = "m"
) -> Array:
    """Read waypoints from what a file holds; otherwise as ``waypoints_of``.

    Parameters
    ----------
    data : bytes
        The file.
    file : str
        Its name: the suffix says the format.
    robot : Robot
        Whose waypoints they are.
    unit, length : str, optional
        Units of angles and lengths.

    Returns
    -------
    Array, shape (n_waypoints, dof)
        Joint positions [rad or m].

    Raises
    ------
    InputError
        One line.
    """
    found = positions_or_poses(data, file, robot, unit, length)
    waypoints = (
        solve_poses(found, file, robot)
        if isinstance(found, Poses)
        else found * _scale(robot, unit, length)
    )
    if len(waypoints) < 2:
        raise InputError(f"{file}: {len(waypoints)} waypoint; a motion needs two or more")
    _check_positions(waypoints, file, robot, unit)
    return waypoints


def positions_or_poses(
    data: bytes, file: str, robot: Robot, unit: str = "rad", length: str = "m"
) -> Array | Poses:
    """Read a file without solving or checking positions: the first half of ``parse_waypoints``.

    Parameters
    ----------
    data : bytes
        The file.
    file : str
        Its name: the suffix says the format.
    robot : Robot
        Whose waypoints they are.
    unit, length : str, optional
        Units of the poses in a file that names none.

    Returns
    -------
    Array, shape (n_waypoints, dof), or Poses
        Joint positions in the units of the file, or poses in SI units.

    Raises
    ------
    InputError
        One line.
    """
    text = decode(data, file)
    if Path(file).suffix.lower() in (".csv", ".txt"):
        table = parse_table(text, file)
        if has_pose_columns(table) and not {"x", "y", "z"} & set(robot.names):
            return poses_of_table(table, unit, length)
        others = [] if robot.urdf is None else [joint.name for joint in robot.urdf.joints]
        return joint_columns(table, robot.names, others)
    top: TextEntry = (parse_json if file.lower().endswith(".json") else parse_yaml)(text, file)
    if top.has("poses"):
        return poses_of_entry(top, unit, length)
    if top.is_list or top.has(*MESSAGE, *WRAPPERS):
        return trajectory_positions(top, robot.names)
    key = next(iter(top.entries()), "")
    raise InputError(
        f"{top.place}: neither poses nor a JointTrajectory: key {shown(key)}; "
        f"{known_names(key, ('poses', *MESSAGE, *WRAPPERS))}"
    )


def solve_poses(found: Poses, file: str, robot: Robot) -> Array:
    """Joint positions for poses, each nearest to the last.

    Parameters
    ----------
    found : Poses
        Poses of a file.
    file : str
        Its name, for messages.
    robot : Robot
        The robot that shall reach them.

    Returns
    -------
    Array, shape (n, dof)
        Joint positions [rad or m].

    Raises
    ------
    InputError
        A link or joint is unknown. OutOfReach, which is one, where a pose cannot be reached.
    """
    links = () if robot.urdf is None else robot.urdf.links
    for key, link in (("tip", found.tip), ("base", found.base)):
        if link is not None and link not in links:
            raise InputError(f"{file}: {key}: no link {shown(link)}; {known_names(link, links)}")
    robot = replace(robot, base=found.base or robot.base, tip=found.tip or robot.tip)
    try:
        return robot.inverse(found.poses, near=_near(found, file, robot))
    except OutOfReach as error:
        raise OutOfReach(f"{file}: link {shown(robot.tip)}: {error}", error.distance) from None
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def _near(found: Poses, file: str, robot: Robot) -> Array | None:
    """The start that a file gives, by joint name or in the robot's order [rad or m]."""
    near: Mapping[str, float] | Sequence[float] | None = found.near
    if near is None:
        return None
    if isinstance(near, Mapping):
        for name in near:
            if name not in robot.names:
                raise InputError(
                    f"{file}: near: no joint {shown(name)}; {known_names(name, robot.names)}"
                )
        missing = [name for name in robot.names if name not in near]
        if missing:
            raise InputError(f"{file}: near: no position for {', '.join(map(shown, missing))}")
        values = [near[name] for name in robot.names]
    else:
        values = list(near)
        if len(values) != robot.dof:
            raise InputError(
                f"{file}: near: {len(values)} positions for {robot.dof} joints ({', '.join(robot.names)})"
            )
    return np.array(values) * _scale(robot, found.near_unit, "m")


def _scale(robot: Robot, unit: str, length: str) -> Array:
    """SI units per unit of the file, (dof,)."""
    return np.array([METRES[length] if name == "m" else UNITS[unit] for name in robot.units])


def _check_positions(waypoints: Array, file: str, robot: Robot, unit: str) -> None:
    """Refuse a waypoint outside the position limits; say so where degrees would be inside."""
    bounds = np.array([joint.position or (-np.inf, np.inf) for joint in robot.joints])
    outside = np.maximum(bounds[:, 0] - waypoints, waypoints - bounds[:, 1]) > POSITION_TOLERANCE
    if not outside.any():
        return
    row, k = (int(i) for i in np.argwhere(outside)[0])
    joint, value, (low, high) = robot.joints[k], waypoints[row, k], bounds[k]
    rotary = np.array([name == "rad" for name in robot.units])
    turned = np.where(rotary, np.deg2rad(waypoints), waypoints)
    fits = ((turned >= bounds[:, 0]) & (turned <= bounds[:, 1])).all()
    hint = (
        "; in degrees all would be inside: unit='deg'?"
        if fits and unit == "rad" and joint.unit == "rad"
        else ""
    )
    scale = np.rad2deg(1.0) if unit == "deg" and joint.unit == "rad" else 1.0
    shown_unit = unit if joint.unit == "rad" else joint.unit
    raise InputError(
        f"{file}: waypoint {row + 1}: joint {shown(joint.name)}: {scale * value:.6g} {shown_unit} lies outside "
        f"its position limits [{scale * low:.6g}, {scale * high:.6g}] {shown_unit}{hint}"
    )
