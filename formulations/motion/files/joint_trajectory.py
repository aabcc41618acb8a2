"""Points of a motion as ROS's message trajectory_msgs/JointTrajectory, in JSON and in YAML.

    joint_names: ["elbow", "wrist"]
    points:
    - positions: [0.0, 0.5]
      velocities: [0.0, 0.0]
      accelerations: [0.0, 0.0]
      time_from_start: {sec: 0, nanosec: 8000000}

``ros2 topic pub``, MoveIt and ros2_control read both. Numbers have a point and no exponent, because YAML 1.1
takes ``1e-05`` for text. The message may stand inside those that carry it (MoveIt's RobotTrajectory, a goal
of FollowJointTrajectory). A time is ``{sec, nanosec}``, ROS 1's ``{secs, nsecs}``, or a number of seconds.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from formulations.motion.files.checked import named, numbered, stacked
from formulations.motion.files.decimals import decimals_of, write_records
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.files.records import (
    LARGEST_IRREGULAR,
    Records,
    json_records,
    require_small,
    yaml_records,
)
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.robot.text.entry import TextEntry
from formulations.robot.text.files import decode
from formulations.robot.text.trees import parse_json, parse_yaml
from formulations.robot.waypoints.trajectory import MESSAGE, POINT, message_of

_STAMPS = (("sec", "nanosec"), ("secs", "nsecs"))
_PLURALS = {"position": "positions", "velocity": "velocities", "acceleration": "accelerations"}


def write_json(points: MotionPoints) -> bytes:
    """Write points as JSON.

    Parameters
    ----------
    points : MotionPoints
        The points, checked.

    Returns
    -------
    bytes
        The file, a line per point; times are rounded to a nanosecond.
    """
    names = _names(points)
    rows = _rows(
        points, b'{"%s": [', b', "%s": [', b'], "time_from_start": {"sec": ', b', "nanosec": ', b"}},\n"
    )
    return b'{"joint_names": ' + names + b', "points": [\n' + rows[:-2] + b"\n]}\n"


def write_yaml(points: MotionPoints) -> bytes:
    """Write points as YAML.

    Parameters
    ----------
    points : MotionPoints
        The points, checked.

    Returns
    -------
    bytes
        The file; times are rounded to a nanosecond.
    """
    names = _names(points)
    rows = _rows(
        points, b"- %s: [", b"\n  %s: [", b"]\n  time_from_start: {sec: ", b", nanosec: ", b"}\n"
    )
    return b"joint_names: " + names + b"\npoints:\n" + rows


def _names(points: MotionPoints) -> bytes:
    """The list of names; YAML does not know how JSON escapes what is beyond 16 bits."""
    names = list(points.names or numbered(points.positions.shape[1], "joint_"))
    return json.dumps(names, ensure_ascii=False).encode()


def _rows(
    points: MotionPoints, first: bytes, next_: bytes, sec: bytes, nanosec: bytes, end: bytes
) -> bytes:
    """All points; the arguments are what stands around the numbers."""
    columns, quantities = stacked(points)
    dof = points.positions.shape[1]
    stamps = np.rint(points.times * 1e9)
    if (np.diff(stamps) <= 0.0).any():
        raise InputError(
            "time: two points lie less than a nanosecond apart, the digits of a JointTrajectory"
        )
    literals = []
    for k, quantity in enumerate(quantities):
        opening = (b"]" + next_ if k else first) % _PLURALS[quantity].encode()
        literals += [opening, *[b", "] * (dof - 1)]
    whole = np.floor(stamps / 1e9)
    table = np.column_stack([columns, whole, stamps - whole * 1e9])
    decimals = np.concatenate([decimals_of(columns), [0, 0]]).astype(np.intp)
    return write_records(table, decimals, [*literals, sec, nanosec, end])


def read_json(data: bytes, file: str, *, records: bool = True) -> MotionPoints:
    """Read points from JSON.

    Parameters
    ----------
    data : bytes
        A file.
    file : str
        Its name, for messages.
    records : bool
        Whether points that are written alike may be read at once.

    Returns
    -------
    MotionPoints
        Not checked yet.

    Raises
    ------
    InputError
        Names the key.
    """
    return _read(data, file, parse_json, json_records if records else None)


def read_yaml(data: bytes, file: str, *, records: bool = True) -> MotionPoints:
    """Read points from YAML.

    Parameters
    ----------
    data : bytes
        A file.
    file : str
        Its name, for messages.
    records : bool
        Whether points that are written alike may be read at once.

    Returns
    -------
    MotionPoints
        Not checked yet.

    Raises
    ------
    InputError
        Names line and key.
    """
    return _read(data, file, parse_yaml, yaml_records if records else None)


def _read(
    data: bytes,
    file: str,
    parse: Callable[[str, str], TextEntry],
    split: Callable[[bytes], Records | None] | None,
) -> MotionPoints:
    found = split(data) if split else None
    if found is not None:
        try:
            points = _message(parse(decode(found.document, file), file)).points(found)
        except InputError:
            if len(data) > LARGEST_IRREGULAR:
                raise
            points = None  # read anew: the line is that of the document, not that of the file
        if points is not None:
            return points
    require_small(data, file, found)
    points = _message(parse(decode(data, file), file)).points()
    assert points is not None
    return points


@dataclass(frozen=True)
class _Message:
    """The numbers of a JointTrajectory."""

    names: tuple[str, ...]
    seconds: Array  # (n_points,)
    nanoseconds: Array | None  # (n_points,)
    values: tuple[Array | None, ...]  # (n_points, dof) each

    def points(self, records: Records | None = None) -> MotionPoints | None:
        """The points; those of records, if the message tells what these are. None if it does not."""
        seconds, nanoseconds, values = self.seconds, self.nanoseconds, self.values
        if records is not None:
            marks = [seconds[:, None], *([] if nanoseconds is None else [nanoseconds[:, None]])]
            marks += [value for value in values if value is not None]
            table = records.columns(np.concatenate(marks, axis=1)[0]) if len(seconds) == 1 else None
            if table is None:
                return None
            ends = np.cumsum([mark.shape[1] for mark in marks])
            parts = iter(np.split(table, ends[:-1], axis=1))
            seconds = next(parts)[:, 0]
            if nanoseconds is not None:
                nanoseconds = next(parts)[:, 0]
                if not all(np.array_equal(np.rint(part), part) for part in (seconds, nanoseconds)):
                    return None
            values = tuple(None if value is None else next(parts) for value in values)
        if nanoseconds is not None:
            with np.errstate(over="ignore"):  # an infinite time is refused with the others
                seconds = (seconds * 1e9 + nanoseconds) / 1e9  # correctly rounded: both are whole
        positions, velocities, accelerations = values
        assert positions is not None
        return MotionPoints(seconds, positions, velocities, accelerations, named(self.names, "joint_"))


def _message(top: TextEntry) -> _Message:
    message = message_of(top)
    entries = message.entries(MESSAGE)
    if "points" not in entries:
        raise message.error("points is missing")
    points = entries["points"].elements()
    if not points:
        raise entries["points"].error("a motion needs two points or more")
    names = (
        [entry.text() for entry in entries["joint_names"].elements()]
        if "joint_names" in entries
        else []
    )
    keys = [point.entries(POINT) for point in points]
    for point, found in zip(points, keys, strict=True):
        for key in ("positions", "time_from_start"):
            if key not in found:
                raise point.error(f"{key} is missing")
    dof = len(names) or len(keys[0]["positions"].elements())
    values = tuple(_values(points, keys, name, dof, names) for name in _PLURALS.values())
    if values[0] is None:
        raise points[0].error("positions is empty")
    stamps = [_stamp(found["time_from_start"]) for found in keys]
    if all(nanosecond is not None for _, nanosecond in stamps):
        whole = np.array(stamps, dtype=np.float64)
        return _Message(tuple(names), whole[:, 0], whole[:, 1], values)
    seconds = [s if ns is None else (s * 1e9 + ns) / 1e9 for s, ns in stamps]
    return _Message(tuple(names), np.array(seconds), None, values)


def _values(
    points: list[TextEntry], keys: list[dict[str, TextEntry]], name: str, dof: int, joints: list[str]
) -> Array | None:
    """One list of numbers per point; None where no point has one."""
    lists = [found[name].elements() if name in found else [] for found in keys]
    if not any(lists):
        return None
    rows = []
    for point, entries in zip(points, lists, strict=True):
        if not entries:
            other = next(k for k, entry in enumerate(lists) if entry)
            raise point.error(
                f"no {name}, and points[{other}] has them; give all points {name}, or none"
                if name != "positions"
                else "positions is empty"
            )
        if len(entries) != dof:
            of = f" ({', '.join(joints)})" if joints else ""
            raise point.error(f"{len(entries)} {name} for {dof} joints{of}")
        rows.append([entry.number() for entry in entries])
    return np.array(rows, dtype=np.float64)


def _stamp(entry: TextEntry) -> tuple[float, float | None]:
    """Seconds, and nanoseconds where the time has them."""
    if not entry.is_mapping:
        return entry.number(), None
    first = next((pair for pair in _STAMPS if entry.has(*pair)), _STAMPS[0])
    found = entry.entries(first)
    if not found:
        raise entry.error("sec and nanosec are missing")
    parts = [found[key].number() if key in found else 0.0 for key in first]
    for key, part in zip(first, parts, strict=True):
        if part != int(part):
            raise entry.error(f"{key}: {part:g} is not a whole number")
    return parts[0], parts[1]
