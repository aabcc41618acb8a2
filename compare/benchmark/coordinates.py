"""Where an objective's zero lies, as an experimental factor: the same search in other coordinates.

A swarm that does not know where zero is does the same in all of them, but for rounding.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from compare.benchmark.protocol import Coordinates
from formulations.problem.arrays import Array

WIDTHS = 10.0  # of the box, from zero to the box in the coordinates `offset`


def seen_in(
    coordinates: Coordinates, f: Callable[[Array], Array], lo: Array, hi: Array
) -> tuple[Callable[[Array], Array], Array, Array]:
    """Return an objective and its box in other coordinates.

    Parameters
    ----------
    coordinates : Coordinates
        ``printed`` returns what is given.
    f : callable
        Objective, (n, dim) -> (n,).
    lo, hi : Array, shape (dim,)
        Its box.

    Returns
    -------
    f, lo, hi
        The same values at the points that stand for the same candidates.
    """
    if coordinates is Coordinates.printed:
        return f, lo, hi
    shift = _shift(coordinates, lo, hi)
    return lambda u: f(as_printed(coordinates, u, lo, hi)), lo + shift, hi + shift


def as_printed(coordinates: Coordinates, u: Array, lo: Array, hi: Array) -> Array:
    """Return the points that a swarm means in other coordinates.

    Parameters
    ----------
    coordinates : Coordinates
    u : Array, shape (..., dim)
        Points of the box that the swarm sees.
    lo, hi : Array, shape (dim,)
        The box in the coordinates ``printed``.

    Returns
    -------
    Array, shape (..., dim)
        Points of that box.
    """
    if coordinates is Coordinates.printed:
        return u
    x = lo + hi - u if coordinates is Coordinates.mirrored else u - _shift(coordinates, lo, hi)
    return np.clip(x, lo, hi)


def _shift(coordinates: Coordinates, lo: Array, hi: Array) -> Array:
    """How far the box is moved."""
    return WIDTHS * (hi - lo) - lo if coordinates is Coordinates.offset else np.zeros_like(lo)
