"""The fastest motion in terms of its durations and waypoint states alone: sequential quadratic programs.

Between its waypoints a motion follows from the states there (``motion``), so durations, velocities and
accelerations at the waypoints are the only unknowns: 2 n + 1 for each segment of n joints. Each step
linearises the rows of ``reach_rows`` in a trust region, prices what cannot be met (an exact penalty), adds
the rows' curvature, and solves the quadratic program in time proportional to the number of waypoints.
Radii grow and shrink at each segment by itself, since segments far apart hardly feel one another.

Whatever a step gives is slowed down by the least factor with which all rows hold, and the best is kept: so
there is a motion from the first point on, which is stop and go.

References
----------
Fletcher 1987, "Practical Methods of Optimization", 2nd edition, sec. 12.4 and 14.4, Wiley.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csr_array

from formulations.deadlines import NEVER, Deadline
from formulations.problem.arrays import Array, Indices, Truths
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.attaining_motion.cruising_start import cruising_point
from formulations.proofs.every_motion.attaining_motion.interior_point import minimise_in_band
from formulations.proofs.every_motion.attaining_motion.reach_rows import ChainPoint, ReachRows
from formulations.proofs.every_motion.attaining_motion.states import MARGIN, WaypointStates
from formulations.proofs.every_motion.closed_forms import stop_and_go_durations
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem

_STEPS = 60
_PRICE, _DEAREST = 8.0, 1e3  # of missing one top speed over a segment's time, in mean durations
_ROUGH = 3  # steps without curvature, solved loosely
_FAR = 1.0  # rows with more slack cannot be met within a step that is worth it
_NEAR_END = 1e-5  # of the time: steps that change it by less keep the rows of the steps before
_GENERATIONS = 2  # of rows that are kept then
_CALM, _CALMER = 1e-3, 1e-2  # weight of the squared change of states, before and in the end
_WIDEST, _NARROWER, _WIDER = 0.5, 0.6, 1.4  # the trust region's radius, and how it changes
_SLOWER = 10.0 ** np.arange(-7.0, 5.0)  # factors less 1, before bisection
_BISECTIONS = 6
_DENSE = 0.1  # of top speed: what full acceleration gains in one segment of a dense path
_SURE = 0.1  # radius of the trust region there


class ChainDescent:
    """Durations and waypoint states on their way to a local optimum.

    Attributes
    ----------
    relaxed : RelaxedProblem
        With limits lowered by a margin, that rounding does not break the problem's own.
    point : ChainPoint
    best : ChainPoint
        The fastest point at which all rows hold.
    converged : bool
    """

    def __init__(self, problem: Problem) -> None:
        """Begin with stop and go.

        Parameters
        ----------
        problem : Problem
            With an acceleration limit or a jerk limit for each joint that moves.
        """
        self.problem = problem
        v, a, j = problem.limits.derivatives * (1.0 - MARGIN)
        lowered = replace(problem, limits=replace(problem.limits, velocity=v, acceleration=a, jerk=j))
        times = stop_and_go_durations(problem)
        self.relaxed = relaxed = RelaxedProblem.of(lowered, 10.0 * float(times.sum()), 0.0)
        still = np.zeros((len(relaxed.segments) + 1, len(relaxed.joints)))
        times = times[relaxed.segments] * (1.0 + 2.0 * MARGIN)
        self.point = self.best = ChainPoint(times, still, still)
        self.rows = ReachRows.of(relaxed)
        self.columns = _Columns.of(len(times), relaxed.has_jerk)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = relaxed.acceleration**2 / (2.0 * relaxed.jerk * relaxed.velocity)
        self._peak = np.where(relaxed.has_jerk, share, 0.0)  # of |v| + a^2 / (2 J) over V
        self._width = np.full(len(times), _WIDEST)
        self._reach = np.ones(still.shape)
        self._price = _PRICE
        self._old: list[Array] = []
        self._weights = np.zeros(len(self.rows.segment))
        self._peak_weights = np.zeros(still.shape)
        self._missing = np.zeros(relaxed.displacements.shape)
        self._ending = False
        self.converged = False
        self._begin_without_stops()

    def _begin_without_stops(self) -> None:
        """Begin at full speed where the steps between waypoints are too short to accelerate in."""
        stopping, point = self.point, cruising_point(self.relaxed)
        ramp = point.T[:, None] * self.relaxed.acceleration / self.relaxed.velocity
        if float(ramp.mean()) > _DENSE:
            return
        self.point = point
        self._keep_feasible()
        if self.best is stopping:
            self.point = stopping
            return
        # the time that a missing bit of speed saves is that of many segments
        self._price = _PRICE / float(ramp.mean())
        self._width[:] = _SURE

    @property
    def seconds(self) -> float:
        """Time of the best point [s]."""
        return float(self.best.T.sum())

    def states(self, point: ChainPoint) -> WaypointStates:
        """The states of a point in rad/s and rad/s^2.

        Parameters
        ----------
        point : ChainPoint

        Returns
        -------
        WaypointStates
        """
        horizon = float(point.T.sum()) * (1.0 + MARGIN)
        own = RelaxedProblem.of(self.problem, horizon)
        relaxed = self.relaxed
        return WaypointStates(own, point.v * relaxed.velocity, point.a * relaxed.acceleration)

    def run(
        self,
        tolerance: float,
        deadline: Deadline = NEVER,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        """Descend until a step gains less than the tolerance, or the time is over.

        Parameters
        ----------
        tolerance : float
            Relative, of the total time.
        deadline : Deadline
        progress : callable, optional
            Called as ``progress(seconds)`` where the best point became faster.
        """
        coefficients = self.rows.coefficients(self.rows.states(self.point))
        for step in range(_STEPS):
            if deadline.over:
                return
            before, last = self.point, self.seconds
            self.point = self._next(coefficients, step, deadline)
            coefficients = self.rows.coefficients(self.rows.states(self.point))
            self._adapt(coefficients, step)
            if step >= _ROUGH:
                self._keep_feasible()
            if progress is not None and self.seconds < last:
                progress(self.seconds)
            change = abs(float(self.point.T.sum() / before.T.sum()) - 1.0)
            self._ending |= change < _NEAR_END
            ahead = self.seconds / float(self.point.T.sum()) - 1.0
            if change < 0.1 * tolerance and 0.0 <= ahead < tolerance:
                self.converged = True
                return

    def _next(self, coefficients: Array, step: int, deadline: Deadline) -> ChainPoint:
        """The next point: linear rows, curvature and trust region; the quadratic program is solved."""
        point, columns, relaxed = self.point, self.columns, self.relaxed
        if self._ending:
            generations = [coefficients, *self._old]
            self._old = generations[:_GENERATIONS]
        else:
            generations = [coefficients]
        states = self.rows.states(point)
        slopes, slacks = zip(*(self.rows.linearised(c, states) for c in generations), strict=True)
        slack = np.concatenate(slacks)
        near = np.flatnonzero(slack < _FAR)
        kept = np.concatenate(slopes)[near]
        places = columns.of_rows(self.rows)[near % len(self.rows.segment)]
        values = np.column_stack([kept, -np.ones(len(near))])
        peak_slopes = 2.0 * self._peak * point.a
        peak_slack = 1.0 - self._peak * point.a**2
        ones = np.ones(point.v.size)
        peaks = [np.column_stack([sign * ones, peak_slopes.ravel()]) for sign in (1.0, -1.0)]
        peak_upper = [(peak_slack - sign * point.v).ravel() for sign in (1.0, -1.0)]
        pairs = np.column_stack([columns.v.ravel(), columns.a.ravel()])
        matrix = _stacked([(places, values), (pairs, peaks[0]), (pairs, peaks[1])], columns.size)
        upper = np.concatenate([slack[near], *peak_upper])
        cost = np.zeros(columns.size)
        mean = float(point.T.mean())
        cost[columns.T], cost[columns.missed] = point.T / mean, self._price
        box = self._trust_region(point)
        quadratic = None if step < _ROUGH else self._quadratic(states)
        free = columns.free
        found = minimise_in_band(
            cost[free],
            matrix[:, free],
            upper,
            box[free],
            None if quadratic is None else quadratic[free][:, free],
            tolerance=1e-5 if step < _ROUGH else 1e-9,
            deadline=deadline,
        )
        x = np.zeros(columns.size)
        x[free] = found.x
        each = np.zeros(len(slack))
        each[near] = found.multipliers[: len(near)]
        self._weights = each.reshape(len(generations), -1).sum(axis=0)
        self._peak_weights = found.multipliers[len(near) :].reshape(2, *point.v.shape).sum(axis=0)
        if self._ending and x[columns.missed].max() > 1e-6:
            self._price = max(self._price, min(4.0 * self._price, _DEAREST))
        T = np.maximum(point.T * (1.0 + x[columns.T]), relaxed.least)
        return ChainPoint(T, point.v + x[columns.v], point.a + x[columns.a])

    def _trust_region(self, point: ChainPoint) -> Array:
        columns, box = self.columns, np.zeros((self.columns.size, 2))
        shortest = np.maximum(-self._width / (1.0 + self._width), self.relaxed.least / point.T - 1.0)
        box[columns.T] = np.column_stack([np.minimum(shortest, -1e-6), self._width])
        box[columns.missed] = (0.0, 10.0)
        for column, value, reach in ((columns.v, point.v, 1.0), (columns.a, point.a, 2.0)):
            low = np.maximum(-reach * self._reach, -1.0 - value)
            high = np.minimum(reach * self._reach, 1.0 - value)
            box[column] = np.stack([np.minimum(low, -1e-9), np.maximum(high, 1e-9)], axis=-1)
        return box

    def _quadratic(self, states: tuple[Array, ...]) -> csr_array:
        """Curvature of the rows, and a weight on each change of a state, which keeps idle joints calm."""
        columns = self.columns
        active = np.flatnonzero(self._weights > 1e-7)
        part = tuple(value[active] for value in states)
        blocks = self.rows[active].curvature(part, self._weights[active])
        K, n = self.relaxed.displacements.shape
        k, j = np.indices((K, n))
        five = [
            columns.T[k],
            columns.v[k, j],
            columns.a[k, j],
            columns.v[k + 1, j],
            columns.a[k + 1, j],
        ]
        place = np.stack(five, axis=-1)
        row = np.broadcast_to(place[..., :, None], blocks.shape).ravel()
        column = np.broadcast_to(place[..., None, :], blocks.shape).ravel()
        calm = np.full(columns.v.size, _CALMER if self._ending else _CALM)
        bend = (2.0 * self._peak * self._peak_weights).ravel() + calm
        v, a = columns.v.ravel(), columns.a.ravel()
        entries = np.concatenate([blocks.ravel(), calm, bend])
        where = (np.concatenate([row, v, a]), np.concatenate([column, v, a]))
        return csr_array(coo_array((entries, where), shape=(columns.size, columns.size)))

    def _adapt(self, coefficients: Array, step: int) -> None:
        """Narrow the trust region where the point misses more than it should, and widen it elsewhere."""
        missing = self._missing_at(self.point, coefficients)
        if step >= 2:
            bad = missing > np.maximum(0.5 * self._missing, 1e-6)
            narrow = bad.any(axis=1)
            self._width = np.where(
                narrow, self._width * _NARROWER, np.minimum(self._width * _WIDER, _WIDEST)
            )
            touched = np.zeros(self._reach.shape, dtype=bool)
            touched[:-1] |= bad
            touched[1:] |= bad
            self._reach = np.where(
                touched, self._reach * _NARROWER, np.minimum(self._reach * _WIDER, 1.0)
            )
        self._missing = missing

    def _missing_at(self, point: ChainPoint, coefficients: Array) -> Array:
        _, slack = self.rows.linearised(coefficients, self.rows.states(point))
        missing = np.zeros(self.relaxed.displacements.shape)
        np.maximum.at(missing, (self.rows.segment, self.rows.joint), -slack)
        return missing

    def _keep_feasible(self) -> None:
        """Slow the point down until every row holds, and keep it if it is the fastest so far."""
        total = float(self.point.T.sum())
        room = self.seconds / total - 1.0
        if room <= 0.0 or not np.isfinite(total):
            return
        tried = [0.0, *(_SLOWER[room > _SLOWER].tolist())]
        low = -1.0
        for share in tried:
            if self._holds(self.point.slower(1.0 + share)):
                break
            low = share
        else:
            return
        high = share
        for _ in range(_BISECTIONS if low > 0.0 else 0):
            middle = float(np.sqrt(low * high))
            low, high = (
                (low, middle) if self._holds(self.point.slower(1.0 + middle)) else (middle, high)
            )
        self.best = self.point.slower(1.0 + high)

    def _holds(self, point: ChainPoint) -> bool:
        peaks = np.abs(point.v) + self._peak * point.a**2
        if max(peaks.max(), np.abs(point.a).max()) > 1.0 or (self.relaxed.least > point.T).any():
            return False
        coefficients = self.rows.coefficients(self.rows.states(point))
        return bool(self._missing_at(point, coefficients).max() <= 1e-12)


class _Columns(NamedTuple):
    """Where the variables are: states of a waypoint, then the duration that follows and what it misses."""

    v: Indices
    a: Indices
    T: Indices
    missed: Indices
    free: Indices
    size: int

    @staticmethod
    def of(K: int, has_jerk: Truths) -> _Columns:
        n = len(has_jerk)
        start = np.arange(K + 1) * (2 * n + 2)
        v = start[:, None] + 2 * np.arange(n)
        T = start[:-1] + 2 * n
        size = K * (2 * n + 2) + 2 * n
        free = np.ones(size, dtype=bool)
        for column in (v, v + 1):
            free[column[[0, -1]]] = False  # at rest
        free[v[:, ~has_jerk] + 1] = False
        return _Columns(v, v + 1, T, T + 1, np.flatnonzero(free), size)

    def of_rows(self, rows: ReachRows) -> Indices:
        """Columns (m, 6) of each row."""
        k, j = rows.segment, rows.joint
        ends = [self.v[k, j], self.a[k, j], self.v[k + 1, j], self.a[k + 1, j]]
        return np.column_stack([self.T[k], *ends, self.missed[k]])


def _stacked(blocks: list[tuple[Indices, Array]], size: int) -> csr_array:
    """Rows with given columns and values, block below block."""
    counts = np.concatenate([np.full(len(values), values.shape[1]) for _, values in blocks])
    starts = np.concatenate([[0], np.cumsum(counts)])
    columns = np.concatenate([places.ravel() for places, _ in blocks])
    values = np.concatenate([values.ravel() for _, values in blocks])
    return csr_array((values, columns, starts), shape=(len(counts), size))
