"""What a registry entry holds."""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from metaheuristics.driver.task import Search

GROUPS = {
    "pso": "PSO",
    "papers": "PSO of the papers",
    "animals": "sparrows, butterflies, whales",
    "controls": "controls",
    "rivals": "other libraries, plug-ins",
}


@dataclass(frozen=True)
class Algorithm:
    """One published variant: run it by ``minimise(a.function, f, ..., **a.parameters)``.

    ``libraries``: distributions that it needs beside this package's own code.  ``shortfall``: why it
    may miss an optimum that others find, if it does.
    """

    name: str
    title: str
    source: str
    function: Search
    parameters: dict[str, Any] = field(hash=False)
    group: str
    libraries: tuple[str, ...] = ()
    shortfall: str = ""

    @property
    def versions(self) -> str:
        """Versions of its libraries on one line; empty for this package's own."""
        return " ".join(f"{name}={_version(name)}" for name in self.libraries)


@dataclass(frozen=True)
class NotReproducible:
    """An algorithm that a paper compares with, but nobody can run."""

    name: str
    title: str
    source: str
    reason: str


def defaults(function: Search) -> dict[str, Any]:
    """Return the keyword parameters of a search with their defaults."""
    return {
        p.name: p.default
        for p in inspect.signature(function).parameters.values()
        if p.kind is p.KEYWORD_ONLY and p.default is not p.empty
    }


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "none"
