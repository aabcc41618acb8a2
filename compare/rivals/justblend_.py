"""justblend: straight lines in joint space, from stop to stop or with blended corners, in closed form.

Its profiles are pieces of constant jerk, or of constant acceleration where there is no jerk limit. When these
begin is not told, so it is read off finely sampled values; the pieces between are then exact. Its blends
are quartics.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.rivals.rival import RivalAnswer, moving_waypoints
from formulations.motion.interpolation import joined
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

_SAMPLES = 4001  # of a straight line, to find where its profile switches
_CUT = 0.2  # of the shorter leg at a corner


def justblend_stops(problem: Problem, seconds: float) -> RivalAnswer:
    """Stop at each waypoint.

    Parameters
    ----------
    problem : Problem
    seconds : float
        Not used: it takes microseconds.

    Returns
    -------
    RivalAnswer
    """
    return _generated(problem, blends=False)


def justblend_blends(problem: Problem, seconds: float) -> RivalAnswer:
    """Blend the corners: the motion does not pass the inner waypoints.

    Parameters
    ----------
    problem : Problem
    seconds : float
        Not used: it takes microseconds.

    Returns
    -------
    RivalAnswer
    """
    return _generated(problem, blends=True)


def _generated(problem: Problem, *, blends: bool) -> RivalAnswer:
    import justblend

    limits, points = problem.limits, moving_waypoints(problem)
    if not limits.has_acceleration:
        return RivalAnswer(None, note="needs an acceleration limit")
    corners = justblend.CornerHandling
    legs = np.linalg.norm(np.diff(points, axis=0), axis=1)
    radii = _CUT * np.minimum(legs[:-1], legs[1:])
    options = justblend.GenerationOptions(
        blend_radii=radii if blends and len(radii) else None,
        corner_handling=corners.HYBRID if blends else corners.STRICT_CORNERS,
    )
    kind = (
        justblend.SCurveTrajectoryGenerator
        if limits.has_jerk
        else justblend.TrapezoidalTrajectoryGenerator
    )
    generator = kind(problem.dof)
    jerk = limits.jerk if limits.has_jerk else None
    generator.set_limits(justblend.Limits(limits.velocity, limits.acceleration, jerk))
    generator.set_options(options)
    found = generator.generate(points)
    times = _switches(found, justblend.SegmentType.LINEAR, limits.has_jerk)
    at = found.samples(times)
    if limits.has_jerk:
        motion = joined(times, at.q, at.qd, at.qdd, interpolation="quintic")
    else:
        motion = joined(times, at.q, at.qd, interpolation="cubic")
    note = f"its own deviation {found.max_corner_deviation():.4g} rad" if blends else ""
    return RivalAnswer(motion, float(found.duration()), note=note)


def _switches(found: Any, straight: Any, has_jerk: bool) -> Array:
    """Times at which the pieces of a motion meet [s]."""
    times = [0.0]
    starts = found.segment_start_times()
    for segment, start, end in zip(found.segments(), starts[:-1], starts[1:], strict=True):
        if segment.type == straight:
            inside = np.linspace(start, end, _SAMPLES)[1:-1]
            at = found.samples(inside)
            profile = (at.qdd if has_jerk else at.qd) @ np.asarray(segment.u_dir)
            times += kinks(inside, profile).tolist()
        times.append(end)
    found_times = np.array(times)
    kept = np.append(np.diff(found_times) > 1e-9 * found_times[-1], True)
    return np.asarray(found_times[kept])


def kinks(times: Array, values: Array) -> Array:
    """Find where a continuous function that is linear piece by piece changes its slope.

    Parameters
    ----------
    times : Array, shape (n,)
        Evenly spaced.
    values : Array, shape (n,)

    Returns
    -------
    Array
        Where the lines on both sides meet.
    """
    bend = np.abs(np.diff(values, 2))
    bent = np.flatnonzero(bend > 1e-7 * max(float(np.abs(np.diff(values)).max(initial=0.0)), 1e-300))
    step, found = times[1] - times[0], []
    for run in np.split(bent, np.flatnonzero(np.diff(bent) > 1) + 1):
        if not len(run) or run[0] < 1 or run[-1] + 3 >= len(values):
            continue
        left, right = run[0], run[-1] + 2  # the last sample of one line, the first of the next
        before = (values[left] - values[left - 1]) / step
        after = (values[right + 1] - values[right]) / step
        gap = values[right] - values[left] - after * (times[right] - times[left])
        found.append(times[left] + gap / (before - after))
    return np.array(found)
