"""justblend: straight lines in joint space, from stop to stop or with blended corners, in closed form.

Its profiles are pieces of constant jerk, or of constant acceleration where there is no jerk limit. When these
begin is not told, so it is read off finely sampled values; the pieces between are then exact. Its blends
are quartics. They stay within the zones of the waypoints.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.rivals.pieces import shifted
from compare.rivals.rival import RivalAnswer, moving_waypoints
from formulations import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

_SAMPLES = 4001  # of a straight line, to find where its profile switches
_SHARES = (0.2, 0.4, 0.6, 0.8, 1.0)  # of the largest blends that are tried
_ROUNDING = 1e-9  # by which a blend stays below its zone


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
    """Blend the corners within the zones of the waypoints, so far as it is fastest.

    Parameters
    ----------
    problem : Problem
        With zones; it stops at a waypoint that has none.
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
    kind = (
        justblend.SCurveTrajectoryGenerator
        if limits.has_jerk
        else justblend.TrapezoidalTrajectoryGenerator
    )
    generator = kind(problem.dof)
    jerk = limits.jerk if limits.has_jerk else None
    generator.set_limits(justblend.Limits(limits.velocity, limits.acceleration, jerk))
    corners = justblend.CornerHandling
    generator.set_options(justblend.GenerationOptions(corner_handling=corners.STRICT_CORNERS))
    found, note = generator.generate(points), ""
    if blends and len(points) > 2:
        largest = _largest_radii(generator, problem, points)
        for share in _SHARES:  # a wider blend can be slower, as its arc is longer
            radii = share * largest
            generator.set_options(
                justblend.GenerationOptions(blend_radii=radii, corner_handling=corners.HYBRID)
            )
            tried = generator.generate(points)
            if tried.duration() < found.duration():
                found = tried
                note = f"blend radii {radii.min():.3g} to {radii.max():.3g} rad"
    return RivalAnswer(_pieces(found, limits.has_jerk), float(found.duration()), note=note)


def _largest_radii(generator: Any, problem: Problem, points: Array) -> Array:
    """Blend radii at the inner waypoints that use up their zones, but at most half of a leg [rad].

    The distance of a blend's middle from its waypoint is proportional to the radius.
    """
    import justblend

    moves = (problem.displacements != 0.0).any(axis=1)
    boxes = problem.conditions.boxes(problem.dof)
    zones = [boxes.get(int(k), np.zeros(problem.dof)) for k in np.flatnonzero([True, *moves])][1:-1]
    legs = np.linalg.norm(np.diff(points, axis=0), axis=1)
    most = 0.5 * np.minimum(legs[:-1], legs[1:])
    first = 0.5 * most
    options = justblend.GenerationOptions(
        blend_radii=first, corner_handling=justblend.CornerHandling.HYBRID
    )
    generator.set_options(options)
    found = generator.generate(points)
    away = np.zeros_like(points[1:-1])
    blended = [k for k, one in enumerate(found.corner_types()) if one == justblend.CornerType.BLEND]
    starts = found.segment_start_times()
    middles = [
        0.5 * (start + end)
        for segment, start, end in zip(found.segments(), starts[:-1], starts[1:], strict=True)
        if segment.type == justblend.SegmentType.BLEND
    ]
    for k, middle in zip(blended, middles, strict=True):
        away[k - 1] = np.abs(found.samples(np.array([middle])).q[0] - points[k])
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.nanmin(np.where(away > 0.0, np.array(zones) / away, np.inf), axis=1)
    radii: Array = np.minimum(first * scale * (1.0 - _ROUNDING), most)
    return radii


def _pieces(found: Any, has_jerk: bool) -> Trajectory:
    """Exact pieces, of degree 4 at most: each is determined by three accelerations, and by position and
    velocity at its middle.
    """
    import justblend

    times = _switches(found, justblend.SegmentType.LINEAR, has_jerk)
    durations, pieces = np.diff(times), []
    for start, duration in zip(times[:-1], durations, strict=True):
        at = found.samples(start + duration * np.array([0.1, 0.5, 0.9]))
        bends = np.linalg.solve(np.vander([-0.4, 0.0, 0.4], increasing=True), np.asarray(at.qdd))
        bends *= duration**2  # the acceleration over u = t / duration - 1/2, in units of it
        series = np.stack(
            [at.q[1], duration * at.qd[1], bends[0] / 2.0, bends[1] / 6.0, bends[2] / 12.0]
        )
        in_time = [shifted(joint, -0.5) / duration ** np.arange(5) for joint in series.T]
        pieces.append(in_time)
    return Trajectory(durations, np.array(pieces))


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
