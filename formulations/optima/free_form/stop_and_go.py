"""Stop and go in closed form: the motion that stops at every waypoint, which needs no solver.

Each joint crosses each segment on its own fastest symmetric S-curve (Biagiotti & Melchiorri 2008,
sec. 3.4), slowed down to the time of the slowest joint. It stays between the segment's two waypoints.

References
----------
Biagiotti & Melchiorri 2008, "Trajectory Planning for Automatic Machines and Robots", Springer.
"""

from __future__ import annotations

import numpy as np

from formulations.optima.free_form.nlp.arcs import ArcMotion, Arcs
from formulations.optima.free_form.nlp.assembly import least_times
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.problem.arrays import Array


def stop_and_go_motion(task: ConditionedProblem, places: Array | None = None) -> ArcMotion:
    """Move from rest to rest across every segment.

    Times of conditions are met by slowing down; those that are too short are not met. End states that
    are given and not zero are not met either: then the motion is a start for the solvers, not an answer.
    Where the acceleration limits of a joint differ between the directions, it uses the lower one.

    Parameters
    ----------
    task : ConditionedProblem
    places : Array, shape (S + 1, dof) [rad], optional
        Positions at the waypoints; the waypoints if left out.

    Returns
    -------
    ArcMotion
    """
    at = task.waypoints if places is None else places
    least = np.maximum(least_times(task, at), task.durations[:, 0])
    profiles, limits = {}, {}
    displacements = np.diff(at, axis=0)
    for order in (2, 3):
        for j in task.group(order):
            d = displacements[:, j]
            (velocity, acceleration), jerk = (
                (both[:, j] for both in task.intervals),
                task.limits[2, :, j],
            )
            speed = np.where(d < 0.0, -velocity[:, 0], velocity[:, 1])
            limits[j] = np.stack([speed, np.abs(acceleration).min(axis=1), jerk])
            phases = s_curve(np.abs(d), limits[j], order)
            profiles[j] = phases
            least = np.maximum(least, phases.sum(axis=1))
    scale = float(least.sum()) or max((early for early, _ in task.windows.values()), default=1.0) or 1.0
    times = _slowed(task, np.maximum(least, 1e-9 * scale))
    joints = {}
    for j, phases in profiles.items():
        own = phases.sum(axis=1)
        order = int(task.order[j])
        signs = np.array([1, 0, -1, 0, -1, 0, 1] if order == 3 else [1, 0, -1])
        limit = limits[j][order - 1] * np.sign(displacements[:, j])
        still = own == 0.0
        factor = times / np.where(still, 1.0, own)
        h = np.where(still[:, None], times[:, None] / phases.shape[1], phases * factor[:, None])
        tops = np.where(still, 0.0, limit / factor**order)[:, None] * signs
        joints[j] = Arcs(order, h, tops, np.zeros((task.n_segments + 1, 2)))
    return ArcMotion(times, joints, at)


def s_curve(distance: Array, limits: Array, order: int) -> Array:
    """Compute the phases of the fastest motions from rest to rest.

    Parameters
    ----------
    distance : Array, shape (S,) [rad]
        Not negative.
    limits : Array, shape (3, S)
        Of velocity, acceleration and jerk.
    order : int
        3, or 2 without a jerk limit.

    Returns
    -------
    Array, shape (S, 7) or of order 2 (S, 3) [s]
    """
    velocity, acceleration, jerk = limits
    if order == 2:
        rise = np.minimum(velocity / acceleration, np.sqrt(distance / acceleration))
        cruise = np.maximum(distance - acceleration * rise**2, 0.0) / velocity
        return np.stack([rise, np.where(rise < velocity / acceleration, 0.0, cruise), rise], axis=1)
    # jerk phase: until the acceleration limit, the velocity limit or the distance is reached
    tj = np.minimum.reduce(
        [acceleration / jerk, np.sqrt(velocity / jerk), np.cbrt(distance / (2.0 * jerk))]
    )
    full = tj >= acceleration / jerk
    # constant acceleration: until the velocity limit or the distance is reached
    peak = acceleration
    by_velocity = velocity / peak - tj
    root = np.sqrt(tj**2 + 4.0 * distance / peak)
    by_distance = 0.5 * (root - 3.0 * tj)
    ta = np.where(full, np.maximum(np.minimum(by_velocity, by_distance), 0.0), 0.0)
    top_speed = jerk * tj * (tj + ta)
    left = distance - top_speed * (2.0 * tj + ta)
    cruises = top_speed >= velocity * (1.0 - 1e-12)
    tv = np.where(cruises, np.maximum(left, 0.0) / velocity, 0.0)
    return np.stack([tj, ta, tj, tv, tj, ta, tj], axis=1)


def _slowed(task: ConditionedProblem, times: Array) -> Array:
    """Segment times stretched to meet earliest times, and not shrunk where the latest are too short."""
    found, before, earlier = times.copy(), 0, 0.0
    for waypoint, (early, _) in sorted(task.windows.items()):
        block = slice(before, waypoint)
        found[block] *= max((early - earlier) / found[block].sum(), 1.0)
        before, earlier = waypoint, max(early, float(found[:waypoint].sum()))
    return found
