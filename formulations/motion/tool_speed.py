"""The greatest speed of the tool point along a motion, bounded rigorously between samples.

Let f = |p'|^2 be the square of the tool's speed on a piece of time of length w. The cubic through the
values and slopes of f at both ends differs from f by at most w^4 / 384 max |f''''|, and its own maximum is
known in closed form. With b_k >= |p^(k)| from ``kinematics.reach_bounds``, |f''''| <= 2 (b_1 b_5 + 4 b_2
b_4 + 3 b_3^2). Where this leaves the answer open, the piece is cut further: a branch and bound that ends
when the bound is within a relative 1e-10 of a value that f attains.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import perm

import numpy as np

from formulations.kinematics.jets import tool_motion
from formulations.kinematics.link_chain import LinkChain
from formulations.kinematics.reach_bounds import ORDERS, derivative_bounds
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array, Indices

_ACCURACY = 1e-10  # of the square of the speed, relative
_SLOW = 1e-8  # share of the square of the limit below which nothing is asked
_ROUNDS = 60
_FIRST = 200  # parts of the whole motion to begin with
_MOST = 2_000_000  # parts at a time; beyond, the bound reached so far is the answer
_ROUNDING = 1e-13  # more than the relative rounding of f in double precision
_WIDEST = 16  # parts that one is cut into at once


@dataclass(frozen=True)
class ToolSpeed:
    """The greatest speed of the tool on each segment.

    Attributes
    ----------
    speed : Array, shape (n_segments,)
        Upper bound on it, tight to a relative 1e-10 [m/s]; where the speed stays below a ten-thousandth of the
        limit, the bound is not sharper than that.
    time : Array, shape (n_segments,)
        When it is attained, from the start [s].
    """

    speed: Array
    time: Array


def tool_speed(chain: LinkChain, trajectory: Trajectory, segments: Indices, limits: Array) -> ToolSpeed:
    """Bound the speed of the tool point on each segment.

    Parameters
    ----------
    chain : LinkChain
        From the base to the tool point.
    trajectory : Trajectory
        The motion.
    segments : Indices, shape (n_pieces,)
        The segment that each piece belongs to.
    limits : Array, shape (n_segments,)
        Limits of the speed [m/s], the scale of what is asked; segments without one (infinite) are left out,
        and their speed is 0 in the answer.

    Returns
    -------
    ToolSpeed
    """
    best, upper, time = (np.zeros(len(limits)) for _ in range(3))
    pieces = np.flatnonzero(np.isfinite(limits[segments]))
    count = np.ceil(trajectory.durations[pieces] * (_FIRST / trajectory.seconds)).astype(int)
    piece = np.repeat(pieces, count)
    width = np.repeat(trajectory.durations[pieces] / count, count)
    start = width * (np.arange(len(piece)) - np.repeat(np.cumsum(count) - count, count))
    for _ in range(_ROUNDS):
        if not len(piece):
            break
        segment = segments[piece]
        scale = limits[segment] ** 2
        ends, slopes = _squares(chain, trajectory, piece, start, width)
        top, where = _cubic_maximum(ends, slopes * width)
        error = width**4 / 384.0 * _fourth(chain, trajectory, piece, start, width)
        most = (top + error) * (1.0 + _ROUNDING)
        trial = np.where(ends[0] >= ends[1], 0.0, 1.0)
        found = ends.max(axis=0)
        # the parts that may hold the maximum are also evaluated where their cubic has it
        tried = np.argsort(most / scale)[-64:]
        inner = _square(chain, trajectory, piece[tried], start[tried] + where[tried] * width[tried])[0]
        better = inner > found[tried]
        found[tried[better]], trial[tried[better]] = inner[better], where[tried[better]]
        order = np.argsort(found, kind="stable")
        before = best.copy()
        best[segment[order]] = np.maximum(best[segment[order]], found[order])
        best = np.maximum(best, before)
        mine = order[best[segment[order]] == found[order]]
        time[segment[mine]] = trajectory.breaks[piece[mine]] + start[mine] + trial[mine] * width[mine]
        wanted = np.maximum(best[segment] * (1.0 + _ACCURACY), _SLOW * scale)
        open_ = most > wanted
        done = segment[~open_]
        np.maximum.at(upper, done, np.minimum(most, wanted)[~open_])
        cuts = np.ceil((error[open_] / (0.5 * _ACCURACY * wanted[open_])) ** 0.25)
        cuts = np.clip(np.nan_to_num(cuts, nan=_WIDEST, posinf=_WIDEST), 2, _WIDEST).astype(int)
        if cuts.sum() > _MOST or (width[open_] <= 1e-14 * trajectory.seconds).any():
            np.maximum.at(upper, segment[open_], most[open_])
            break
        width = np.repeat(width[open_] / cuts, cuts)
        start = np.repeat(start[open_], cuts) + width * (
            np.arange(cuts.sum()) - np.repeat(np.cumsum(cuts) - cuts, cuts)
        )
        piece = np.repeat(piece[open_], cuts)
    else:
        np.maximum.at(upper, segments[piece], np.inf)
    return ToolSpeed(np.sqrt(upper), time)


def _derivative(trajectory: Trajectory, piece: Indices, t: Array, order: int) -> Array:
    """A derivative of the joint positions at local times, (n, dof)."""
    coefficients = trajectory.coefficients
    value = np.zeros((len(piece), trajectory.dof))
    for power in range(coefficients.shape[2] - 1, order - 1, -1):
        value = value * t[:, None] + coefficients[piece, :, power] * perm(power, order)
    return value


def _square(chain: LinkChain, trajectory: Trajectory, piece: Indices, t: Array) -> tuple[Array, Array]:
    """The square of the speed and its slope at local times, (n,) each."""
    state = [_derivative(trajectory, piece, t, order) for order in range(3)]
    _, velocity, acceleration = tool_motion(chain, *state)
    return (velocity**2).sum(axis=0), 2.0 * (velocity * acceleration).sum(axis=0)


def _squares(
    chain: LinkChain, trajectory: Trajectory, piece: Indices, start: Array, width: Array
) -> tuple[Array, Array]:
    """The same at both ends of each part, (2, n) each."""
    found = [_square(chain, trajectory, piece, t) for t in (start, start + width)]
    return np.stack([f for f, _ in found]), np.stack([slope for _, slope in found])


def _cubic_maximum(ends: Array, slopes: Array) -> tuple[Array, Array]:
    """Maximum on [0, 1] of the cubic with these values and slopes at the ends, and where it is, (n,) each."""
    (f0, f1), (m0, m1) = ends, slopes
    B, C = 3.0 * (f1 - f0) - 2.0 * m0 - m1, m0 + m1 - 2.0 * (f1 - f0)
    best, where = np.maximum(f0, f1), np.where(f0 >= f1, 0.0, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        q = -(B + np.where(B >= 0.0, 1.0, -1.0) * np.sqrt(np.maximum(B * B - 3.0 * C * m0, 0.0)))
        for root in (q / (3.0 * C), m0 / q):
            u = np.where((root > 0.0) & (root < 1.0), root, 0.0)
            value = f0 + u * (m0 + u * (B + u * C))
            where, best = np.where(value > best, u, where), np.maximum(best, value)
    return best, where


def _fourth(
    chain: LinkChain, trajectory: Trajectory, piece: Indices, start: Array, width: Array
) -> Array:
    """Upper bound on the fourth derivative of the square of the speed on each part, (n,)."""
    half = 0.5 * width
    orders = range(max(trajectory.coefficients.shape[2], ORDERS + 1))
    at_middle = [np.abs(_derivative(trajectory, piece, start + half, k)) for k in orders]
    bounds = []
    for order in range(ORDERS + 1):
        value, power = np.zeros_like(at_middle[0]), np.ones_like(half)
        for step, derivative in enumerate(at_middle[order:]):
            value += derivative * power[:, None]
            power = power * half / (step + 1)
        bounds.append(value)
    b = derivative_bounds(chain, bounds[0], np.stack(bounds[1:]))
    return np.asarray(2.0 * (b[1] * b[5] + 4.0 * b[2] * b[4] + 3.0 * b[3] ** 2))
