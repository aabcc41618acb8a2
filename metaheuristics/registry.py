"""Every algorithm of the papers and every control by name: one line each, in the order of tables.

A new algorithm is one file in `metaheuristics.swarms` (or, of a library, in `metaheuristics.libraries`) and
one line here.
"""

from __future__ import annotations

from typing import Any

from metaheuristics.driver.plug_in import defaults
from metaheuristics.driver.task import Search
from metaheuristics.entry import Algorithm, NotReproducible
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
from metaheuristics.swarms.pso_zhang_2025 import pso_zhang_2025
from metaheuristics.swarms.random_search import random_search
from metaheuristics.swarms.sparrow import sparrow, sparrow_printed
from metaheuristics.swarms.whale import whale
from metaheuristics.swarms.whale_lu_2024 import whale_lu_2024


def _entry(
    group: str,
    name: str,
    title: str,
    source: str,
    function: Search,
    *libraries: str,
    shortfall: str = "",
    seeded_as: str = "",
    **changed: Any,
) -> Algorithm:
    """Make an entry with every parameter spelt out: the defaults of the function, then what changed."""
    return Algorithm(
        name,
        title,
        source,
        function,
        defaults(function) | changed,
        group,
        libraries,
        shortfall,
        seeded_as=seeded_as,
    )


# fmt: off
_ENTRIES = [
    _entry("pso", "pso", "PSO, constants equal to constriction",
           "Clerc & Kennedy 2002; the step is Zhang 2025, eq. 3 and 2", pso),
    _entry("pso", "pso-linear", "PSO, linearly decreasing inertia",
           "Shi & Eberhart 1998; Zhang 2025, eq. 3-4; Li 2022, eq. 14", pso_linear),
    _entry("pso", "pso-1995", "PSO, no inertia", "Kennedy & Eberhart 1995; Zhang 2025, eq. 1-2", pso_1995,
           shortfall="without inertia only the clamp limits the velocities, so that the swarm never"
                     " converges"),

    _entry("papers", "mipso", "MIPSO, resolved", "Wang 2025, eq. 10-18 and Table 7", mipso),
    _entry("papers", "mipso-pso1", "MIPSO minus tent map", "Wang 2025, section 3.4", mipso, tent=False),
    _entry("papers", "mipso-pso2", "MIPSO minus dynamic factors", "Wang 2025, section 3.4", mipso,
           dynamic=False),
    _entry("papers", "mipso-pso3", "MIPSO minus mutation", "Wang 2025, section 3.4", mipso,
           mutation=False),
    _entry("papers", "mipso-printed", "MIPSO, eq. 15 and 16 as printed",
           "Wang 2025, eq. 10-18 and Table 7", mipso_printed),
    _entry("papers", "mpso", "MPSO, factors as printed", "Li 2022, eq. 14-16", mpso),
    _entry("papers", "mpso-times-ten", "MPSO, factors times ten", "Li 2022, eq. 14-16", mpso,
           c_start=0.5, c_end=0.2),
    _entry("papers", "pso-zhang-2025", "PSO with Beta inertia and DE crossover, resolved",
           "Zhang 2025, eq. 2, 3, 5-7", pso_zhang_2025, seeded_as="pso-004"),
    _entry("papers", "pso-zhang-2025-printed", "PSO with Beta inertia and DE crossover, eq. 7 as printed",
           "Zhang 2025, eq. 2, 3, 5-7", pso_zhang_2025, seeded_as="pso-004-printed", printed=True,
           shortfall="each step copies nine of ten coordinates from another particle, so that no particle"
                     " continues its own search"),

    _entry("animals", "sparrow", "Sparrow search", "Xue & Shen 2020, eq. 3-5; Zhou 2025, eq. 8-11",
           sparrow),
    _entry("animals", "sparrow-printed", "Sparrow search, eq. 8 and 10 of Zhou 2025 as printed",
           "Zhou 2025, eq. 8-11", sparrow_printed,
           shortfall="producers are always better than the median, so that they only shrink; and the"
                     " stretch takes out any common scale"),
    _entry("animals", "butterfly", "Butterfly optimisation", "Arora & Singh 2019, eq. 1-3", butterfly),
    _entry("animals", "issa", "ISSA, each individual chooses its move", "Zhou 2025, eq. 8-15", issa,
           shortfall="the flock takes one shape within a few generations; once its best no longer falls,"
                     " the weight leaves only butterfly moves, which change its scale alone, and the"
                     " stretch takes out any common scale"),
    _entry("animals", "issa-blended", "ISSA, each individual blends both moves", "Zhou 2025, eq. 8-15",
           issa, blended=True),
    _entry("animals", "whale", "Whale optimisation", "Mirjalili & Lewis 2016, eq. 2.1-2.8", whale),
    _entry("animals", "whale-lu-2024", "Whales with inertia and chaotic start, resolved",
           "Lu 2024, eq. 14-23", whale_lu_2024, seeded_as="whale-003"),
    _entry("animals", "whale-lu-2024-printed",
           "Whales with inertia and chaotic start, eq. 16, 19, 21, 23 as printed", "Lu 2024, eq. 14-23",
           whale_lu_2024, seeded_as="whale-003-printed", lam=0.5, printed=True,
           shortfall="without the test of |A| no whale moves towards another whale, so that the swarm may"
                     " converge too early"),

    _entry("controls", "random", "Uniform random search", "none", random_search,
           shortfall="it does not search: it is the least that any algorithm must beat"),
    _entry("controls", "sobol", "Quasi-random search, scrambled", "Sobol 1967", sobol, "scipy",
           shortfall="it does not search: it covers the box evenly"),
    _entry("controls", "de", "Differential evolution, best1bin", "Storn & Price 1997",
           differential_evolution, "scipy"),
    _entry("controls", "lshade", "L-SHADE", "Tanabe & Fukunaga 2014", lshade, "minionpy"),
    _entry("controls", "cma-es", "CMA-ES, restarts with growing populations",
           "Hansen 2016; Auger & Hansen 2005", cma_es, "cmaes"),
    _entry("controls", "annealing", "Dual annealing", "Xiang et al. 1997", dual_annealing, "scipy"),
    _entry("controls", "nelder-mead", "Nelder-Mead, many starts", "Nelder & Mead 1965", nelder_mead,
           "scipy"),
    _entry("controls", "slsqp", "SLSQP, many starts, finite differences", "Kraft 1988", slsqp, "scipy"),
]
# fmt: on

ALGORITHMS: dict[str, Algorithm] = {entry.name: entry for entry in _ENTRIES}
"""Every algorithm by name, in the order of tables."""

NOT_REPRODUCIBLE: dict[str, NotReproducible] = {
    "ipso": NotReproducible(
        "ipso",
        "IPSO, the rival in Table 8 of Wang 2025",
        "reference [4] of Wang 2025: Du, Song, Chen et al. 2023",
        "Wang 2025 prints its results but no equation or constant of it, and its paper was not found",
    )
}
"""Algorithms that a paper compares with, but that nobody can run."""
