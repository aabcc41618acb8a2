"""Write a retimed path to a file whose points, joined as a controller joins them, keep every limit.

The free motion switches its jerk at the points of the file (``export_motion``). A motion on the path cannot,
because the path says where it bends. It is sampled, what a controller makes of the samples is judged, and the
motion is stretched until that keeps every limit.
"""

from __future__ import annotations

from pathlib import Path as File

import numpy as np

from formulations.motion.files.formats import format_to_write
from formulations.motion.files.motion_file import points_of
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.judged_file import JudgedFile
from formulations.motion.peaks import Peak
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import check
from formulations.optima.at_rate.export import Export, export_motion
from formulations.optima.at_rate.requests import require_exportable
from formulations.problem.errors import InputError, NoFeasibleMotion
from formulations.problem.problem import Problem
from formulations.retiming.retime import Retimed

_ROUNDS = 12  # of stretching: each stretch moves the points along the path
_FINER = (2, 4, 8, 16)  # times the rate, where points are too coarse
_ENOUGH = 1.001  # a rate that needs no more stretch than this is worth naming
_NOTED = 1e-5  # relative excess from which a broken limit is no rounding


def export_retimed(path: str | File, way: Retimed, rate: float | None = None) -> Export:
    """Write a motion of ``retime`` so that the file itself keeps every limit.

    Parameters
    ----------
    path : str or Path
        As in ``export_motion``.
    way : Retimed
        A way of timing the path that keeps every limit, stretched where it had to be.
    rate : float, optional
        Points per second [1/s]. Left out: points where the pieces of the motion meet.

    Returns
    -------
    Export
        What was written and how it was judged. Its notes say which limit a motion on the path would break
        between the points, and the stretch and the rate that mend it.

    Raises
    ------
    InputError
        As ``export_motion``.
    NoFeasibleMotion
        The way keeps no limits, or no stretch makes its file keep them; nothing is written.
    """
    if way.kept is None or way.problem is None:
        raise NoFeasibleMotion(f"{path}: not written: no motion of {way.key} keeps every limit")
    if way.key == "free_form":
        return export_motion(path, way.problem, way.kept, rate)
    return _export_on_path(path, way.problem, way.kept, rate)


def _export_on_path(
    path: str | File, problem: Problem, motion: Trajectory, rate: float | None
) -> Export:
    require_exportable(problem, motion.seconds, rate)
    exact = format_to_write(path) is None
    factor, broken = 1.0, None
    for k in range(_ROUNDS):
        points = _points(problem, motion.stretched(factor), rate)
        ends = points.times[[0, -1]]
        content = points.motion(passages=ends) if exact else points
        file = JudgedFile.of(path, problem, content, ends, names=problem.names)
        broken = broken or _over(file.verdict.peaks)
        if file.verdict.feasible or file.verdict.stretch <= 1.0:
            break
        # a little more each time: the rounding of the numbers is another one each time
        factor *= file.verdict.stretch * (1.0 + 1e-8 * 4.0**k)
    if not file.verdict.feasible and rate is not None:
        raise NoFeasibleMotion(
            f"{path}: not written: its points, joined as a controller does, fail: "
            f"{file.verdict.faults[0]}{_finer(problem, motion, rate)}"
        )
    file.write()
    notes: tuple[str, ...] = ()
    if broken is not None:
        finer = "" if rate is None else _finer(problem, motion, rate)
        notes = (
            f"unstretched, a controller would break between its points: {broken}; a stretch of "
            f"{factor:.6g} mends it{finer}",
        )
    return Export(
        path=str(path),
        seconds=file.verdict.seconds,
        given_seconds=motion.seconds,
        n_points=len(points.times),
        rate=rate,
        motion=file.motion,
        verdict=file.verdict,
        price=f"stretched by {file.verdict.seconds / motion.seconds:.9g}, whole periods included",
        notes=notes,
    )


def _points(problem: Problem, motion: Trajectory, rate: float | None) -> MotionPoints:
    """Sample a motion at whole nanoseconds; at a rate it is slowed down to a whole number of periods."""
    if rate is None:
        stamps = np.unique(np.rint(motion.breaks * 1e9))
    else:
        periods = int(np.ceil(motion.seconds * rate - 1e-6))
        stamps = np.rint(np.arange(periods + 1) * (1e9 / rate))
    times = stamps / 1e9
    return points_of(motion.stretched(float(times[-1]) / motion.seconds), times, problem.names)


def _over(peaks: tuple[Peak, ...]) -> Peak | None:
    """The worst broken limit, if it is broken by more than rounding."""
    worst = max(peaks, key=lambda peak: peak.factor, default=None)
    return worst if worst is not None and worst.factor > 1.0 + _NOTED else None


def _finer(problem: Problem, motion: Trajectory, rate: float) -> str:
    """The least multiple of a rate, of those tried, that needs hardly any stretch: the end of a message."""
    for times in _FINER:
        try:
            require_exportable(problem, motion.seconds, rate * times)
        except InputError:
            break
        points = _points(problem, motion, rate * times)
        verdict = check(problem, points.motion(passages=points.times[[0, -1]]))
        if verdict.stretch <= _ENOUGH and verdict.position_kept:
            needed = (
                f"one of {verdict.stretch:.6g} is enough" if verdict.stretch > 1.0 else "none is needed"
            )
            return f"; at {rate * times:g} points per second {needed}"
    return ""
