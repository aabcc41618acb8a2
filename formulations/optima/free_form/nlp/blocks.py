"""What a program is made of: its shape, blocks of variables or rows with their bounds, parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from formulations.optima.free_form.nlp.scaled import Offset, Place, ScaledProblem
from formulations.problem.arrays import Array

Rule: TypeAlias = Callable[[ScaledProblem], tuple[Array | float, Array | float]]  # low and high


@dataclass(frozen=True)
class Shape:
    """All that the symbols of a program depend on; programs of equal shape share them.

    Attributes
    ----------
    segments : int
    joints : tuple of int
        Number of joints of order 2 and of order 3.
    arcs : tuple of int
        Number of arcs per segment, of order 2 and of order 3.
    free : bool
        Free arcs, or even steps.
    timed : tuple of int
        Waypoints with an earliest or a latest time.
    guarded : tuple of Place
        Where rows (6) are posed.
    smooth : bool
        Whether the objective is the integral of the squares of jerk over limit (of order 2:
        acceleration over limit), and not the time.
    elastic : bool
        Whether times may be missed, and the objective is the sum of what they are missed by, plus
        ``SHARE`` of the time.
    hurried : tuple of int
        Segments with a greatest time, which may be missed too; of elastic programs.
    zones : tuple of Offset
        Where the position at a waypoint is free within a box.
    crossings : tuple of Offset
        Segments that joints with a velocity limit only cross from or to such a waypoint.
    cyclic : bool
        Whether both ends have the same state.
    """

    segments: int
    joints: tuple[int, int]
    arcs: tuple[int, int]
    free: bool
    timed: tuple[int, ...] = ()
    guarded: tuple[Place, ...] = ()
    smooth: bool = False
    elastic: bool = False
    hurried: tuple[int, ...] = ()
    zones: tuple[Offset, ...] = ()
    crossings: tuple[Offset, ...] = ()
    cyclic: bool = False


@dataclass(frozen=True)
class Block:
    """A block of variables or rows of one group of joints.

    Attributes
    ----------
    name : str
    order : int
        Highest limited derivative of the group's joints, 2 or 3; 0 for blocks of no group.
    symbols : casadi.SX, shape (n, 1)
        Joints change fastest, then arcs or segments.
    part : slice
        Its place among all variables or all rows.
    rule : callable
        The lower and the upper bound, from the numbers of a problem.
    linear : bool
        Whether rows are linear in the variables.
    place : Place or None
        Of rows (6).
    """

    name: str
    order: int
    symbols: Any
    part: slice
    rule: Rule
    linear: bool = True
    place: Place | None = None

    def bounds(self, numbers: ScaledProblem) -> tuple[Array, Array]:
        """Evaluate the bounds.

        Parameters
        ----------
        numbers : ScaledProblem

        Returns
        -------
        low, high : Array, shape (n,)
        """
        n = self.part.stop - self.part.start
        low, high = (np.broadcast_to(side, n) for side in self.rule(numbers))
        return low, high


@dataclass(frozen=True)
class Parameter:
    """A block of numbers that the rows contain, and how they follow from a problem."""

    name: str
    order: int
    symbols: Any
    value: Callable[[ScaledProblem], Array]
