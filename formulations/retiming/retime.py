"""A path timed in three ways, side by side, each judged by the same judge."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.judgement import Judgement, judge
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.problem import Limits, Problem
from formulations.retiming.free import FreeRetiming, by_free_form
from formulations.retiming.on_path import by_copp, by_toppra
from formulations.retiming.path import Path

WAYS = {
    "given": "the motion with the times that it came with",
    "toppra": "TOPP-RA on the path (knows no jerk limit)",
    "copp": "COPP on the path (jerk limits too)",
    "free_form": "the fastest motion through some of its points",
}


@dataclass(frozen=True)
class Retimed:
    """One way of timing a path, judged.

    Attributes
    ----------
    key : str
        In ``WAYS``.
    problem : Problem or None
        What it was judged by: the limits, and the points of the path that it has to pass.
    judgement : Judgement or None
        What the judge says of the motion as it came out; None where there is no motion.
    kept : Trajectory or None
        The motion, stretched where it has to be, that keeps every limit; None where no stretch does it.
    deviation : float or None [rad]
        Largest distance in joint space from the polyline of the points.
    reason : str
        Why there is no motion.
    """

    key: str
    problem: Problem | None = None
    judgement: Judgement | None = None
    kept: Trajectory | None = None
    deviation: float | None = None
    reason: str = ""


def retime(
    motion: MotionPoints | Trajectory | Array,
    limits: Limits,
    *,
    tolerance: float = 1e-2,
    progress: Callable[[str], None] | None = None,
) -> list[Retimed]:
    """Time a path in three ways: on the path by TOPP-RA and by COPP, and freely near it.

    Parameters
    ----------
    motion : MotionPoints, Trajectory, or Array of shape (n_points, dof) [rad]
        A motion from elsewhere, or the dense points of a path.
    limits : Limits
    tolerance : float, default 1e-2 [rad]
        How far the free motion may leave the polyline of the points, in joint space.
    progress : callable, optional
        Called with one line before each stage.

    Returns
    -------
    list of Retimed
        In the order of ``WAYS``; "given" is there if the motion came with times.

    Raises
    ------
    InputError
        If no joint moves, a point lies outside the position limits, or the limits are of other joints.

    Examples
    --------
    >>> import numpy as np
    >>> from formulations import Limits
    >>> u = np.linspace(0.0, 1.0, 50)[:, None]
    >>> limits = Limits.of(velocity=1.0, acceleration=2.0, jerk=10.0, dof=2)
    >>> found = {way.key: way for way in retime(np.hstack([np.sin(u), u**2]), limits)}
    >>> found["free_form"].judgement.feasible
    True
    >>> found["free_form"].kept.seconds < found["copp"].kept.seconds < found["toppra"].kept.seconds
    True
    """
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise InputError(f"tolerance: {tolerance:g} rad is not a positive distance")
    path = Path.of(motion)
    Problem.of(path.points, limits, names=path.names)  # refuses points outside the position limits
    ends = Problem.of(path.points[[0, -1]], limits, name="path", names=path.names)
    say = progress or (lambda stage: None)
    ways = []
    if not isinstance(motion, np.ndarray):
        given = motion.motion() if isinstance(motion, MotionPoints) else motion
        ways.append(_judged("given", path, ends, given))
    say("TOPP-RA on the path")
    ways.append(_judged("toppra", path, ends, by_toppra(path, limits)))
    say("COPP on the path")
    ways.append(_judged("copp", path, ends, by_copp(path, limits)))
    free = by_free_form(path, limits, tolerance, progress=progress)
    if isinstance(free, FreeRetiming):
        way = _judged("free_form", path, free.problem, free.motion)
        ways.append(replace(way, deviation=free.deviation))
    else:
        ways.append(Retimed("free_form", reason=free))
    return ways


def _judged(key: str, path: Path, problem: Problem, motion: Trajectory | str) -> Retimed:
    """Judge a motion, and stretch it until it keeps every limit."""
    if isinstance(motion, str):
        return Retimed(key, reason=motion)
    judged = judge(problem, motion)
    kept = None
    if judged.feasible:
        kept = judged.motion
    elif np.isfinite(judged.stretch):
        kept = judged.motion.stretched(judged.stretch)
        kept = kept if judge(problem, kept).feasible else None
    return Retimed(key, problem, judged, kept, path.farthest(judged.motion)[1])
