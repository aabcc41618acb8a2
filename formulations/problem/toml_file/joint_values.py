"""Values that a person gives for joints: one for all of them, a list with one for each, or a table by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from formulations.problem.errors import InputError
from formulations.problem.joint_words import joint_label
from formulations.problem.toml_file.toml_values import (
    Number,
    known_keys,
    read_interval,
    read_number,
    shown,
)

Read = TypeVar("Read")


def by_joint(
    key: str, value: Any, names: Sequence[str], dof: int, read: Callable[[str, Any], Read]
) -> dict[int, Read]:
    """Read a number for all joints, a list with an entry per joint, or a table by joint.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.
    names : sequence of str
        Names of the joints; empty where there are none.
    dof : int
        Number of joints.
    read : callable
        Reads an entry: where it stands, and what it is.

    Returns
    -------
    dict of int to object
        What was read, by joint; of a table, for the joints in it.

    Raises
    ------
    InputError
        In one line that names the key, the joint and the value.
    """
    if isinstance(value, dict):
        return {
            joint: read(f"{key}: {joint_label(names, joint)}", entry)
            for joint, entry in _named(key, value, names).items()
        }
    if not isinstance(value, list):
        return dict.fromkeys(range(dof), read(key, value))
    if len(value) != dof:
        raise InputError(f"{key}: {len(value)} values for {dof} joints")
    return {j: read(f"{key}: {joint_label(names, j)}", entry) for j, entry in enumerate(value)}


def intervals_by_joint(
    key: str, value: Any, names: Sequence[str], dof: int, number: Number = read_number
) -> dict[int, tuple[float, float]]:
    """Read a list with an interval [low, high] per joint, or a table of intervals by joint.

    Parameters
    ----------
    key : str
        Where the value stands, for the message.
    value : object
        The value.
    names : sequence of str
        Names of the joints; empty where there are none.
    dof : int
        Number of joints.
    number : callable
        Reads the two numbers of an interval.

    Returns
    -------
    dict of int to (float, float)

    Raises
    ------
    InputError
        In one line that names the key, the joint and the value.
    """
    entries = _named(key, value, names) if isinstance(value, dict) else None
    rows = list(entries.values()) if entries is not None else value
    if not isinstance(rows, list) or not rows or not all(isinstance(row, list) for row in rows):
        raise InputError(f"{key}: expected [low, high] per joint, got {shown(rows)}")
    joints = list(range(len(rows))) if entries is None else list(entries)
    found = {}
    for joint, row in zip(joints, rows, strict=True):
        where = f"{key}: {joint_label(names if joint < len(names) else (), joint)}"
        found[joint] = read_interval(where, row, number=number)
    if entries is None and len(found) != dof:
        raise InputError(
            f"{key}: {len(found)} intervals; expected [low, high] for each of {dof} joints"
        )
    return found


def _named(key: str, table: dict[str, Any], names: Sequence[str]) -> dict[int, Any]:
    """The entries of a table by joint, by number of the joint."""
    if not names:
        raise InputError(f"{key}: a table by joint needs names of joints (key joints)")
    known_keys(key, table, tuple(names))
    return {names.index(name): entry for name, entry in table.items()}
