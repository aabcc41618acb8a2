"""The free-form nonlinear program on arcs: each block is registered once, with its name and its bounds.

    minimise    sum_k T_k
    subject to, for each joint, on each arc of duration h with jerk (a+ - a) / h,
        v+ - v = h (a + a+) / 2                                                          (1)
        |a+ - a| <= J h                                                                  (2)
        |v|, |a| at nodes <= V, A    and    |v + h a / 2| <= V                           (3)
    and on each segment, over its arcs,
        sum h = T_k                                                                      (4)
        sum [h (v + v+) / 2 - h^2 (a+ - a) / 12] = d                                     (5)

(3) bounds the three Bernstein coefficients of the velocity, hence the velocity at all times; it is
exact once an arc ends where the acceleration is zero. Joints without a jerk limit have no a: (2) is
|v+ - v| <= A h, and (5) is sum h (v + v+) / 2 = d. Where a joint left its position limits in an earlier
solution, the Bernstein coefficients of its position are bounded too:
        x, x + h v / 3, x+ - h v+ / 3 (of order 2: x + h v / 2) within [low, high]       (6)

Where a waypoint is a zone, its position is free within a box: with its offsets e from the waypoint, (5) has
d + e+ - e in place of d, and (6) starts at e. Times are ranges of sums of T_k, and of single ones. In a
cycle the velocities and accelerations of both ends are equal, and their offset is one.

Free arcs: every arc of every joint has a duration h >= 0 of its own, and the program contains the
optimum exactly. Even steps: h = T_k / N. Then fewer local optima occur (for given T the rest is convex),
but the optimum is approximate.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any

import casadi
import numpy as np

from formulations.optima.free_form.nlp.blocks import Block, Parameter, Rule, Shape
from formulations.optima.free_form.nlp.scaled import Place, ScaledProblem
from formulations.problem.arrays import Array

SHARE = 1e-3  # of the time, in the objective of elastic programs


def _equal(numbers: ScaledProblem) -> tuple[float, float]:
    return 0.0, 0.0


def _nonnegative(numbers: ScaledProblem) -> tuple[float, float]:
    return 0.0, np.inf


def _passing(waypoint: int) -> Rule:
    return lambda numbers: numbers.window(waypoint)


def _at_most(segment: int) -> Rule:
    return lambda numbers: (-np.inf, float(numbers.segment_times[1][segment]))


def _inside(place: Place) -> Rule:
    return lambda numbers: numbers.room(place)


class Equations:
    """Variables, parameters, rows and objective of one shape, in scaled units."""

    def __init__(self, shape: Shape) -> None:
        """Register every block of the program.

        Parameters
        ----------
        shape : Shape
        """
        self.shape = shape
        self.variables: list[Block] = []
        self.parameters: list[Parameter] = []
        self.rows: list[Block] = []
        times = casadi.SX.sym("T", shape.segments)
        if shape.elastic:
            self._variable("times", 0, times, lambda p: (p.segment_times[0], np.inf))
        else:
            self._variable("times", 0, times, lambda p: p.segment_times)
        self.offsets = casadi.SX.sym("e", len(shape.zones))
        cost = casadi.sum1(times)
        roughness = 0.0
        for order, n, arcs in zip((2, 3), shape.joints, shape.arcs, strict=True):
            if n:
                roughness += self._group(order, n, arcs, times)
        if shape.zones:
            self._variable("offset", 0, self.offsets, lambda p: p.offsets(shape.zones))
        if shape.crossings:
            self._crossings(times)
        missed: Any = 0.0
        for waypoint in shape.timed:
            passed = casadi.sum1(times[:waypoint])
            if shape.elastic:
                early, late = casadi.SX.sym("early"), casadi.SX.sym("late")
                self._variable("missed", 0, casadi.vertcat(early, late), _nonnegative)
                passed += early - late
                missed += early + late
            self._row("time", 0, passed, _passing(waypoint))
        for segment in shape.hurried:
            late = casadi.SX.sym("late")
            self._variable("missed", 0, late, _nonnegative)
            missed += late
            self._row("time", 0, times[segment] - late, _at_most(segment))
        self.objective = roughness if shape.smooth else cost
        if shape.elastic:
            self.objective = missed + SHARE * cost

    def _variable(self, name: str, order: int, symbols: Any, rule: Rule) -> None:
        column = casadi.vec(symbols)
        self.variables.append(Block(name, order, column, _next(self.variables, column), rule))

    def _parameter(
        self, name: str, order: int, symbols: Any, value: Callable[[ScaledProblem], Array]
    ) -> None:
        self.parameters.append(Parameter(name, order, casadi.vec(symbols), value))

    def _row(
        self,
        name: str,
        order: int,
        expression: Any,
        rule: Rule,
        *,
        linear: bool = True,
        place: Place | None = None,
    ) -> None:
        column = casadi.vec(expression)
        part = _next(self.rows, column)
        self.rows.append(Block(name, order, column, part, rule, linear, place))

    def _group(self, order: int, n: int, arcs: int, times: Any) -> Any:
        """Register the joints of one order; returns their roughness."""
        S, steps = self.shape.segments, self.shape.segments * arcs
        per_step = np.repeat(np.arange(S), arcs).tolist()
        v = casadi.SX.sym("v", n, steps + 1)
        # top: limit on the change of a (of order 2: of v, upwards) per unit of time; d: displacements
        top, d = casadi.SX.sym("top", n, S), casadi.SX.sym("d", n, S)
        if self.shape.free:
            h = casadi.SX.sym("h", n, steps)
            self._variable("arcs", order, h, _nonnegative)
        else:
            h = casadi.repmat(casadi.horzcat(*[times[k] / arcs for k in per_step]), n, 1)
        self._variable("velocity", order, v, lambda p: p.at_nodes(order, 0))
        self._parameter("top", order, top, lambda p: p.top(order))
        self._parameter("displacement", order, d, lambda p: p.displacement(order))
        v0, v1 = v[:, :-1], v[:, 1:]
        x = h * (v0 + v1) / 2.0
        if order == 3:
            a = casadi.SX.sym("a", n, steps + 1)
            gain = casadi.SX.sym("gain", n)  # what a unit of a adds to v in a unit of time
            self._variable("acceleration", order, a, lambda p: p.at_nodes(order, 1))
            self._parameter("gain", order, gain, lambda p: p.gain(order))
            a0, a1 = a[:, :-1], a[:, 1:]
            gh = casadi.repmat(gain, 1, steps) * h
            gained = v1 - v0 - gh * (a0 + a1) / 2.0
            self._row("dynamics", order, gained, _equal, linear=False)  # (1)
            middle = v0 + gh * a0 / 2.0
            self._row(
                "velocity", order, middle, lambda p: p.velocity_on_arcs(order), linear=False
            )  # (3)
            x -= gh * h * (a1 - a0) / 12.0
            change = a1 - a0
        else:
            change = v1 - v0
        reach = top[:, per_step] * h
        self._row("top", order, reach - change, _nonnegative)  # (2)
        if order == 2:
            fall = casadi.SX.sym("fall", n, S)
            self._parameter("fall", order, fall, lambda p: p.top(order, 0))
            self._row("fall", order, fall[:, per_step] * h + change, _nonnegative)
        else:
            self._row("fall", order, reach + change, _nonnegative)
        if self.shape.free:
            missing = _per_segment(h, S, arcs) - casadi.repmat(times.T, n, 1)
            self._row("sum", order, missing, _equal)  # (4)
        missing = _per_segment(x, S, arcs) - d
        offset = self._offset(order, n)
        if offset is not None:
            missing -= offset[:, 1:] - offset[:, :-1]
        self._row("displacement", order, missing, _equal, linear=False)  # (5)
        if self.shape.cyclic:
            self._row("cycle", order, v[:, 0] - v[:, -1], _equal)
            if order == 3:
                self._row("cycle", order, a[:, 0] - a[:, -1], _equal)
        for place in (place for place in self.shape.guarded if place.order == order):
            start = 0.0 if offset is None else offset[place.member, place.segment]
            coefficients = _bernstein(x, h, v, place, arcs, start)
            inner = casadi.vertcat(*coefficients[place.first : len(coefficients) - place.last])
            self._row("position", order, inner, _inside(place), linear=False, place=place)  # (6)
        rough = change / (h * top[:, per_step])
        return casadi.sum1(casadi.vec(rough**2 * h))

    def _offset(self, order: int, n: int) -> Any:
        """Offsets of a group of joints at the waypoints, (n, S + 1); None where there are none."""
        mine = [(i, zone) for i, zone in enumerate(self.shape.zones) if zone.order == order]
        if not mine:
            return None
        found = casadi.SX(n, self.shape.segments + 1)
        for i, zone in mine:
            found[zone.member, zone.waypoint] = self.offsets[i]
        if self.shape.cyclic:
            found[:, -1] = found[:, 0]
        return found

    def _crossings(self, times: Any) -> None:
        """Register the segments of joints with a velocity limit only whose displacement is free."""
        crossings, n = self.shape.crossings, len(self.shape.crossings)
        numbers = [casadi.SX.sym(name, n) for name in ("way", "least", "greatest")]
        for i, (name, symbols) in enumerate(zip(("way", "least", "greatest"), numbers, strict=True)):
            self._parameter(name, 1, symbols, lambda p, i=i: p.crossed(crossings)[i])  # type: ignore[misc]
        offset = self._offset(1, 1 + max(one.member for one in crossings))
        for i, one in enumerate(crossings):
            way, least, greatest = (symbols[i] for symbols in numbers)
            way += offset[one.member, one.waypoint + 1] - offset[one.member, one.waypoint]
            seconds = times[one.waypoint]
            self._row("crossing", 1, greatest * seconds - way, _nonnegative)
            self._row("crossing", 1, way - least * seconds, _nonnegative)

    def variable(self, name: str, order: int) -> slice:
        """Find a block of variables.

        Parameters
        ----------
        name : str
        order : int

        Returns
        -------
        slice
            Its place among all variables.
        """
        return next(v.part for v in self.variables if (v.name, v.order) == (name, order))

    @cached_property
    def nlp(self) -> dict[str, Any]:
        """The program as CasADi takes it."""
        return {
            "x": casadi.vertcat(*(block.symbols for block in self.variables)),
            "p": casadi.vertcat(*(block.symbols for block in self.parameters)),
            "f": self.objective,
            "g": casadi.vertcat(*(block.symbols for block in self.rows)),
        }


def _next(blocks: list[Block], column: Any) -> slice:
    start = blocks[-1].part.stop if blocks else 0
    return slice(start, start + column.numel())


def _per_segment(steps: Any, segments: int, arcs: int) -> Any:
    return casadi.horzcat(*[casadi.sum2(steps[:, k * arcs : (k + 1) * arcs]) for k in range(segments)])


def _bernstein(x: Any, h: Any, v: Any, place: Place, arcs: int, start: Any) -> list[Any]:
    """Inner Bernstein coefficients of the position less the segment's first waypoint, and inner nodes."""
    found, at, i = [], start, place.member
    for step in range(place.segment * arcs, (place.segment + 1) * arcs):
        after = at + x[i, step]
        if place.order == 3:
            found += [at + h[i, step] * v[i, step] / 3.0, after - h[i, step] * v[i, step + 1] / 3.0]
        else:
            found.append(at + h[i, step] * v[i, step] / 2.0)
        found.append(after)
        at = after
    return found[:-1]


@lru_cache(maxsize=64)
def equations_of(shape: Shape) -> Equations:
    """Make the equations of a shape, once.

    Parameters
    ----------
    shape : Shape

    Returns
    -------
    Equations
    """
    return Equations(shape)
