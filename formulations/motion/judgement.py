"""A motion from elsewhere, judged: every limit that it breaks, where, and what would mend it.

``check`` says whether a motion is good. This says all that is wrong with it, joint by joint, and reads it as
a controller runs it: points are joined by the pieces that the controller makes of them, the waypoints are
searched for, and every value is an exact extreme in continuous time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.motion.files.motion_points import MotionPoints, order_of_joints
from formulations.motion.passages import Balls, passages
from formulations.motion.peaks import QUANTITIES, Peak, peaks_of_joints
from formulations.motion.smoothness import TOLERANCE, Jump, jumps, motion_at
from formulations.motion.tool_check import tool_peaks
from formulations.motion.trajectory import Trajectory
from formulations.motion.unkept import TIME_TOLERANCE, from_arrival, moving_at, unkept
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem

WAYPOINT_TOLERANCE = 1e-4  # rad (or m) by which a waypoint may be missed: files and tables are rounded
_MOST = 1e-6  # relative excess that counts as rounding, however short the pieces are
_STEPS = 400  # roundings of a position between the points of a file and a derivative of its pieces
_DEGREES = {2: "linear", 4: "cubic", 6: "quintic"}


@dataclass(frozen=True)
class Miss:
    """A waypoint that a motion does not pass.

    Attributes
    ----------
    waypoint, joint : int
        From 0; the joint that is farthest off.
    distance : float
        Position less waypoint of this joint [rad].
    time : float
        When the motion is nearest, or when it should be there [s].
    """

    waypoint: int
    joint: int
    distance: float
    time: float


@dataclass(frozen=True)
class Judgement:
    """All that was found about one motion.

    Attributes
    ----------
    motion : Trajectory
        The motion as it was judged; its passages are those that were found.
    interpolation : str
        "linear", "cubic" or "quintic": how its points were joined; "pieces" where it was no points.
    names : tuple of str
        Names of the joints; empty where none are known.
    tolerance : float
        By how much a waypoint may be missed in each joint [rad].
    peaks : tuple of Peak
        Where each joint uses most of each limited quantity; worst first.
    violations : tuple of Peak
        Those of them that are over the limit; worst first.
    jumps : tuple of Jump
        Where pieces do not fit together: the largest of each quantity and joint.
    not_at_rest : tuple of Jump
        What moves at the start, the end or a stop; where velocities are asked for at the ends, what
        differs from them.
    missed : tuple of Miss
        Waypoints that are not passed, in their order; at the time asked for, where there is one.
    unkept : tuple of str
        What else was asked for and is not kept, a line each: windows, times of segments, waits, cycles,
        balls of the tool.
    conditions : Conditions
        What was asked for beyond the problem.
    """

    motion: Trajectory
    interpolation: str
    names: tuple[str, ...]
    tolerance: float
    peaks: tuple[Peak, ...]
    violations: tuple[Peak, ...]
    jumps: tuple[Jump, ...]
    not_at_rest: tuple[Jump, ...]
    missed: tuple[Miss, ...]
    unkept: tuple[str, ...]
    conditions: Conditions

    @property
    def seconds(self) -> float:
        """Total time [s]."""
        return self.motion.seconds

    @property
    def feasible(self) -> bool:
        """Whether nothing is wrong."""
        faults = (self.violations, self.jumps, self.not_at_rest, self.missed, self.unkept)
        return not any(faults) and self.missed_total is None

    @property
    def missed_total(self) -> float | None:
        """The total time asked for, where the motion takes another one [s]."""
        last = len(self.motion.passage_times) - 1
        asked = self.conditions.passage.get(last, self.conditions.total)
        return None if asked is None or abs(self.seconds - asked) <= TIME_TOLERANCE else asked

    @property
    def is_paced(self) -> bool:
        """Whether times or states at the ends are asked for, so that no uniform stretch is allowed."""
        asked = self.conditions
        ends = (
            asked.start_velocity,
            asked.end_velocity,
            asked.start_acceleration,
            asked.end_acceleration,
        )
        times = (asked.passage, asked.windows, asked.segment_times, asked.waits)
        return (
            any(times)
            or asked.total is not None
            or any(np.any(v) for v in ends if v is not None and not isinstance(v, str))
        )

    @property
    def stretch_for_limits(self) -> float:
        """Least factor on all durations that keeps velocity, acceleration and jerk limits.

        Below 1, the same motion could be that much faster. Jumps are not looked at.
        """
        return max((peak.stretch for peak in self.peaks if peak.quantity != "position"), default=0.0)

    @property
    def is_mended_by_stretch(self) -> bool:
        """Whether a uniform stretch mends all that is wrong."""
        positions = any(peak.quantity == "position" for peak in self.violations)
        faults = (self.jumps, self.not_at_rest, self.missed, self.unkept)
        return not (positions or any(faults) or self.is_paced)

    @property
    def stretch(self) -> float:
        """Least factor on all durations that makes the motion feasible; infinite where none does."""
        if self.is_paced and self.feasible:
            return 1.0
        return self.stretch_for_limits if self.is_mended_by_stretch else np.inf


def judge(
    problem: Problem,
    motion: MotionPoints | Trajectory,
    *,
    interpolation: str = "auto",
    tolerance: float = WAYPOINT_TOLERANCE,
    conditions: Conditions | None = None,
) -> Judgement:
    """Judge a motion from elsewhere in continuous time, joint by joint.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    motion : MotionPoints or Trajectory
        Points as they stand in a file, or exact pieces.
    interpolation : {"auto", "linear", "cubic", "quintic"}
        How the controller joins points; ``auto`` takes the highest degree that the points allow.
    tolerance : float, default 1e-4
        By how much a waypoint may be missed in each joint [rad], and a ball of the tool [m].
    conditions : Conditions, optional
        What is asked for; the conditions of the problem if left out. A waypoint with a passage time has to
        be within the tolerance at that time, one with a window at some time within it. The whole motion,
        segments and waits may differ from the times asked for by 1e-5 s. At a stop, less than a thousandth
        of the velocity and acceleration limits counts as standing still.

    Returns
    -------
    Judgement

    Raises
    ------
    InputError
        The conditions do not fit the problem, the number or the names of the joints do not fit, or the
        points do not allow the interpolation.

    See Also
    --------
    formulations.motion.verdict.check : the check of motions whose passages are known.

    Notes
    -----
    A limit counts as kept up to a relative excess of 1e-9. Pieces of a millisecond multiply the rounding
    of their points by 1e9 in the jerk; where this is more, the rounding of double numbers is allowed, but
    never more than 1e-6.

    Examples
    --------
    A joint that is to move 1 rad from rest to rest, sampled by a planner at three points:

    >>> import numpy as np
    >>> from formulations import Limits, Problem
    >>> from formulations.motion.files.motion_points import MotionPoints
    >>> problem = Problem.of([[0.0], [1.0]], Limits.of(velocity=1.5, acceleration=8.0, dof=1))
    >>> points = MotionPoints(np.array([0.0, 0.5, 1.0]), np.array([[0.0], [0.5], [1.0]]),
    ...                       np.array([[0.0], [2.0], [0.0]]))
    >>> found = judge(problem, points)
    >>> found.interpolation, found.feasible, [str(peak) for peak in found.violations][:1]
    ('cubic', False, ['velocity of joint 1 in segment 1 at 0.5000 s: 2 rad/s, limit 1.5 rad/s, factor 1.33333'])
    >>> round(found.stretch, 6)
    1.333333
    """
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise InputError(f"tolerance: {tolerance:g} is not a positive distance")
    demands = Demands.of(problem, conditions)
    asked = demands.conditions
    wanted = problem.names
    names, method = wanted, "pieces"
    if isinstance(motion, MotionPoints):
        points = in_order_of(wanted, motion)
        names = names or points.names
        trajectory = points.motion(interpolation)
        method = _DEGREES[trajectory.coefficients.shape[2]]
    elif interpolation != "auto":
        raise InputError(f"interpolation: {interpolation!r}: exact pieces are not joined; leave it out")
    else:
        trajectory = motion
    if trajectory.dof != problem.dof:
        raise InputError(f"motion: {trajectory.dof} joints, the problem has {problem.dof}")
    windows = {
        k: (float(early), float(late))
        for k, (early, late) in enumerate(demands.passages)
        if early > 0.0 or np.isfinite(late)
    }
    balls = None
    if problem.tool is not None and np.isfinite(demands.tool_radius).any():
        balls = Balls(problem.tool, problem.waypoints, demands.tool_radius)
    passed = passages(trajectory, problem.waypoints, windows, demands.waypoints, balls)
    trajectory = Trajectory(trajectory.durations, trajectory.coefficients, passed.times)
    trajectory = from_arrival(demands, trajectory, tolerance)
    peaks = sorted(
        [*peaks_of_joints(demands, trajectory), *tool_peaks(demands, trajectory)],
        key=lambda peak: (peak.factor > 1.0, peak.urgency),
        reverse=True,
    )
    limits = asked.derivatives(problem).max(axis=1)
    over = [TOLERANCE * np.ones(problem.dof)]
    over += [_rounding(trajectory, order, limits[order - 1]) for order in (1, 2, 3)]
    sizes = [np.ptp(problem.waypoints, axis=0), *limits[:2]]
    smooth = [
        _rounding(trajectory, order, _size(trajectory, order, sizes[order])) for order in range(3)
    ]
    ends = np.array([0.0, trajectory.seconds])
    states = np.stack([demands.end_velocity, demands.end_acceleration])
    moving = motion_at(problem, trajectory, ends, states, smooth)
    for stop in sorted((asked.stops | set(asked.waits)) - {0, problem.n_segments}):
        moving += moving_at(demands, trajectory, stop, tolerance)
    return Judgement(
        motion=trajectory,
        interpolation=method,
        names=names,
        tolerance=tolerance,
        peaks=tuple(peaks),
        violations=tuple(peak for peak in peaks if peak.factor > 1.0 + _allowed(over, peak)),
        jumps=tuple(jumps(problem, trajectory, smooth)),
        not_at_rest=tuple(moving),
        missed=tuple(_missed(passed.misses, passed.times, tolerance)),
        unkept=tuple(unkept(demands, trajectory, tolerance, smooth)),
        conditions=asked,
    )


def _allowed(over: list[Array], peak: Peak) -> float:
    """Relative excess of a peak that is rounding; over: that of position to jerk, (4, dof)."""
    if peak.quantity not in QUANTITIES:
        return TOLERANCE
    return float(over[QUANTITIES.index(peak.quantity)][peak.joint])


def in_order_of(names: tuple[str, ...], points: MotionPoints) -> MotionPoints:
    """Put the joints of points in the order of a problem's, where both have names.

    Parameters
    ----------
    names : tuple of str
        The joints of the problem; empty where they have no names.
    points : MotionPoints

    Returns
    -------
    MotionPoints

    Raises
    ------
    InputError
        They have other names.
    """
    return points if order_of_joints(names, points.names) is None else points.in_order(names)


def _missed(misses: Array, times: Array, tolerance: float) -> list[Miss]:
    """Waypoints among the misses (n_waypoints, dof) that are farther off than the tolerance."""
    found = []
    for waypoint, row in enumerate(misses):
        joint = int(np.abs(row).argmax())
        if abs(row[joint]) > tolerance:
            found.append(Miss(waypoint, joint, float(row[joint]), float(times[waypoint])))
    return found


def _size(trajectory: Trajectory, order: int, scale: Array) -> Array:
    """Size of a derivative per joint: its scale where that is finite, or what the motion reaches, (dof,)."""
    return np.maximum(np.where(np.isfinite(scale), scale, 0.0), trajectory.reach(order))


def _rounding(trajectory: Trajectory, order: int, size: Array) -> Array:
    """Relative excess of a derivative that is rounding, per joint: between 1e-9 and 1e-6, (dof,)."""
    reach = trajectory.reach(0)
    short = float(trajectory.durations.min())
    with np.errstate(divide="ignore", over="ignore"):
        share = _STEPS * np.finfo(np.float64).eps * reach / (short**order * np.maximum(size, 1e-300))
    return np.asarray(np.clip(share, TOLERANCE, _MOST))
