"""The answer of ``free_form`` under limits on the tool, made of the one without them."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from formulations.deadlines import Deadline
from formulations.optima.free_form.ending import SearchStatus
from formulations.optima.free_form.tool.search import ToolSearch
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.errors import NoFeasibleMotion, NotFoundInTime
from formulations.problem.problem import Problem

if TYPE_CHECKING:
    from formulations.optima.free_form.answer import FreeForm


def under_tool(
    problem: Problem,
    asked: Conditions,
    fastest: Callable[..., FreeForm],
    tolerance: float,
    deadline: Deadline,
    progress: Callable[[str, float], None] | None,
) -> FreeForm:
    """Find the fastest motion under limits on the tool.

    Parameters
    ----------
    problem : Problem
        With a chain to the tool.
    asked : Conditions
        Those in force.
    fastest : callable
        ``free_form`` with its options; it is asked for the motion without the limits on the tool.
    tolerance : float
        Relative, of the total time.
    deadline : Deadline
    progress : callable or None
        Called as ``progress(stage, seconds)``.

    Returns
    -------
    FreeForm

    Raises
    ------
    NoFeasibleMotion, NotFoundInTime
        No motion passes the check.
    UnsupportedProblem
        A joint has no acceleration limit.
    """
    begun = time.perf_counter()
    search = ToolSearch(Demands.of(problem, asked), progress, deadline)
    plain = replace(problem, conditions=asked.without_tool(problem.dof))
    without = fastest(plain, time_limit=None if np.isinf(deadline.end) else deadline.left)
    if without.trajectory is None:
        return replace(without, problem=problem, conditions=asked)
    search.run(without.trajectory, tolerance)
    best = search.best
    if best is None:
        line = f"no motion found that keeps conditions.{', conditions.'.join(asked.asked)}"
        if deadline.over:
            raise NotFoundInTime(f"time limit: {line} yet")
        raise NoFeasibleMotion(f"{line}; the last one tried: {search.stages[-1].status}")
    status = SearchStatus.OK if search.converged else SearchStatus.NOT_CONVERGED
    if len(search.stages) == 1:  # the limits on the tool cost nothing
        status = without.status
    if deadline.over:
        status = SearchStatus.INTERRUPTED if deadline.interrupted else SearchStatus.TIME_LIMIT
    return replace(
        without,
        problem=problem,
        conditions=asked,
        durations=np.diff(best.trajectory.passage_times),
        trajectory=best.trajectory,
        verdict=best.verdict,
        method=best.name,
        status=status,
        reason=search.reason if status is SearchStatus.NOT_CONVERGED else "",
        sensitivity=None,
        stages=tuple(search.stages),
        runtime=time.perf_counter() - begun,
    )
