"""A second start of the search: the tool on straight lines between waypoints, where the joints can follow.

Small steps along the line are mended by Newton's method with the least change of the joints. Across the line,
where the arm has more joints than the tool point needs, they are pulled to their next waypoint. What is left of
the way to it is gone with the tool at rest. Where the joints get stuck, from either end, the segment keeps the
straight line in the space of the joints.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from formulations.kinematics.link_chain import LinkChain
from formulations.optima.shared_steps.steps import Steps
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands

_STEPS, _MOST = 100, 500  # along a line; with those at its end
_NEWTON, _NEAR = 20, 1e-6  # steps; m by which the line may be missed
_ROUND = 1e-6  # m^2 added to J J^T: near a singular posture the joints do not jump
_LARGEST, _PULL = 0.2, 0.05  # rad of a step of Newton's method, and at the end of a line
_THERE = 1e-3  # rad
_SLOWER = 1.2  # times the least time of each step


def along_lines(demands: Demands, steps: int) -> Steps:
    """Make the start.

    Parameters
    ----------
    demands : Demands
        Of a problem with a chain to the tool.
    steps : int
        Per segment.

    Returns
    -------
    Steps
        They keep no limits.
    """
    chain, points = demands.problem.tool, demands.problem.waypoints
    assert chain is not None
    fastest = np.abs(demands.velocity).max(axis=-1)
    h, nodes = [], [points[:1]]
    for k, (start, end) in enumerate(pairwise(points)):
        path = _path(chain, start, end)
        ways = np.linalg.norm(np.diff(chain.forward(path)[:, :3, 3], axis=0), axis=1)
        times = (np.abs(np.diff(path, axis=0)) / fastest[k]).max(axis=1)
        times = _SLOWER * np.maximum(times, ways / demands.tool_speed[k]) + 1e-6
        ends = np.concatenate([[0.0], np.cumsum(times)])
        at = np.linspace(0.0, ends[-1], steps + 1)[1:]
        nodes.append(np.stack([np.interp(at, ends, joint) for joint in path.T], axis=1))
        h.append(np.full(steps, ends[-1] / steps))
    q, t = np.concatenate(nodes), np.concatenate([[0.0], np.cumsum(h)])
    v = np.gradient(q, t, axis=0)
    return Steps(np.array(h), np.stack([q, v, np.gradient(v, t, axis=0)]))


def _path(chain: LinkChain, start: Array, end: Array) -> Array:
    """Joint positions (n, dof) along the line of the tool, or along that of the joints."""
    found = _followed(chain, start, end)
    if found is None:
        found = _followed(chain, end, start)
        found = None if found is None else found[::-1]
    shares = np.linspace(0.0, 1.0, _STEPS + 1)[:, None]
    return start + shares * (end - start) if found is None else found


def _followed(chain: LinkChain, start: Array, end: Array) -> Array | None:
    """Follow the line of the tool; None where the joints get stuck."""
    first, last = chain.forward(np.stack([start, end]))[:, :3, 3]
    q, path = start, [start]
    for i in range(1, _MOST):
        left = end - q
        if i > _STEPS and np.abs(left).max() < _THERE:
            return np.array([*path, end])
        pull = left * min(1.0, 3.0 / max(_STEPS + 1 - i, 1))
        if i > _STEPS:
            pull = left * min(1.0, _PULL / np.abs(left).max())
        moved = _mended(chain, q, first + min(i / _STEPS, 1.0) * (last - first), pull)
        if moved is None or (i > _STEPS and np.abs(moved - q).max() < 0.01 * _PULL):
            return None
        q = moved
        path.append(q)
    return None


def _mended(chain: LinkChain, q: Array, target: Array, pull: Array) -> Array | None:
    """Joints with the tool at a target, pulled across it at first; None where there are none nearby."""
    for attempt in range(_NEWTON):
        pose, jacobian = chain.pose_and_jacobian(q[None])
        J, off = jacobian[0, :3], target - pose[0, :3, 3]
        if attempt and np.linalg.norm(off) < _NEAR:
            return q
        if attempt:
            pull = np.zeros_like(q)
        step = pull + J.T @ np.linalg.solve(J @ J.T + _ROUND * np.eye(3), off - J @ pull)
        q = q + step * min(1.0, _LARGEST / max(float(np.abs(step).max()), 1e-300))
    return None
