"""The free-form nonlinear program on arcs.

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
|v+ - v| <= A h, and (5) sum h (v + v+) / 2 = d. Where a joint has left its position limits in an
earlier solution, the Bernstein coefficients of its position are bounded too:
        x, x + h v / 3, x+ - h v+ / 3 (of order 2: x + h v / 2) within [low, high]       (6)

Free: every arc of every joint has a duration of its own, h >= 0, and the program holds the optimum
exactly. Uniform: h = T_k / N; fewer ways to go wrong (for given T the rest is convex), but inexact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi
import numpy as np

Place = tuple[int, int, int, int, int]


@dataclass(frozen=True)
class Shape:
    """All that the symbols of a program depend on; programs of equal shape share them.

    joints: number of joints of order 2 and 3. arcs: per segment, of order 2 and 3. timed: waypoints
    with a fixed time. guarded: order, index in its group and segment of the joints with rows (6), and
    how many of these to leave out at either end since they hold by themselves. smooth: the objective is
    the integral of the squares of jerk over limit (order 2: acceleration), not the time.
    """

    segments: int
    joints: tuple[int, int]
    arcs: tuple[int, int]
    free: bool
    timed: tuple[int, ...] = ()
    guarded: tuple[Place, ...] = ()
    smooth: bool = False


class Symbols:
    """Variables, parameters, objective and rows of one shape, in scaled units."""

    def __init__(self, shape: Shape) -> None:
        S = shape.segments
        self.times = casadi.SX.sym("T", S)
        self.variables: list[Any] = [self.times]
        self.parameters: list[Any] = []
        self.rows: list[Any] = []
        self.kinds: list[tuple[str, int, int]] = []  # kind, order of the group, number of rows
        cost = casadi.sum1(self.times)
        roughness = 0.0
        for order, n, arcs in zip((2, 3), shape.joints, shape.arcs, strict=True):
            if n:
                roughness += self._group(shape, order, n, arcs)
        for waypoint in shape.timed:
            self._row("time", 0, casadi.sum1(self.times[:waypoint]))
        self.objective = roughness if shape.smooth else cost

    def _row(self, kind: str, order: int, rows: Any) -> None:
        self.rows.append(casadi.vec(rows))
        self.kinds.append((kind, order, rows.numel()))

    def _group(self, shape: Shape, order: int, n: int, arcs: int) -> Any:
        S, steps = shape.segments, shape.segments * arcs
        v = casadi.SX.sym("v", n, steps + 1)
        # top: limit on the steps of a (of order 2: of v) per unit of time; d: displacements
        top, d = casadi.SX.sym("top", n, S), casadi.SX.sym("d", n, S)
        per_step = np.repeat(np.arange(S), arcs).tolist()
        if shape.free:
            h = casadi.SX.sym("h", n, steps)
            self.variables.append(casadi.vec(h))
        else:
            h = casadi.repmat(casadi.horzcat(*[self.times[k] / arcs for k in per_step]), n, 1)
        self.variables.append(casadi.vec(v))
        self.parameters += [casadi.vec(top), casadi.vec(d)]
        v0, v1 = v[:, :-1], v[:, 1:]
        x = h * (v0 + v1) / 2.0
        if order == 3:
            a = casadi.SX.sym("a", n, steps + 1)
            gain = casadi.SX.sym("gain", n)  # what a unit of a adds to v in a unit of time
            self.variables.append(casadi.vec(a))
            self.parameters.append(gain)
            a0, a1 = a[:, :-1], a[:, 1:]
            gh = casadi.repmat(gain, 1, steps) * h
            self._row("dynamics", order, v1 - v0 - gh * (a0 + a1) / 2.0)  # (1)
            self._row("velocity", order, v0 + gh * a0 / 2.0)  # (3)
            x -= gh * h * (a1 - a0) / 12.0
            change = a1 - a0
        else:
            change = v1 - v0
        reach = top[:, per_step] * h
        self._row("top", order, reach - change)  # (2)
        self._row("top", order, reach + change)
        if shape.free:
            self._row("sum", order, _per_segment(h, S, arcs) - casadi.repmat(self.times.T, n, 1))  # (4)
        self._row("displacement", order, _per_segment(x, S, arcs) - d)  # (5)
        for _, i, k, first, last in (g for g in shape.guarded if g[0] == order):
            rows = _bernstein(x, h, v, i, k, arcs, order)
            self._row("position", order, casadi.vertcat(*rows[first : len(rows) - last]))  # (6)
        rough = change / (h * top[:, per_step])
        return casadi.sum1(casadi.vec(rough**2 * h))

    @cached_property
    def nlp(self) -> dict[str, Any]:
        """As CasADi takes it."""
        return {
            "x": casadi.vertcat(*self.variables),
            "p": casadi.vertcat(*self.parameters),
            "f": self.objective,
            "g": casadi.vertcat(*self.rows),
        }


def _per_segment(steps: Any, segments: int, arcs: int) -> Any:
    return casadi.horzcat(*[casadi.sum2(steps[:, k * arcs : (k + 1) * arcs]) for k in range(segments)])


def _bernstein(x: Any, h: Any, v: Any, i: int, k: int, arcs: int, order: int) -> list[Any]:
    """Inner Bernstein coefficients of the position from the segment's start on, and inner nodes."""
    found, at = [], 0.0
    for step in range(k * arcs, (k + 1) * arcs):
        after = at + x[i, step]
        if order == 3:
            found += [at + h[i, step] * v[i, step] / 3.0, after - h[i, step] * v[i, step + 1] / 3.0]
        else:
            found.append(at + h[i, step] * v[i, step] / 2.0)
        found.append(after)
        at = after
    return found[:-1]


_SYMBOLS: dict[Shape, Symbols] = {}


def symbols(shape: Shape) -> Symbols:
    """The symbols of a shape, made once."""
    if shape not in _SYMBOLS:
        if len(_SYMBOLS) >= 64:
            _SYMBOLS.clear()
        _SYMBOLS[shape] = Symbols(shape)
    return _SYMBOLS[shape]
