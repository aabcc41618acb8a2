"""A motion as exact piecewise polynomials, and the check that judges every reported number.

This file shares no code with the optimisers' kernels. Extremes come from the roots of derivatives,
never from samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PPoly

from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem

TOLERANCE = 1e-9  # relative excess over a limit that still counts as keeping it
QUANTITIES = ("position", "velocity", "acceleration", "jerk")
UNITS = ("rad", "rad/s", "rad/s²", "rad/s³")


@dataclass(frozen=True)
class Extremes:
    """Least and greatest value per piece and joint, and the times they occur.

    All arrays (n_pieces, dof); times from the start of the motion [s].
    """

    low: Array
    high: Array
    time_low: Array
    time_high: Array


@dataclass(frozen=True)
class Trajectory:
    """Piecewise polynomial motion of all joints.

    durations: (n_pieces,) [s], positive. coefficients: (n_pieces, dof, degree + 1), ascending powers
    of the local time from 0 [rad/s^k]. passages: (n_waypoints,) times [s] at which the waypoints are
    passed; the breakpoints if left out. Raises InputError for wrong shapes or durations.
    """

    durations: Array
    coefficients: Array
    passages: Array | None = None

    def __post_init__(self) -> None:
        if self.coefficients.ndim != 3 or len(self.coefficients) != len(self.durations):
            raise InputError(
                f"trajectory: coefficients {self.coefficients.shape} do not fit "
                f"{len(self.durations)} durations"
            )
        if not (np.isfinite(self.durations).all() and (self.durations > 0.0).all()):
            raise InputError(f"trajectory: durations must be positive, got {self.durations}")
        if not np.isfinite(self.coefficients).all():
            raise InputError("trajectory: coefficients must be finite")
        if self.passages is not None and not np.isfinite(self.passages).all():
            raise InputError(f"trajectory: passage times must be finite, got {self.passages}")

    @property
    def dof(self) -> int:
        """Number of joints."""
        return int(self.coefficients.shape[1])

    @cached_property
    def breaks(self) -> Array:
        """Breakpoints, (n_pieces + 1,) [s]."""
        return np.concatenate([[0.0], np.cumsum(self.durations)])

    @property
    def seconds(self) -> float:
        """Total time [s]."""
        return float(self.breaks[-1])

    @property
    def passage_times(self) -> Array:
        """Times at which the waypoints are passed, (n_waypoints,) [s]."""
        return self.breaks if self.passages is None else self.passages

    @cached_property
    def _piecewise(self) -> PPoly:
        return PPoly(np.moveaxis(self.coefficients[..., ::-1], -1, 0), self.breaks)

    def at(self, times: ArrayLike, order: int = 0) -> Array:
        """Position (order 0) or a derivative at times (...,) [s]: (..., dof)."""
        return np.asarray(self._piecewise(np.asarray(times, dtype=np.float64), nu=order))

    def sample(self, rate: float) -> tuple[Array, Array]:
        """Times (m,) [s] at ``rate`` [1/s], the end included, and position to jerk (4, m, dof)."""
        if not (np.isfinite(rate) and rate > 0.0):
            raise InputError(f"trajectory: a sample rate must be positive, got {rate:g}")
        # a step that ends at the end but for rounding is the end
        steps = int(np.ceil(self.seconds * rate * (1.0 - 1e-12) - 1e-9))
        times = np.append(np.arange(steps) / rate, self.seconds)
        return times, np.stack([self.at(times, order) for order in range(4)])

    def stretched(self, factor: float) -> Trajectory:
        """The same path, every duration multiplied by ``factor``."""
        powers = factor ** -np.arange(self.coefficients.shape[2], dtype=np.float64)
        return Trajectory(
            self.durations * factor,
            self.coefficients * powers,
            None if self.passages is None else self.passages * factor,
        )

    def extremes(self, order: int) -> Extremes:
        """Exact extremes of the derivative of the given order (0: position) on every piece."""
        if order not in self._extremes:
            self._extremes[order] = self._find_extremes(order)
        return self._extremes[order]

    @cached_property
    def _extremes(self) -> dict[int, Extremes]:
        return {}

    def _find_extremes(self, order: int) -> Extremes:
        value = _differentiated(self._normalised, order)
        candidates = np.concatenate(
            [
                np.broadcast_to([0.0, 1.0], (*value.shape[:2], 2)),
                _turning_points(_differentiated(value, 1)),
            ],
            axis=2,
        )
        values = _evaluated(value, candidates) / self.durations[:, None, None] ** order
        lowest, highest = values.argmin(axis=2)[..., None], values.argmax(axis=2)[..., None]
        times = self.breaks[:-1, None, None] + candidates * self.durations[:, None, None]
        return Extremes(
            low=np.take_along_axis(values, lowest, 2)[..., 0],
            high=np.take_along_axis(values, highest, 2)[..., 0],
            time_low=np.take_along_axis(times, lowest, 2)[..., 0],
            time_high=np.take_along_axis(times, highest, 2)[..., 0],
        )

    @property
    def _normalised(self) -> Array:
        """Coefficients on normalised time s = t / T of each piece."""
        return self.coefficients * self.durations[:, None, None] ** np.arange(
            self.coefficients.shape[2]
        )

    @cached_property
    def jumps(self) -> Array:
        """Largest jump per joint of position, velocity, acceleration at inner breaks, (3, dof)."""
        ends = np.stack([self._edge(order, 1.0)[:-1] for order in range(3)])
        starts = np.stack([self._edge(order, 0.0)[1:] for order in range(3)])
        return np.asarray(np.abs(starts - ends).max(axis=1, initial=0.0))

    def _edge(self, order: int, s: float) -> Array:
        value = _differentiated(self._normalised, order)
        at = np.full((*value.shape[:2], 1), s)
        return _evaluated(value, at)[..., 0] / self.durations[:, None] ** order


@dataclass(frozen=True)
class Peak:
    """The place where a motion uses most of one limit.

    factor: value over limit (for position: 1 plus the excess over the allowed range).
    stretch: factor on all durations that would just keep it; infinite for position.
    joint and segment count from 0; time in s; value and limit in rad/s^k.
    """

    quantity: str
    joint: int
    segment: int
    time: float
    value: float
    limit: float
    factor: float
    stretch: float

    def __str__(self) -> str:
        unit = UNITS[QUANTITIES.index(self.quantity)]
        return (
            f"{self.quantity} of joint {self.joint + 1} in segment {self.segment + 1} at "
            f"{self.time:.4f} s: {self.value:.6g} {unit}, limit {self.limit:.6g} {unit}, "
            f"factor {self.factor:.6g}"
        )


@dataclass(frozen=True)
class Verdict:
    """What the independent check found about one motion.

    feasible: passes the waypoints, is continuous, rests at both ends and keeps every limit.
    stretch: least factor on all durations that keeps velocity, acceleration and jerk limits.
    peaks: the worst place per limited quantity, worst first. faults: all that is wrong, in words.
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
    """Judge a motion by its exact extremes: waypoints, continuity, rest, limits.

    ``through=False`` asks only for the first and last waypoint (end-to-end references); conditions
    say what else was asked for, and take waypoints and segments as ``through`` does.
    """
    faults: list[str] = []
    asked = conditions or Conditions()
    if trajectory.dof != problem.dof:
        raise InputError(f"trajectory: {trajectory.dof} joints, the problem has {problem.dof}")
    limits = problem.limits

    # waypoints
    reach = float(np.ptp(problem.waypoints, axis=0).max())
    tolerance = TOLERANCE * reach + 1e-13 * float(np.abs(problem.waypoints).max())
    targets = problem.waypoints if through else problem.waypoints[[0, -1]]
    times = trajectory.passage_times
    if len(times) != len(targets):
        faults.append(f"{len(times)} passage times for {len(targets)} waypoints")
    elif not (
        abs(times[0]) <= TOLERANCE * trajectory.seconds
        and abs(times[-1] - trajectory.seconds) <= TOLERANCE * trajectory.seconds
        and (np.diff(times) >= 0.0).all()
    ):
        faults.append("passage times do not run from the start to the end of the motion")
    else:
        miss = np.abs(trajectory.at(times) - targets)
        if miss.max() > tolerance:
            row, joint = divmod(int(miss.argmax()), problem.dof)
            faults.append(f"misses waypoint {row + 1}, joint {joint + 1} by {miss.max():.3g} rad")

    # continuity and rest; acceleration too where jerk is limited
    scales = [np.full(problem.dof, tolerance), TOLERANCE * limits.velocity]
    orders = [0, 1]
    if limits.has_jerk:
        known = np.where(np.isfinite(limits.acceleration), limits.acceleration, 0.0)
        scales.append(np.where(np.isfinite(limits.jerk), TOLERANCE * known, np.inf))
        orders.append(2)
    for order, scale in zip(orders, scales, strict=True):
        # rounding grows with the size of the motion itself; 1e-300 for joints that never move
        allowed = np.maximum(scale, TOLERANCE * _size(trajectory, order)) + 1e-300
        jump = trajectory.jumps[order]
        if (jump > allowed).any():
            joint = int(np.argmax(jump / allowed))
            faults.append(f"{QUANTITIES[order]} of joint {joint + 1} jumps by {jump[joint]:.3g}")
        if order > 0:
            given = asked.end_velocities(problem) * (order == 1)
            ends = np.abs(trajectory.at([0.0, trajectory.seconds], order) - given).max(axis=0)
            if (ends > allowed).any():
                joint = int(np.argmax(ends / allowed))
                off = f"off by {ends[joint]:.3g}" if given.any() else f"{ends[joint]:.3g}"
                faults.append(f"{QUANTITIES[order]} of joint {joint + 1} is {off} at an end")
            for stop in sorted(asked.stops if len(times) == len(targets) else ()):
                moves = np.abs(trajectory.at(times[stop], order))
                if (moves > allowed).any():
                    joint = int(np.argmax(moves / allowed))
                    faults.append(
                        f"{QUANTITIES[order]} of joint {joint + 1} is {moves[joint]:.3g} at waypoint "
                        f"{stop + 1}, a stop"
                    )

    for waypoint, time in asked.times(problem).items():
        if len(times) == len(targets) and abs(times[waypoint] - time) > TOLERANCE * time:
            faults.append(
                f"passes waypoint {waypoint + 1} at {times[waypoint]:.9g} s, not {time:.9g} s"
            )

    peaks = sorted(
        _peaks(problem, trajectory, asked),
        key=lambda peak: peak.stretch if np.isfinite(peak.stretch) else peak.factor,
        reverse=True,
    )
    faults += [f"over the limit: {peak}" for peak in peaks if peak.factor > 1.0 + TOLERANCE]
    stretch = max((peak.stretch for peak in peaks if peak.quantity != "position"), default=0.0)
    return Verdict(trajectory.seconds, not faults, stretch, tuple(peaks), tuple(faults))


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
        return Peak(name, joint, int(segments[piece]), time, value, limit, factor, stretch)

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


def _differentiated(polynomials: Array, order: int) -> Array:
    """Derivative of ascending coefficients along the last axis; at least one coefficient is kept."""
    for _ in range(order):
        width = polynomials.shape[-1]
        if width == 1:
            return np.zeros_like(polynomials)
        polynomials = polynomials[..., 1:] * np.arange(1, width)
    return polynomials


def _evaluated(polynomials: Array, points: Array) -> Array:
    """Values (..., m) of polynomials (..., k) at points (..., m), Horner."""
    values = np.zeros_like(points)
    for k in range(polynomials.shape[-1] - 1, -1, -1):
        values = values * points + polynomials[..., k : k + 1]
    return values


def _turning_points(slopes: Array) -> Array:
    """Points of [0, 1] that include every root of the polynomials (..., k): (..., k - 1).

    Further points do no harm: a value taken anywhere on the piece never exceeds its extreme.
    """
    width = slopes.shape[-1]
    while width > 1 and not slopes[..., width - 1].any():
        width -= 1
    slopes = slopes[..., :width]
    if width == 1:
        return np.zeros((*slopes.shape[:-1], 0))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        if width == 2:
            roots = -slopes[..., :1] / slopes[..., 1:]
        elif width == 3:
            c, b, a = slopes[..., 0], slopes[..., 1], slopes[..., 2]
            h = -0.5 * (b + np.copysign(np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0)), b))
            roots = np.stack([h / a, c / h], axis=-1)
        else:
            flat = slopes.reshape(-1, width)
            roots = _companion_roots(flat).reshape(*slopes.shape[:-1], width - 1)
    return np.clip(np.nan_to_num(roots, nan=0.0), 0.0, 1.0)


def _companion_roots(rows: Array) -> Array:
    """Real parts of all roots of the polynomials (m, k), within [0, 1]: (m, k - 1), 0 where none.

    Eigenvalues of companion matrices, polished by Newton.
    """
    found = np.zeros((len(rows), rows.shape[1] - 1))
    # leading coefficients that are rounding dust only move roots far outside [0, 1]
    size = np.abs(rows).max(axis=1, keepdims=True)
    significant = np.abs(rows) > 1e-15 * size
    degrees = np.where(
        significant.any(axis=1), rows.shape[1] - 1 - significant[:, ::-1].argmax(axis=1), 0
    )
    for degree in np.unique(degrees[degrees > 0]):
        mine = np.flatnonzero(degrees == degree)
        polynomials = rows[mine, : degree + 1]
        companion = np.zeros((len(mine), degree, degree))
        companion[:, 1:, :-1] = np.eye(degree - 1)
        companion[:, :, -1] = -polynomials[:, :-1] / polynomials[:, -1:]
        roots = np.linalg.eigvals(companion).real.clip(0.0, 1.0)
        slopes = _differentiated(rows[mine], 1)
        for _ in range(3):
            step = _evaluated(rows[mine], roots) / _evaluated(slopes, roots)
            roots = np.clip(np.where(np.isfinite(step), roots - step, roots), 0.0, 1.0)
        found[mine, :degree] = roots
    return found
