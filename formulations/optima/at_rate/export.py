"""Write a motion to a file whose points, joined as a controller joins them, keep every limit.

The file is judged, not the motion it comes from: its bytes are read back, its points are joined by quintics,
and ``check`` judges that motion by its exact extremes. Only then does the file get its name.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from formulations.motion.files.formats import format_to_write
from formulations.motion.files.motion_file import points_of
from formulations.motion.judged_file import JudgedFile
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict
from formulations.optima.at_rate.motion import at_rate
from formulations.optima.at_rate.requests import check_request, require_exportable, require_kept
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError, NoFeasibleMotion
from formulations.problem.problem import Problem

_FINER = (2, 4, 8, 16, 32)  # times the rate, where points are too coarse


@dataclass(frozen=True)
class Export:
    """A file that was written, and what its points make of the motion.

    Attributes
    ----------
    path : str
        The file.
    seconds : float [s]
        Time of the motion that the file holds.
    given_seconds : float [s]
        Time of the motion that was to be written.
    n_points : int
        Points of the file; for exact pieces, where they meet.
    rate : float or None [1/s]
        Points per second, if they are even.
    motion : Trajectory
        What a controller makes of the file.
    verdict : Verdict
        About this motion.
    price : str
        What the file takes longer for than the motion that was given.
    notes : tuple of str
        What else is to be said, a line each.
    """

    path: str
    seconds: float
    given_seconds: float
    n_points: int
    rate: float | None
    motion: Trajectory
    verdict: Verdict
    price: str = ""
    notes: tuple[str, ...] = ()

    @property
    def cost(self) -> float:
        """Seconds that the file takes longer than the motion that was given."""
        return self.seconds - self.given_seconds

    def lines(self) -> list[str]:
        """Say what was written, what it uses of the limits, and what the points cost.

        Returns
        -------
        list of str
            Two lines, one for the price if there is one, and the notes.
        """
        at = "" if self.rate is None else f" at {self.rate:g} per second"
        used = {
            peak.quantity: peak.factor for peak in self.verdict.peaks if peak.quantity != "position"
        }
        factors = ", ".join(f"{name} {used[name]:.9g}" for name in sorted(used, key=_ORDER.index))
        joined = "" if format_to_write(self.path) is None else " and joined as a controller does"
        lines = [
            f"{self.path}: written, {self.n_points} points{at}, {self.seconds:.9g} s",
            f"  the file, read back{joined}, keeps every limit; used of them: {factors}",
        ]
        if self.cost > 0.0:
            share = 100.0 * self.cost / self.given_seconds
            lines.append(
                f"  {self.cost:.4g} s ({share:.3g} %) longer than the motion found: {self.price}"
            )
        return [*lines, *(f"  {note}" for note in self.notes)]


_ORDER = ("velocity", "acceleration", "jerk", "tool speed", "torque")


def check_export(
    path: str | Path, problem: Problem, rate: float | None, conditions: Conditions | None = None
) -> None:
    """Refuse an export before its motion is computed.

    Parameters
    ----------
    path : str or Path
        The file.
    problem : Problem
        Waypoints and limits.
    rate : float or None [1/s]
        Points per second.
    conditions : Conditions, optional
        What else is asked of the motion.

    Raises
    ------
    InputError
        No format has this suffix, or the rate or the limits cannot make a file.
    """
    check_request(problem, rate, conditions)
    if format_to_write(path) is not None or rate is not None:
        require_kept(problem.conditions if conditions is None else conditions)


def export_motion(
    path: str | Path,
    problem: Problem,
    trajectory: Trajectory,
    rate: float | None = None,
    *,
    conditions: Conditions | None = None,
    names: tuple[str, ...] | None = None,
) -> Export:
    """Write a motion so that the file itself keeps every limit; read it back and judge it first.

    Parameters
    ----------
    path : str or Path
        Ends in .csv, .json or .yaml (a ROS JointTrajectory), .npz, or .pieces.json (exact polynomials).
    problem : Problem
        Waypoints and limits that the file keeps.
    trajectory : Trajectory
        A motion that keeps them.
    rate : float, optional
        Points per second [1/s]. Left out: points where the jerk switches; exact pieces are written as
        they are.
    conditions : Conditions, optional
        What else was asked of the motion.
    names : tuple of str, optional
        Names of the joints; left out, those of the problem if it has some.

    Returns
    -------
    Export
        What was written and how it was judged.

    Raises
    ------
    InputError
        As ``write_motion`` and ``at_rate``.
    NoFeasibleMotion
        The points are too coarse; the message says at which rate they keep the limits, and nothing is
        written.
    """
    names = problem.names if names is None else tuple(names)
    exact = format_to_write(path) is None
    if exact and rate is None:
        require_exportable(problem, trajectory.seconds, None)
        motion, times, margin = trajectory, trajectory.breaks, 0.0
    else:
        try:
            found = at_rate(problem, trajectory, rate, conditions=conditions)
        except NoFeasibleMotion as reason:
            raise NoFeasibleMotion(
                f"{path}: not written: {reason}{_finer(problem, trajectory, rate, conditions)}"
            ) from None
        motion, times, margin = found.trajectory, found.times, found.margin
    content = motion if exact else points_of(motion, times, names)
    file = JudgedFile.of(
        path, problem, content, motion.passage_times, names=names, conditions=conditions
    )
    file.write()
    return Export(
        path=str(path),
        seconds=file.verdict.seconds,
        given_seconds=trajectory.seconds,
        n_points=len(times),
        rate=rate,
        motion=file.motion,
        verdict=file.verdict,
        price=_price(trajectory, file.verdict.seconds, rate, margin),
    )


def _price(trajectory: Trajectory, seconds: float, rate: float | None, margin: float) -> str:
    """What the points cost: whole periods, and switches at points."""
    parts, rounding_up = [], 0.0
    if rate is not None:
        periods = np.diff(trajectory.passage_times) * rate
        rounding_up = float((np.ceil(periods - 1e-6) - periods).sum() / rate)
        parts.append(f"{rounding_up:.4g} s to round segments up to whole periods")
    rest = max(seconds - trajectory.seconds - rounding_up, 0.0)
    parts.append(
        f"{rest if rest > 1e-12 else 0.0:.4g} s to switch at points, with a margin of "
        f"{margin:.2g} of the limits for rounding"
    )
    return "; ".join(parts)


def _finer(
    problem: Problem, trajectory: Trajectory, rate: float | None, conditions: Conditions | None
) -> str:
    """The least multiple of a rate, of those tried, whose points keep the limits: the end of a message."""
    if rate is None:
        return ""
    for times in _FINER:
        try:
            at_rate(problem, trajectory, rate * times, conditions=conditions)
        except (InputError, NoFeasibleMotion):
            continue
        return f"; at {rate * times:g} points per second they keep every limit"
    return ""
