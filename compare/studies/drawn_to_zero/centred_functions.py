"""Test functions whose optimum, 0, is the centre of their box: x = 0."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from formulations.problem.arrays import Array

DIM, HALF = 10, 100.0  # coordinates, half the width of the box


def sphere(x: Array) -> Array:
    """Sum of squares.

    Parameters
    ----------
    x : Array, shape (n, DIM)
        Points of the box.

    Returns
    -------
    Array, shape (n,)
        Values; 0 at x = 0.
    """
    return np.asarray((x**2).sum(axis=1))


def rastrigin(x: Array) -> Array:
    """A function with many local optima on a grid (Rastrigin 1974), scaled to the box.

    Parameters
    ----------
    x : Array, shape (n, DIM)
        Points of the box.

    Returns
    -------
    Array, shape (n,)
        Values; 0 at x = 0.
    """
    z = x * 5.12 / HALF
    return np.asarray((z**2 - 10 * np.cos(2 * np.pi * z) + 10).sum(axis=1))


def ackley(x: Array) -> Array:
    """A narrow hole in a rough plain (Ackley 1987), scaled to the box.

    Parameters
    ----------
    x : Array, shape (n, DIM)
        Points of the box.

    Returns
    -------
    Array, shape (n,)
        Values; 0 at x = 0.
    """
    z = x * 32.0 / HALF
    root = np.sqrt((z**2).mean(axis=1))
    cosines = np.cos(2 * np.pi * z).mean(axis=1)
    # expm1: the sum of four terms would cancel near the optimum
    return np.asarray(-20 * np.expm1(-0.2 * root) - np.e * np.expm1(cosines - 1))


FUNCTIONS: dict[str, Callable[[Array], Array]] = {
    "sphere": sphere,
    "rastrigin": rastrigin,
    "ackley": ackley,
}
