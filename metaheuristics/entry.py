"""What the registry holds about an algorithm."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from metaheuristics.driver.isolation import apart
from metaheuristics.driver.task import Search

GROUPS = {
    "pso": "PSO",
    "papers": "PSO of the papers",
    "animals": "sparrows, butterflies, whales",
    "controls": "controls",
    "rivals": "other libraries, plug-ins",
}
"""Groups of algorithms in tables and pictures: key and title."""

TIME_LIMIT = 60.0
"""Time limit of one run of an algorithm that is not trusted [s], unless another one is given."""


@dataclass(frozen=True)
class Algorithm:
    """One published variant, or one optimiser of a library, or a plug-in, with all its parameters.

    Parameters
    ----------
    name : str
        The name in `ALGORITHMS` and in tables.
    title : str
        One line for people.
    source : str
        Authors, year, and equations.
    function : Search
        A generator function ``(task, **parameters)``.
    parameters : dict[str, Any]
        Every parameter that can be changed, with its value.
    group : str
        A key of `GROUPS`.
    libraries : tuple[str, ...]
        Distributions that it needs beside this package.
    shortfall : str
        Why it may miss an optimum that other algorithms find; empty if it does not.
    trusted : bool
        Whether it may run in the process of the comparison.  Plug-ins are not trusted.
    seeded_as : str
        The name from which a comparison derives its random numbers, where that is not ``name``: an
        algorithm that was renamed keeps its results.

    Examples
    --------
    >>> from metaheuristics import ALGORITHMS, minimise
    >>> entry = ALGORITHMS["mipso"]
    >>> entry.source
    'Wang 2025, eq. 10-18 and Table 7'
    >>> f = lambda x: (x**2).sum(axis=1)
    >>> minimise(entry.search(), f, [-1, -1], [1, 1], budget=500, seed=0, **entry.parameters).status
    <Status.ok: 'ok'>
    """

    name: str
    title: str
    source: str
    function: Search
    parameters: dict[str, Any] = field(hash=False)
    group: str
    libraries: tuple[str, ...] = ()
    shortfall: str = ""
    trusted: bool = True
    seeded_as: str = ""

    def search(self, seconds: float | None = None) -> Search:
        """Return what `minimise` should run: the function, or the function in a process of its own.

        Parameters
        ----------
        seconds : float, optional
            Time limit of the algorithm's own work in one run [s].  If left out, a trusted algorithm runs
            in this process without a limit, and any other one apart for at most `TIME_LIMIT`.

        Returns
        -------
        Search
            A generator function ``(task, **parameters)``.
        """
        if seconds is None and self.trusted:
            return self.function
        return apart(self.function, seconds=TIME_LIMIT if seconds is None else seconds)

    @property
    def versions(self) -> str:
        """Versions of its libraries on one line; empty for this package's own algorithms."""
        return " ".join(f"{name}={_version(name)}" for name in self.libraries)


@dataclass(frozen=True)
class NotReproducible:
    """An algorithm that a paper compares with, but that nobody can run.

    Parameters
    ----------
    name : str
        The name in `NOT_REPRODUCIBLE` and in tables.
    title : str
        One line for people.
    source : str
        Where it is said to be published.
    reason : str
        What is missing.
    """

    name: str
    title: str
    source: str
    reason: str


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "none"
