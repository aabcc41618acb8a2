"""What all adapters of libraries share: how a library is found, a seed for it, and finite fitness."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from metaheuristics.driver.task import Array, Task

EXTRAS = {"mealpy": "rivals", "pymoo": "rivals", "nevergrad": "rivals", "minionpy": "rivals"}
INFEASIBLE = 1e18
"""Stands for +inf where a library computes with fitness."""


class MissingLibraryError(ImportError):
    """A library is not installed; the message says how to install it."""


def library(name: str, module: str | None = None) -> Any:
    """Return a library, or one module of it.

    Parameters
    ----------
    name : str
        Name of the library.
    module : str, optional
        Full name of a module of it.

    Returns
    -------
    Any
        The module.

    Raises
    ------
    MissingLibraryError
        The library is not installed.
    """
    try:
        return importlib.import_module(module or name)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != name:
            raise  # something that the library needs
        raise MissingLibraryError(
            f"{name} is not installed: pip install 'timebound[{EXTRAS[name]}]'"
        ) from None


def seed_of(task: Task) -> int:
    """Draw a seed for a library that makes its own generator.

    Parameters
    ----------
    task : Task
        Random numbers.

    Returns
    -------
    int
        A seed below 2^31.
    """
    return int(task.rng.integers(2**31 - 1))


def finite(fitness: Array) -> Array:
    """Return fitness with a large number for +inf.

    Parameters
    ----------
    fitness : Array, any shape
        Fitness.

    Returns
    -------
    Array, shape of fitness
        At most `INFEASIBLE`.
    """
    return np.minimum(fitness, INFEASIBLE)
