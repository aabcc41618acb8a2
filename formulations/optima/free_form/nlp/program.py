"""A task on a mesh: bounds and parameters of the equations; motions to points and back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.optima.free_form.nlp.arcs import Arcs, Motion
from formulations.optima.free_form.nlp.assembly import least_times
from formulations.optima.free_form.nlp.equations import Place, Shape, symbols
from formulations.optima.free_form.nlp.task import Task
from formulations.problem.arrays import Array

POSITION_MARGIN = 1e-9  # rad per (1 + |waypoints|) that solutions stay inside the position limits


@dataclass(frozen=True)
class Solution:
    """Point, multipliers (CasADi's signs: positive at upper bounds) and what the solver said."""

    x: Array
    row_multipliers: Array
    bound_multipliers: Array
    converged: bool
    status: str
    iterations: int


class Program:
    """A task on a mesh: bounds, parameters, scales, and the way from motions to points and back.

    Scales: ``second`` [s] for time; per joint a velocity and an acceleration the motion can reach.
    """

    def __init__(
        self,
        task: Task,
        arcs: tuple[int, int],
        *,
        free: bool,
        second: float,
        guarded: frozenset[tuple[int, int]] = frozenset(),
        smooth: bool = False,
    ) -> None:
        self.task, self.arcs, self.free, self.second = task, arcs, free, second
        self.groups = {o: task.group(o) for o in (2, 3) if task.group(o)}
        self.margin = POSITION_MARGIN * (1.0 + float(np.abs(task.waypoints).max()))
        places = sorted(self._place(j, k) for j, k in guarded if task.order[j] > 1)
        self.shape = Shape(
            task.n_segments,
            (len(task.group(2)), len(task.group(3))),
            arcs,
            free,
            tuple(sorted(task.times)),
            tuple(places),
            smooth,
        )
        self.symbols = symbols(self.shape)
        velocity, acceleration, jerk = task.limits.max(axis=1)
        span = second * task.n_segments
        with np.errstate(invalid="ignore"):  # joints without arcs
            self.a_unit = np.minimum(acceleration, jerk * span)
            self.v_unit = np.minimum(velocity, self.a_unit * span)
        self._set_bounds()

    def _place(self, j: int, k: int) -> Place:
        """Where rows (6) go. The first coefficients of a segment are the waypoint itself where the
        velocity there is 0, and the first two of a cubic where the acceleration is 0 as well.
        """
        order = int(self.task.order[j])
        first, last = (
            order - 1 if self._rests(j, w) else int(self._on_limit([j])[w, 0]) for w in (k, k + 1)
        )
        return order, self.groups[order].index(j), k, first, last

    def _rests(self, j: int, waypoint: int) -> bool:
        given = {0: self.task.ends[0, j], self.task.n_segments: self.task.ends[1, j]}
        return waypoint in self.task.stops or given.get(waypoint, 1.0) == 0.0

    def _on_limit(self, joints: list[int]) -> Array:
        """Waypoints that lie on a position limit, where the velocity must be 0, (S + 1, n)."""
        bounds, x = self.task.position_bounds[:, joints], self.task.waypoints[:, joints]
        near = np.zeros(x.shape, dtype=bool)
        for side in (slice(None, -1), slice(1, None)):
            near[side] |= (np.abs(bounds - x[side, :, None]) <= self.margin).any(axis=2)
        return near

    def _set_bounds(self) -> None:
        task, S = self.task, self.task.n_segments
        low, high = [least_times(task) / self.second], [np.full(S, np.inf)]
        row_low, row_high, parameters = [], [], []
        limits = task.limits
        for order, joints in self.groups.items():
            arcs = self.arcs[order - 2]
            steps = S * arcs
            v_unit, a_unit = self.v_unit[joints], self.a_unit[joints]
            if self.free:
                low.append(np.zeros(len(joints) * steps))
                high.append(np.full(len(joints) * steps, np.inf))
            fixed = {0: task.ends[0, joints] / v_unit, steps: task.ends[1, joints] / v_unit}
            fixed |= {k * arcs: np.zeros(len(joints)) for k in task.stops}
            for derivative, unit in ((0, v_unit), (1, a_unit)) if order == 3 else ((0, v_unit),):
                bound = self._at_nodes(limits[derivative][:, joints], arcs) / unit
                lower, upper = -bound, bound.copy()
                if derivative == 0:
                    still = self._on_limit(joints)[1:-1]
                    lower[arcs:-1:arcs][still] = upper[arcs:-1:arcs][still] = 0.0
                for node, value in fixed.items():
                    lower[node] = upper[node] = value if derivative == 0 else 0.0
                low.append(lower.ravel())
                high.append(upper.ravel())
            top = limits[order - 1][:, joints] * self.second / (a_unit if order == 3 else v_unit)
            d = task.displacements[:, joints] / (v_unit * self.second)
            parameters += [top.ravel(), d.ravel()]
            if order == 3:
                parameters.append(a_unit * self.second / v_unit)
        counts = iter(self.shape.guarded)
        for kind, order, n in self.symbols.kinds:
            bottom, ceiling = np.zeros(n), np.zeros(n)
            if kind == "top":
                ceiling += np.inf
            elif kind == "velocity":
                joints, arcs = self.groups[order], self.arcs[order - 2]
                bound = np.repeat(limits[0][:, joints] / self.v_unit[joints], arcs, axis=0).ravel()
                bottom, ceiling = -bound, bound
            elif kind == "position":
                _, i, k, *_ = next(counts)
                j = self.groups[order][i]
                ends = task.waypoints[k : k + 2, j]
                # a waypoint on the limit leaves no room for the margin
                lowest = min(task.position_bounds[k, j, 0] + self.margin, ends.min())
                highest = max(task.position_bounds[k, j, 1] - self.margin, ends.max())
                unit = self.v_unit[j] * self.second
                bottom += (lowest - ends[0]) / unit
                ceiling += (highest - ends[0]) / unit
            row_low.append(bottom)
            row_high.append(ceiling)
        if self.shape.timed:
            fixed_times = np.array([task.times[w] for w in self.shape.timed]) / self.second
            row_low[-len(fixed_times) :] = row_high[-len(fixed_times) :] = list(fixed_times[:, None])
        self.low, self.high = np.concatenate(low), np.concatenate(high)
        self.row_low, self.row_high = np.concatenate(row_low), np.concatenate(row_high)
        self.parameters = np.concatenate([np.zeros(0), *parameters])

    def _at_nodes(self, limits: Array, arcs: int) -> Array:
        """Limits (S, n) at the nodes (S arcs + 1, n); at a waypoint the lower of both segments."""
        found = np.repeat(limits, arcs, axis=0)
        return np.asarray(np.minimum(np.vstack([found[:1], found]), np.vstack([found, found[-1:]])))

    def point(self, motion: Motion, floor: float = 1e-3) -> Array:
        """A motion on this mesh, or any motion sampled on it, as a starting point.

        floor: least share of a segment over the number of arcs that an arc is given.
        """
        parts = [motion.times / self.second]
        for order, joints in self.groups.items():
            n = self.arcs[order - 2]
            if self.free:
                fitted = [motion.joints[j].fitted(n, floor) for j in joints]
                parts.append(np.stack([f.durations for f in fitted], axis=-1).ravel() / self.second)
                nodes = [_flat(arcs.nodes, arcs.states) for arcs in fitted]
            else:
                nodes = [_sampled(motion.joints[j], n) for j in joints]
            for derivative, unit in ((0, self.v_unit), (1, self.a_unit)):
                if derivative < order - 1:
                    values = np.stack([node[derivative] for node in nodes], axis=-1)
                    parts.append((values / unit[joints]).ravel())
        return np.clip(np.concatenate(parts), self.low, self.high)

    def motion(self, x: Array) -> Motion:
        """The motion of a point, true to the rows only as far as the point is."""
        S = self.task.n_segments
        times, at = np.maximum(x[:S], 1e-12) * self.second, S
        found = {}
        for order, joints in self.groups.items():
            n, arcs = len(joints), self.arcs[order - 2]
            steps = S * arcs
            if self.free:
                h = np.maximum(x[at : at + n * steps].reshape(S, arcs, n), 0.0)
                at += n * steps
                h = h * (times[:, None] / np.maximum(h.sum(axis=1), 1e-300))[:, None]
            else:
                h = np.tile((times / arcs)[:, None, None], (1, arcs, n))
            nodes = np.zeros((2, steps + 1, n))
            for derivative, unit in ((0, self.v_unit), (1, self.a_unit))[: order - 1]:
                nodes[derivative] = x[at : at + n * (steps + 1)].reshape(-1, n) * unit[joints]
                at += n * (steps + 1)
            change = np.diff(nodes[order - 2], axis=0).reshape(S, arcs, n)
            tops = np.divide(change, h, out=np.zeros_like(h), where=h > 0.0)
            for i, j in enumerate(joints):
                found[j] = Arcs(order, h[:, :, i], tops[:, :, i], nodes[:, ::arcs, i].T.copy())
        return Motion(times, found)


def _flat(nodes: Array, states: Array) -> Array:
    """Nodes (2, S, M + 1) in a row, each waypoint once, (2, S M + 1)."""
    return np.concatenate([nodes[:, :, :-1].reshape(2, -1), states[-1][:, None]], axis=1)


def _sampled(arcs: Arcs, n: int) -> Array:
    """Velocity and acceleration at n even steps of each segment, (2, S n + 1)."""
    v, a = arcs.nodes
    S = len(v)
    found = np.zeros((2, S * n + 1))
    found[:, -1] = arcs.states[-1]
    for k in range(S):
        ends = np.concatenate([[0.0], np.cumsum(arcs.durations[k])])
        at = np.arange(n) * ends[-1] / n
        arc = np.clip(np.searchsorted(ends, at, side="right") - 1, 0, len(arcs.durations[k]) - 1)
        tau, top = at - ends[arc], arcs.tops[k, arc]
        if arcs.order == 3:
            found[1, k * n : (k + 1) * n] = a[k, arc] + tau * top
            found[0, k * n : (k + 1) * n] = v[k, arc] + tau * (a[k, arc] + tau * top / 2.0)
        else:
            found[0, k * n : (k + 1) * n] = v[k, arc] + tau * top
    return found
