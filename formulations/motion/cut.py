"""A motion cut at given times: the same motion, whose pieces also meet there."""

from __future__ import annotations

from math import comb

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array

_ROUNDING = 1e-12  # of the whole time: nearer to a break, no piece is cut


def cut_at(trajectory: Trajectory, times: Array) -> Trajectory:
    """Cut the pieces of a motion at given times, exactly up to rounding.

    Parameters
    ----------
    trajectory : Trajectory
    times : Array, shape (n,) [s]
        Those within rounding of a break, or outside the motion, are left out.

    Returns
    -------
    Trajectory
        With the same passage times.
    """
    breaks = trajectory.breaks
    inside = np.unique(times[(times > 0.0) & (times < trajectory.seconds)])
    nearest = np.abs(inside[:, None] - breaks[None]).min(axis=1, initial=np.inf)
    inside = inside[nearest > _ROUNDING * trajectory.seconds]
    if not len(inside):
        return trajectory
    starts = np.sort(np.concatenate([breaks[:-1], inside]))
    piece = np.searchsorted(breaks, starts, side="right") - 1
    off = starts - breaks[piece]
    c = trajectory.coefficients[piece]
    shifted = np.zeros_like(c)
    for k in range(c.shape[2]):
        for m in range(k, c.shape[2]):
            shifted[..., k] += comb(m, k) * c[..., m] * off[:, None] ** (m - k)
    durations = np.diff(np.append(starts, trajectory.seconds))
    return Trajectory(durations, shifted, trajectory.passage_times)


def range_between(trajectory: Trajectory, start: float, end: float) -> tuple[Array, Array]:
    """Find the exact range of positions between two times.

    Parameters
    ----------
    trajectory : Trajectory
    start, end : float [s]

    Returns
    -------
    low, high : Array, shape (dof,) [rad]
    """
    found = cut_at(trajectory, np.array([start, end]))
    middles = found.breaks[:-1] + 0.5 * found.durations
    mine = (middles > start) & (middles < end)
    ends = trajectory.at(np.clip([start, end], 0.0, trajectory.seconds))
    extremes = found.extremes(0)
    return (
        np.vstack([ends, extremes.low[mine]]).min(axis=0),
        np.vstack([ends, extremes.high[mine]]).max(axis=0),
    )
