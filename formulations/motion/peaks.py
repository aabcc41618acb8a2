"""Where a motion uses most of each limit, by its exact extremes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from formulations.motion.cut import cut_at
from formulations.motion.extremes import Extremes
from formulations.motion.trajectory import Trajectory
from formulations.problem.demands import Demands
from formulations.problem.joint_words import factors, shown_unit

QUANTITIES = ("position", "velocity", "acceleration", "jerk")


@dataclass(frozen=True)
class Peak:
    """The place where a motion uses most of one kind of limit.

    Attributes
    ----------
    quantity : str
        One of ``QUANTITIES``, or "torque".
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
        unit, scale = unit_of(self.quantity, self.unit, self.angle)
        return (
            f"{self.quantity} of joint {self.name or self.joint + 1} in segment {self.segment + 1} at "
            f"{self.time:.4f} s: {self.value / scale:.6g} {unit}, limit {self.limit / scale:.6g} {unit}, "
            f"factor {self.factor:.6g}"
        )

    def unit_in(self, angle: str) -> str:
        """Say the unit of the value.

        Parameters
        ----------
        angle : {"rad", "deg"}
            The unit of angles.

        Returns
        -------
        str
        """
        return unit_of(self.quantity, self.unit, angle)[0]

    @property
    def urgency(self) -> float:
        """What peaks are sorted by: the stretch, or for a position the factor."""
        return self.stretch if np.isfinite(self.stretch) else self.factor


def unit_of(quantity: str, unit: str, angle: str) -> tuple[str, float]:
    """Find the unit that a quantity is shown in.

    Parameters
    ----------
    quantity : str
        One of ``QUANTITIES``, or "torque".
    unit, angle : str
        Unit of the joint's position, "rad" or "m", and the one that angles are shown in, "rad" or "deg".

    Returns
    -------
    str
    float
        What one such unit is, in SI units.
    """
    if quantity == "torque":
        return ("N" if unit == "m" else "N m"), 1.0
    return shown_unit(unit, angle, QUANTITIES.index(quantity)), float(factors([unit], angle)[0])


def peaks_of_joints(demands: Demands, trajectory: Trajectory) -> list[Peak]:
    """Find the worst place of every limited quantity of every joint.

    Parameters
    ----------
    demands : Demands
        Limits per segment.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    list of Peak
        At most one for each joint and quantity.
    """
    found, problem = [], demands.problem
    if demands.conditions.segment_limits:
        trajectory = cut_at(trajectory, trajectory.passage_times)
    # each piece belongs to the segment that its middle lies in
    middles = trajectory.breaks[:-1] + 0.5 * trajectory.durations
    segments = np.searchsorted(trajectory.passage_times, middles) - 1
    segments = np.clip(segments, 0, max(len(trajectory.passage_times) - 2, 0))
    # a motion may have no inner waypoints; limits are compared once per segment, not per piece
    mine, starts = np.unique(np.minimum(segments, problem.n_segments - 1), return_index=True)
    ends = np.append(starts[1:], len(segments))

    def worst_piece(
        extremes: Extremes, row: int, joint: int, upper: float, lower: float
    ) -> tuple[int, bool]:
        """The piece of a segment with the worst value, and whether it is the highest one; ties: the first."""
        pieces = slice(starts[row], ends[row])
        high = int(starts[row] + extremes.high[pieces, joint].argmax())
        low = int(starts[row] + extremes.low[pieces, joint].argmin())
        is_high = upper > lower or (upper == lower and high <= low)
        return (high if is_high else low), is_high

    def peak(
        extremes: Extremes, order: int, piece: int, joint: int, high: bool, limit: float, factor: float
    ) -> Peak:
        time = float((extremes.time_high if high else extremes.time_low)[piece, joint])
        value = float((extremes.high if high else extremes.low)[piece, joint])
        stretch = factor ** (1.0 / order) if order else np.inf
        name = QUANTITIES[order]
        words = (
            problem.names[joint] if problem.names else "",
            problem.units[joint],
            problem.display_unit,
        )
        return Peak(name, joint, int(segments[piece]), time, value, limit, factor, stretch, *words)

    bounds = demands.position
    if np.isfinite(bounds).any():
        extremes = trajectory.extremes(0)
        low, high = bounds[mine, :, 0], bounds[mine, :, 1]
        width = np.where(np.isfinite(high - low), high - low, 1.0)
        slack = problem.position_slack
        below = low - slack - np.minimum.reduceat(extremes.low, starts)
        above = np.maximum.reduceat(extremes.high, starts) - high - slack
        excess = np.maximum(below, above)
        for joint, row in enumerate(excess.argmax(axis=0).tolist()):
            piece, is_high = worst_piece(extremes, row, joint, above[row, joint], below[row, joint])
            limit = float((high if is_high else low)[row, joint])
            if np.isfinite(limit):
                # strictly inside counts as exactly 1: a position is kept or not
                factor = 1.0 + max(float(excess[row, joint]), 0.0) / float(width[row, joint])
                found.append(peak(extremes, 0, piece, joint, is_high, limit, factor))
    both_ways = (
        demands.velocity,
        demands.acceleration,
        np.stack([-demands.jerk, demands.jerk], axis=-1),
    )
    for order, intervals in enumerate(both_ways, start=1):
        if not np.isfinite(intervals).any():
            continue
        down, up = -intervals[mine, :, 0], intervals[mine, :, 1]
        extremes = trajectory.extremes(order)
        upper = np.maximum.reduceat(extremes.high, starts) / up
        lower = -np.minimum.reduceat(extremes.low, starts) / down
        ratio = np.maximum(upper, lower)
        for joint, row in enumerate(ratio.argmax(axis=0).tolist()):
            piece, is_high = worst_piece(extremes, row, joint, upper[row, joint], lower[row, joint])
            limit = float((up if is_high else down)[row, joint])
            if np.isfinite(limit):
                found.append(
                    peak(extremes, order, piece, joint, is_high, limit, float(ratio[row, joint]))
                )
    if demands.conditions.torque is not None:
        from formulations.dynamics import torque_peaks  # loaded where it is asked for

        found += torque_peaks(demands.problem, trajectory, demands.conditions.torque)
    return found


def worst_of_quantities(peaks: Sequence[Peak]) -> list[Peak]:
    """Keep the worst place of each quantity.

    Parameters
    ----------
    peaks : sequence of Peak
        Of single joints.

    Returns
    -------
    list of Peak
        Worst first.
    """
    worst: dict[str, Peak] = {}
    for peak in peaks:
        if peak.quantity not in worst or peak.factor > worst[peak.quantity].factor:
            worst[peak.quantity] = peak
    return sorted(worst.values(), key=lambda peak: peak.urgency, reverse=True)
