"""What a motion on arcs keeps badly before it is assembled: position limits and times."""

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
    arrivals = np.cumsum(motion.times) + task.waited[1:]
    segment = np.minimum(np.searchsorted(arrivals, middles), task.n_segments - 1)
    extremes, slack = whole.extremes(0), task.problem.position_slack
    low, high = bounds[segment, :, 0] - slack, bounds[segment, :, 1] + slack
    out = (extremes.low < low) | (extremes.high > high)
    return frozenset((int(j), int(segment[i])) for i, j in np.argwhere(out))


def missed(task: ConditionedProblem, motion: ArcMotion) -> float:
    """Measure by how much a motion misses the times asked for.

    Parameters
    ----------
    task : ConditionedProblem
        With at least one time that is not to be exceeded.
    motion : ArcMotion

    Returns
    -------
    float
        The largest difference, as a share of the longest time that is not to be exceeded.
    """
    passed = np.concatenate([[0.0], np.cumsum(motion.times)])
    times = [(passed[w], early, late) for w, (early, late) in task.windows.items()]
    times += [(time, 0.0, late) for time, late in zip(motion.times, task.durations[:, 1], strict=True)]
    longest = max(abs(late) for _, _, late in times if np.isfinite(late))
    return max(float(max(early - time, time - late, 0.0)) for time, early, late in times) / (
        longest or 1.0
    )


def least_stretch(task: ConditionedProblem, motion: ArcMotion) -> float:
    """Find the least factor on all segment times that meets the earliest and the least times.

    Parameters
    ----------
    task : ConditionedProblem
    motion : ArcMotion

    Returns
    -------
    float
        At least 1.
    """
    passed = np.concatenate([[0.0], np.cumsum(motion.times)])
    factors = [early / passed[w] for w, (early, _) in task.windows.items()]
    return float(max([1.0, *factors, *(task.durations[:, 0] / motion.times)]))
