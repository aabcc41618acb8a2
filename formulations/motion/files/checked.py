"""What every file of points must keep, whatever its format."""

from __future__ import annotations

import numpy as np

from formulations.motion.files.motion_points import MotionPoints
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.robot.text.entry import LARGEST_NUMBER
from formulations.robot.text.files import shown

QUANTITIES = ("position", "velocity", "acceleration")
_LEAST_STEP = 1e-15  # s; a quintic between points closer than this has no finite coefficients


def checked(points: MotionPoints, file: str) -> MotionPoints:
    """Refuse points that are no motion.

    Parameters
    ----------
    points : MotionPoints
        What was read, or what shall be written.
    file : str
        Name of the file, for messages.

    Returns
    -------
    MotionPoints
        The same.

    Raises
    ------
    InputError
        Fewer than two points, no joint, a number that is not finite or beyond 1e9, accelerations without
        velocities, names that do not fit, or times that do not increase.
    """
    if len(points.times) < 2 or points.positions.shape[1] < 1:
        raise InputError(f"{file}: a motion needs two points or more of one joint or more")
    if points.velocities is None and points.accelerations is not None:
        raise InputError(f"{file}: accelerations are given, but no velocities")
    _check_names(points, file)
    labels = points.names or tuple(f"{j + 1}" for j in range(points.positions.shape[1]))
    values = (points.positions, points.velocities, points.accelerations)
    columns: list[tuple[str, Array | None]] = [("time", points.times[:, None])]
    columns += [(name, value) for name, value in zip(QUANTITIES, values, strict=True)]
    for name, array in columns:
        if array is None:
            continue
        fine = np.abs(array) <= LARGEST_NUMBER
        if not fine.all():
            point, joint = divmod(int(np.argmin(fine)), array.shape[1])
            of = "" if name == "time" else f" of joint {labels[joint]}"
            value = array[point, joint]
            wrong = f"is beyond {LARGEST_NUMBER:g}" if np.isfinite(value) else "is not finite"
            raise InputError(f"{file}: point {point + 1}: {name}{of}: {value:g} {wrong}")
    late = np.flatnonzero(np.diff(points.times) < _LEAST_STEP)
    if len(late):
        k = int(late[0]) + 1
        raise InputError(
            f"{file}: times must increase: point {k + 1} is at {points.times[k]:.9g} s, point {k} "
            f"at {points.times[k - 1]:.9g} s, less than {_LEAST_STEP:g} s before"
        )
    return points


def _check_names(points: MotionPoints, file: str) -> None:
    names, dof = points.names, points.positions.shape[1]
    if names and len(names) != dof:
        raise InputError(f"{file}: {len(names)} names of joints for {dof} joints")
    for index, name in enumerate(names):
        if not name.strip() or not name.isprintable():
            raise InputError(f"{file}: {shown(name)} cannot be the name of a joint")
        if name in names[:index]:
            raise InputError(f"{file}: joint {shown(name)} is given twice")


def named(names: tuple[str, ...], prefix: str = "") -> tuple[str, ...]:
    """Drop names that only count the joints.

    Parameters
    ----------
    names : tuple of str
        As a file has them.
    prefix : str
        What stands before the numbers.

    Returns
    -------
    tuple of str
        Empty if they are prefix 1, prefix 2, ... in this order.
    """
    return () if names == numbered(len(names), prefix) else names


def numbered(dof: int, prefix: str = "") -> tuple[str, ...]:
    """Names that count the joints from 1.

    Parameters
    ----------
    dof : int
        Number of joints.
    prefix : str
        What stands before the numbers.

    Returns
    -------
    tuple of str
        For files of motions without names.
    """
    return tuple(f"{prefix}{j + 1}" for j in range(dof))


def stacked(points: MotionPoints) -> tuple[Array, tuple[str, ...]]:
    """All numbers of the points beside each other.

    Parameters
    ----------
    points : MotionPoints
        Positions, and velocities and accelerations where there are some.

    Returns
    -------
    columns : Array, shape (n_points, n_quantities * dof)
        Positions of all joints, then velocities, then accelerations.
    quantities : tuple of str
        The quantities there are.
    """
    values = (points.positions, points.velocities, points.accelerations)
    found = {name: value for name, value in zip(QUANTITIES, values, strict=True) if value is not None}
    return np.concatenate(list(found.values()), axis=1), tuple(found)
