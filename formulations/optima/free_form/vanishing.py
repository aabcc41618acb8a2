"""Zones that overlap may be passed at one time; the program then has a segment that takes no time.

Such a segment is left out, its two waypoints become one, and the search begins again. So no motion has
pieces so short that rounding breaks its limits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from formulations.optima.free_form.mesh_refinement import MeshRefinement
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem

_SHORT = 0.1  # of the mean segment: a shorter one is tried without any time
_TRIES = 3


def searched(
    task: ConditionedProblem, search: Callable[[ConditionedProblem], MeshRefinement]
) -> MeshRefinement:
    """Search for the fastest motion, again without the segments that nearly vanish.

    Parameters
    ----------
    task : ConditionedProblem
    search : callable
        Runs a search for a task.

    Returns
    -------
    MeshRefinement
        The search with the best motion; its stages are those of all searches.
    """
    best = last = search(task)
    for _ in range(_TRIES):
        gone = _vanishing(last)
        if gone <= task.vanishing or last.ended:
            break
        task = replace(task, vanishing=task.vanishing | gone)
        stages = last.stages
        last = search(task)
        last.stages[:0] = stages
        if best.best is None or (last.best is not None and _seconds(last) < _seconds(best)):
            best = last
        else:
            best.stages[:] = last.stages
    return best


def _seconds(search: MeshRefinement) -> float:
    return np.inf if search.best is None else search.best.verdict.seconds


def _vanishing(search: MeshRefinement) -> frozenset[int]:
    """Segments of the problem whose zones overlap and which take almost no time."""
    task, motion = search.task, search.last
    if motion is None or not task.zones.any():
        return frozenset()
    short = motion.times < _SHORT * motion.times.mean()
    boxes = task.boxes
    overlap = np.maximum(boxes[1:, :, 0], boxes[:-1, :, 0]) <= np.minimum(
        boxes[1:, :, 1], boxes[:-1, :, 1]
    )
    short &= (
        overlap.all(axis=1) & (task.durations[:, 0] == 0.0) & (task.waits[1:] + task.waits[:-1] == 0.0)
    )
    return frozenset(int(k) for k in task.segments[short])
