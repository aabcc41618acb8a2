"""Every algorithm by name: those of the papers, the controls, and whatever else is plugged in."""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from metaheuristics.butterfly import butterfly
from metaheuristics.issa import issa
from metaheuristics.mipso import mipso, mipso_printed
from metaheuristics.mpso import mpso
from metaheuristics.outside.cmaes_ import cma_es
from metaheuristics.outside.library import library
from metaheuristics.outside.mealpy_ import mealpy
from metaheuristics.outside.minion_ import lshade, minion
from metaheuristics.outside.nevergrad_ import nevergrad
from metaheuristics.outside.pymoo_ import find, pymoo
from metaheuristics.outside.scipy_ import (
    differential_evolution,
    dual_annealing,
    nelder_mead,
    slsqp,
    sobol,
)
from metaheuristics.plug_in import UnknownAlgorithmError, plug_in
from metaheuristics.pso import pso, pso_1995, pso_linear
from metaheuristics.pso_004 import pso_004
from metaheuristics.random_search import random_search
from metaheuristics.sparrow import sparrow, sparrow_printed
from metaheuristics.task import Search
from metaheuristics.whale import whale
from metaheuristics.whale_003 import whale_003

GROUPS = {
    "pso": "PSO",
    "papers": "PSO of the papers",
    "animals": "sparrows, butterflies, whales",
    "controls": "controls",
    "rivals": "other libraries and plug-ins",
}


@dataclass(frozen=True)
class Algorithm:
    """One published variant: run it by ``minimise(a.function, f, ..., **a.parameters)``.

    ``libraries``: distributions that it needs beside this package's own code.  ``shortfall``: why it
    misses an optimum it should find, if it does.
    """

    name: str
    title: str
    source: str
    function: Search
    parameters: dict[str, Any] = field(hash=False)
    group: str = "rivals"
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


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "none"


def _algorithm(
    group: str,
    name: str,
    title: str,
    source: str,
    function: Search,
    *,
    libraries: tuple[str, ...] = (),
    shortfall: str = "",
    **changed: Any,
) -> tuple[str, Algorithm]:
    """Return a registry entry with every parameter spelt out: the defaults, then what changed."""
    parameters = defaults(function) | changed
    return name, Algorithm(name, title, source, function, parameters, group, libraries, shortfall)


def defaults(function: Search) -> dict[str, Any]:
    """Return the keyword parameters of a search with their defaults."""
    return {
        p.name: p.default
        for p in inspect.signature(function).parameters.values()
        if p.kind is p.KEYWORD_ONLY and p.default is not p.empty
    }


ALGORITHMS: dict[str, Algorithm] = dict(
    (
        _algorithm(
            "pso",
            "pso",
            "PSO, constants equal to constriction",
            "Clerc & Kennedy 2002; the step is 004 eq. 3 and 2",
            pso,
        ),
        _algorithm(
            "pso",
            "pso-linear",
            "PSO, linearly decreasing inertia",
            "Shi & Eberhart 1998; 004 eq. 3-4, 001 eq. 14",
            pso_linear,
        ),
        _algorithm(
            "pso", "pso-1995", "PSO, no inertia", "Kennedy & Eberhart 1995; 004 eq. 1-2", pso_1995
        ),
        _algorithm("papers", "mipso", "MIPSO, resolved", "000 eq. 10-18, table 7", mipso),
        _algorithm("papers", "mipso-pso1", "MIPSO minus tent map", "000 section 3.4", mipso,
                   tent=False),
        _algorithm(
            "papers",
            "mipso-pso2",
            "MIPSO minus dynamic factors",
            "000 section 3.4",
            mipso,
            dynamic=False,
        ),
        _algorithm(
            "papers", "mipso-pso3", "MIPSO minus mutation", "000 section 3.4", mipso, mutation=False
        ),
        _algorithm(
            "papers",
            "mipso-printed",
            "MIPSO, eq. 15 and 16 as printed",
            "000 eq. 10-18, table 7",
            mipso_printed,
        ),
        _algorithm("papers", "mpso", "MPSO, factors as printed", "001 eq. 14-16", mpso),
        _algorithm(
            "papers",
            "mpso-times-ten",
            "MPSO, factors times ten",
            "001 eq. 14-16",
            mpso,
            c_start=0.5,
            c_end=0.2,
        ),
        _algorithm("papers", "pso-004", "PSO with Beta inertia and DE crossover, resolved",
                   "004 eq. 2, 3, 5-7", pso_004),
        _algorithm("papers", "pso-004-printed", "the same, eq. 7 as printed",
                   "004 eq. 2, 3, 5-7", pso_004, printed=True),
        _algorithm("animals", "sparrow", "Sparrow search", "Xue & Shen 2020, eq. 3-5; 002 eq. 8-11",
                   sparrow),
        _algorithm("animals", "sparrow-printed", "Sparrow search, eq. 8 and 10 as printed in 002",
                   "002 eq. 8-11", sparrow_printed),
        _algorithm("animals", "butterfly", "Butterfly optimisation",
                   "Arora & Singh 2019, eq. 1-3", butterfly),
        _algorithm("animals", "issa", "ISSA, each individual chooses its move", "002 eq. 8-15", issa),
        _algorithm("animals", "issa-blended", "ISSA, each individual blends both moves",
                   "002 eq. 8-15", issa, blended=True),
        _algorithm("animals", "whale", "Whale optimisation", "Mirjalili & Lewis 2016, eq. 2.1-2.8",
                   whale),
        _algorithm("animals", "whale-003", "Whales with inertia and chaotic start, resolved",
                   "003 eq. 14-23", whale_003),
        _algorithm("animals", "whale-003-printed", "the same, eq. 16, 19, 21, 23 as printed",
                   "003 eq. 14-23", whale_003, lam=0.5, printed=True),
        _algorithm("controls", "random", "Uniform random search", "none: the floor", random_search),
        _algorithm("controls", "sobol", "Quasi-random search, scrambled", "Sobol 1967; SciPy", sobol,
                   libraries=("scipy",)),
        _algorithm("controls", "de", "Differential evolution, best1bin", "Storn & Price 1997; SciPy",
                   differential_evolution, libraries=("scipy",)),
        _algorithm("controls", "lshade", "L-SHADE", "Tanabe & Fukunaga 2014; minionpy", lshade,
                   libraries=("minionpy",)),
        _algorithm("controls", "cma-es", "CMA-ES, restarts with growing populations",
                   "Hansen 2016; Auger & Hansen 2005; cmaes", cma_es, libraries=("cmaes",)),
        _algorithm("controls", "annealing", "Dual annealing", "Xiang et al. 1997; SciPy",
                   dual_annealing, libraries=("scipy",)),
        _algorithm("controls", "nelder-mead", "Nelder-Mead, many starts", "Nelder & Mead 1965; SciPy",
                   nelder_mead, libraries=("scipy",)),
        _algorithm("controls", "slsqp", "SLSQP, many starts, finite differences", "Kraft 1988; SciPy",
                   slsqp, libraries=("scipy",)),
    )
)  # fmt: skip

NOT_REPRODUCIBLE: dict[str, NotReproducible] = {
    "ipso": NotReproducible(
        "ipso",
        "IPSO, the rival in table 8 of 000",
        "000 reference [4]: Du, Song, Chen et al. 2023",
        "000 prints its results but no equation or constant of it, and its paper was not found",
    )
}

_RIVALS = {"mealpy": mealpy, "pymoo": pymoo, "nevergrad": nevergrad, "minion": minion}
_DISTRIBUTIONS = {"minion": "minionpy"}


def algorithm(name: str) -> Algorithm:
    """Return the algorithm of this name: of `ALGORITHMS`, ``library:Name``, or ``module:function``.

    Libraries: mealpy, pymoo, nevergrad, minion.  Raises `UnknownAlgorithmError`, or
    `MissingLibraryError` if its library is not installed.
    """
    if name in ALGORITHMS:
        found = ALGORITHMS[name]
        for distribution in found.libraries:
            library(distribution)
        return found
    if name in NOT_REPRODUCIBLE:
        raise UnknownAlgorithmError(f"{name} is not reproducible: {NOT_REPRODUCIBLE[name].reason}")
    place, colon, attribute = name.partition(":")
    if not (place and colon and attribute):
        known = f"known: {', '.join(ALGORITHMS)}; or library:Name; or module:function"
        raise UnknownAlgorithmError(f"{name!r} is not known ({known})")
    if place not in _RIVALS:
        function = plug_in(name)
        return Algorithm(name, "plugged in", place, function, defaults(function))
    _require(place, attribute)
    function = partial(_RIVALS[place], attribute)
    distribution = _DISTRIBUTIONS.get(place, place)
    return Algorithm(
        name, f"{attribute} of {distribution}", distribution, function, defaults(function),
        libraries=(distribution,),
    )  # fmt: skip


def _require(place: str, attribute: str) -> None:
    """Raises `UnknownAlgorithmError` if a library has nothing of this name."""
    there = library(_DISTRIBUTIONS.get(place, place))
    try:
        if place == "pymoo":
            find(attribute)
        elif place == "mealpy":
            there.get_optimizer_by_class(attribute)
        elif place == "nevergrad":
            there.optimizers.registry[attribute]
        elif not issubclass(getattr(there, attribute), there.MinimizerBase):
            raise AttributeError(f"{attribute} is no minimiser")
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise UnknownAlgorithmError(f"{place}:{attribute}: {error}") from None
