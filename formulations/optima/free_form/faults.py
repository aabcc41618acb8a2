"""What a motion on arcs keeps badly before it is assembled: position limits and fixed times."""

from __future__ import annotations

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.optima.free_form.nlp.arcs import ArcMotion
from formulations.optima.free_form.nlp.assembly import assemble
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.problem.errors import InputError


def finite(task: ConditionedProblem, motion: ArcMotion) -> Trajectory | None:
    """Assemble a motion, unless its numbers overflow.

    Parameters
    ----------
    task : ConditionedProblem
    motion : ArcMotion

    Returns
    -------
    Trajectory or None
    """
    try:
        return assemble(task, motion)
    except InputError:  # a trajectory has finite coefficients
        return None


def outside(task: ConditionedProblem, motion: ArcMotion) -> frozenset[tuple[int, int]]:
    """Find where a motion leaves the position limits.

    Parameters
    ----------
    task : ConditionedProblem
    motion : ArcMotion

    Returns
    -------
    frozenset of (joint, segment)
    """
    whole = finite(task, motion)
    if whole is None:
        return frozenset()
    bounds = task.position_bounds
    middles = whole.breaks[:-1] + 0.5 * whole.durations
    passages = np.unique(whole.passage_times)
    segment = np.searchsorted(passages, middles) - 1
    extremes, slack = whole.extremes(0), task.problem.position_slack
    low, high = bounds[segment, :, 0] - slack, bounds[segment, :, 1] + slack
    out = (extremes.low < low) | (extremes.high > high)
    return frozenset((int(j), int(segment[i])) for i, j in np.argwhere(out))


def missed(task: ConditionedProblem, motion: ArcMotion) -> float:
    """Measure by how much a motion misses the fixed times.

    Parameters
    ----------
    task : ConditionedProblem
        With at least one fixed time.
    motion : ArcMotion

    Returns
    -------
    float
        The largest difference, as a share of the longest fixed time.
    """
    passed, times = np.cumsum(motion.times), task.times
    return max(abs(float(passed[w - 1]) - time) for w, time in times.items()) / max(times.values())
