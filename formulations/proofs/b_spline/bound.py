"""Certified lower bound of a B-spline: no waypoint times fit into a total time L.

Coordinates. t_i, the times of the inner waypoints; t_0 = 0 and t_n = L. A motion that takes less than L is
stretched to L. A box of them is discarded in one of two ways:

travel      the durations are too short for what speed and acceleration allow any motion (``travel``)
conditions  a sum of conditions with multipliers >= 0 is positive all over the box. The conditions are the
            limits at fixed shares of fixed knot spans; each is enclosed by a Taylor model of third order
            (``taylor``, ``basis``, ``control_points``, ``conditions``)

Near the optimum fewer limits are active than there are durations, so the curvature of the Lagrangian
decides: that is why a model keeps its second order. Third order narrows the rests on larger boxes.

Events of the certificate: those of ``events``, the variables counted by the waypoint; ["T", lo, hi] gives
the box after the cut by travel.
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.b_spline.basis import forms_of
from formulations.proofs.b_spline.control_points import SplineData
from formulations.proofs.b_spline.search import MOST_ROWS, STACK, branch_and_bound
from formulations.proofs.domain import LESS, MORE, data_of, duration_domain
from formulations.proofs.events import Effort, EventTrace
from formulations.proofs.proof import NARROW, ProofSearch, Prover

_SHORT = 1e-10  # of L: the least duration of a motion that is tried


def prover_of(degree: int) -> Prover:
    """Make the prover of one degree.

    Parameters
    ----------
    degree : int
        3 or 5.

    Returns
    -------
    Prover
        Sets up an attempt to prove that no B-spline of this degree takes L seconds or less.
    """

    def begin(
        problem: Problem,
        L: float,
        *,
        near: Array | None = None,
        narrow: float = NARROW,
        aside: bool = False,
        blur: Array | None = None,
    ) -> ProofSearch:
        return _search(problem, degree, L, narrow, aside, blur)

    return begin


def _search(
    problem: Problem, degree: int, L: float, narrow: float, aside: bool, blur: Array | None
) -> ProofSearch:
    """Set up one attempt."""
    source = data_of(problem, blur)
    n = len(source.d)
    moved = np.zeros_like(source.d) if blur is None else blur[:, problem.moving_joints]
    acceleration = np.minimum(source.derivatives[1], source.derivatives[2] * L * 0.5 * MORE)
    data = SplineData(
        forms_of(n, degree),
        np.ascontiguousarray(problem.waypoints[:, problem.moving_joints]),
        np.vstack([np.zeros_like(moved[:1]), np.cumsum(moved, axis=0)]) * MORE,
        source.derivatives, source.room_below[0], source.room_above[0],
        np.ascontiguousarray(source.least), np.sign(source.d), source.speed(L), acceleration,
    )  # fmt: skip
    domain = duration_domain(source.shortest(L), L)
    stack = np.zeros((STACK, 2, n + 1))
    before = np.concatenate([[0.0], np.cumsum(domain.shortest)])
    stack[0, 0, 1:n] = before[1:n] * LESS
    # a difference: its rounding is relative to L
    stack[0, 1, 1:n] = (L - (before[n] - before[1:n])) * MORE + 1e-14 * L
    stack[0, :, n] = L

    def advance(depth: int, max_boxes: int, trace: EventTrace) -> tuple[int, bool]:
        return branch_and_bound(stack, depth, data, Effort(max_boxes, narrow, aside), trace)

    def durations(depth: int) -> Array:
        # where nothing moves, waypoints may coincide
        return np.maximum(np.diff(0.5 * (stack[depth - 1, 0] + stack[depth - 1, 1])), _SHORT * L)

    return ProofSearch(n + 1, MOST_ROWS, 0 if domain.empty else 1, advance, durations, turns_cut=True)
