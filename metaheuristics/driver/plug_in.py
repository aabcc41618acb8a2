"""Anybody's optimiser by name, ``module:function``: a generator, ask/tell, or a plain function.

generator   ``def swarm(task, **parameters)``: yields x (n, dim), is sent fitness (n,)
ask/tell    ``class Swarm``: ``Swarm(task)``, ``ask() -> x``, ``tell(x, fitness)``, and, if it likes,
            ``best() -> (x, fitness)``, its claim
function    ``def optimise(f, lo, hi, budget, rng)``: calls ``f`` with x (dim,) or (n, dim) at most
            ``budget`` times in all; returns its claim (x, fitness) or None
"""

from __future__ import annotations

import functools
import importlib
import inspect
import sys
from pathlib import Path
from typing import Any

import numpy as np

from metaheuristics.driver.bridge import inverted
from metaheuristics.driver.reason import reason
from metaheuristics.driver.task import Array, BudgetSpent, Claim, Moves, Search, Task


class UnknownAlgorithmError(ValueError):
    """No algorithm goes by this name; the message says why."""


def plug_in(name: str) -> Search:
    """Return the optimiser ``module:function``, whichever of the three kinds it is.

    Modules are looked for in the working directory too.  Raises `UnknownAlgorithmError`.
    """
    module, _, attribute = name.partition(":")
    here = str(Path.cwd())
    if here not in sys.path:
        sys.path.append(here)
    try:
        found: Any = importlib.import_module(module)
        for part in attribute.split("."):
            found = getattr(found, part)
    except Exception as error:  # whatever a foreign module may raise while it loads
        raise UnknownAlgorithmError(f"{name}: {reason(error)}") from error
    if not callable(found):
        raise UnknownAlgorithmError(f"{name}: {type(found).__name__} cannot be called")
    return search_of(found)


def search_of(optimiser: Any) -> Search:
    """Return a generator function for an optimiser of any of the three kinds."""
    if inspect.isgeneratorfunction(optimiser):
        return optimiser  # type: ignore[no-any-return]
    if hasattr(optimiser, "ask") and hasattr(optimiser, "tell"):
        return functools.partial(_ask_and_tell, optimiser)
    return functools.partial(_function, optimiser)


def _ask_and_tell(kind: Any, task: Task) -> Moves:
    swarm = kind(task)
    while True:
        x = swarm.ask()
        try:
            fitness = yield x
        except BudgetSpent as last:
            if len(last.fitness) == len(x):  # not cut off
                swarm.tell(x, last.fitness)
            return _best(swarm)
        swarm.tell(x, fitness)


def _best(swarm: Any) -> Claim | None:
    return swarm.best() if hasattr(swarm, "best") else None


def _function(optimiser: Any, task: Task) -> Moves:
    def call(f: Any) -> Claim | None:
        def objective(x: Any) -> Any:
            x = np.asarray(x)
            fitness: Array = f(x if x.ndim != 1 else x[None])
            return fitness if x.ndim != 1 else float(fitness[0])

        return optimiser(objective, task.lo, task.hi, task.budget, task.rng)  # type: ignore[no-any-return]

    return inverted(task, call, endless=False)
