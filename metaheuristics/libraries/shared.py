"""What all adapters share: finding a library, or saying how to install it, and finite fitness."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from metaheuristics.driver.task import Array, Task

EXTRAS = {"mealpy": "rivals", "pymoo": "rivals", "nevergrad": "rivals", "minionpy": "rivals"}
INFEASIBLE = 1e18  # stands for +inf where a library computes with fitness


class MissingLibraryError(ImportError):
    """A library is not installed; the message says how to install it."""


def library(name: str, module: str | None = None) -> Any:
    """Return a library, or one module of it. Raises `MissingLibraryError`."""
    try:
        return importlib.import_module(module or name)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != name:
            raise  # something it needs itself
        raise MissingLibraryError(
            f"{name} is not installed: pip install 'timebound[{EXTRAS[name]}]'"
        ) from None


def seed_of(task: Task) -> int:
    """Draw a seed for a library that makes its own generator."""
    return int(task.rng.integers(2**31 - 1))


def finite(fitness: Array) -> Array:
    """Return fitness with a large number for +inf."""
    return np.minimum(fitness, INFEASIBLE)
