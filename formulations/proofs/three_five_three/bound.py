"""Certified lower bound of the 3-5-3 spline: no durations fit into a total time L.

Coordinates. r = T2/T1, q = T2/T3, T = T2. With d1, d2, d3 the displacements of a joint, derivative k of
its middle quintic at normalised time s, times T^k, is a separable quadratic

    D_k(s; r, q) = d2 A(s) + d1 (B(s) r + C(s) r^2) + d3 (E(s) q + F(s) q^2),   A..F integer.

Necessary for a feasible motion of total time L, each condition separable in (r, q, T):

    piece(j,k,s,sign)   sign D_k(s; r, q) - limit T^k <= 0     (k = 0: position, 1, 2, 3)
    first               t1 r - T <= 0      (T1 >= t1: the cube's peaks 3|d|/T1, 6|d|/T1^2, 6|d|/T1^3)
    last                t3 q - T <= 0      (the same of the last cube)
    total               1 + 1/r + 1/q - L/T <= 0               (in fact = 0, which also gives T's range)

A box is discarded by multipliers that make the Lagrangian positive on it (three_five_three_lagrangian);
where they come from does not matter. A box is contracted by discarding a slab of it for such a reason.

Domain. T1 >= t1, T3 >= t3, T2 >= t2 = max |d2| / v, v a bound on any joint's speed. Hence Tk lies in
[tk, L - the other two], and r in [t2 / T1max, T2max / t1]. If t1 = 0 no joint moves on the first
segment, nothing depends on r, and 'total' without 1/r is still necessary: r is fixed to 1 and dropped.
So for q. If no joint moves on the middle segment, T2 >= tau = 1e-10 L is treated so, and T2 <= tau by
three_five_three_short.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import Late
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.domain import LESS, MORE, Data, data_of
from formulations.proofs.proof import NARROW, Setup
from formulations.proofs.three_five_three.lagrangian import BASIS
from formulations.proofs.three_five_three.search import MOST_ROWS, STACK, search
from formulations.proofs.three_five_three.short import short_middle

SHORT = 1e-10  # of L: a middle segment on which nothing moves may be as short as it likes
_SHORT_LEAVES = 20_000
_search = Late(search)


def shortest_segments(data: Data, L: float) -> Array:
    """Rounded-down t1, t2, t3, (3,) [s]: for the cubes max of 3|d|/V, sqrt(6|d|/A), cbrt(6|d|/J)."""
    velocity, acceleration, jerk = data.derivatives
    shortest = data.shortest(L)
    for k in (0, 2):
        d = data.least[k]
        each = [3.0 * d / velocity, np.sqrt(6.0 * d / acceleration), np.cbrt(6.0 * d / jerk)]
        shortest[k] = np.maximum.reduce(each).max() * LESS
    return shortest


def begin(
    problem: Problem,
    L: float,
    *,
    near: Array | None = None,
    narrow: float = NARROW,
    aside: bool = False,
    blur: Array | None = None,
) -> Setup:
    """Set up the attempt to prove that no 3-5-3 motion takes L or less."""
    data = data_of(problem, blur)
    room = np.stack([data.room_above[1], data.room_below[1]])
    limit = np.concatenate([room, data.derivatives])
    compiled_data = (data.d_lo, data.d_hi, limit, BASIS)
    shortest = shortest_segments(data, L)
    has = (data.d[[0, 2]] != 0.0).any(axis=1)
    slack = np.array([L - (shortest.sum() - t) for t in shortest]) * (1.0 + 1e-14) + 1e-14 * L
    impossible, short = "", None
    empty = bool(shortest.sum() > L * (1.0 + 1e-13))
    if not empty and not (data.d[1] != 0.0).any():
        shortest[1] = tau = SHORT * L
        leaves = np.zeros((_SHORT_LEAVES, 6))
        count = short_middle(compiled_data, data.d, has, shortest, L, tau, leaves)
        if count < 0:
            impossible = "undecided where the middle segment vanishes"
        short = tau, leaves[:count]

    stack = np.ones((STACK, 2, 2))
    if not empty:
        for x, k in ((0, 0), (1, 2)):
            if has[x]:
                stack[0, 0, x] = shortest[1] / slack[k] * LESS
                stack[0, 1, x] = slack[1] / shortest[k] * MORE

    def advance(depth: int, max_boxes: int, counts: Any, log: Any) -> tuple[int, bool]:
        return _search(
            stack, depth, data.d, compiled_data, has, shortest, L, max_boxes, narrow, aside, counts, log
        )

    def durations(depth: int) -> Array:
        ratio = np.sqrt(stack[depth - 1].prod(axis=0))
        # a segment on which nothing moves may be as short as it likes
        inverse = np.where(has, 1.0 / ratio, SHORT)
        middle = L / (1.0 + inverse.sum())
        return np.array([middle * inverse[0], middle, middle * inverse[1]])

    depth = 0 if empty else 1
    return Setup(2, MOST_ROWS, depth, advance, durations, impossible, short)
