"""Waypoints given as poses: the keys ``pose``, ``length`` and ``near``, for a robot or a shipped ``arm``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from formulations.arms import joints_of, load_arm, pose_of
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.joint_words import METRES, UNITS
from formulations.problem.toml_file.keys import POSE_KEYS
from formulations.problem.toml_file.robot_files import require_few
from formulations.problem.toml_file.toml_values import (
    known_keys,
    read_choice,
    read_matrix,
    read_number,
    shown,
)

if TYPE_CHECKING:
    from formulations.robot import Robot

POSED = ("arm", "pose", "length", "near")  # the keys that stand in place of waypoints
_FARTHEST, _MOST_ANGLE = 1e4, 1e6  # m, rad


def waypoints_of_poses(data: dict[str, Any], angle: float) -> tuple[Array, Array]:
    """Solve the poses of a problem file for joint waypoints.

    Each pose takes the solution nearest to the last waypoint, the first pose the one nearest to ``near``.

    Parameters
    ----------
    data : dict
        The file, as ``tomllib`` reads it.
    angle : float
        Radians per unit of angle in the file.

    Returns
    -------
    waypoints : Array, shape (n_waypoints, dof)
        Joint positions [rad].
    reach : Array, shape (dof, 2)
        The arm's own joint limits [rad].

    Raises
    ------
    InputError
        For a key or value that cannot be used; OutOfReach for a pose that no joint positions reach.
    """
    if not isinstance(data["arm"], str):
        raise InputError(f"arm: expected a name, got {shown(data['arm'])}")
    arm = load_arm(data["arm"])
    near = None
    if "near" in data:
        near = read_matrix("near", [data["near"]])[0] * angle
        _within("near", near, _MOST_ANGLE)
        if len(near) != arm.dof:
            raise InputError(f"near: {len(near)} values for {arm.dof} joints")
    return joints_of(arm, list(_poses(data, angle)), near), arm.position


def robot_waypoints_of_poses(data: dict[str, Any], robot: Robot, unit: str) -> Array:
    """Solve the poses of a problem file by the kinematics of a URDF, as those of a file of poses are.

    Parameters
    ----------
    data : dict
        The file, as ``tomllib`` reads it.
    robot : Robot
        Poses are those of its tip in its base.
    unit : {"rad", "deg"}
        Unit of angles in the file.

    Returns
    -------
    Array, shape (n_waypoints, dof)
        Joint positions [rad or m].

    Raises
    ------
    InputError
        For a key or value that cannot be used; OutOfReach for a pose that no joint positions reach.
    """
    from formulations.robot.waypoints.poses import Poses
    from formulations.robot.waypoints.reader import solve_poses

    near = data.get("near")
    if isinstance(near, Mapping):
        near = {name: read_number(f"near: joint {name}", value) for name, value in near.items()}
    elif near is not None:
        near = read_matrix("near", [near])[0].tolist()
    poses = Poses(_poses(data, UNITS[unit]), near=near, near_unit=unit)
    return solve_poses(poses, "pose", robot)


def _poses(data: dict[str, Any], angle: float) -> Array:
    """The poses of the tables ``[[pose]]``, (n, 4, 4) [m]."""
    metre = METRES[read_choice("length", data.get("length", "m"), METRES)]
    tables = data["pose"]
    if not isinstance(tables, list) or not tables or not all(isinstance(t, dict) for t in tables):
        raise InputError(f"pose: expected tables [[pose]], got {shown(tables)}")
    require_few("pose", len(tables))
    return np.array(
        [_pose(f"pose {index + 1}", table, metre, angle) for index, table in enumerate(tables)]
    )


def _pose(where: str, table: dict[str, Any], metre: float, angle: float) -> Array:
    """Pose (4, 4) of one table."""
    known_keys(where, table, tuple(POSE_KEYS))
    vectors = []
    for key in POSE_KEYS:
        if key not in table:
            raise InputError(f"{where}: {key}: missing")
        vector = read_matrix(f"{where}: {key}", [table[key]], "row", "value")[0]
        if len(vector) != 3:
            raise InputError(f"{where}: {key}: {len(vector)} values where 3 are expected")
        vectors.append(vector)
    position, rpy = vectors[0] * metre, vectors[1] * angle
    _within(f"{where}: position", position, _FARTHEST)
    _within(f"{where}: rpy", rpy, _MOST_ANGLE)
    return pose_of(position, rpy)


def _within(key: str, values: Array, most: float) -> None:
    """Refuse values [rad or m] with which nothing can be computed."""
    if (np.abs(values) > most).any():
        unit = "m" if most == _FARTHEST else "rad"
        raise InputError(f"{key}: {np.abs(values).max():g} {unit} is beyond {most:g} {unit}")
