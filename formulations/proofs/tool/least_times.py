"""The least time of each segment under a limit of the tool's speed: its shortest way at that speed.

The tool's path from one waypoint to the next is at least as long as the straight line between them, and as the
way by a place that it has to pass (``passing``). With vectors a at the start and b at the end, no longer
than 1, either is at least b p' - a p + c: along the line a = b and c = 0. Where a waypoint is a zone, p and
p' are those of the waypoints w themselves. In a box |q - w| <= D of the joints, Taylor's formula gives

    |u (p(q) - p(w))| <= sum_j |u J_j(w)| D_j + 1/2 sum_jk C_jk D_j D_k,

with C from ``kinematics.reach_bounds.curvatures``; in a ball of the tool, it is at most the radius. What is
left of the way, less both, is a lower bound. All of it is computed in intervals rounded outward.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from formulations.kinematics.link_chain import LinkChain
from formulations.kinematics.reach_bounds import curvatures
from formulations.kinematics.tool_point import tool_point
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.proofs.arithmetic.intervals import down, up
from formulations.proofs.tool.enclosed import Enclosed, Sloped, sloped_cosine, sloped_sine
from formulations.proofs.tool.passing import places_passed


def with_tool_times(demands: Demands) -> Demands:
    """Raise the least times of segments to what the limit of the tool's speed implies.

    Parameters
    ----------
    demands : Demands

    Returns
    -------
    Demands
        The same where the speed of the tool is not limited. Every motion that keeps the demands given keeps
        these too, so that a bound under them holds.
    """
    if not np.isfinite(demands.tool_speed).any():
        return demands
    durations = demands.durations.copy()
    least = np.minimum(tool_least_times(demands), durations[:, 1])
    durations[:, 0] = np.maximum(durations[:, 0], least)
    return replace(demands, durations=durations)


def tool_least_times(demands: Demands) -> Array:
    """Bound the time of each segment from below by the tool's way at its greatest speed.

    Parameters
    ----------
    demands : Demands
        Of a problem with a chain to the tool.

    Returns
    -------
    Array, shape (n_segments,)
        [s], rounded down; 0 where the speed is not limited.
    """
    chain, speed = demands.problem.tool, demands.tool_speed
    if chain is None:
        return np.zeros(len(speed))
    points, slopes = _points(chain, demands.problem.waypoints)
    steps = [Enclosed(c.low[1:], c.high[1:]) - Enclosed(c.low[:-1], c.high[:-1]) for c in points]
    middles = np.stack([0.5 * (step.low + step.high) for step in steps])
    lengths = np.linalg.norm(middles, axis=0)
    # a vector of length at most 1 will do: the distance along it is no longer than the distance
    u = middles / np.where(lengths > 0.0, lengths, 1.0) * (1.0 - 1e-14)
    distance = u[0] * steps[0] + u[1] * steps[1] + u[2] * steps[2]
    bent, before, after = _bent(demands, chain), slice(None, -1), slice(1, None)

    def less_zones(way: Array, a: Array, b: Array) -> Array:
        """A way less what both zones take off along a and b."""
        for side, direction in ((before, a), (after, b)):
            moved = _along(direction, slopes, side, demands) + Enclosed.of(bent[side])
            way = down(way - np.minimum(moved.high, demands.tool_radius[side]))
        return way

    place = places_passed(demands, chain)
    a, b = place.a.T, place.b.T
    start, end = (
        sum((direction[i] * Enclosed(c.low[side], c.high[side]) for i, c in enumerate(points)), zero)
        for side, direction in ((before, a), (after, b))
        for zero in (Enclosed.of(np.zeros(len(speed))),)
    )
    by_place = down((end - start).low + np.where(place.joint < 0, 0.0, place.along))
    least = np.where(place.joint < 0, 0.0, less_zones(by_place, a, b))
    least = np.maximum(least, less_zones(distance.low, u, u))
    with np.errstate(divide="ignore"):
        return np.asarray(np.maximum(down(np.maximum(least, 0.0) / speed), 0.0))


def _half_widths(demands: Demands) -> Array:
    """How far each joint may be off its waypoint, (n_segments + 1, dof), rounded up."""
    points = demands.problem.waypoints
    low, high = demands.waypoints[..., 0], demands.waypoints[..., 1]
    off = np.maximum(points - low, high - points)
    return np.asarray(np.where(off > 0.0, up(off), 0.0))


def _points(chain: LinkChain, waypoints: Array) -> tuple[list[Enclosed], list[list[Enclosed]]]:
    """The tool points (3 components over the waypoints), and their slopes by joint."""
    zero = Enclosed.of(np.zeros(len(waypoints)))
    points: list[Enclosed] = []
    slopes = []
    for j in range(chain.dof):
        joints = [
            Sloped(Enclosed.of(waypoints[:, i]), zero + (1.0 if i == j else 0.0))
            for i in range(chain.dof)
        ]
        found = tool_point(
            chain, joints, sloped_sine, sloped_cosine, lambda value: Sloped(zero + value, zero)
        )
        points = [component.value for component in found]
        slopes.append([component.slope for component in found])
    return points, slopes


def _along(u: Array, slopes: list[list[Enclosed]], side: slice, demands: Demands) -> Enclosed:
    """How far the tool can be moved along u by the joints within their boxes, to first order."""
    off = _half_widths(demands)[side]
    total = Enclosed.of(np.zeros(u.shape[1]))
    for j, components in enumerate(slopes):
        mine = [Enclosed(c.low[side], c.high[side]) for c in components]
        along = u[0] * mine[0] + u[1] * mine[1] + u[2] * mine[2]
        total = total + Enclosed.of(along.size) * off[:, j]
    return total


def _bent(demands: Demands, chain: LinkChain) -> Array:
    """Bound on the second-order part at each waypoint, (n_segments + 1,)."""
    off = _half_widths(demands)
    ends = np.concatenate([demands.waypoints, demands.problem.waypoints[..., None]], axis=-1)
    reach = np.abs(ends).max(axis=(0, 2))  # also between a zone and a waypoint outside it, on a cycle
    both = np.einsum("kj,ji,ki->k", off, curvatures(chain, reach), off)
    return np.asarray(0.5 * both * (1.0 + 1e-12))  # above what rounding takes off
