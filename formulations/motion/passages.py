"""When a motion from elsewhere passes the waypoints, and by how much it misses them.

A file holds points, not waypoints. Of all increasing choices of times, one per waypoint from the start to
the end of the motion, that with the least sum of distances is found: the local minima of the distance to
each waypoint are the candidates, and dynamic programming chooses among them. Where the tool has to pass
within a ball too, what it is outside of the ball counts as a distance like that of a joint.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from formulations.kinematics.link_chain import LinkChain
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array

_SAMPLES = 8  # per piece, where the search for local minima starts; two in motions of very many pieces
_ALL_SAMPLES = 200_000
_GOLDEN = 0.5 * (5.0**0.5 - 1.0)
_SECTIONS = 35  # golden sections: to 1e-7 of two samples
_NEWTON = 3  # steps from there
_CANDIDATES = 200  # per waypoint, the nearest ones


@dataclass(frozen=True)
class Passages:
    """Times and distances at which a motion passes waypoints.

    Attributes
    ----------
    times : Array, shape (n_waypoints,) [s]
        Not decreasing, from the start to the end of the motion.
    misses : Array, shape (n_waypoints, dof) [rad]
        Position less the nearest place of the waypoint's box at these times.
    """

    times: Array
    misses: Array


@dataclass(frozen=True)
class Balls:
    """Where the tool has to pass the waypoints.

    Attributes
    ----------
    chain : LinkChain
        From base to tool.
    waypoints : Array, shape (n_waypoints, dof) [rad]
        At whose tool points the balls are.
    radius : Array, shape (n_waypoints,) [m]
        Infinite where there is none.
    """

    chain: LinkChain
    waypoints: Array
    radius: Array

    def outside(self, waypoint: int, positions: Array) -> Array:
        """Measure how far the tool is outside of a ball.

        Parameters
        ----------
        waypoint : int
            From 0.
        positions : Array, shape (n, dof) [rad]
            Of the joints.

        Returns
        -------
        Array, shape (n,) [m]
            0 inside.
        """
        if not np.isfinite(self.radius[waypoint]):
            return np.zeros(len(positions))
        middle, *at = self.chain.forward(np.vstack([self.waypoints[waypoint], positions]))[:, :3, 3]
        away = np.linalg.norm(np.reshape(at, (-1, 3)) - middle, axis=1)
        return np.asarray(np.maximum(away - self.radius[waypoint], 0.0))


def passages(
    trajectory: Trajectory,
    waypoints: Array,
    windows: Mapping[int, tuple[float, float]] | None = None,
    boxes: Array | None = None,
    balls: Balls | None = None,
) -> Passages:
    """Find the times at which a motion passes waypoints in their order.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    waypoints : Array, shape (n_waypoints, dof) [rad]
        Positions to pass, at least two; the first at the start and the last at the end.
    windows : mapping of int to (float, float), optional
        Earliest and latest time at which inner waypoints have to be passed [s]: the misses are those within.
    boxes : Array, shape (n_waypoints, dof, 2) [rad], optional
        Least and greatest position that passes each waypoint; the waypoints themselves if left out.
    balls : Balls, optional
        Where the tool has to be when it passes them.

    Returns
    -------
    Passages
        Times and misses; a waypoint that is not passed gets the time of its nearest approach.
    """
    boxes = np.stack([waypoints, waypoints], axis=-1) if boxes is None else boxes
    candidates = [np.array([0.0]), *_approaches(trajectory, boxes, balls)]
    candidates.append(np.array([trajectory.seconds]))
    for waypoint, (early, late) in (windows or {}).items():
        if 0 < waypoint < len(waypoints) - 1:
            ends = np.clip([early, late], 0.0, trajectory.seconds)
            times = candidates[waypoint]
            inside = times[(times > ends[0]) & (times < ends[1])]
            candidates[waypoint] = np.unique(np.concatenate([ends, inside]))
    distances = [
        np.abs(_off(at, box)).max(axis=1) + (0.0 if balls is None else balls.outside(k, at))
        for k, (at, box) in enumerate(zip(map(trajectory.at, candidates), boxes, strict=True))
    ]
    # least sum of distances up to each candidate, and the candidate before it
    cost, before = distances[0], []
    for k in range(1, len(waypoints)):
        order = np.argsort(candidates[k - 1], kind="stable")
        best = np.minimum.accumulate(cost[order])
        where = order[np.maximum.accumulate(np.where(cost[order] <= best, np.arange(len(order)), 0))]
        allowed = np.searchsorted(candidates[k - 1][order], candidates[k], side="right") - 1
        reachable = allowed >= 0
        cost = np.where(reachable, best[allowed], np.inf) + distances[k]
        before.append(where[allowed])
    chosen = [int(cost.argmin())]
    for previous in reversed(before):
        chosen.append(int(previous[chosen[-1]]))
    times = np.array([candidates[k][i] for k, i in enumerate(reversed(chosen))])
    return Passages(
        times, np.stack([_off(at, box) for at, box in zip(trajectory.at(times), boxes, strict=True)])
    )


def _off(positions: Array, box: Array) -> Array:
    """Positions (..., dof) less the nearest place of a box (dof, 2)."""
    return np.asarray(positions - np.clip(positions, box[:, 0], box[:, 1]))


def _approaches(trajectory: Trajectory, boxes: Array, balls: Balls | None) -> list[Array]:
    """Times of the nearest local minima of the distance to each inner box (n, dof, 2) and its ball [s]."""
    if len(boxes) < 3:
        return []
    count = int(np.clip(_ALL_SAMPLES // len(trajectory.durations), 2, _SAMPLES))
    steps = np.linspace(0.0, 1.0, count, endpoint=False)
    times = (trajectory.breaks[:-1, None] + trajectory.durations[:, None] * steps).ravel()
    times = np.append(times, trajectory.seconds)
    positions = trajectory.at(times)
    found = []
    for k, box in enumerate(boxes[1:-1], 1):
        ball = None
        if balls is not None and np.isfinite(balls.radius[k]):
            ball = partial(balls.outside, k)
        found.append(_approaches_of_one(trajectory, box, times, positions, ball))
    return found


def _approaches_of_one(
    trajectory: Trajectory,
    box: Array,
    times: Array,
    positions: Array,
    ball: Callable[[Array], Array] | None,
) -> Array:
    """Those of one box (dof, 2), both ends included; positions (n_times, dof) at times are known."""

    def size(at: Array) -> Array:
        joints = np.square(_off(at, box)).sum(axis=1)
        return np.asarray(joints if ball is None else joints + np.square(ball(at)))

    distance = size(positions)
    padded = np.concatenate([[np.inf], distance, [np.inf]])
    lowest = (distance <= padded[:-2]) & (distance <= padded[2:])
    # of a standstill, the first and the last moment are enough
    inner = np.convolve(lowest, [1, 1, 1], mode="same") == 3
    found = np.flatnonzero(lowest & ~inner)
    if len(found) > _CANDIDATES:
        found = found[np.argsort(distance[found], kind="stable")[:_CANDIDATES]]
    low, high = times[np.maximum(found - 1, 0)], times[np.minimum(found + 1, len(times) - 1)]

    def away(at: Array) -> Array:
        return size(trajectory.at(at))

    for _ in range(_SECTIONS):
        left, right = low + (high - low) * (1.0 - _GOLDEN), low + (high - low) * _GOLDEN
        is_left = away(left) <= away(right)
        low, high = np.where(is_left, low, left), np.where(is_left, right, high)
    at = 0.5 * (low + high)
    for _ in range(0 if ball else _NEWTON):  # of the derivative of half the squared distance
        error, speed = _off(trajectory.at(at), box), trajectory.at(at, 1)
        slope = (speed * error).sum(axis=1)
        curvature = np.square(speed).sum(axis=1) + (trajectory.at(at, 2) * error).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.nan_to_num(np.where(curvature > 0.0, slope / curvature, 0.0))
        nearer = np.clip(at - step, 0.0, trajectory.seconds)
        at = np.where(away(nearer) <= away(at), nearer, at)
    at = np.where(away(at) <= distance[found], at, times[found])
    return np.unique(np.concatenate([[0.0], at, [trajectory.seconds]]))
