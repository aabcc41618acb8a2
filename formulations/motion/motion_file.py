"""Motions as files that a robot controller reads, and back: CSV, or a ROS JointTrajectory as JSON.

    CSV    time, position_1.., velocity_1.., acceleration_1..; a row per point [s, rad, rad/s, rad/s^2]
    JSON   {"joint_names": [...], "points": [{"positions": [...], "velocities": [...],
           "accelerations": [...], "time_from_start": {"sec": 0, "nanosec": 0}}, ...]}

Points lie at a fixed rate, or at the times at which the polynomial pieces of the motion meet. A reader joins
two points by the quintic that has their positions, velocities and accelerations, as ROS's
joint_trajectory_controller does. This gives back a motion whose pieces have degree 5 or less exactly, if its
file has the points where pieces meet; JSON rounds their times to a nanosecond.
"""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import BPoly, PPoly

from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.files import write_text

_QUANTITIES = ("position", "velocity", "acceleration")
_LARGEST = 200_000_000  # bytes of a file to be read


def write_motion(path: str | Path, trajectory: Trajectory, *, rate: float | None = None) -> None:
    """Write a motion to a file, whole or not at all.

    Parameters
    ----------
    path : str or Path
        Ends in .csv (a row per point, [s, rad, rad/s, rad/s^2]) or .json (a ROS JointTrajectory).
    trajectory : Trajectory
        The motion.
    rate : float, optional
        Points per second [1/s]. Left out: one point wherever two polynomial pieces meet.

    Raises
    ------
    InputError
        For another suffix, a rate that is not positive, or a file that cannot be written.

    Examples
    --------
    >>> import formulations as f
    >>> spline = f.FAMILIES["3-5-3"].trajectory(f.load("sr4c"), [5.0, 3.0, 5.0])
    >>> f.write_motion("sr4c.csv", spline, rate=125.0)  # doctest: +SKIP
    >>> f.read_motion("sr4c.csv").seconds  # doctest: +SKIP
    13.0
    """
    path = Path(path)
    if rate is None:
        times = trajectory.breaks
    else:
        times, _ = trajectory.sample(rate)
    values = np.stack([trajectory.at(times, order) for order in range(3)], axis=1)
    if path.suffix == ".csv":
        text = _as_csv(times, values)
    elif path.suffix == ".json":
        text = _as_json(times, values)
    else:
        raise InputError(f"{path}: a motion is written as .csv or .json, not {path.suffix!r}")
    write_text(path, text)


def read_motion(path: str | Path, *, passages: Array | None = None) -> Trajectory:
    """Read a motion that ``write_motion`` or another program wrote in one of its formats.

    Parameters
    ----------
    path : str or Path
        A .json file, or a CSV file.
    passages : Array, shape (n_waypoints,), optional
        Times at which the waypoints are passed [s]. Left out: every point of the file is a waypoint.

    Returns
    -------
    Trajectory
        Quintics between the points.

    Raises
    ------
    InputError
        Names the file, the row and the value.
    """
    points = read_points(path)
    values = np.stack([points.positions, points.velocities, points.accelerations], axis=1)  # type: ignore[list-item]
    pieces = PPoly.from_bernstein_basis(BPoly.from_derivatives(points.times, values))
    coefficients = np.moveaxis(pieces.c, 0, -1)[..., ::-1]
    return Trajectory(np.diff(points.times), np.ascontiguousarray(coefficients), passages)


def read_points(path: str | Path) -> MotionPoints:
    """Read the points of a motion, as they stand in a file.

    Parameters
    ----------
    path : str or Path
        A .json file, or a CSV file.

    Returns
    -------
    MotionPoints

    Raises
    ------
    InputError
        Names the file, the row and the value.
    """
    path = Path(path)
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(f"{path}: larger than {_LARGEST} bytes")
        text = path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    try:
        times, values = _from_json(text) if path.suffix == ".json" else _from_csv(text)
    except (LookupError, TypeError, ValueError, OverflowError, RecursionError) as error:
        raise InputError(f"{path}: not a motion: {type(error).__name__}: {error}") from None
    if values.ndim != 3 or len(times) < 2 or not values.shape[2]:
        raise InputError(f"{path}: a motion needs two points or more of one joint or more")
    for name, array in (("time", times), *zip(_QUANTITIES, np.moveaxis(values, 1, 0), strict=True)):
        if not np.isfinite(array).all():
            raise InputError(f"{path}: {name} must be finite")
    wrong = np.flatnonzero(np.diff(times) <= 0.0)
    if len(wrong):
        k = int(wrong[0]) + 1
        raise InputError(f"{path}: time must rise: point {k + 1} is at {times[k]:g} s")
    return MotionPoints(times, values[:, 0], values[:, 1], values[:, 2])


def _as_csv(times: Array, values: Array) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    joints = range(1, values.shape[2] + 1)
    writer.writerow(["time", *(f"{name}_{j}" for name in _QUANTITIES for j in joints)])
    for time, point in zip(times.tolist(), values, strict=True):
        writer.writerow([repr(time), *(repr(x) for x in point.ravel().tolist())])
    return stream.getvalue()


def _from_csv(text: str) -> tuple[Array, Array]:
    rows = [row for row in csv.reader(io.StringIO(text)) if row]
    header, body = rows[0], rows[1:]
    joints = (len(header) - 1) // 3
    expected = ["time", *(f"{name}_{j + 1}" for name in _QUANTITIES for j in range(joints))]
    if header != expected:
        raise ValueError(f"expected the columns {', '.join(expected)}")
    for k, row in enumerate(body):
        if len(row) != len(header):
            raise ValueError(f"row {k + 2} has {len(row)} values, not {len(header)}")
    table = np.array(body, dtype=np.float64)
    return table[:, 0], table[:, 1:].reshape(len(body), 3, joints)


def _as_json(times: Array, values: Array) -> str:
    nanoseconds = [round(time * 1e9) for time in times.tolist()]
    points: list[dict[str, Any]] = [
        {
            "positions": point[0].tolist(),
            "velocities": point[1].tolist(),
            "accelerations": point[2].tolist(),
            "time_from_start": {"sec": whole // 10**9, "nanosec": whole % 10**9},
        }
        for whole, point in zip(nanoseconds, values, strict=True)
    ]
    names = [f"joint_{j + 1}" for j in range(values.shape[2])]
    return json.dumps({"joint_names": names, "points": points}, allow_nan=False) + "\n"


def _from_json(text: str) -> tuple[Array, Array]:
    points = json.loads(text)["points"]
    stamps = [point["time_from_start"] for point in points]
    times = np.array([float(stamp["sec"]) + 1e-9 * float(stamp["nanosec"]) for stamp in stamps])
    keys = ("positions", "velocities", "accelerations")
    return times, np.array([[point[key] for key in keys] for point in points], dtype=np.float64)
