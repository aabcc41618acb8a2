"""What joints and their units are called: the one place for it, for every message, table and figure."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError

UNITS = {"rad": 1.0, "deg": math.pi / 180.0}  # rad per unit of angle
METRES = {"m": 1.0, "mm": 1e-3}  # m per unit of length
JOINT_UNITS = ("rad", "m")  # of the position of a rotary and of a prismatic joint
_PER = ("", "/s", "/s²", "/s³")
_LONGEST = 100  # characters of a joint's name


def joint_label(names: Sequence[str], joint: int) -> str:
    """Say which joint is meant.

    Parameters
    ----------
    names : sequence of str
        Names of all joints; empty where they have none.
    joint : int
        Counts from 0.

    Returns
    -------
    str
        ``joint elbow``, or ``joint 2`` (counted from 1) without names.
    """
    return f"joint {names[joint] if names else joint + 1}"


def shown_unit(joint_unit: str, angle: str, order: int = 0) -> str:
    """Name the unit in which a person sees a value of a joint.

    Parameters
    ----------
    joint_unit : {"rad", "m"}
        Unit of the joint's position.
    angle : {"rad", "deg"}
        Unit of angles for the person.
    order : int
        Order of the derivative; 0 is the position.

    Returns
    -------
    str
        ``deg/s``, say.
    """
    return (angle if joint_unit == "rad" else joint_unit) + _PER[order]


def factors(units: Sequence[str], angle: str) -> Array:
    """SI units per unit that a person sees, (dof,).

    Parameters
    ----------
    units : sequence of str
        Units of the joints' positions, "rad" or "m".
    angle : {"rad", "deg"}
        Unit of angles for the person.

    Returns
    -------
    Array, shape (dof,)
    """
    return np.array([UNITS[angle] if unit == "rad" else 1.0 for unit in units])


def read_angle_unit(key: str, unit: object) -> str:
    """Refuse a unit of angles that is neither rad nor deg.

    Parameters
    ----------
    key : str
        Name of the argument, for the message.
    unit : object
        What was given.

    Returns
    -------
    str
        The unit.

    Raises
    ------
    InputError
        It is another one.
    """
    if not isinstance(unit, str) or unit not in UNITS:
        raise InputError(f"{key}: {unit!r:.50} is not one of {', '.join(UNITS)}")
    return unit


def read_names(names: Iterable[str], dof: int) -> tuple[str, ...]:
    """Refuse names of joints that are not one short text per joint, each once.

    Parameters
    ----------
    names : iterable of str
        The names; none at all is allowed.
    dof : int
        Number of joints.

    Returns
    -------
    tuple of str
        The names.

    Raises
    ------
    InputError
        In one line.
    """
    found = _listed("names", names)
    for name in found:
        if not isinstance(name, str) or not name.strip() or not name.isprintable():
            raise InputError(f"names: {name!r:.50} is not the name of a joint")
        if len(name) > _LONGEST:
            raise InputError(f"names: {name!r:.50} is longer than {_LONGEST} characters")
        if found.count(name) > 1:
            raise InputError(f"names: {name!r} is given twice")
    if found and len(found) != dof:
        raise InputError(f"names: {len(found)} names for {dof} joints")
    return found


def read_units(units: Iterable[str], dof: int) -> tuple[str, ...]:
    """Refuse units of joints other than rad and m, one per joint.

    Parameters
    ----------
    units : iterable of str
        The units; rad for all joints if there are none.
    dof : int
        Number of joints.

    Returns
    -------
    tuple of str
        The units, one per joint.

    Raises
    ------
    InputError
        In one line.
    """
    found = _listed("units", units)
    for unit in found:
        if unit not in JOINT_UNITS:
            raise InputError(f"units: {unit!r:.50} is not one of {', '.join(JOINT_UNITS)}")
    if found and len(found) != dof:
        raise InputError(f"units: {len(found)} units for {dof} joints")
    return found or ("rad",) * dof


def _listed(key: str, given: Iterable[str]) -> tuple[str, ...]:
    if isinstance(given, str):
        raise InputError(f"{key}: expected a list of one text per joint, got {given!r:.50}")
    try:
        return tuple(given)
    except TypeError:
        raise InputError(f"{key}: expected a list of one text per joint, got {given!r:.50}") from None
