"""Anybody's optimiser by name, ``module:function``: a generator, ask/tell, or a plain function.

generator   ``def swarm(task, **parameters)``: yields x (n, dim), is sent fitness (n,)
ask/tell    ``class Swarm``: ``Swarm(task)``, ``ask() -> x``, ``tell(x, fitness)``, and, if it likes,
            ``best() -> (x, fitness)``, its claim
function    ``def optimise(f, lo, hi, budget, rng)``: calls ``f`` with x (dim,) or (n, dim) at most
            ``budget`` times in all; returns its claim (x, fitness) or None

The code of a plug-in is loaded in the process that runs it and in no other: whoever runs plug-ins apart
never imports them.
"""

from __future__ import annotations

import functools
import importlib
import inspect
import os
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np

from metaheuristics.driver.bridge import inverted
from metaheuristics.driver.guards import user_interrupt
from metaheuristics.driver.isolation import START, Child
from metaheuristics.driver.reason import printable, reason
from metaheuristics.driver.task import Array, BudgetSpent, Claim, Fault, Moves, Search, Task

_DESCRIPTION = 1 << 16  # bytes
_PLAIN = (bool, int, float, str)


class UnknownAlgorithmError(ValueError):
    """No algorithm goes by this name; the message says why."""


class PlugIn:
    """An optimiser by its name, loaded when it is first run.

    Parameters
    ----------
    name : str
        ``module:function``.  Modules are looked for in the working directory too.
    parameters : Mapping[str, object]
        The keyword parameters that it takes, with their defaults.
    """

    def __init__(self, name: str, parameters: Mapping[str, object]) -> None:
        self.name = name
        kinds = inspect.Parameter
        self.__signature__ = inspect.Signature(
            [kinds("task", kinds.POSITIONAL_OR_KEYWORD)]
            + [kinds(key, kinds.KEYWORD_ONLY, default=value) for key, value in parameters.items()]
        )

    def __call__(self, task: Task, **parameters: object) -> Moves:
        """Load the optimiser into this process and start it."""
        return load(self.name)(task, **parameters)


def plug_in(name: str) -> tuple[PlugIn, dict[str, object]]:
    """Return the optimiser ``module:function`` without loading it into this process.

    Parameters
    ----------
    name : str
        ``module:function``.

    Returns
    -------
    function : PlugIn
        Run it by `minimise`, or better by ``minimise(apart(function, seconds=...), ...)``.
    parameters : dict[str, object]
        Its keyword parameters that are numbers or texts, with their defaults.

    Raises
    ------
    UnknownAlgorithmError
        A process of its own could not load it; the message holds the reason.
    """
    parameters = dict(_described(name, os.getcwd()))
    return PlugIn(name, parameters), parameters


@functools.cache
def _described(name: str, folder: str) -> tuple[tuple[str, object], ...]:
    """Ask a process that loads the plug-in for its parameters; once per name and working directory."""
    child = None
    try:
        child = Child("describe", name, START, most=_DESCRIPTION)
        header, _ = child.exchange(None)
    except Fault as fault:
        raise UnknownAlgorithmError(f"{name}: {fault.note}") from None
    finally:
        if child is not None:
            child.kill()
    found = header.get("parameters")
    if header.get("kind") == "known" and isinstance(found, dict):
        return tuple(
            (key, value) for key, value in found.items() if key.isidentifier() and type(value) in _PLAIN
        )
    raise UnknownAlgorithmError(printable(str(header.get("reason"))))


def load(name: str) -> Search:
    """Load the optimiser ``module:function`` into this process, whichever of the three kinds it is.

    Parameters
    ----------
    name : str
        ``module:function``.

    Returns
    -------
    Search
        A generator function.

    Raises
    ------
    UnknownAlgorithmError
        The module or the function is not there, or raised something while it was loaded.
    """
    module, _, attribute = name.partition(":")
    if os.getcwd() not in sys.path:
        sys.path.append(os.getcwd())
    with user_interrupt() as interrupt:
        try:
            found: Any = importlib.import_module(module)
            for part in attribute.split("."):
                found = getattr(found, part)
            if not callable(found):
                raise TypeError(f"{type(found).__name__} cannot be called")
            return search_of(found)
        except BaseException as error:  # of a foreign module: whatever it raises
            interrupt.check()
            raise UnknownAlgorithmError(f"{name}: {reason(error)}") from error


def search_of(optimiser: Any) -> Search:
    """Return a generator function for an optimiser of any of the three kinds.

    Parameters
    ----------
    optimiser : Any
        A generator function, a class with ``ask`` and ``tell``, or a function that calls its objective.

    Returns
    -------
    Search
        A generator function ``(task, **parameters)``.
    """
    if inspect.isgeneratorfunction(optimiser):
        return optimiser  # type: ignore[no-any-return]
    if hasattr(optimiser, "ask") and hasattr(optimiser, "tell"):
        return functools.partial(_ask_and_tell, optimiser)
    return functools.partial(_function, optimiser)


def defaults(search: Search) -> dict[str, Any]:
    """Return the keyword parameters of a search.

    Parameters
    ----------
    search : Search
        A generator function ``(task, *, name=default, ...)``.

    Returns
    -------
    dict[str, Any]
        Names and defaults, in the order of the signature.
    """
    return {
        p.name: p.default
        for p in inspect.signature(search).parameters.values()
        if p.kind is p.KEYWORD_ONLY and p.default is not p.empty
    }


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
