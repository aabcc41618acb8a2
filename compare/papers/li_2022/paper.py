"""Paper 001: what its items share."""

from __future__ import annotations

from functools import cache
from typing import Any

from compare.audit.paper import Paper, Row
from compare.audit.paper_file import load_papers
from compare.benchmark.suite import Budget
from compare.papers.printed import tables
from formulations import Problem, family_bound, family_optimum, load

SWARMS = {"mpso": "factors as printed", "mpso-times-ten": "factors times ten"}
READINGS = SWARMS | {"boxed": "factors as printed, 0.1 to 2 s a segment"}


def paper() -> Paper:
    """Paper 001 as data."""
    return load_papers("bagging")[0]


def rows() -> tuple[list[Row], Row]:
    """Table 3: the rows of single joints, and the starred times."""
    single = [row for row in paper().rows if row.joint is not None]
    return single, next(row for row in paper().rows if row.joint is None)


def budget() -> Budget:
    """Section 3."""
    settings = tables("bagging")["swarm"]
    return Budget(settings["particles"], settings["iterations"])


def certified(problem: Problem) -> dict[str, Any]:
    """The family's optimum, proved to 1e-4 however long it takes: bound, best time, durations [s]."""
    start = family_optimum(problem, random_starts=0)
    found = family_bound(problem, gap=1e-4, time_limit=600.0, optimum=start)
    durations = None if found.durations is None else found.durations.tolist()
    return {"bound": found.seconds, "optimum": found.upper, "durations": durations}


@cache
def whole_optimum() -> dict[str, Any]:
    """That of all joints together under the assumed limits."""
    return certified(load("bagging"))
