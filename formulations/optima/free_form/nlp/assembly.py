"""Assembly: the arcs of all joints as one trajectory of common polynomial pieces, exact to rounding.

Break times are rounded to a grid on which sums and differences of doubles are exact. Joints with a
velocity limit only cross each segment on a velocity trapezoid with very short ramps.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.optima.free_form.nlp.arcs import ArcMotion
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.problem.arrays import Array, Indices

RAMP = 1e-6  # share of a segment that a joint with a velocity limit only takes to change its velocity


def least_times(task: ConditionedProblem, places: Array | None = None) -> Array:
    """Compute the least time of each segment set by the joints with a velocity limit only.

    It is slightly above the infimum |d| / V, which no motion attains: the velocity needs some time to
    change.

    Parameters
    ----------
    task : ConditionedProblem
    places : Array, shape (S + 1, dof) [rad], optional
        Positions at the waypoints; left out, wherever in their zones they are nearest to each other.

    Returns
    -------
    Array, shape (S,) [s]
    """
    joints = task.group(1)
    boxes = task.boxes if places is None else np.stack([places, places], axis=-1)
    forth = boxes[1:, joints, 0] - boxes[:-1, joints, 1]
    back = boxes[1:, joints, 1] - boxes[:-1, joints, 0]
    speeds = task.intervals[0][:, joints]
    shares = np.maximum(forth / speeds[..., 1], back / speeds[..., 0])
    return np.asarray(shares.max(axis=1, initial=0.0) / (1.0 - 3.0 * RAMP))


def assemble(task: ConditionedProblem, motion: ArcMotion) -> Trajectory:
    """Assemble a motion to a trajectory that passes the waypoints exactly.

    The tops of the arcs are changed within rounding or the solver's tolerance. The motion waits where
    that is asked for.

    Parameters
    ----------
    task : ConditionedProblem
    motion : ArcMotion

    Returns
    -------
    Trajectory
        Of all joints of the problem, with the passage times of all its waypoints.
    """
    # number of segments before the arrival at each waypoint, waits among them
    arrival = np.arange(task.n_segments + 1) + np.concatenate([[0], np.cumsum(task.waits > 0.0)[:-1]])
    motion = motion.with_waits(task.waits)
    grid = 2.0 ** (np.ceil(np.log2(motion.times.sum())) - 52)
    passages = np.round(np.concatenate([[0.0], np.cumsum(motion.times)]) / grid) * grid
    ends = {}
    for j, arcs in motion.joints.items():
        inner = np.round((passages[:-1, None] + np.cumsum(arcs.durations, axis=1)) / grid) * grid
        inner[:, -1] = passages[1:]
        ends[j] = np.minimum(inner, passages[1:, None])
    ramps = _ramps(task, passages, grid)
    breaks = np.unique(np.concatenate([passages, ramps.ravel(), *(e.ravel() for e in ends.values())]))
    durations = np.diff(breaks)
    middles = breaks[:-1] + 0.5 * durations
    segment = np.searchsorted(passages, middles) - 1
    places, displacements = motion.places, motion.displacements
    coefficients = np.zeros((len(durations), task.problem.dof, 4))
    coefficients[:, :, 0] = places[segment]
    for j, arcs in motion.joints.items():
        lengths = np.diff(np.concatenate([passages[:-1, None], ends[j]], axis=1), axis=1)
        exact = replace(arcs, durations=lengths).projected(displacements[:, j])
        top = exact.tops.ravel()[np.searchsorted(ends[j].ravel(), middles)]
        start = np.column_stack([places[:-1, j], exact.states[:-1]])[segment]
        coefficients[:, j] = _integrated(durations, segment, top, start, arcs.order)
    for j in task.group(1):
        slopes, v = _trapezoids(task.ends[:, j], displacements[:, j], passages, ramps)
        top = slopes.ravel()[np.searchsorted(ramps.ravel(), middles) - 1]
        start = np.column_stack([places[:-1, j], v[:-1], 0.0 * v[:-1]])[segment]
        coefficients[:, j] = _integrated(durations, segment, top, start, 2)
    return Trajectory(durations, coefficients, passages[arrival][task.waypoint_of])


def _integrated(h: Array, segment: Indices, top: Array, start: Array, order: int) -> Array:
    """Coefficients (n_pieces, 4) of one joint, by integration on each segment.

    top: (n_pieces,), the highest derivative. start: (n_pieces, 3), the state at the waypoint before.
    """
    first = np.searchsorted(segment, np.arange(segment[-1] + 1))[segment]

    def since_waypoint(steps: Array) -> Array:
        sums = np.concatenate([[0.0], np.cumsum(steps)])
        return np.asarray(sums[:-1] - sums[first])

    x, v, a = start.T
    jerk = top if order == 3 else np.zeros_like(top)
    a = a + since_waypoint(h * jerk) if order == 3 else top
    v = v + since_waypoint(h * (a + h * jerk / 2.0))
    x = x + since_waypoint(h * (v + h * (a / 2.0 + h * jerk / 6.0)))
    return np.stack([x, v, a / 2.0, jerk / 6.0], axis=1)


def _ramps(task: ConditionedProblem, passages: Array, grid: float) -> Array:
    """Start of the rise, its end, and start of the fall of the trapezoids, (S, 3); empty if none."""
    if not task.group(1):
        return np.zeros((0, 3))
    length = np.maximum(np.round(RAMP * np.diff(passages) / grid) * grid, grid)
    return np.stack([passages[:-1], passages[:-1] + length, passages[1:] - length], axis=1)


def _trapezoids(
    given: Array, displacements: Array, passages: Array, ramps: Array
) -> tuple[Array, Array]:
    """Acceleration on each part of each segment, (S, 3), and velocities at the waypoints, (S + 1,).

    given: velocities at both ends, (2,); where they are free, NaN, the joint rests.
    """
    rise, seconds = ramps[:, 1] - ramps[:, 0], np.diff(passages)
    v = np.zeros(len(passages))
    v[[0, -1]] = np.nan_to_num(given)
    cruise = (displacements - rise * (v[:-1] + v[1:]) / 2.0) / (seconds - rise)
    return np.stack([(cruise - v[:-1]) / rise, 0.0 * rise, (v[1:] - cruise) / rise], axis=1), v
