"""Where an objective's zero lies, as an experimental factor: the same search in other coordinates.

printed   as the paper has them: durations, with zero just below the box
mirrored  each coordinate counted from the other end of the box: what was short is now long
offset    zero lies ten widths of the box below it
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from formulations.problem.arrays import Array

COORDINATES = ("printed", "mirrored", "offset")
WIDTHS = 10.0


def seen_in(
    coordinates: str, f: Callable[[Array], Array], lo: Array, hi: Array
) -> tuple[Callable[[Array], Array], Array, Array]:
    """Return an objective and its box in other coordinates.

    Parameters
    ----------
    coordinates : str
        One of ``COORDINATES``.
    f : callable
        Objective, (n, dim) -> (n,).
    lo, hi : Array, shape (dim,)
        Its box.

    Returns
    -------
    f, lo, hi
        The same values at the points that stand for the same candidates.

    """
    if coordinates == "mirrored":
        return lambda u: f(np.clip(lo + hi - u, lo, hi)), lo, hi
    if coordinates == "offset":
        shift = WIDTHS * (hi - lo) - lo
        return lambda u: f(np.clip(u - shift, lo, hi)), lo + shift, hi + shift
    return f, lo, hi
