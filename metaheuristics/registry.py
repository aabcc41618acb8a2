"""Every algorithm of the papers, and the controls, by name."""

from __future__ import annotations

from typing import Any

from metaheuristics.driver.task import Search
from metaheuristics.entry import Algorithm, NotReproducible, defaults
from metaheuristics.libraries.cmaes_ import cma_es
from metaheuristics.libraries.minion_ import lshade
from metaheuristics.libraries.scipy_ import (
    differential_evolution,
    dual_annealing,
    nelder_mead,
    slsqp,
    sobol,
)
from metaheuristics.swarms.butterfly import butterfly
from metaheuristics.swarms.issa import issa
from metaheuristics.swarms.mipso import mipso, mipso_printed
from metaheuristics.swarms.mpso import mpso
from metaheuristics.swarms.pso import pso, pso_1995, pso_linear
from metaheuristics.swarms.pso_zhang_2025 import pso_004
from metaheuristics.swarms.random_search import random_search
from metaheuristics.swarms.sparrow import sparrow, sparrow_printed
from metaheuristics.swarms.whale import whale
from metaheuristics.swarms.whale_lu_2024 import whale_003

ALGORITHMS: dict[str, Algorithm] = {}
"""By name, in the order of tables."""

NOT_REPRODUCIBLE: dict[str, NotReproducible] = {
    "ipso": NotReproducible(
        "ipso",
        "IPSO, the rival in table 8 of 000",
        "000 reference [4]: Du, Song, Chen et al. 2023",
        "000 prints its results but no equation or constant of it, and its paper was not found",
    )
}


def _add(
    name: str,
    title: str,
    source: str,
    function: Search,
    *libraries: str,
    group: str,
    shortfall: str = "",
    **changed: Any,
) -> None:
    """Enter an algorithm with every parameter spelt out: the defaults, then what changed."""
    parameters = defaults(function) | changed
    ALGORITHMS[name] = Algorithm(name, title, source, function, parameters, group, libraries, shortfall)


def _pso(*entry: Any, **more: Any) -> None:
    _add(*entry, group="pso", **more)


def _papers(*entry: Any, **more: Any) -> None:
    _add(*entry, group="papers", **more)


def _animals(*entry: Any, **more: Any) -> None:
    _add(*entry, group="animals", **more)


def _control(*entry: Any, **more: Any) -> None:
    _add(*entry, group="controls", **more)


# fmt: off
_pso("pso", "PSO, constants equal to constriction",
     "Clerc & Kennedy 2002; the step is 004 eq. 3 and 2", pso)
_pso("pso-linear", "PSO, linearly decreasing inertia",
     "Shi & Eberhart 1998; 004 eq. 3-4, 001 eq. 14", pso_linear)
_pso("pso-1995", "PSO, no inertia", "Kennedy & Eberhart 1995; 004 eq. 1-2", pso_1995,
     shortfall="without inertia only the clamp holds the velocities: the swarm never settles")

_papers("mipso", "MIPSO, resolved", "000 eq. 10-18, table 7", mipso)
_papers("mipso-pso1", "MIPSO minus tent map", "000 section 3.4", mipso, tent=False)
_papers("mipso-pso2", "MIPSO minus dynamic factors", "000 section 3.4", mipso, dynamic=False)
_papers("mipso-pso3", "MIPSO minus mutation", "000 section 3.4", mipso, mutation=False)
_papers("mipso-printed", "MIPSO, eq. 15 and 16 as printed", "000 eq. 10-18, table 7", mipso_printed)
_papers("mpso", "MPSO, factors as printed", "001 eq. 14-16", mpso)
_papers("mpso-times-ten", "MPSO, factors times ten", "001 eq. 14-16", mpso, c_start=0.5, c_end=0.2)
_papers("pso-004", "PSO with Beta inertia and DE crossover, resolved", "004 eq. 2, 3, 5-7", pso_004)
_papers("pso-004-printed", "the same, eq. 7 as printed", "004 eq. 2, 3, 5-7", pso_004, printed=True,
        shortfall="nine of ten coordinates are copied from another particle at each step: no particle"
                  " goes on with a search of its own")

_animals("sparrow", "Sparrow search", "Xue & Shen 2020, eq. 3-5; 002 eq. 8-11", sparrow)
_animals("sparrow-printed", "Sparrow search, eq. 8 and 10 as printed in 002", "002 eq. 8-11",
         sparrow_printed,
         shortfall="producers, always better than the median, only ever shrink, and a common scale is"
                   " what the stretch takes out")
_animals("butterfly", "Butterfly optimisation", "Arora & Singh 2019, eq. 1-3", butterfly)
_animals("issa", "ISSA, each individual chooses its move", "002 eq. 8-15", issa,
         shortfall="the flock takes one shape within a few generations; once its best stops falling the"
                   " weight leaves butterflies alone, which only scale it, and a common scale is what"
                   " the stretch takes out")
_animals("issa-blended", "ISSA, each individual blends both moves", "002 eq. 8-15", issa, blended=True)
_animals("whale", "Whale optimisation", "Mirjalili & Lewis 2016, eq. 2.1-2.8", whale)
_animals("whale-003", "Whales with inertia and chaotic start, resolved", "003 eq. 14-23", whale_003)
_animals("whale-003-printed", "the same, eq. 16, 19, 21, 23 as printed", "003 eq. 14-23", whale_003,
         lam=0.5, printed=True,
         shortfall="without the test of A no whale ever looks at another one's place: it may settle too"
                   " soon")

_control("random", "Uniform random search", "none: the floor", random_search,
         shortfall="it does not search: the floor")
_control("sobol", "Quasi-random search, scrambled", "Sobol 1967", sobol, "scipy",
         shortfall="it does not search: the floor, laid evenly")
_control("de", "Differential evolution, best1bin", "Storn & Price 1997", differential_evolution,
         "scipy")
_control("lshade", "L-SHADE", "Tanabe & Fukunaga 2014", lshade, "minionpy")
_control("cma-es", "CMA-ES, restarts with growing populations", "Hansen 2016; Auger & Hansen 2005",
         cma_es, "cmaes")
_control("annealing", "Dual annealing", "Xiang et al. 1997", dual_annealing, "scipy")
_control("nelder-mead", "Nelder-Mead, many starts", "Nelder & Mead 1965", nelder_mead, "scipy")
_control("slsqp", "SLSQP, many starts, finite differences", "Kraft 1988", slsqp, "scipy")
# fmt: on
