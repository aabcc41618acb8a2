"""Why a stored row is none of a plan, in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from compare.benchmark.grade import Run
from compare.benchmark.records.provenance import provenance_of
from formulations import Problem

# what a plan must have in common with a row, step by step, and what is said where it has not
_STEPS = (
    (("case", "coding", "swarm"), "a case, coding or swarm that is not asked for"),
    (("track", "coordinates"), "a track or coordinates that are not asked for"),
    (("budget", "population"), "another budget"),
)


def mismatch(maker: Mapping[str, Any], runs: Sequence[Run], problems: Mapping[str, Problem]) -> str:
    """Say why a plan does not ask for a stored row.

    Parameters
    ----------
    maker : mapping
        The columns of the row that all seeds of its swarm share.
    runs : sequence of Run
        The plan.
    problems : mapping of str to Problem
        By case.

    Returns
    -------
    str
        Ends the sentence "a row with".
    """
    same = list(runs)
    for names, reason in _STEPS:
        same = [run for run in same if all(getattr(run, name) == maker[name] for name in names)]
        if not same:
            return reason
    run = same[0]
    wanted = provenance_of(run.swarm, problems[run.case], run.population, run.time_limit, run.constants)
    return wanted.difference(maker) or "a seed that is not asked for"
