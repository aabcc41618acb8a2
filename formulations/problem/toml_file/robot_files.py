"""A problem from files: limit files and a file of waypoints, with the URDF and SRDF of a robot or without.

Problem files name them under the keys of ``ROBOT_KEYS``; the commands have options for them. The package
``formulations.robot`` is loaded when a robot is asked for, not before.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem
from formulations.problem.size import MOST_WAYPOINTS
from formulations.problem.toml_file.toml_values import read_number, read_text, shown

if TYPE_CHECKING:
    from formulations.robot import Robot

SCALINGS = ("velocity_scaling", "acceleration_scaling", "jerk_scaling")
URDF_KEYS = ("srdf", "group", "base", "tip")  # what only a URDF gives a meaning
ROBOT_KEYS = ("robot", "limits_file", "unlimited", *URDF_KEYS, *SCALINGS)
FREE = ("acceleration", "jerk", "position")  # limits that a joint may go without


@dataclass(frozen=True)
class RobotFiles:
    """Which files describe a robot, and which of its joints move.

    Attributes
    ----------
    robot : Path or None
        The URDF; None where joints have names and limits alone.
    joints : tuple of str or None
        The joints to move, in order; None for all, or for those of the group. Without a URDF, for those
        that the waypoints name, or else the limits files.
    group : str or None
        A group of the SRDF.
    srdf : Path or None
        MoveIt's semantic description.
    limits : tuple of Path
        joint_limits.yaml files, each laid over the ones before.
    unlimited : tuple of str
        Quantities that a joint may have no limit of.
    base, tip : str or None
        Links that Cartesian poses are measured from and given for.
    scaling : mapping of str to float
        Factors on the limits, by the names of ``SCALINGS``.
    prismatic : tuple of str
        Without a URDF: the joints whose positions are lengths.
    waypoints : Path or None
        Their file.
    """

    robot: Path | None = None
    joints: tuple[str, ...] | None = None
    group: str | None = None
    srdf: Path | None = None
    limits: tuple[Path, ...] = ()
    unlimited: tuple[str, ...] = ()
    base: str | None = None
    tip: str | None = None
    scaling: Mapping[str, float] | None = None
    prismatic: tuple[str, ...] = ()
    waypoints: Path | None = None

    def read(self) -> Robot:
        """Read the robot; raises InputError in one line, also where the extra ``robot`` is missing."""
        from formulations.robot import joint_names_in, robot_of, robot_of_joints

        if self.robot is None:
            for key in URDF_KEYS:
                if getattr(self, key) is not None:
                    raise InputError(f'{key}: needs a robot (key robot = "FILE.urdf")')
            names = self.joints
            if names is None and self.waypoints is not None:
                names = joint_names_in(self.waypoints)
            return robot_of_joints(
                names,
                prismatic=self.prismatic,
                limits=self.limits,
                unlimited=self.unlimited,
                **(self.scaling or {}),
            )
        return robot_of(
            self.robot,
            joints=self.joints,
            group=self.group,
            srdf=self.srdf,
            limits=self.limits,
            unlimited=self.unlimited,
            base=self.base,
            tip=self.tip,
            **(self.scaling or {}),
        )


def robot_of_keys(data: Mapping[str, Any], folder: Path) -> Robot:
    """Read the robot that a problem file names.

    Parameters
    ----------
    data : mapping
        The file, as ``tomllib`` reads it, with the key ``robot``, ``limits_file`` or ``waypoints_file``.
    folder : Path
        Folder of the file; paths are relative to it.

    Returns
    -------
    Robot
        Its own ``limits`` may still be incomplete.

    Raises
    ------
    InputError
        In one line that names the key or the file.
    """
    paths = {}
    for key in ("robot", "waypoints_file", *URDF_KEYS):
        if key in data:
            paths[key] = folder / read_text(key, data[key])
    free = read_texts("unlimited", data.get("unlimited", []))
    if not {"robot", "limits_file"} & set(data):
        free = FREE  # as in a file that has only the table [limits]
    return RobotFiles(
        robot=paths.get("robot"),
        joints=read_texts("joints", data["joints"]) if "joints" in data else None,
        group=data.get("group"),
        srdf=paths.get("srdf"),
        limits=tuple(folder / name for name in read_texts("limits_file", data.get("limits_file", []))),
        unlimited=free,
        base=data.get("base"),
        tip=data.get("tip"),
        scaling={key: read_number(key, data[key]) for key in SCALINGS if key in data},
        prismatic=read_texts("prismatic", data.get("prismatic", [])),
        waypoints=paths.get("waypoints_file"),
    ).read()


def problem_from(files: RobotFiles, *, unit: str = "rad", length: str = "m") -> Problem:
    """Read a problem from files alone.

    Parameters
    ----------
    files : RobotFiles
        The robot, and the file of its waypoints.
    unit : {"rad", "deg"}
        Unit of angles in the waypoints, in messages and in reports.
    length : {"m", "mm"}
        Unit of lengths in the waypoints.

    Returns
    -------
    Problem
        Named after the file of waypoints.

    Raises
    ------
    InputError
        In one line that names the file, the joint and the value.
    """
    if files.waypoints is None:
        raise InputError("waypoints: missing")
    robot = files.read()
    limits = robot.limits  # what is missing is asked for first
    return Problem(
        waypoints_from(files.waypoints, robot, unit, length),
        limits,
        name=files.waypoints.stem,
        names=robot.names,
        display_unit=unit,
    )


def read_texts(key: str, value: Any) -> tuple[str, ...]:
    """Read one text, or a list of them.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.

    Returns
    -------
    tuple of str

    Raises
    ------
    InputError
        It is something else.
    """
    found = value if isinstance(value, list) else [value]
    for entry in found:
        if not isinstance(entry, str):
            raise InputError(f"{key}: expected a text or a list of texts, got {shown(entry)}")
    return tuple(found)


def require_few(key: str, count: int) -> None:
    """Refuse more waypoints than are planned.

    Parameters
    ----------
    key : str
        Where they stand, for the message.
    count : int
        How many there are.

    Raises
    ------
    InputError
        More than ``MOST_WAYPOINTS``.
    """
    if count > MOST_WAYPOINTS:
        raise InputError(
            f"{key}: {count} waypoints; at most {MOST_WAYPOINTS} are planned, so thin them out"
        )


def waypoints_from(path: Path, robot: Robot, unit: str, length: str) -> Array:
    """Read a file of waypoints.

    Parameters
    ----------
    path : Path
        A table, a JointTrajectory or poses.
    robot : Robot
        Whose waypoints they are.
    unit : {"rad", "deg"}
        Unit of angles.
    length : {"m", "mm"}
        Unit of lengths.

    Returns
    -------
    Array, shape (n_waypoints, dof)
        [rad or m].
    """
    from formulations.robot import waypoints_of

    found = waypoints_of(path, robot, unit=unit, length=length)
    require_few(str(path), len(found))
    return found
