"""The certified bound, verified optimum and features of an instance: proved once, then read from the store."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from compare.benchmark.ladders import LadderRecord, ladder_record
from compare.benchmark.suite.features import features_of
from formulations import Problem, family_optimum, ladder
from formulations.optima.family.optimum import best_of
from formulations.proofs.family import PROVERS

BASIN_STARTS = 8
TIME_LIMIT = 300.0  # s per instance; most take a few seconds, B-splines minutes


def rungs_of(problem: Problem) -> tuple[str, ...]:
    """Return the bounds that grading needs.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    tuple of str
        Keys of ``RUNGS``. Of a family without a prover the bound of every motion is the best there is, and
        of a B-spline of many segments it may be.
    """
    both = ("family", "family_lower")
    sure = problem.family in PROVERS and not problem.family.startswith("b-spline")
    return both if sure else (*both, "free_form_lower")


def prove(name: str, problem: Problem) -> tuple[str, LadderRecord, dict[str, Any]]:
    """Find the optimum of an instance, prove its bound, and describe it.

    Parameters
    ----------
    name : str
    problem : Problem

    Returns
    -------
    name : str
    record : LadderRecord
        Its rungs say how each proof ended.
    features : dict
        Those of `Features`; empty if there is no verified optimum.
    """
    found = ladder(problem, rungs=rungs_of(problem), time_limit=TIME_LIMIT)
    record = ladder_record(found)
    if found.optimum is None:
        return name, record, {}
    # the proof needs one start; how many basins there are, only many starts can tell
    searched = family_optimum(problem, starts=BASIN_STARTS, time_limit=TIME_LIMIT)
    return (
        name,
        record,
        asdict(features_of(problem, best_of(problem, [*found.optimum.starts, *searched.starts]))),
    )
