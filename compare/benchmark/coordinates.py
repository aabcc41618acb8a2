"""Coordinates: where an objective's zero lies, as an experimental factor.

printed   as the paper has them: durations, with zero just below the box
mirrored  each coordinate counted from the other end of the box: short is where long was
offset    zero ten box widths below the box
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
    """The same f, (n, dim) -> (n,), on its box [lo, hi] (dim,) in other coordinates: f, lo, hi."""
    if coordinates == "mirrored":
        return lambda u: f(np.clip(lo + hi - u, lo, hi)), lo, hi
    if coordinates == "offset":
        shift = WIDTHS * (hi - lo) - lo
        return lambda u: f(np.clip(u - shift, lo, hi)), lo + shift, hi + shift
    return f, lo, hi
