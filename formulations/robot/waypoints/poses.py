"""Waypoints from Cartesian poses, solved by the URDF's own kinematics.

    tip: panda_hand_tcp          # link that is put at the poses; the robot's own if left out
    base: panda_link0            # link that they are measured from
    length: m                    # or mm
    unit: rad                    # of rpy and near; or deg
    near: [0, -0.8, 0, -2.4, 0, 1.6, 0.8]   # joint positions that the first waypoint is nearest to
    poses:
      - {position: [0.3, 0.1, 0.5], rpy: [3.14159265, 0, 0]}
      - {position: {x: 0.3, y: 0.2, z: 0.5}, orientation: {x: 1, y: 0, z: 0, w: 0}}

The same in JSON, or as CSV with the columns x, y, z and either roll, pitch, yaw or qx, qy, qz, qw.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.joint_words import METRES, UNITS
from formulations.robot.text.entry import TextEntry
from formulations.robot.text.files import known_names, shown
from formulations.robot.waypoints.csv_table import CsvTable, numbers_of

FARTHEST = 1e4  # m; a position beyond is a mistaken unit

_TOP = ("poses", "tip", "base", "length", "unit", "near")
_POSE = ("position", "rpy", "quaternion", "orientation")
_XYZ, _XYZW = ("x", "y", "z"), ("x", "y", "z", "w")
_RPY_COLUMNS = ("x", "y", "z", "roll", "pitch", "yaw")
_QUATERNION_COLUMNS = ("x", "y", "z", "qx", "qy", "qz", "qw")
_NORM = 1e-2  # that a quaternion's norm may differ from 1 by: digits of a file


@dataclass(frozen=True)
class Poses:
    """Poses as a file has them, in SI units.

    Attributes
    ----------
    poses : Array, shape (n, 4, 4)
        Poses of the tip link in the base link [m].
    tip, base : str or None
        Links; None where the file names none.
    near : mapping of str to float, or sequence of float, or None
        Joint positions that the first waypoint is nearest to, as the file has them.
    near_unit : str
        ``rad`` or ``deg``.
    """

    poses: Array
    tip: str | None = None
    base: str | None = None
    near: dict[str, float] | list[float] | None = None
    near_unit: str = "rad"


def poses_of_entry(top: TextEntry, unit: str = "rad", length: str = "m") -> Poses:
    """Read poses from YAML or JSON.

    Parameters
    ----------
    top : TextEntry
        The file.
    unit, length : str, optional
        Units where the file names none: ``rad`` or ``deg``, ``m`` or ``mm``.

    Returns
    -------
    Poses
        In SI units.

    Raises
    ------
    InputError
        For an unknown key, a value of the wrong type, and an orientation that is missing or given twice.
    """
    entries = top.entries(_TOP)
    unit = _unit(entries, "unit", UNITS, unit)
    length = _unit(entries, "length", METRES, length)
    found = []
    for entry in entries["poses"].elements():
        keys = entry.entries(_POSE)
        if "position" not in keys:
            raise entry.error("position is missing")
        given = [key for key in _POSE[1:] if key in keys]
        if len(given) != 1:
            raise entry.error(f"expected one of rpy, quaternion and orientation, got {len(given)}")
        key = given[0]
        position = _vector(keys["position"], _XYZ)
        angles = _vector(keys[key], ("roll", "pitch", "yaw") if key == "rpy" else _XYZW)
        found.append(_pose(keys["position"].place, position, angles, METRES[length], UNITS[unit]))
    if not found:
        raise entries["poses"].error("holds no pose")
    near: dict[str, float] | list[float] | None = None
    if "near" in entries:
        near = (
            {name: entry.number() for name, entry in entries["near"].entries().items()}
            if entries["near"].is_mapping
            else entries["near"].numbers()
        )
    tip, base = (entries[key].text() if key in entries else None for key in ("tip", "base"))
    return Poses(np.array(found), tip, base, near, unit)


def has_pose_columns(table: CsvTable) -> bool:
    """Whether a CSV file holds poses: its first three columns are x, y and z.

    Parameters
    ----------
    table : CsvTable
        Cells of a file.

    Returns
    -------
    bool
        False where it has no header.
    """
    return table.header is not None and {"x", "y", "z"} <= set(table.header)


def poses_of_table(table: CsvTable, unit: str = "rad", length: str = "m") -> Poses:
    """Read poses from CSV.

    Parameters
    ----------
    table : CsvTable
        With the columns x, y, z, and roll, pitch, yaw or qx, qy, qz, qw, in any order.
    unit, length : str, optional
        Units of the angles and the positions.

    Returns
    -------
    Poses
        In SI units.

    Raises
    ------
    InputError
        A column is missing, unknown or given twice.
    """
    header = table.header or ()
    wanted = _QUATERNION_COLUMNS if "qw" in header else _RPY_COLUMNS
    for column in header:
        if column not in wanted:
            raise InputError(f"{table.file}: column {shown(column)}; {known_names(column, wanted)}")
        if header.count(column) > 1:
            raise InputError(f"{table.file}: column {shown(column)} is given twice")
    missing = [column for column in wanted if column not in header]
    if missing:
        raise InputError(f"{table.file}: columns are missing: {', '.join(missing)}")
    values = numbers_of(table, header)[:, [header.index(column) for column in wanted]]
    found = [
        _pose(f"{table.file}: line {line}", row[:3], row[3:], METRES[length], UNITS[unit])
        for (line, _), row in zip(table.rows, values, strict=True)
    ]
    return Poses(np.array(found))


def _pose(
    where: str,
    position: Sequence[float] | Array,
    angles: Sequence[float] | Array,
    metre: float,
    radian: float,
) -> Array:
    """One pose (4, 4) from a position and roll, pitch, yaw or a quaternion x, y, z, w."""
    pose = np.eye(4)
    pose[:3, 3] = np.asarray(position) * metre
    if np.abs(pose[:3, 3]).max() > FARTHEST:
        raise InputError(
            f"{where}: {np.abs(pose[:3, 3]).max():g} m from the base; give length: mm if it is mm"
        )
    if len(angles) == 3:  # R = Rz(yaw) Ry(pitch) Rx(roll), as in URDF
        pose[:3, :3] = Rotation.from_euler("xyz", np.asarray(angles) * radian).as_matrix()
        return pose
    norm = float(np.linalg.norm(angles))
    if abs(norm - 1.0) > _NORM:
        raise InputError(f"{where}: the quaternion (x, y, z, w) has norm {norm:.6g}, not 1")
    pose[:3, :3] = Rotation.from_quat(np.asarray(angles)).as_matrix()
    return pose


def _vector(entry: TextEntry, names: tuple[str, ...]) -> list[float]:
    """Numbers in a list, or by name as ROS messages have them."""
    if not entry.is_mapping:
        return entry.numbers(len(names))
    entries = entry.entries(names)
    for name in names:
        if name not in entries:
            raise entry.error(f"{name} is missing")
    return [entries[name].number() for name in names]


def _unit(entries: dict[str, TextEntry], key: str, known: dict[str, float], default: str) -> str:
    if key not in entries:
        return default
    text = entries[key].text()
    if text not in known:
        raise entries[key].error(f"{shown(text)} is not one of {', '.join(known)}")
    return text
