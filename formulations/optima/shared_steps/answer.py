"""The answer of ``free_form`` under limits on tool or motors, made of the one without them."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from formulations.deadlines import Deadline
from formulations.optima.free_form.answer import FreeForm
from formulations.optima.free_form.ending import SearchStatus
from formulations.optima.shared_steps.search import StepSearch
from formulations.problem.demands import Demands
from formulations.problem.errors import NoFeasibleMotion, NotFoundInTime

NOTE = "the lower bound is that of the limits without torques"
_MOST_NODES = 4000  # joints times steps of a second, finer program


def fastest_within(
    demands: Demands,
    plain: Callable[..., FreeForm],
    *,
    mesh: int = 7,
    tolerance: float = 1e-3,
    deadline: Deadline,
    progress: Callable[[str, float], None] | None = None,
) -> FreeForm:
    """Find the fastest motion under limits on the tool, torque limits, or both.

    Parameters
    ----------
    demands : Demands
        With such limits among their conditions.
    plain : callable
        Finds the fastest motion without them; it is given ``time_limit``.
    mesh : int
        The program has twice as many steps per segment. With a ``tolerance`` below 1e-3 a second one has
        four times as many.
    tolerance : float
        Relative tolerance of the total time: an aim.
    deadline : Deadline
    progress : callable, optional
        Called as ``progress(stage, seconds)``.

    Returns
    -------
    FreeForm
        Verified by the check.

    Raises
    ------
    InputError
        A motor cannot hold the arm where it has to stand still.
    NoFeasibleMotion
        No motion was found. NotFoundInTime where the time was over.
    UnsupportedProblem
        The tool is limited, and a joint has no acceleration limit.
    """
    begun = time.perf_counter()
    search = StepSearch(demands, deadline, progress)
    left, asked = deadline.left, demands.conditions
    first = plain(time_limit=left / 2.0 if np.isfinite(left) else None)
    if first.trajectory is None:
        return replace(first, problem=demands.problem, conditions=asked)
    search.clock = time.perf_counter()
    finer = tolerance < 1e-3 and 4 * mesh * demands.jerk.size <= _MOST_NODES
    search.run(first.trajectory, (2 * mesh, 4 * mesh) if finer else (2 * mesh,))
    if search.best is None:
        line = f"no motion found that keeps {search.limits}; {search.stages[-1].status}"
        raise NotFoundInTime(line) if deadline.over else NoFeasibleMotion(line)
    name, motion, verdict = search.best
    status, reason = SearchStatus.OK, ""
    if deadline.over:
        status = SearchStatus.INTERRUPTED if deadline.interrupted else SearchStatus.TIME_LIMIT
    elif not search.converged:
        status, reason = SearchStatus.NOT_CONVERGED, search.stages[-1].status
    unhindered = len(search.stages) == 1 and search.converged
    return replace(
        first,
        problem=demands.problem,
        conditions=asked,
        durations=np.diff(motion.passage_times) - demands.waits[:-1],
        trajectory=motion,
        verdict=verdict,
        method=first.method if unhindered else name,
        status=first.status if unhindered else status,
        reason=first.reason if unhindered else reason,
        notes=first.notes if asked.torque is None else (*first.notes, NOTE),
        sensitivity=first.sensitivity if unhindered else None,
        stages=(*first.stages, *search.stages),
        runtime=time.perf_counter() - begun,
    )
