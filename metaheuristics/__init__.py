"""Metaheuristics for any f on a box, behind one driver that counts and keeps the score.

Conventions, for whatever a paper leaves open:

- every evaluation counts, the first population and mutants included, and the papers' k/K is
  evaluations used / budget at the time of the move;
- random numbers are drawn per coordinate, unless the algorithm's file says otherwise;
- positions are clipped to the box, velocities are left as they are there;
- velocities start at zero and are clamped to +-0.2 (hi - lo) per coordinate;
- updates are synchronous: a population moves, then it is evaluated, then bests are renewed;
- a best is replaced by the strictly better only; +inf is never better than anything, so a swarm
  that has seen nothing finite follows its first particle.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field
from typing import Any

from metaheuristics.minimise import (
    ObjectiveError,
    Result,
    Search,
    Status,
    Task,
    TaskError,
    minimise,
)
from metaheuristics.mipso import mipso, mipso_printed
from metaheuristics.pso import pso, pso_1995, pso_linear
from metaheuristics.random_search import random_search
from metaheuristics.whale import whale

__all__ = [
    "ALGORITHMS",
    "Algorithm",
    "ObjectiveError",
    "Result",
    "Status",
    "Task",
    "TaskError",
    "minimise",
]


@dataclass(frozen=True)
class Algorithm:
    """One published variant: run it by ``minimise(a.function, f, ..., **a.parameters)``."""

    name: str
    title: str
    source: str
    function: Search
    parameters: dict[str, Any] = field(hash=False)


def _algorithm(
    name: str, title: str, source: str, function: Search, **changed: Any
) -> tuple[str, Algorithm]:
    """Return a registry entry with every parameter spelt out: the defaults, then what changed."""
    defaults = {
        p.name: p.default
        for p in inspect.signature(function).parameters.values()
        if p.kind is p.KEYWORD_ONLY
    }
    return name, Algorithm(name, title, source, function, defaults | changed)


ALGORITHMS: dict[str, Algorithm] = dict(
    (
        _algorithm("random", "Uniform random search", "none: the floor", random_search),
        _algorithm(
            "pso",
            "PSO, constants equal to constriction",
            "Clerc & Kennedy 2002; the step is 004 eq. 3 and 2",
            pso,
        ),
        _algorithm(
            "pso-linear",
            "PSO, linearly decreasing inertia",
            "Shi & Eberhart 1998; 004 eq. 3-4, 001 eq. 14",
            pso_linear,
        ),
        _algorithm("pso-1995", "PSO, no inertia", "Kennedy & Eberhart 1995; 004 eq. 1-2", pso_1995),
        _algorithm("mipso", "MIPSO, resolved", "000 eq. 10-18, table 7", mipso),
        _algorithm("mipso-pso1", "MIPSO minus tent map", "000 section 3.4", mipso, tent=False),
        _algorithm(
            "mipso-pso2", "MIPSO minus dynamic factors", "000 section 3.4", mipso, dynamic=False
        ),
        _algorithm("mipso-pso3", "MIPSO minus mutation", "000 section 3.4", mipso, mutation=False),
        _algorithm(
            "mipso-printed",
            "MIPSO, eq. 15 and 16 as printed",
            "000 eq. 10-18, table 7",
            mipso_printed,
        ),
        _algorithm("whale", "Whale optimisation", "Mirjalili & Lewis 2016, eq. 2.1-2.8", whale),
    )
)
