"""A first point that does not stop at the waypoints: for dense paths, where stop and go is far too slow.

The waypoints' number grows at a rate that velocity limits and half of the acceleration limits allow, as if
the path between them were smooth; one pass forwards and one backwards find it (Bobrow et al. 1985). Jerk
is not looked at: what the point violates is left to the descent.

References
----------
Bobrow, Dubowsky & Gibson 1985, "Time-optimal control of robotic manipulators along specified paths",
International Journal of Robotics Research 4, pp. 3-17.
"""

from __future__ import annotations

import numpy as np

from formulations.proofs.every_motion.attaining_motion.chain_task import ChainTask
from formulations.proofs.every_motion.attaining_motion.reach_rows import ChainPoint

_TOP, _SHARE = 0.8, 0.5  # of the velocity and of the acceleration limits


def cruising_point(task: ChainTask) -> ChainPoint:
    """Pass the waypoints without a stop.

    Parameters
    ----------
    task : ChainTask

    Returns
    -------
    ChainPoint
        It may violate rows.
    """
    d = task.displacements
    K, n = d.shape
    with np.errstate(divide="ignore"):
        top = _TOP * (task.velocity / np.abs(d)).min(axis=1)
        gain = 2.0 * _SHARE * (task.acceleration / np.abs(d)).min(axis=1)
        bend = np.abs(np.diff(d, axis=0))
        turn = np.sqrt(_SHARE * (task.acceleration / bend).min(axis=1))
    rate = np.zeros(K + 1)  # waypoints per second
    rate[1:-1] = np.minimum.reduce([top[:-1], top[1:], turn])
    for k in range(K):
        rate[k + 1] = min(rate[k + 1], np.sqrt(rate[k] ** 2 + gain[k]))
    for k in reversed(range(K)):
        rate[k] = min(rate[k], np.sqrt(rate[k + 1] ** 2 + gain[k]))
    T = np.maximum(2.0 / np.maximum(rate[:-1] + rate[1:], 1e-9), task.least)
    v = np.zeros((K + 1, n))
    v[1:-1] = 0.5 * rate[1:-1, None] * (d[1:] + d[:-1]) / task.velocity
    return ChainPoint(T, v, np.zeros_like(v), np.zeros_like(v))
