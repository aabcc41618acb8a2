"""Full stop at every waypoint in closed form: a motion that is always there, without a solver.

Each joint crosses each segment on its own fastest symmetric S-curve (Biagiotti & Melchiorri 2008,
sec. 3.4), slowed down to the slowest joint's time; it never leaves the segment's two waypoints.
"""

from __future__ import annotations

import numpy as np

from formulations.optima.free_form.nlp.arcs import Arcs, Motion
from formulations.optima.free_form.nlp.assembly import least_times
from formulations.optima.free_form.nlp.task import Task
from formulations.problem.arrays import Array


def stop_and_go(task: Task) -> Motion:
    """Rest to rest across every segment; times of conditions are met by slowing down, if at all.

    End velocities that are not zero are not met: then it is a start for the solvers, not an answer.
    """
    least = least_times(task)
    profiles = {}
    for order in (2, 3):
        for j in task.group(order):
            d = task.displacements[:, j]
            phases = s_curve(np.abs(d), task.limits[:, :, j], order)
            profiles[j] = phases
            least = np.maximum(least, phases.sum(axis=1))
    scale = float(least.sum()) or max(task.times.values(), default=1.0)
    times = _slowed(task, np.maximum(least, 1e-9 * scale))
    joints = {}
    for j, phases in profiles.items():
        own = phases.sum(axis=1)
        order = int(task.order[j])
        signs = np.array([1, 0, -1, 0, -1, 0, 1] if order == 3 else [1, 0, -1])
        limit = task.limits[order - 1, :, j] * np.sign(task.displacements[:, j])
        still = own == 0.0
        factor = times / np.where(still, 1.0, own)
        h = np.where(still[:, None], times[:, None] / phases.shape[1], phases * factor[:, None])
        tops = np.where(still, 0.0, limit / factor**order)[:, None] * signs
        joints[j] = Arcs(order, h, tops, np.zeros((task.n_segments + 1, 2)))
    return Motion(times, joints)


def s_curve(distance: Array, limits: Array, order: int) -> Array:
    """Phases of the fastest rest-to-rest motions: (S, 7) [s], without a jerk limit (S, 3).

    distance: (S,) [rad], not negative. limits: (3, S).
    """
    velocity, acceleration, jerk = limits
    if order == 2:
        rise = np.minimum(velocity / acceleration, np.sqrt(distance / acceleration))
        cruise = np.maximum(distance - acceleration * rise**2, 0.0) / velocity
        return np.stack([rise, np.where(rise < velocity / acceleration, 0.0, cruise), rise], axis=1)
    # jerk phase: until the acceleration, the velocity or the distance is used up
    tj = np.minimum.reduce(
        [acceleration / jerk, np.sqrt(velocity / jerk), np.cbrt(distance / (2.0 * jerk))]
    )
    full = tj >= acceleration / jerk
    # constant acceleration: until the velocity or the distance is used up
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


def _slowed(task: Task, times: Array) -> Array:
    """Times stretched between fixed ones to meet them; as they are where they would have to shrink."""
    found, before, earlier = times.copy(), 0, 0.0
    for waypoint, time in sorted(task.times.items()):
        block = slice(before, waypoint)
        found[block] *= max((time - earlier) / found[block].sum(), 1.0)
        before, earlier = waypoint, time
    return found
