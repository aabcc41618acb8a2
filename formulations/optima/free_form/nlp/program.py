"""The program of one problem on a mesh: equations with their numbers; motions to points and back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.optima.free_form.nlp.arcs import ArcMotion, Arcs
from formulations.optima.free_form.nlp.blocks import Shape
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.optima.free_form.nlp.equations import equations_of
from formulations.optima.free_form.nlp.scaled import Offset, ScaledProblem
from formulations.problem.arrays import Array


@dataclass(frozen=True)
class NLPSolution:
    """What a solver returned for a free-form program.

    Attributes
    ----------
    x : Array, shape (n_variables,)
    row_multipliers : Array, shape (n_rows,)
        In CasADi's signs: positive at upper bounds.
    bound_multipliers : Array, shape (n_variables,)
        In the same signs.
    converged : bool
    status : str
        How the solver says it ended, in lower case.
    iterations : int
    """

    x: Array
    row_multipliers: Array
    bound_multipliers: Array
    converged: bool
    status: str
    iterations: int


class FreeFormNLP:
    """The free-form program of one problem on a mesh.

    Attributes
    ----------
    equations : Equations
    numbers : ScaledProblem
    low, high : Array, shape (n_variables,)
    row_low, row_high : Array, shape (n_rows,)
    parameters : Array, shape (n_parameters,)
    """

    def __init__(
        self,
        task: ConditionedProblem,
        arcs: tuple[int, int],
        *,
        free: bool,
        second: float,
        guarded: frozenset[tuple[int, int]] = frozenset(),
        smooth: bool = False,
        elastic: bool = False,
    ) -> None:
        """Pose the program.

        Parameters
        ----------
        task : ConditionedProblem
        arcs : tuple of int
            Arcs per segment, of joints of order 2 and of order 3.
        free : bool
            Free arcs, or even steps.
        second : float [s]
            The unit of time.
        guarded : frozenset of (joint, segment)
            Where the position is kept inside its limits by rows (6).
        smooth : bool
            Minimise the roughness in place of the time.
        elastic : bool
            Minimise what the times asked for are missed by.
        """
        self.task, self.free = task, free
        self.numbers = numbers = ScaledProblem(task, arcs, second)
        places = sorted(numbers.place(j, k) for j, k in guarded if task.order[j] > 1)
        self.shape = Shape(
            task.n_segments,
            (len(task.group(2)), len(task.group(3))),
            arcs,
            free,
            tuple(sorted(task.windows)),
            tuple(places),
            smooth,
            elastic,
            tuple(np.flatnonzero(np.isfinite(task.durations[:, 1])).tolist()) if elastic else (),
            *_free_places(task),
            task.demands.cyclic,
        )
        self.equations = equations_of(self.shape)
        ends = (np.zeros(0), np.zeros(0))
        self.low, self.high, self.row_low, self.row_high = (
            np.concatenate(side)
            for blocks in (self.equations.variables, self.equations.rows)
            for side in zip(ends, *(block.bounds(numbers) for block in blocks), strict=True)
        )
        values = [parameter.value(numbers) for parameter in self.equations.parameters]
        self.parameters = np.concatenate([np.zeros(0), *values])

    def point(self, motion: ArcMotion, floor: float = 1e-3) -> Array:
        """Sample a motion as a starting point of this program.

        Parameters
        ----------
        motion : ArcMotion
            On any mesh.
        floor : float
            Least duration of a free arc, as a share of the mean arc of its segment.

        Returns
        -------
        Array, shape (n_variables,)
        """
        numbers, second = self.numbers, self.numbers.second
        parts = [motion.times / second]
        for order, joints in numbers.groups.items():
            n = numbers.arcs_of(order)
            if self.free:
                fitted = [motion.joints[j].fitted(n, floor) for j in joints]
                parts.append(np.stack([f.durations for f in fitted], axis=-1).ravel() / second)
                nodes = [_flat(arcs.nodes, arcs.states) for arcs in fitted]
            else:
                nodes = [_sampled(motion.joints[j], n) for j in joints]
            for derivative in range(order - 1):
                values = np.stack([node[derivative] for node in nodes], axis=-1)
                parts.append((values / numbers.unit(order, derivative)).ravel())
        for zone in self.shape.zones:
            j = self.task.group(zone.order)[zone.member]
            off = motion.places[zone.waypoint, j] - self.task.waypoints[zone.waypoint, j]
            parts.append(np.array([off / (numbers.v_unit[j] * second)]))
        if self.shape.elastic:
            passed = np.cumsum(motion.times)
            for waypoint in self.shape.timed:  # what is below 0 is set to 0
                early, late = numbers.window(waypoint)
                parts.append(
                    np.array([early, -late]) + np.array([-1.0, 1.0]) * passed[waypoint - 1] / second
                )
            for segment in self.shape.hurried:
                late = motion.times[segment] / second - numbers.segment_times[1][segment]
                parts.append(np.array([late]))
        return np.clip(np.concatenate(parts), self.low, self.high)

    def motion(self, x: Array) -> ArcMotion:
        """Read a motion off a point; it fulfils the rows only as far as the point does.

        Parameters
        ----------
        x : Array, shape (n_variables,)

        Returns
        -------
        ArcMotion
        """
        numbers, S = self.numbers, self.task.n_segments
        times = np.maximum(x[self.equations.variable("times", 0)], 1e-12) * numbers.second
        found = {}
        for order, joints in numbers.groups.items():
            n, arcs = len(joints), numbers.arcs_of(order)
            if self.free:
                h = np.maximum(x[self.equations.variable("arcs", order)].reshape(S, arcs, n), 0.0)
                h = h * (times[:, None] / np.maximum(h.sum(axis=1), 1e-300))[:, None]
            else:
                h = np.tile((times / arcs)[:, None, None], (1, arcs, n))
            nodes = np.zeros((2, S * arcs + 1, n))
            for derivative, name in enumerate(("velocity", "acceleration")[: order - 1]):
                values = x[self.equations.variable(name, order)].reshape(-1, n)
                nodes[derivative] = values * numbers.unit(order, derivative)
            change = np.diff(nodes[order - 2], axis=0).reshape(S, arcs, n)
            tops = np.divide(change, h, out=np.zeros_like(h), where=h > 0.0)
            for i, j in enumerate(joints):
                found[j] = Arcs(order, h[:, :, i], tops[:, :, i], nodes[:, ::arcs, i].T.copy())
        return ArcMotion(times, found, self._places(x))

    def _places(self, x: Array) -> Array:
        """Positions at the waypoints, (S + 1, dof)."""
        places = self.task.waypoints.copy()
        if self.shape.zones:
            offsets = x[self.equations.variable("offset", 0)]
            for zone, offset in zip(self.shape.zones, offsets, strict=True):
                j = self.task.group(zone.order)[zone.member]
                places[zone.waypoint, j] += offset * self.numbers.v_unit[j] * self.numbers.second
        if self.shape.cyclic:
            places[-1] = places[0]
        return np.clip(places, self.task.boxes[..., 0], self.task.boxes[..., 1])


def _free_places(task: ConditionedProblem) -> tuple[tuple[Offset, ...], tuple[Offset, ...]]:
    """Offsets of the program, and the segments that joints with a velocity limit only cross with them."""
    zones, crossings = [], []
    for order in (1, 2, 3):
        for member, j in enumerate(task.group(order)):
            wide = task.zones[:, j].copy()
            if order == 1:
                crossings += [Offset(1, member, int(k)) for k in np.flatnonzero(wide[:-1] | wide[1:])]
            wide[-1] &= not task.demands.cyclic
            zones += [Offset(order, member, int(w)) for w in np.flatnonzero(wide)]
    return tuple(zones), tuple(crossings)


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
