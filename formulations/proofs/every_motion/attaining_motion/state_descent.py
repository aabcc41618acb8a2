"""The fastest motion in terms of its durations and waypoint states alone: sequential quadratic programs.

Between its waypoints a motion follows from the states there (``motion``), so durations, velocities and
accelerations at the waypoints are the only unknowns: 2 n + 1 for each segment of n joints. Each step
linearises the rows of ``reach_rows`` in a trust region, prices what cannot be met (an exact penalty), adds
the rows' curvature, and solves the quadratic program in time proportional to the number of waypoints.
What a row may miss counts in units of what full acceleration or full jerk gains in its segment.

Whatever a step gives is slowed down by the least factor with which all rows hold, and the best is kept: so
there is a motion from the first point on, which is stop and go.

References
----------
Fletcher 1987, "Practical Methods of Optimization", 2nd edition, sec. 12.4 and 14.4, Wiley.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import csr_array, diags_array

from formulations.deadlines import NEVER, Deadline
from formulations.problem.arrays import Array
from formulations.proofs.every_motion.attaining_motion.chain_columns import ChainColumns, stacked
from formulations.proofs.every_motion.attaining_motion.chain_task import ChainTask
from formulations.proofs.every_motion.attaining_motion.cruising_start import cruising_point
from formulations.proofs.every_motion.attaining_motion.peaks import PeakRows
from formulations.proofs.every_motion.attaining_motion.reach_rows import ChainPoint, ReachRows
from formulations.proofs.every_motion.attaining_motion.smooth_timing import smoothly_timed
from formulations.proofs.every_motion.attaining_motion.trust_region import TrustRegion
from formulations.proofs.every_motion.interior_point import minimise_in_band

_STEPS = 60
_PRICE, _DEAREST = 8.0, 1e3  # of missing one unit of a segment's rows, in mean durations
_ABOVE = 0.1  # units missed besides, so that a solve begins inside all rows
_ROUGH = 3  # steps without curvature, solved loosely
_FAR = 1.0  # rows with more slack cannot be met within a step that is worth it
_FAR_BACK = 0.5  # rows of the steps before, in their units
_NEAR_END = 1e-5  # of the time: steps that change it by less keep the rows of the steps before
_GENERATIONS = 2  # of rows that are kept then
_CALM, _CALMER = 1e-3, 1e-2  # weight of the squared change of states, before and in the end
_SLOWER = 10.0 ** np.arange(-7.0, 5.0)  # factors less 1, before bisection
_BISECTIONS = 6
_ROUNDING = 1e-12  # of a limit
_DENSE = 0.1  # of top speed: what full acceleration gains in one segment of a dense path
_MOST_MISSED = 2.0  # units that a step may miss there
_ALLOWED, _STRICTER = 1.0, 0.8  # of that what no radius shrinks for, and how it falls from step to step
_SHARES = (1.0, 0.5, 0.25, 0.1, 0.03)  # of a step that are tried there
_LONGER = (1e-2, 3e-3, 1e-3, 3e-4)  # of durations that are held, tried in turn until one fails
_CUTS = 6  # rounds of rows there
_NARROW = 0.3  # share of that by which a point may be slowed down
_NEARLY = 0.01  # units that most rows miss less than, where it is worth it
_OFTEN = 4  # steps from one time to the next
_FAILURES = 8  # steps in a row whose programs rounding leaves unsolved, after which there is no use


class ChainDescent:
    """Durations and waypoint states on their way to a local optimum.

    Attributes
    ----------
    point : ChainPoint
    best : ChainPoint
        The fastest point at which all rows hold.
    converged : bool
    dense : bool
        Whether the steps between waypoints are too short to accelerate in, so that it did not begin at
        stop and go.
    """

    def __init__(
        self, task: ChainTask, start: ChainPoint, path: Array | None, deadline: Deadline = NEVER
    ) -> None:
        """Begin with stop and go; on a dense path with a smooth timing of it.

        Parameters
        ----------
        task : ChainTask
            With limits lowered by a margin, that rounding does not break those that are asked for.
        start : ChainPoint
            Stop and go.
        path : Array or None, shape (K + 1, n) [rad]
            The waypoints, where a dense path may begin with a smooth timing.
        deadline : Deadline
        """
        self.task = task
        self.point = self.best = start
        self.rows = ReachRows.of(task)
        self.columns = ChainColumns.of(task)
        self._peaks = PeakRows.of(task)
        self._region = TrustRegion(task)
        self._price = np.full(len(start.T), _PRICE)
        self._old: list[Array] = []
        self._weights = np.zeros(len(self.rows.segment))
        self._curving = np.zeros(start.v.shape)  # curvature of the peaks' rows
        self._missing = np.zeros(task.displacements.shape)
        self._foreseen = np.zeros(len(start.T))
        self._failures = 0
        self._ending = self.converged = False
        self.dense = False
        if path is not None:
            self._begin_without_stops(path, deadline)

    def _begin_without_stops(self, path: Array, deadline: Deadline) -> None:
        """Begin at full speed where the steps between waypoints are too short to accelerate in."""
        task, stopping, point = self.task, self.point, cruising_point(self.task)
        if float((point.T[:, None] * task.acceleration / task.velocity).mean()) > _DENSE:
            return
        timed = smoothly_timed(task, path, point, deadline)
        self.point = point if timed is None else timed
        self._keep_feasible()
        self.dense = self.best is not stopping
        self.point = self.best
        if self.dense:
            units = self.rows.units(self.rows.states(self.point))
            self._region.suit(self.point, units.reshape(*self._missing.shape, -1)[..., 0])

    @property
    def seconds(self) -> float:
        """Time of the best point [s]."""
        return float(self.best.T.sum())

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
            if deadline.over or self._failures == _FAILURES:
                return
            before, last = self.point, self.seconds
            coefficients = self._go(coefficients, step, deadline)
            if self.point is before:
                continue
            if step >= _ROUGH:
                self._keep_feasible()
            change = abs(float(self.point.T.sum() / before.T.sum()) - 1.0)
            if self.dense and self._restorable(step):
                self._restore(deadline)
            if progress is not None and self.seconds < last:
                progress(self.seconds)
            self._ending |= change < _NEAR_END
            ahead = self.seconds / float(self.point.T.sum()) - 1.0
            if change < 0.1 * tolerance and abs(ahead) < tolerance:
                self.converged = True
                return

    def _go(self, coefficients: Array, step: int, deadline: Deadline) -> Array:
        """Go one step, on a dense path a share of it that does not miss too much, or none."""
        before, missed = self.point, self._missing
        whole = self._next(coefficients, step, deadline)
        for share in _SHARES if self.dense else (1.0,):
            self.point = before.towards(whole, share)
            found = self.rows.coefficients(self.rows.states(self.point))
            self._missing = self._missing_at(self.point, found)
            if share == 1.0 and (self.dense or step >= 2):
                allowed = _ALLOWED * _STRICTER**step if self.dense else 0.0
                self._region.adapt(self._missing, missed, self._foreseen, allowed)
            most = max(_MOST_MISSED, float(missed.max()))
            if not self.dense or float(self._missing.max()) <= most:
                return found
        self.point, self._missing = before, missed
        return coefficients

    def _next(self, coefficients: Array, step: int, deadline: Deadline) -> ChainPoint:
        """The next point: linear rows, curvature and trust region; the quadratic program is solved."""
        generations = [coefficients]
        if self._ending:
            generations += self._old
            self._old = generations[:_GENERATIONS]
        quadratic = None if step < _ROUGH else self._quadratic(self.rows.states(self.point))
        tolerance = 1e-5 if step < _ROUGH else 1e-6 if self.dense else 1e-9
        box = self._region.box(self.columns, self.point)
        found = self._solved(generations, box, quadratic, tolerance, deadline)
        self._failures = 0 if found[1] else self._failures + self.dense
        if self._ending or (self.dense and step >= _ROUGH):
            cheap = self._foreseen > (1e-6 if self._ending else 1e-3)
            self._price[cheap] = np.minimum(4.0 * self._price[cheap], _DEAREST)
        return found[0]

    def _restorable(self, step: int) -> bool:
        """Whether it is time to look for states with which all rows hold."""
        gain = self.seconds / float(self.point.T.sum()) - 1.0
        if step % _OFTEN != _OFTEN - 1 or gain < 2.0 * _LONGER[-1]:
            return False
        return float(np.percentile(self._missing, 99.0)) < _NEARLY

    def _restore(self, deadline: Deadline) -> None:
        """Look for states with which all rows hold while the durations, a little longer, are held.

        That is a convex problem: with durations held a row is linear in the states for fixed switches, and
        holds for every motion.
        """
        point = self.point
        kept = self._missing, self._foreseen, self._weights, self._curving
        calm = np.zeros(self.columns.size)
        calm[self.columns.v], calm[self.columns.a] = _CALMER, _CALMER
        total = float(point.T.sum())
        for share in (x for x in _LONGER if total * (1.0 + x) < self.seconds):
            self.point, best = point.slower(1.0 + share), self.best
            cuts: list[Array] = []
            for _ in range(_CUTS):
                cuts.insert(0, self.rows.coefficients(self.rows.states(self.point)))
                box = TrustRegion(self.task).box(self.columns, self.point)
                box[self.columns.T] = (-1e-9, 1e-9)
                self.point, _ = self._solved(cuts, box, csr_array(diags_array(calm)), 1e-6, deadline)
                self._keep_feasible(_NARROW * share)
                if deadline.over or self.best is not best:
                    break
            if deadline.over or self.best is best:
                break
        self.point = point
        self._missing, self._foreseen, self._weights, self._curving = kept

    def _solved(
        self,
        generations: list[Array],
        box: Array,
        quadratic: csr_array | None,
        tolerance: float,
        deadline: Deadline,
    ) -> tuple[ChainPoint, bool]:
        """The point that a quadratic program leads to, and whether the program was solved."""
        point, columns = self.point, self.columns
        states = self.rows.states(point)
        slopes, slacks = zip(*(self.rows.linearised(c, states) for c in generations), strict=True)
        slack = np.concatenate(slacks)
        m, each = len(self.rows.segment), self.rows.units(states)
        wanted = np.concatenate(
            [slack[:m] < _FAR, slack[m:] < _FAR_BACK * np.tile(each, len(slacks) - 1)]
        )
        near = np.flatnonzero(wanted)
        row = near % m
        unit = each[row]
        places = columns.of_rows(self.rows)[row]
        kept = columns.slopes(np.concatenate(slopes)[near]) / unit[:, None]
        values = np.column_stack([kept, -np.ones(len(near))])
        pairs = np.column_stack([columns.v.ravel(), columns.a.ravel()])
        peaks, peak_upper, bends = [], [], []
        for sign in (1.0, -1.0):
            top, bend = self._peaks.at(point.a, sign)
            peaks.append(
                (pairs, np.column_stack([np.full(bend.size, sign), 2.0 * (bend * point.a).ravel()]))
            )
            peak_upper.append((top - bend * point.a**2 - sign * point.v).ravel())
            bends.append(2.0 * bend)
        matrix = stacked([(places, values), *peaks], columns.size)
        upper = np.concatenate([slack[near] / unit, *peak_upper])
        cost = np.zeros(columns.size)
        mean = float(point.T.mean())
        cost[columns.T], cost[columns.missed] = point.T / mean, self._price
        free = columns.free
        start = np.zeros(columns.size)  # no step, and what is missing then
        np.maximum.at(start, columns.missed[self.rows.segment[row]], -slack[near] / unit)
        start[columns.missed] += _ABOVE
        found = minimise_in_band(
            cost[free],
            matrix[:, free],
            upper,
            box[free],
            None if quadratic is None else quadratic[free][:, free],
            tolerance=tolerance,
            start=start[free] if self.dense else None,
            deadline=deadline,
        )
        x = np.zeros(columns.size)
        x[free] = found.x
        weights = np.zeros(len(slack))
        weights[near] = found.multipliers[: len(near)] / unit
        self._weights = weights.reshape(len(generations), -1).sum(axis=0)
        of_peaks = found.multipliers[len(near) :].reshape(2, *point.v.shape)
        self._curving = (of_peaks * bends).sum(axis=0)
        self._foreseen = x[columns.missed]
        T = np.maximum(point.T * (1.0 + x[columns.T]), self.task.least)
        e = point.e + x[columns.e] if columns.e.size else point.e
        return ChainPoint(T, point.v + x[columns.v], point.a + x[columns.a], e), found.converged

    def _quadratic(self, states: tuple[Array, ...]) -> csr_array:
        """Curvature of the rows, and a weight on each change of a state, which keeps idle joints calm."""
        active = np.flatnonzero(self._weights > 1e-7)
        part = tuple(value[active] for value in states)
        blocks = self.rows[active].curvature(part, self._weights[active])
        calm = np.full(self.columns.v.shape, _CALMER if self._ending else _CALM)
        return self.columns.quadratic(blocks, calm, self._curving + calm)

    def _missing_at(self, point: ChainPoint, coefficients: Array) -> Array:
        states = self.rows.states(point)
        _, slack = self.rows.linearised(coefficients, states)
        missing = np.zeros(self.task.displacements.shape)
        lacking = -slack / self.rows.units(states)
        np.maximum.at(missing, (self.rows.segment, self.rows.joint), lacking)
        return missing

    def _keep_feasible(self, most: float = np.inf) -> None:
        """Slow the point down, by ``most`` at most, until every row holds; keep it if it is the fastest."""
        total = float(self.point.T.sum())
        room = min(self.seconds / total - 1.0, most)
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
        for value, box in zip((point.v, point.a), self.task.shares, strict=True):
            if (value < box[..., 0] - _ROUNDING).any() or (value > box[..., 1] + _ROUNDING).any():
                return False
        if (self.task.least > point.T).any() or not self._peaks.kept(point.v, point.a):
            return False
        coefficients = self.rows.coefficients(self.rows.states(point))
        return bool(self._missing_at(point, coefficients).max() <= 1e-12)
