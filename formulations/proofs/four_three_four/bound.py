"""Certified lower bound of the 4-3-...-3-4 spline: no durations fit into a total time L.

Coordinates. x_k = 1 / T_k of the n segments, and per joint the velocities v_1 .. v_{n-1} at the inner
waypoints (v_0 = v_n = 0). The search branches on x only; v is enclosed (``velocities``).

Conditions. Each is linear in v, with coefficients linear in x, plus separable powers of x:

    knot(j,i)   2 x_{i-1} v_{i-1} + (wl x_{i-1} + wr x_i) v_i + 2 x_i v_{i+1}
                    - pl d_{i-1} x_{i-1}^2 - pr d_i x_i^2 = 0     (w, p = 4, 6; 6, 12 at the end pieces)
    piece(j,k,r,s,sign)   sign u - limit / x_k^(r-1) <= 0, r = 1, 2, 3;  sign u - room x_k <= 0, r = 0;
                          u = Pd(s) d_k x_k + P0(s) v_k + P1(s) v_{k+1}
    total       sum_k 1 / x_k - L <= 0                                   (in fact = 0)
    jump(j,k,sign)  (open segments only)  sign (S_k + S_{k+1}) - J / x_k <= 0, where S_i is the share in
                    knot i's equation of the segment beside k: S_k = a(knot k), S_{k+1} = -a(knot k+1),
                    a(0) = a(n) = 0

with integer polynomials P of the normalised time s.

Proof. Boxes, and slabs of boxes, are discarded by a positive Lagrangian (``lagrangian``).

Parts. ``parts`` proves, for sub-chains of segments whose end velocities are free, that they take more
than some time b in every motion of at most H >= L seconds. Then b - sum of their 1/x_k <= 0 is a row as well,
and cuts the box together with the total.

Domain. T_k >= t_k = max |d_k| / v, v a bound on the joint's speed; T_k <= L - sum of the other t. A
segment on which nothing moves has t_k = 0 and x_k up to infinity: the box is 'open' there, T_k in
[0, 1 / x_lo].
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.domain import LESS, MORE, ProblemData, data_of, duration_domain
from formulations.proofs.events import Effort, EventTrace
from formulations.proofs.four_three_four.branching import SHORT
from formulations.proofs.four_three_four.data import BASIS, RateData
from formulations.proofs.four_three_four.ends import n_variables
from formulations.proofs.four_three_four.search import STACK, branch_and_bound
from formulations.proofs.part import PartBound
from formulations.proofs.proof import NARROW, ProofSearch


def begin(
    problem: Problem,
    L: float,
    *,
    near: Array | None = None,
    narrow: float = NARROW,
    aside: bool = False,
    blur: Array | None = None,
    parts: Sequence[PartBound] = (),
) -> ProofSearch:
    """Set up the attempt to prove that no 4-3-...-3-4 motion takes L seconds or less.

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
    parts : sequence of PartBound
        Bounds of parts that are proved already, for the same ``blur`` and a horizon of L at least.

    Returns
    -------
    ProofSearch
        The search, at its beginning.
    """
    source = data_of(problem, blur)
    return search_of(source, (0, len(source.d)), L, L, parts, narrow=narrow, aside=aside)


def search_of(
    source: ProblemData,
    part: tuple[int, int],
    L: float,
    horizon: float,
    parts: Sequence[PartBound],
    *,
    narrow: float = NARROW,
    aside: bool = False,
) -> ProofSearch:
    """Set up the attempt to prove that a part takes more than L in every motion of at most horizon seconds.

    Parameters
    ----------
    source : ProblemData
        Displacements and limits of the whole.
    part : (int, int)
        First segment, and the one after the last.
    L : float [s]
        The bound to prove.
    horizon : float [s]
        Most time of the whole motion.
    parts : sequence of PartBound
        Bounds that are proved already; those of parts within this one are used.
    narrow, aside : optional
        As in ``formulations.proofs.proof.Prover``.

    Returns
    -------
    ProofSearch
        The search, at its beginning.
    """
    start, end = part
    n, dof, inside = end - start, source.d.shape[1], slice(start, end)
    known = tuple(p for p in parts if start <= p.start and p.end <= end)
    speed = source.speed(horizon)
    first, last = 1 if start == 0 else 0, n - 1 if end == len(source.d) else n
    data = RateData(
        n, (n, first, last),
        source.d[inside], source.d_lo[inside], source.d_hi[inside], source.derivatives,
        np.ascontiguousarray(source.room_below[inside]), np.ascontiguousarray(source.room_above[inside]),
        BASIS, L, speed,
        np.array([(p.start - start, p.end - start, p.seconds) for p in known]).reshape(-1, 3),
    )  # fmt: skip
    domain = duration_domain(source.shortest(horizon)[inside], L)
    stack, stack_v = np.empty((STACK, 2, n)), np.empty((STACK, 2, dof, n + 1))
    if not domain.empty:
        stack[0] = LESS / domain.longest, np.full(n, inf)
        moving = domain.shortest > 0.0
        stack[0, 1, moving] = MORE / domain.shortest[moving]
        stack_v[0] = 0.0
        stack_v[0, 1, :, first : last + 1] = speed[:, None]
        stack_v[0, 0] = -stack_v[0, 1]

    def advance(depth: int, max_boxes: int, trace: EventTrace) -> tuple[int, bool]:
        effort = Effort(max_boxes, narrow, aside)
        return branch_and_bound(stack, stack_v, depth, data, effort, trace)

    def durations(depth: int) -> Array:
        lo, hi = stack[depth - 1]
        closed = hi < inf
        # an open segment may be as short as it likes
        return np.where(closed, 1.0 / np.sqrt(lo * np.where(closed, hi, 1.0)), SHORT * L)

    rows = n_variables(data.ends, dof) + 1
    return ProofSearch(n, rows, 0 if domain.empty else 1, advance, durations, parts=known)
