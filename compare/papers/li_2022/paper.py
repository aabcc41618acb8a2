"""Li 2022: what its tables and figures share."""

from __future__ import annotations

from functools import cache
from typing import Any

from compare.audit.paper import Paper, PrintedTimes, load_papers, settings
from compare.benchmark.protocol import Budget
from formulations import Problem, family_bound, family_optimum, load

SWARMS = {"mpso": "factors as printed", "mpso-times-ten": "factors times ten"}
READINGS = SWARMS | {
    "boxed": "factors as printed, 0.1 to 2 s a segment",
    "six": "factors as printed, six populations",
    "six, all iterations": "factors as printed, six populations, each its 200 iterations",
}


def paper() -> Paper:
    """The numbers that the paper prints."""
    return load_papers("bagging")[0]


def rows() -> tuple[list[PrintedTimes], PrintedTimes]:
    """Rows of Table 3: the single joints, and the starred longest times."""
    single = [row for row in paper().rows if row.joint is not None]
    return single, next(row for row in paper().rows if row.joint is None)


def budget() -> Budget:
    """Population and iterations of sec. 3."""
    swarm = settings("bagging")["swarm"]
    return Budget(swarm["population"], swarm["iterations"])


def certified(problem: Problem) -> dict[str, Any]:
    """Prove the optimum of the problem's family to a gap of 1e-4.

    The proof goes on for at most ten minutes.

    Parameters
    ----------
    problem : Problem
        The task.

    Returns
    -------
    dict
        bound (certified) and optimum (best verified time) [s], durations [s].
    """
    start = family_optimum(problem, starts=6)
    found = family_bound(problem, gap=1e-4, time_limit=600.0, optimum=start)
    durations = None if found.durations is None else found.durations.tolist()
    return {"bound": found.seconds, "optimum": found.upper, "durations": durations}


@cache
def whole_optimum() -> dict[str, Any]:
    """The certified optimum of all joints together, under the assumed limits."""
    return certified(load("bagging"))
