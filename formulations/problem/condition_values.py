"""Values of conditions: states at the ends, and when two of them are equal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypeAlias

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.limits import Limits
from formulations.problem.torque import TorqueLimits

EndState: TypeAlias = "Array | Literal['free'] | None"


def end_state(value: EndState, dof: int) -> Array:
    """Write a state at an end as an array.

    Parameters
    ----------
    value : Array, "free" or None
    dof : int

    Returns
    -------
    Array, shape (dof,)
        0 where none is given, NaN where it is free.
    """
    if value is None:
        return np.zeros(dof)
    return np.full(dof, np.nan) if isinstance(value, str) else np.asarray(value, dtype=np.float64)


def same_value(one: object, other: object) -> bool:
    """Say whether two values of a field are equal, arrays entry by entry.

    Parameters
    ----------
    one, other : object

    Returns
    -------
    bool
    """
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(same_value(one[key], other[key]) for key in one)
    if isinstance(one, str) or isinstance(other, str) or one is None or other is None:
        return one is other or (isinstance(one, str) and one == other)
    if isinstance(one, Limits | TorqueLimits | frozenset | bool):
        return one == other
    return np.array_equal(np.asarray(one), np.asarray(other))
