"""The independent check: whether a motion keeps what its problem asks for, by exact extremes.

It judges every number that is reported, and shares no code with the kernels that make the motions.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError
from formulations.problem.joint_words import factors, shown_unit
from formulations.problem.problem import Problem

TOLERANCE = 1e-9  # relative excess over a limit that still counts as keeping it
QUANTITIES = ("position", "velocity", "acceleration", "jerk")


@dataclass(frozen=True)
class Peak:
    """The place where a motion uses most of one kind of limit.

    Attributes
    ----------
    quantity : str
        One of ``QUANTITIES``.
    joint, segment : int
        Where it is; both count from 0.
    time : float
        When it is, from the start [s].
    value, limit : float
        What is reached and what is allowed [rad/s^k].
    factor : float
        Value over limit. For a position: 1 plus the excess over the width of the allowed range.
    stretch : float
        Factor on all durations that would just keep the limit; infinite for a position, as no stretch
        changes the path.
    name : str
        Name of the joint; empty where it has none.
    unit, angle : str
        Unit of the joint's position, "rad" or "m", and the one that angles are shown in, "rad" or "deg".
    """

    quantity: str
    joint: int
    segment: int
    time: float
    value: float
    limit: float
    factor: float
    stretch: float
    name: str = ""
    unit: str = "rad"
    angle: str = "rad"

    def __str__(self) -> str:
        unit = shown_unit(self.unit, self.angle, QUANTITIES.index(self.quantity))
        scale = float(factors([self.unit], self.angle)[0])
        return (
            f"{self.quantity} of joint {self.name or self.joint + 1} in segment {self.segment + 1} at "
            f"{self.time:.4f} s: {self.value / scale:.6g} {unit}, limit {self.limit / scale:.6g} {unit}, "
            f"factor {self.factor:.6g}"
        )


@dataclass(frozen=True)
class Verdict:
    """What the independent check found about one motion.

    Attributes
    ----------
    seconds : float
        Total time of the motion [s].
    feasible : bool
        Whether it passes the waypoints, is continuous, rests at both ends and keeps every limit.
    stretch : float
        Least factor on all durations that keeps the velocity, acceleration and jerk limits.
    peaks : tuple of Peak
        The worst place of each quantity that is limited, worst first.
    faults : tuple of str
        All that is wrong, a line each; empty if feasible.
    """

    seconds: float
    feasible: bool
    stretch: float
    peaks: tuple[Peak, ...]
    faults: tuple[str, ...]

    @property
    def worst(self) -> Peak | None:
        """The limit used most; None if nothing is limited or nothing moves."""
        return self.peaks[0] if self.peaks else None

    @property
    def position_kept(self) -> bool:
        """Whether the position limits are kept; no stretch can mend them."""
        return all(p.factor <= 1.0 for p in self.peaks if p.quantity == "position")


def check(
    problem: Problem,
    trajectory: Trajectory,
    *,
    through: bool = True,
    conditions: Conditions | None = None,
) -> Verdict:
    """Judge a motion by its exact extremes: waypoints, continuity, rest and limits.

    A limit counts as kept up to a relative excess of 1e-9 (``TOLERANCE``), which is rounding.

    Parameters
    ----------
    problem : Problem
        What the motion has to do.
    trajectory : Trajectory
        The motion, whoever made it.
    through : bool
        Whether every waypoint has to be passed; False asks for the first and the last alone.
    conditions : Conditions, optional
        What else is asked for: times, stops, velocities at the ends, limits of single segments.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        If the motion has another number of joints than the problem.

    Examples
    --------
    >>> import formulations as f
    >>> problem = f.load("sr4c")
    >>> spline = f.FAMILIES["3-5-3"].trajectory(problem, [2.0, 1.0, 2.0])
    >>> verdict = f.check(problem, spline)
    >>> verdict.feasible
    False
    >>> slower = f.check(problem, spline.stretched(verdict.stretch))
    >>> slower.feasible
    True
    """
    asked = conditions or Conditions()
    if trajectory.dof != problem.dof:
        raise InputError(f"trajectory: {trajectory.dof} joints, the problem has {problem.dof}")
    targets = problem.waypoints if through else problem.waypoints[[0, -1]]
    times = trajectory.passage_times
    known = len(times) == len(targets) and bool(((times >= 0.0) & (times <= trajectory.seconds)).all())
    faults = [
        *_waypoint_faults(problem, trajectory, targets),
        *_smoothness_faults(problem, trajectory, asked, known),
        *_time_faults(problem, trajectory, asked, known),
    ]
    peaks = sorted(
        _peaks(problem, trajectory, asked),
        key=lambda peak: peak.stretch if np.isfinite(peak.stretch) else peak.factor,
        reverse=True,
    )
    faults += [f"over the limit: {peak}" for peak in peaks if peak.factor > 1.0 + TOLERANCE]
    stretch = max((peak.stretch for peak in peaks if peak.quantity != "position"), default=0.0)
    return Verdict(trajectory.seconds, not faults, stretch, tuple(peaks), tuple(faults))


def _tolerance(problem: Problem) -> float:
    """How far a waypoint may be missed [rad]: rounding of the way, and of the positions themselves."""
    reach = float(np.ptp(problem.waypoints, axis=0).max())
    return TOLERANCE * reach + 1e-13 * float(np.abs(problem.waypoints).max())


def _waypoint_faults(problem: Problem, trajectory: Trajectory, targets: Array) -> Iterator[str]:
    """Passage times that cannot be, and waypoints (n, dof) that are missed."""
    times = trajectory.passage_times
    if len(times) != len(targets):
        yield f"{len(times)} passage times for {len(targets)} waypoints"
    elif not (
        abs(times[0]) <= TOLERANCE * trajectory.seconds
        and abs(times[-1] - trajectory.seconds) <= TOLERANCE * trajectory.seconds
        and (np.diff(times) >= 0.0).all()
    ):
        yield "passage times do not run from the start to the end of the motion"
    else:
        miss = np.abs(trajectory.at(times) - targets)
        if miss.max() > _tolerance(problem):
            row, joint = divmod(int(miss.argmax()), problem.dof)
            by = problem.amount(float(miss.max()), joint, digits=3)
            yield f"misses waypoint {row + 1}, {problem.joint_name(joint)} by {by}"


def _smoothness_faults(
    problem: Problem, trajectory: Trajectory, asked: Conditions, known: bool
) -> Iterator[str]:
    """Jumps between pieces, and motion at the ends and stops; of the acceleration where jerk is limited.

    known: whether there is a passage time for each waypoint.
    """
    limits = problem.limits
    scales = [np.full(problem.dof, _tolerance(problem)), TOLERANCE * limits.velocity]
    if limits.has_jerk:
        finite = np.where(np.isfinite(limits.acceleration), limits.acceleration, 0.0)
        scales.append(np.where(np.isfinite(limits.jerk), TOLERANCE * finite, np.inf))
    for order, scale in enumerate(scales):
        # rounding grows with the size of the motion itself; 1e-300 for joints that never move
        allowed = np.maximum(scale, TOLERANCE * _size(trajectory, order)) + 1e-300
        name = QUANTITIES[order]
        jump = trajectory.jumps[order]
        if (jump > allowed).any():
            joint = int(np.argmax(jump / allowed))
            yield f"{name} of {problem.joint_name(joint)} jumps by {jump[joint]:.3g}"
        if order == 0:
            continue
        given = asked.end_velocities(problem) * (order == 1)
        ends = np.abs(trajectory.at([0.0, trajectory.seconds], order) - given).max(axis=0)
        if (ends > allowed).any():
            joint = int(np.argmax(ends / allowed))
            off = f"off by {ends[joint]:.3g}" if given.any() else f"{ends[joint]:.3g}"
            yield f"{name} of {problem.joint_name(joint)} is {off} at an end"
        for stop in sorted(asked.stops if known else ()):
            moves = np.abs(trajectory.at(trajectory.passage_times[stop], order))
            if (moves > allowed).any():
                joint = int(np.argmax(moves / allowed))
                yield (
                    f"{name} of {problem.joint_name(joint)} is {moves[joint]:.3g} at waypoint {stop + 1}, "
                    "a stop"
                )


def _time_faults(
    problem: Problem, trajectory: Trajectory, asked: Conditions, known: bool
) -> Iterator[str]:
    """Waypoints that are passed at another time than asked for."""
    times = trajectory.passage_times
    for waypoint, time in asked.times(problem).items():
        if known and abs(times[waypoint] - time) > TOLERANCE * time:
            yield f"passes waypoint {waypoint + 1} at {times[waypoint]:.9g} s, not {time:.9g} s"


def _size(trajectory: Trajectory, order: int) -> Array:
    """Largest absolute value of a derivative per joint: the scale of its rounding errors, (dof,)."""
    extremes = trajectory.extremes(order)
    return np.asarray(np.maximum(-extremes.low, extremes.high).max(axis=0))


def _peaks(problem: Problem, trajectory: Trajectory, asked: Conditions) -> list[Peak]:
    """The worst place of every limited quantity."""
    found = []
    # each piece belongs to the segment that its middle lies in
    middles = trajectory.breaks[:-1] + 0.5 * trajectory.durations
    segments = np.searchsorted(trajectory.passage_times, middles) - 1
    segments = np.clip(segments, 0, max(len(trajectory.passage_times) - 2, 0))
    mine = np.minimum(segments, problem.n_segments - 1)  # a motion may have no inner waypoints

    def peak(order: int, piece: int, joint: int, high: bool, limit: float, factor: float) -> Peak:
        time = float((extremes.time_high if high else extremes.time_low)[piece, joint])
        value = float((extremes.high if high else extremes.low)[piece, joint])
        stretch = factor ** (1.0 / order) if order else np.inf
        name = QUANTITIES[order]
        return Peak(
            name,
            joint,
            int(segments[piece]),
            time,
            value,
            limit,
            factor,
            stretch,
            problem.names[joint] if problem.names else "",
            problem.units[joint],
            problem.display_unit,
        )

    bounds = asked.position_bounds(problem)[mine]
    if np.isfinite(bounds).any():
        extremes = trajectory.extremes(0)
        low, high = bounds[..., 0], bounds[..., 1]
        width = np.where(np.isfinite(high - low), high - low, 1.0)
        slack = problem.position_slack
        below, above = low - slack - extremes.low, extremes.high - high - slack
        for excess, is_high in ((below, False), (above, True)):
            piece, joint = divmod(int(excess.argmax()), problem.dof)
            limit = float((high if is_high else low)[piece, joint])
            if np.isfinite(limit):
                # strictly inside counts as exactly 1: a position is kept or not
                factor = 1.0 + max(float(excess[piece, joint]), 0.0) / float(width[piece, joint])
                found.append(peak(0, piece, joint, is_high, limit, factor))
    for order in (1, 2, 3):
        limits = asked.derivatives(problem)[order - 1, mine]
        if not np.isfinite(limits).any():
            continue
        extremes = trajectory.extremes(order)
        upper, lower = extremes.high / limits, -extremes.low / limits
        ratio = np.maximum(upper, lower)
        piece, joint = divmod(int(ratio.argmax()), problem.dof)
        is_high = bool(upper[piece, joint] >= lower[piece, joint])
        limit = float(limits[piece, joint])
        found.append(peak(order, piece, joint, is_high, limit, float(ratio[piece, joint])))
    return found
