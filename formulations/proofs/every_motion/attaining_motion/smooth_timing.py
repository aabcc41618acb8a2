"""A first point for dense paths: the fastest timing of a smooth curve through the waypoints.

Where waypoints are close, a motion has little freedom between them, and the fastest motion is nearly that
along a spline q(s) through them, s = 0 ... K at the waypoints. Its timing has three unknowns for each
waypoint whatever the number of joints: the duration T of a segment, and the rate r = ds/dt and its slope
b = dr/dt at the waypoints, with a constant c = db/dt on each segment,

    1 = r T + b T^2 / 2 + c T^3 / 6,    r+ = r + b T + c T^2 / 2,    b+ = b + c T,

and the limits at both ends of each segment (Bobrow et al. 1985, with jerk)

    |q' r| <= V,    |q' b + q'' r^2| <= A,    |q' c + 3 q'' r b + q''' r^3| <= J.

What it violates between the waypoints is little, and left to the descent.

References
----------
Bobrow, Dubowsky & Gibson 1985, "Time-optimal control of robotic manipulators along specified paths",
International Journal of Robotics Research 4, pp. 3-17.
"""

from __future__ import annotations

from typing import Any

import casadi
import numpy as np
from scipy.interpolate import CubicSpline

from formulations.deadlines import NEVER, Deadline
from formulations.deadlines.ipopt import StoppableIpopt
from formulations.problem.arrays import Array
from formulations.proofs.every_motion.attaining_motion.chain_task import ChainTask
from formulations.proofs.every_motion.attaining_motion.reach_rows import ChainPoint

_OPTIONS: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.max_iter": 300,
    "ipopt.tol": 1e-6,
    "print_time": False,
    "error_on_fail": False,
    "show_eval_warnings": False,
}


def smoothly_timed(
    task: ChainTask, waypoints: Array, start: ChainPoint, deadline: Deadline = NEVER
) -> ChainPoint | None:
    """Time the spline through the waypoints.

    Parameters
    ----------
    task : ChainTask
    waypoints : Array, shape (K + 1, n) [rad]
        Of its joints.
    start : ChainPoint
        Its durations are where the search begins.
    deadline : Deadline

    Returns
    -------
    ChainPoint or None
        It may violate rows a little. None where no timing was found.
    """
    if not casadi.has_nlpsol("ipopt"):
        return None
    K = len(start.T)
    second = float(start.T.mean())  # the unit of time
    spline = CubicSpline(np.arange(K + 1.0), waypoints)
    first, bend = spline(np.arange(K + 1), 1), spline(np.arange(K + 1), 2)
    T, c = casadi.SX.sym("T", K), casadi.SX.sym("c", K)
    r, b = casadi.SX.sym("r", K + 1), casadi.SX.sym("b", K + 1)
    equal = casadi.vertcat(
        r[:-1] * T + b[:-1] * T**2 / 2.0 + c * T**3 / 6.0 - 1.0,
        r[:-1] + b[:-1] * T + c * T**2 / 2.0 - r[1:],
        b[:-1] + c * T - b[1:],
        *(state[i] for state in (r, b) for i in (0, K)),  # at rest
    )
    limited = []
    for j in range(len(task.velocity)):
        q1, q2 = casadi.DM(first[:, j]), casadi.DM(bend[:, j])
        limited.append(q1 * r / (task.velocity[j] * second))
        limited.append((q1 * b + q2 * r**2) / (task.acceleration[j] * second**2))
        if task.has_jerk[j]:
            q3 = casadi.DM(np.diff(bend[:, j]))
            for at in (slice(0, K), slice(1, K + 1)):
                jerk = q1[at] * c + 3.0 * q2[at] * r[at] * b[at] + q3 * r[at] ** 3
                limited.append(jerk / (task.jerks[0, j] * second**3))
    blocks = [equal, *limited]
    nlp = {
        "x": casadi.vertcat(T, r, b, c),
        "p": casadi.SX(0, 1),
        "f": casadi.sum1(T) / K,
        "g": casadi.vertcat(*blocks),
    }
    bounds = np.concatenate([np.zeros(equal.numel()), np.ones(nlp["g"].numel() - equal.numel())])
    rates = np.zeros(K + 1)
    rates[1:-1] = 2.0 * second / (start.T[1:] + start.T[:-1])
    still = np.full(2 * K + 1, np.inf)
    solved = StoppableIpopt("smooth_timing", nlp, _OPTIONS, blocks).solve(
        deadline,
        x0=np.concatenate([start.T / second, rates, np.zeros(2 * K + 1)]),
        p=[],
        lbx=np.concatenate([np.full(K, 1e-3), np.zeros(K + 1), -still]),
        ubx=np.inf,
        lbg=-bounds,
        ubg=bounds,
    )
    found = np.full(4 * K + 2, np.nan) if solved is None else np.asarray(solved[0]["x"]).ravel()
    if not np.isfinite(found).all() or not found[:K].min() > 0.0:
        return None
    rate, slope = np.split(found[K : 3 * K + 2, None], 2)
    rate, slope = rate / second, slope / second**2
    v, a = first * rate / task.velocity, (first * slope + bend * rate**2) / task.acceleration
    v[[0, -1]] = a[[0, -1]] = 0.0
    a[:, ~task.has_jerk] = 0.0
    return ChainPoint(np.maximum(found[:K] * second, task.least), v, a, np.zeros_like(v))
