"""Motions as files that a robot controller reads, and back.

A file holds points, or the exact polynomial pieces of a motion; ``formats`` lists the formats. A reader
joins two points as ROS's joint_trajectory_controller does: by quintics where the points state positions,
velocities and accelerations, by cubics or lines where they state less.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from formulations.motion.files.checked import checked
from formulations.motion.files.formats import JSON, format_to_read, format_to_write, is_pieces
from formulations.motion.files.motion_points import MotionPoints, order_of_joints
from formulations.motion.files.pieces import holds_pieces, read_pieces, write_pieces
from formulations.motion.passages import passages as find_passages
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.files import write_bytes
from formulations.robot.text.files import read_bytes

LARGEST = 1_000_000_000  # bytes of a file that is read or written


def points_of(trajectory: Trajectory, times: Array, names: tuple[str, ...] = ()) -> MotionPoints:
    """Evaluate a motion at times.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    times : Array, shape (n_points,) [s]
        Increasing.
    names : tuple of str
        Names of the joints.

    Returns
    -------
    MotionPoints
        With velocities and accelerations.
    """
    positions, velocities, accelerations = (trajectory.at(times, order) for order in range(3))
    return MotionPoints(times, positions, velocities, accelerations, names)


def encode_motion(
    path: str | Path, motion: MotionPoints | Trajectory, names: tuple[str, ...] = ()
) -> bytes:
    """Make the bytes of a file in the format of its suffix.

    Parameters
    ----------
    path : str or Path
        The file; it is not touched.
    motion : MotionPoints or Trajectory
        Points, or for ``.pieces.json`` a motion.
    names : tuple of str
        Names of the joints of a Trajectory.

    Returns
    -------
    bytes
        What the file shall hold.

    Raises
    ------
    InputError
        For another suffix, and for points that are no motion.
    """
    entry = format_to_write(path)
    if isinstance(motion, Trajectory):
        if entry is not None:
            raise InputError(f"{path}: {entry.name} holds points, not pieces")
        checked(points_of(motion, motion.breaks[[0, -1]], names), str(path))
        return write_pieces(motion, names)
    if entry is None:
        raise InputError(f"{path}: holds pieces, not points")
    data = entry.write(checked(motion, str(path)))
    if len(data) > LARGEST:
        raise InputError(f"{path}: {len(data)} bytes; at most {LARGEST} are written: take a lower rate")
    return data


def decode_motion(path: str | Path, data: bytes) -> MotionPoints | tuple[Trajectory, tuple[str, ...]]:
    """Read what the bytes of a file hold.

    Parameters
    ----------
    path : str or Path
        The file, for its suffix and for messages; it is not touched.
    data : bytes
        What it holds.

    Returns
    -------
    MotionPoints, or tuple of Trajectory and names
        Points, or exact pieces.

    Raises
    ------
    InputError
        Names the file, the place and the value.
    """
    file = str(path)
    entry = format_to_read(path, data)
    if is_pieces(path) or (entry is JSON and holds_pieces(data)):
        return read_pieces(data, file)
    return checked(entry.read(data, file), file)


def write_motion(
    path: str | Path,
    trajectory: Trajectory,
    *,
    rate: float | None = None,
    names: tuple[str, ...] = (),
) -> None:
    """Write a motion to a file as it is, whole or not at all.

    The points between which a controller joins are samples of the motion: nobody judges whether the joined
    motion keeps limits. ``export_motion`` does.

    Parameters
    ----------
    path : str or Path
        Ends in .csv (a row per point, [s, rad, rad/s, rad/s^2]), .json or .yaml (a ROS JointTrajectory),
        .npz, or .pieces.json (the exact polynomials).
    trajectory : Trajectory
        The motion.
    rate : float, optional
        Points per second [1/s]. Left out: one point wherever two polynomial pieces meet.
    names : tuple of str, optional
        Names of the joints; they are counted from 1 if left out.

    Raises
    ------
    InputError
        For another suffix, a rate that is not positive or that pieces have no use for, points less than
        a nanosecond apart in a JointTrajectory, or a file that cannot be written.

    Examples
    --------
    >>> import formulations as f
    >>> spline = f.FAMILIES["3-5-3"].trajectory(f.load("sr4c"), [5.0, 3.0, 5.0])
    >>> f.write_motion("sr4c.csv", spline, rate=125.0)  # doctest: +SKIP
    >>> f.read_motion("sr4c.csv").seconds  # doctest: +SKIP
    13.0
    """
    if format_to_write(path) is None:
        if rate is not None:
            raise InputError(f"{path}: exact pieces have no rate; leave it out")
        write_bytes(path, encode_motion(path, trajectory, tuple(names)))
        return
    times = trajectory.breaks if rate is None else trajectory.sample_times(rate)
    write_bytes(path, encode_motion(path, points_of(trajectory, times, tuple(names))))


def read_points(path: str | Path) -> MotionPoints:
    """Read the points of a motion that ``write_motion`` or another program wrote.

    Parameters
    ----------
    path : str or Path
        A file of a format that ``write_motion`` writes. A JointTrajectory may lack velocities and
        accelerations, and may stand inside a message of MoveIt or a goal. Other suffixes are read by what
        the file holds.

    Returns
    -------
    MotionPoints
        As the file has them, with the names of the joints.

    Raises
    ------
    InputError
        Names the file, the place and the value.
    """
    found = decode_motion(path, read_bytes(path, largest=LARGEST))
    if not isinstance(found, MotionPoints):
        raise InputError(f"{path}: holds polynomial pieces, not points; read it as a motion")
    return found


def read_points_or_pieces(path: str | Path, names: tuple[str, ...] = ()) -> MotionPoints | Trajectory:
    """Read a motion as its file states it: points that a controller joins, or exact pieces.

    Parameters
    ----------
    path : str or Path
        As in ``read_points``; a file of exact pieces too.
    names : tuple of str
        The order of the joints that is wanted for pieces, where the file names its joints.

    Returns
    -------
    MotionPoints or Trajectory
        Points are as the file has them.

    Raises
    ------
    InputError
        Names the file, the place and the value; the pieces are of other joints.
    """
    found = decode_motion(path, read_bytes(path, largest=LARGEST))
    if isinstance(found, MotionPoints):
        return found
    motion, own = found
    order = order_of_joints(names, own)
    return motion if order is None else replace(motion, coefficients=motion.coefficients[:, order])


def read_motion(
    path: str | Path,
    *,
    passages: Array | None = None,
    waypoints: Array | None = None,
    interpolation: str = "auto",
) -> Trajectory:
    """Read a motion that ``write_motion`` or another program wrote in one of its formats.

    Parameters
    ----------
    path : str or Path
        As in ``read_points``; a file of exact pieces too.
    passages : Array, shape (n_waypoints,), optional
        Times at which the waypoints are passed [s]. Left out: those of a file of pieces, or else every
        point of the file is a waypoint.
    waypoints : Array, shape (n_waypoints, dof), optional
        In place of ``passages``: the times are found at which the motion is nearest to these positions
        [rad], in their order. Golden sections and Newton steps find each to about 1e-7 of the distance of
        two points or better; ``check`` judges by how much a waypoint is missed.
    interpolation : {"auto", "linear", "cubic", "quintic"}
        How points are joined; ``auto`` does as a controller does, by what the points state.

    Returns
    -------
    Trajectory
        Polynomials between the points.

    Raises
    ------
    InputError
        Names the file, the place and the value.
    """
    if passages is not None and waypoints is not None:
        raise InputError("passages, waypoints: give one of the two")
    found = decode_motion(path, read_bytes(path, largest=LARGEST))
    if isinstance(found, MotionPoints):
        motion = found.motion(interpolation, passages)
    else:
        motion = found[0] if passages is None else replace(found[0], passages=passages)
    if waypoints is None:
        return motion
    if waypoints.ndim != 2 or waypoints.shape[1] != motion.dof:
        raise InputError(f"waypoints: shape {waypoints.shape} for a motion of {motion.dof} joints")
    return replace(motion, passages=find_passages(motion, waypoints).times)
