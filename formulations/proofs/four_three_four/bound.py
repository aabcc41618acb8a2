"""Certified lower bound of the 4-3-...-3-4 spline: no durations fit into a total time L.

Coordinates. x_k = 1 / T_k of the n segments, and per joint the velocities v_1 .. v_{n-1} at the inner
waypoints (v_0 = v_n = 0). Only x is branched on; v is enclosed (four_three_four_velocities). Every
condition is linear in v, with coefficients linear in x, but for separable powers of x:

    knot(j,i)   2 x_{i-1} v_{i-1} + (wl x_{i-1} + wr x_i) v_i + 2 x_i v_{i+1}
                    - pl d_{i-1} x_{i-1}^2 - pr d_i x_i^2 = 0     (w, p = 4, 6; 6, 12 at the end pieces)
    piece(j,k,r,s,sign)   sign u - limit / x_k^(r-1) <= 0, r = 1, 2, 3;  sign u - room x_k <= 0, r = 0;
                          u = Pd(s) d_k x_k + P0(s) v_k + P1(s) v_{k+1}
    total       sum_k 1 / x_k - L <= 0                                   (in fact = 0)
    jump(j,k,sign)  (open segments only)  sign (S_k + S_{k+1}) - J / x_k <= 0, S_i the share of the
    segment
                    beside k in knot i's row: S_k = a(knot k), S_{k+1} = -a(knot k+1), a(0) = a(n) = 0

with integer polynomials P of the normalised time s. Boxes are discarded, and slabs of them, by a
positive Lagrangian (four_three_four_lagrangian).

Domain. T_k >= t_k = max |d_k| / v, v a bound on the joint's speed; T_k <= L - sum of the other t. A
segment on which nothing moves has t_k = 0 and x_k up to infinity: the box is 'open' there, T_k in [0, 1
/ x_lo].
"""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.domain import LESS, MORE, data_of
from formulations.proofs.four_three_four.lagrangian import BASIS
from formulations.proofs.four_three_four.search import STACK, search
from formulations.proofs.proof import NARROW, Setup

_FLOOR = 1e-10  # of L: an open segment this short is not split further


def begin(
    problem: Problem,
    L: float,
    *,
    near: Array | None = None,
    narrow: float = NARROW,
    aside: bool = False,
    blur: Array | None = None,
) -> Setup:
    """Set up the attempt to prove that no 4-3-...-3-4 motion takes L or less."""
    data = data_of(problem, blur)
    n, dof = data.d.shape
    compiled_data = (
        data.d_lo, data.d_hi, data.derivatives, data.room_below, data.room_above, BASIS
    )  # fmt: skip
    speed, shortest = data.speed(L), data.shortest(L)
    empty = bool(shortest.sum() > L * (1.0 + 1e-13))
    longest = (L - (shortest.sum() - shortest)) * (1.0 + 1e-13) + 1e-14 * L
    stack, stack_v = np.empty((STACK, 2, n)), np.zeros((STACK, 2, dof, n + 1))
    if not empty:
        stack[0] = LESS / longest, np.full(n, inf)
        moving = shortest > 0.0
        stack[0, 1, moving] = MORE / shortest[moving]
        stack_v[0, 1, :, 1:n] = speed[:, None]
        stack_v[0, 0] = -stack_v[0, 1]

    def advance(depth: int, max_boxes: int, counts: Any, log: Any) -> tuple[int, bool]:
        return search(
            stack, stack_v, depth, data.d, compiled_data, n, L, _FLOOR * L,
            max_boxes, narrow, aside, counts, log,
        )  # fmt: skip

    def durations(depth: int) -> Array:
        lo, hi = stack[depth - 1]
        # an open segment may be as short as it likes
        return np.where(hi < inf, 1.0 / np.sqrt(lo * np.minimum(hi, 1e300)), _FLOOR * L)

    return Setup(n, n + 1, 0 if empty else 1, advance, durations)
