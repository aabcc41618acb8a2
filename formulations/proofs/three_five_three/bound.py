"""Certified lower bound of the 3-5-3 spline: no durations fit into a total time L.

Coordinates. r = T2/T1, q = T2/T3, T = T2. With d1, d2, d3 the displacements of a joint, derivative k of
its middle quintic at normalised time s, times T^k, is a separable quadratic

    D_k(s; r, q) = d2 A(s) + d1 (B(s) r + C(s) r^2) + d3 (E(s) q + F(s) q^2),   A..F integer.

Conditions. A feasible motion of total time L fulfils, each separable in (r, q, T):

    piece(j,k,s,sign)   sign D_k(s; r, q) - limit T^k <= 0     (k = 0: position, 1, 2, 3)
    first               t1 r - T <= 0      (T1 >= t1: the cubic's peaks 3|d|/T1, 6|d|/T1^2, 6|d|/T1^3)
    last                t3 q - T <= 0      (the same of the last cubic)
    total               1 + 1/r + 1/q - L/T <= 0               (in fact = 0, which also gives T's range)

Proof. Multipliers that make the Lagrangian positive on a box discard it (``lagrangian``); it does not
matter where they come from. A slab of a box is discarded in the same way, and the box is cut.

Domain. T1 >= t1, T3 >= t3, T2 >= t2 = max |d2| / v, v a bound on a joint's speed. Hence each T_k lies in
[t_k, L - the other two], and r in [t2 / T1max, T2max / t1]; q alike. If t1 = 0, no joint moves on the
first segment and nothing depends on r; 'total' without 1/r is still necessary, so r is fixed to 1 and
dropped. If no joint moves on the middle segment, the search covers T2 >= tau = 1e-10 L, and ``short``
covers T2 <= tau.
"""

from __future__ import annotations

import numpy as np

from formulations.compiled import Late
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.domain import LESS, MORE, ProblemData, data_of, duration_domain
from formulations.proofs.events import Effort, EventTrace
from formulations.proofs.proof import NARROW, ProofSearch
from formulations.proofs.three_five_three.data import BASIS, RatioData
from formulations.proofs.three_five_three.search import MOST_ROWS, STACK, branch_and_bound
from formulations.proofs.three_five_three.short import short_middle

SHORT = 1e-10  # of L: tau, the duration below which a still middle segment is treated apart
_SHORT_LEAVES = 20_000
_search = Late(branch_and_bound)


def begin(
    problem: Problem,
    L: float,
    *,
    near: Array | None = None,
    narrow: float = NARROW,
    aside: bool = False,
    blur: Array | None = None,
) -> ProofSearch:
    """Set up the attempt to prove that no 3-5-3 motion takes L seconds or less.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    L : float [s]
        The bound to prove.
    near : Array, shape (n_segments,) [s], optional
        Is not used.
    narrow, aside, blur : optional
        As in ``formulations.proofs.proof.Prover``.

    Returns
    -------
    ProofSearch
        The search, at its beginning.
    """
    source = data_of(problem, blur)
    domain = duration_domain(_shortest_durations(source, L), L)
    shortest, has = domain.shortest, (source.d[[0, 2]] != 0.0).any(axis=1)
    room = np.stack([source.room_above[1], source.room_below[1]])
    limit = np.concatenate([room, source.derivatives])
    impossible, short = "", None
    still = not domain.empty and not (source.d[1] != 0.0).any()
    if still:
        shortest[1] = SHORT * L
    data = RatioData(source.d, source.d_lo, source.d_hi, limit, BASIS, has, shortest, L)
    if still:
        leaves = np.zeros((_SHORT_LEAVES, 6))
        count = short_middle(data, SHORT * L, leaves)
        if count < 0:
            impossible = "undecided where the middle segment vanishes"
        short = SHORT * L, leaves[:count]

    stack = np.ones((STACK, 2, 2))
    if not domain.empty:
        for x, k in ((0, 0), (1, 2)):
            if has[x]:
                stack[0, 0, x] = shortest[1] / domain.longest[k] * LESS
                stack[0, 1, x] = domain.longest[1] / shortest[k] * MORE

    def advance(depth: int, max_boxes: int, trace: EventTrace) -> tuple[int, bool]:
        return _search(stack, depth, data, Effort(max_boxes, narrow, aside), trace)

    def durations(depth: int) -> Array:
        ratio = np.sqrt(stack[depth - 1].prod(axis=0))
        # a segment on which nothing moves may be as short as it likes
        inverse = np.where(has, 1.0 / ratio, SHORT)
        middle = L / (1.0 + inverse.sum())
        return np.array([middle * inverse[0], middle, middle * inverse[1]])

    depth = 0 if domain.empty else 1
    return ProofSearch(2, MOST_ROWS, depth, advance, durations, impossible, short)


def _shortest_durations(data: ProblemData, L: float) -> Array:
    """t1, t2, t3 rounded down, (3,) [s]; of the cubics max of 3|d|/V, sqrt(6|d|/A), cbrt(6|d|/J)."""
    velocity, acceleration, jerk = data.derivatives
    shortest = data.shortest(L)
    for k in (0, 2):
        d = data.least[k]
        each = [3.0 * d / velocity, np.sqrt(6.0 * d / acceleration), np.cbrt(6.0 * d / jerk)]
        shortest[k] = np.maximum.reduce(each).max() * LESS
    return shortest
