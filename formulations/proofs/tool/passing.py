"""The way of the tool by places that it cannot avoid: where a joint passes a value between two waypoints.

A joint that goes from one side of a value c to the other is at c in between, and then the tool is at a point x
that the chain reaches with this joint at c. With vectors a and b no longer than 1, the way by x is at least

    |x - p| + |p' - x| >= a (x - p) + b (p' - x) = (a - b) x - a p + b p'.

So a lower bound on (a - b) x over all x that can be reached is enough. Along the chain from the base it is
found link by link: a pose and a joint that stands at a known angle turn the direction g = a - b. At a
turning joint whose angle is not known, with unit axis k, the part of g along k stays as it is, and the part
across k takes off at most its length times the distance of the tool from the axis.

Most often it is the first joint: an arm that turns about its base from the left to the right has to pass the
front, even where the straight line between the tool points passes behind.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.kinematics.link_chain import LinkChain
from formulations.problem.arrays import Array, Indices
from formulations.problem.demands import Demands

_SHARES = np.linspace(0.0, 1.0, 11)[1:-1]  # of the way of a joint, where its value is tried
_ROUNDING = 1e-11  # times size of the arm: far above what rounding adds up to over a chain


@dataclass(frozen=True)
class Passing:
    """The places by which the tool's way is bounded, one per segment.

    Attributes
    ----------
    joint : Indices, shape (n_segments,)
        The joint that passes a value; -1 where the straight line is as good.
    value : Array, shape (n_segments,) [rad or m]
    a, b : Array, shape (n_segments, 3)
        Vectors no longer than 1.
    along : Array, shape (n_segments,) [m]
        Lower bound on (a - b) x; minus infinity where there is no joint.
    """

    joint: Indices
    value: Array
    a: Array
    b: Array
    along: Array


def places_passed(demands: Demands, chain: LinkChain) -> Passing:
    """Choose the place that makes the tool's way on each segment longest.

    Every joint is tried at several values, with the axes of the chain as directions.

    Parameters
    ----------
    demands : Demands
    chain : LinkChain
        From base to tool.

    Returns
    -------
    Passing
    """
    points = demands.problem.waypoints
    n, dof = len(points) - 1, chain.dof
    found = Passing(
        np.full(n, -1), np.zeros(n), np.zeros((n, 3)), np.zeros((n, 3)), np.full(n, -np.inf)
    )
    low, high = np.moveaxis(demands.waypoints, -1, 0)
    tools = chain.forward(points)[:, :3, 3]
    step = np.diff(tools, axis=0)
    best = np.linalg.norm(step, axis=1) * (1.0 + 1e-6)
    limited = np.isfinite(demands.tool_speed)
    for joint in range(dof):
        rising, falling = high[:-1, joint] < low[1:, joint], low[:-1, joint] > high[1:, joint]
        which = np.flatnonzero(limited & (rising | falling))
        if not len(which):
            continue
        start = np.where(rising, high[:-1, joint], low[:-1, joint])
        end = np.where(rising, low[1:, joint], high[1:, joint])
        # candidates (values, directions, segments), flattened
        values = start[which] + _SHARES[:, None] * (end - start)[which]
        q = np.tile(points[which], (len(_SHARES), 1))
        q[:, joint] = values.ravel()
        axes = np.stack(_axes(chain, q)).reshape(-1, len(_SHARES), len(which), 3)
        u = np.moveaxis(np.concatenate([axes, -axes]), 1, 0).reshape(-1, 3)
        value = np.repeat(values, 2 * len(axes), axis=0).ravel()
        k = np.tile(which, len(u) // len(which))
        least = least_along(demands, chain, k, u, joint, value)
        before, after = (least - (u * ends[k]).sum(axis=1) for ends in (tools[:-1], tools[1:]))
        flat = step[k] - (u * step[k]).sum(axis=1)[:, None] * u
        there = (before > 0.0) & (after > 0.0)
        to = np.where(there, before + after, 0.0)[:, None] * u  # to the place and back
        size = np.where(there, np.linalg.norm(flat + to, axis=1), 0.0)
        at = size.reshape(-1, len(which)).argmax(axis=0) * len(which) + np.arange(len(which))
        at = at[size[at] > best[which]]
        k, shorter = k[at], (1.0 - 1e-14) / size[at][:, None]
        best[k], found.joint[k], found.value[k] = size[at], joint, value[at]
        found.a[k], found.b[k] = (flat + to)[at] * shorter, (flat - to)[at] * shorter
    for joint in range(dof):
        which = np.flatnonzero(found.joint == joint)
        g = found.a[which] - found.b[which]
        found.along[which] = least_along(demands, chain, which, g, joint, found.value[which])
    return found


def least_along(
    demands: Demands, chain: LinkChain, segments: Indices, g: Array, joint: int, value: Array
) -> Array:
    """Bound g x from below over all tool points x that can be reached with one joint at a value.

    Parameters
    ----------
    demands : Demands
        Position limits, which count for sliding joints.
    chain : LinkChain
    segments : Indices, shape (m,)
        Whose position limits hold.
    g : Array, shape (m, 3)
        Directions in the base's frame.
    joint : int
        That is at the value.
    value : Array, shape (m,) [rad or m]

    Returns
    -------
    Array, shape (m,)
        Times the unit of g [m]; minus infinity where a sliding joint has no limits.
    """
    slack = 1.01 * demands.problem.position_slack  # more than the limits allow
    low, high = np.moveaxis(demands.position[segments] + slack * np.array([-1.0, 1.0]), -1, 0)
    with np.errstate(invalid="ignore"):  # infinite positions times 0
        found = _least_within(chain, (low, high), g, joint, value)
    return np.where(np.isfinite(found), found, -np.inf)


def _least_within(
    chain: LinkChain, positions: tuple[Array, Array], g: Array, joint: int, value: Array
) -> Array:
    """The bound of ``least_along`` within positions (m, dof); not finite where some are not."""
    low, high = positions
    across, size = _distances(chain, np.maximum(np.abs(low), np.abs(high)))
    total = -_ROUNDING * size * np.linalg.norm(g, axis=1)
    for place, link in enumerate(chain.steps):
        total = total + g @ link.before[:3, 3]
        g = g @ link.before[:3, :3]
        known = link.variable == joint
        along = g @ link.axis
        if link.prismatic:
            ends = (value, value) if known else (low[:, link.variable], high[:, link.variable])
            total = total + np.minimum(*(along * (link.factor * x + link.offset) for x in ends))
        elif known:
            angle = (link.factor * value + link.offset)[:, None]
            turned = np.cross(link.axis, g)
            g = g - np.sin(angle) * turned
            g = g + (1.0 - np.cos(angle)) * np.cross(link.axis, turned)
        else:
            kept = along[:, None] * link.axis
            total = total - np.linalg.norm(g - kept, axis=1) * across[place]
            g = kept
        total = total + g @ link.after[:3, 3]
        g = g @ link.after[:3, :3]
    return np.asarray(total + g @ chain.end[:3, 3])


def _distances(chain: LinkChain, reach: Array) -> tuple[list[Array], Array]:
    """How far the tool may be from the axis of each link, and from the base (m,)."""
    size = np.full(len(reach), float(np.linalg.norm(chain.end[:3, 3])))
    across = []
    for link in reversed(chain.steps):
        shift = link.after[:3, 3]
        across.append(np.linalg.norm(shift - (shift @ link.axis) * link.axis) + size)
        size = size + np.linalg.norm(shift)
        if link.prismatic:
            size = size + abs(link.factor) * reach[:, link.variable] + abs(link.offset)
        size = size + np.linalg.norm(link.before[:3, 3])
    return across[::-1], size


def _axes(chain: LinkChain, joints: Array) -> list[Array]:
    """The axes of the links in the base's frame, each (m, 3)."""
    pose = np.broadcast_to(np.eye(4), (len(joints), 4, 4))
    found = []
    for link in chain.steps:
        pose = pose @ link.before
        found.append(pose[:, :3, :3] @ link.axis)
        pose = pose @ link.motion(joints) @ link.after
    return found
