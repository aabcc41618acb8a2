"""Waypoints from a ROS JointTrajectory, as JSON or YAML: the positions of its points.

The message may stand alone or inside those that carry it: RobotTrajectory and MoveIt's results
(``joint_trajectory``), FollowJointTrajectory goals (``trajectory``), DisplayTrajectory (a list of one).
Times, velocities, accelerations and efforts are left aside: waypoints are positions.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.robot.text.entry import TextEntry
from formulations.robot.text.files import known_names, shown
from formulations.robot.waypoints.csv_table import MOST_WAYPOINTS, check_complete

WRAPPERS = ("joint_trajectory", "trajectory", "goal")
MESSAGE = ("header", "joint_names", "points")

_BESIDE = (  # what ROS messages have beside a trajectory
    "multi_dof_joint_trajectory",
    "multi_dof_trajectory",
    "path_tolerance",
    "component_path_tolerance",
    "goal_tolerance",
    "component_goal_tolerance",
    "goal_time_tolerance",
    "model_id",
    "trajectory_start",
)
POINT = ("positions", "velocities", "accelerations", "effort", "time_from_start")


def trajectory_positions(top: TextEntry, names: Sequence[str]) -> Array:
    """Positions of all points, in the order of the joints.

    Parameters
    ----------
    top : TextEntry
        A JointTrajectory, or a message that holds one.
    names : sequence of str
        The joints that are moved.

    Returns
    -------
    Array, shape (n_points, n_joints)
        As the file has them.

    Raises
    ------
    InputError
        For an unknown key, a joint that is missing, unknown or given twice, and a point without positions.
    """
    message = message_of(top)
    entries = message.entries(MESSAGE)
    for key in ("joint_names", "points"):
        if key not in entries:
            raise message.error(f"{key} is missing")
    given = [entry.text() for entry in entries["joint_names"].elements()]
    for entry, name in zip(entries["joint_names"].elements(), given, strict=True):
        if name not in names:
            raise entry.error(f"{shown(name)} is not a joint that is moved; {known_names(name, names)}")
    check_complete(entries["joint_names"].place, "joint_names", given, names)
    points = entries["points"].elements()
    if len(points) > MOST_WAYPOINTS:
        raise entries["points"].error(f"{len(points)} points; at most {MOST_WAYPOINTS} are read")
    rows = []
    for point in points:
        keys = point.entries(POINT)
        if "positions" not in keys:
            raise point.error("positions are missing")
        positions = keys["positions"]
        values = positions.elements()
        if len(values) != len(given):
            raise positions.error(
                f"{len(values)} positions for {len(given)} joints ({', '.join(given)})"
            )
        rows.append([_number(entry, name) for entry, name in zip(values, given, strict=True)])
    order = [given.index(name) for name in names]
    return np.array(rows, dtype=np.float64).reshape(-1, len(given))[:, order]


def trajectory_joints(top: TextEntry) -> tuple[str, ...]:
    """The joints that a JointTrajectory names.

    Parameters
    ----------
    top : TextEntry
        A JointTrajectory, or a message that holds one.

    Returns
    -------
    tuple of str
        In its order.

    Raises
    ------
    InputError
        It names none.
    """
    message = message_of(top)
    entries = message.entries(MESSAGE)
    if "joint_names" not in entries:
        raise message.error("joint_names is missing")
    return tuple(entry.text() for entry in entries["joint_names"].elements())


def _number(entry: TextEntry, joint: str) -> float:
    try:
        return entry.number()
    except InputError as error:
        raise InputError(f"{error} (joint {shown(joint)})") from None


def message_of(top: TextEntry) -> TextEntry:
    """The JointTrajectory inside the messages that carry it.

    Parameters
    ----------
    top : TextEntry
        A JointTrajectory, or a message that holds one.

    Returns
    -------
    TextEntry
        With the keys ``joint_names`` and ``points``, if it is one.

    Raises
    ------
    InputError
        For a key that stands beside a trajectory in no such message, and a list of several.
    """
    current = top
    for _ in range(4):
        if current.is_list:
            elements = current.elements()
            if len(elements) != 1:
                raise current.error(f"{len(elements)} trajectories; one is read")
            current = elements[0]
        inner = next((key for key in WRAPPERS if current.has(key)), None)
        if inner is None:
            break
        current = current.entries((inner, *_BESIDE))[inner]
    return current
