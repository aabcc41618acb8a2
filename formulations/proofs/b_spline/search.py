"""B-splines: branch and bound over boxes of waypoint times."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.b_spline.conditions import candidates, condition_model
from formulations.proofs.b_spline.control_points import empty_reference, place_reference
from formulations.proofs.b_spline.least import least_on, least_separable
from formulations.proofs.b_spline.taylor import (
    CUBE,
    REST,
    SLOPES,
    VALUE,
    add_scaled,
    clear,
    close,
    size_of,
    width_of,
)
from formulations.proofs.b_spline.travel import cut_by_travel
from formulations.proofs.conditions import MARGIN, MULTIPLIER, SCALE, WIDTH
from formulations.proofs.events import (
    ASIDE,
    BELOW,
    BOXES,
    EMPTIES,
    EMPTY,
    LEAF,
    LEAVES,
    SLABS,
    SPLIT,
    TURN,
    Box,
    copy,
    has_room,
    push_halves,
    write,
)
from formulations.proofs.multipliers import minimax

STACK = 2000
_TURNS = 4  # rounds of cuts on one box before it is split
_ROUNDS = 2  # of cuts by travel per turn
_FEW, _MANY = 3, 12  # conditions that are modelled at first, and in all
_BENT = 0.5  # share of a condition's own curvature that the linear program counts
_NARROW = 0.05  # of the widest variable: a narrower one is not split
_RESTS = 6.0  # weight of a rest beside a slope in the choice of the variable to split


class Posed(NamedTuple):
    """Conditions posed on a box.

    found (most, WIDTH), scores (most,): all; models (_MANY, width), rows (_MANY, WIDTH): those modelled.
    a, g, multipliers: of the linear program. few (_MANY, WIDTH): with a multiplier. total (width,): model
    of their sum; least, own (n-1,): its quadratics. smear (n-1,): what a split of each variable promises.
    lengths, pieces: scratch for ``candidates``.
    """

    found: Any
    scores: Any
    models: Any
    rows: Any
    a: Any
    g: Any
    multipliers: Any
    few: Any
    total: Any
    least: Any
    own: Any
    smear: Any
    lengths: Any
    pieces: Any


MOST_ROWS = _MANY


@compiled
def _empty_posed(forms: Any, dof: int) -> Posed:
    m, most, width = forms.n - 1, 40 * dof * forms.spans, width_of(forms.n - 1)
    return Posed(
        np.zeros((most, WIDTH)), np.zeros(most), np.zeros((_MANY, width)), np.zeros((_MANY, WIDTH)),
        np.zeros(_MANY), np.zeros((_MANY, m)), np.zeros(_MANY), np.zeros((_MANY, WIDTH)),
        np.zeros(width), np.zeros(m), np.zeros(m), np.zeros(m),
        np.zeros((1, forms.spans)), np.zeros((1, forms.spans, dof, 6)),
    )  # fmt: skip


@compiled
def _narrowed(box: Any, data: Any, times: Any, trace: Any, few: Any) -> bool:
    """Cut the box by what holds for every motion; returns whether anything is left."""
    lo, hi = box
    shortest, longest, v_lo, v_hi = times
    left, before = True, 0.0
    for _ in range(_ROUNDS):
        left = left and cut_by_travel(lo, hi, shortest, longest, data, v_lo, v_hi)
        width = 0.0
        for k in range(len(lo)):
            width += hi[k] - lo[k]
        if not left or width > 0.98 * before > 0.0:
            break
        before = width
    write(trace, TURN, 0, 0.0, box, few, 0)
    return left


@compiled
def _model_conditions(
    posed: Any, order: Any, first: int, last: int, kept: int, data: Any, ref: Any
) -> int:
    """Model conditions first .. last - 1; returns the number of models."""
    m = posed.g.shape[1]
    for r in range(first, last):
        model = posed.models[kept]
        copy(posed.rows[kept], posed.found[order[r]])
        if not condition_model(posed.rows[kept], data, ref, model):
            continue
        size = posed.rows[kept, SCALE]
        least_separable(m, model, posed.least, posed.own)  # fills in the curvatures
        # to first order and with a share of the curvature, as a sum of conditions may cancel it
        y = model[VALUE] - model[REST] - model[CUBE]
        for q in range(m):
            posed.g[kept, q] = model[SLOPES + q] / size
            y += _BENT * min(0.0, posed.own[q])
        posed.a[kept] = y / size
        kept += 1
    return kept


@compiled
def _sum_up(posed: Any, count: int) -> tuple[int, float]:
    """Choose multipliers and add up; returns the number of rows and the lower bound of the sum."""
    m, few, total = posed.g.shape[1], posed.few, posed.total
    minimax(posed.a, posed.g, count, m, posed.multipliers, 200)
    kept = 0
    clear(total)
    for i in range(count):
        if posed.multipliers[i] > 1e-13:
            copy(few[kept], posed.rows[i])
            few[kept, MULTIPLIER] = posed.multipliers[i]
            # this float is the multiplier
            add_scaled(few[kept, MULTIPLIER] / few[kept, SCALE], posed.models[i], total)
            kept += 1
    close(m, total)
    return kept, least_separable(m, total, posed.least, posed.own)


@compiled
def _cut_slabs(bound: float, kept: int, posed: Any, box: Any, ref: Any, trace: Any) -> bool:
    """Cut off slabs on which the sum is positive; returns whether enough was cut for another turn."""
    lo, hi, total = box.lo, box.hi, posed.total
    margin = MARGIN * (1.0 + size_of(total))
    cut = False
    for q in range(len(posed.own)):
        k = q + 1
        others, width = bound - posed.least[q], hi[k] - lo[k]
        for side in range(2):
            part = 0.5
            for _ in range(3):
                edge = hi[k] - part * width if side == 0 else lo[k] + part * width
                e = (edge - ref.c[k]) / ref.h[k]
                s_lo, s_hi = (max(e - 1e-15, -1.0), 1.0) if side == 0 else (-1.0, min(e + 1e-15, 1.0))
                inside = lo[k] < edge < hi[k]
                if inside and others + least_on(total[SLOPES + q], posed.own[q], s_lo, s_hi) > margin:
                    trace.counts[SLABS] += 1
                    if side == 0:
                        hi[k] = edge
                    else:
                        lo[k] = edge
                    write(trace, BELOW + side, k, edge, box, posed.few, kept)
                    cut = cut or part > 0.2
                    break
                part *= 0.5
    return cut


@compiled
def _reduced_to_nothing(box: Any, data: Any, ref: Any, posed: Any, times: Any, trace: Any) -> bool:
    """Narrow the box turn by turn as long as that helps; returns whether nothing is left."""
    m = data.forms.n - 1
    for _ in range(_TURNS):
        for q in range(m):
            posed.smear[q] = 0.0
        if not _narrowed(box, data, times, trace, posed.few):
            trace.counts[EMPTIES] += 1
            write(trace, EMPTY, 0, 0.0, box, posed.few, 0)
            return True
        if not place_reference(data.forms, box.lo, box.hi, ref):
            return False
        found = candidates(posed.found, posed.scores, data, ref.c, posed.lengths, posed.pieces)
        order = np.argsort(-posed.scores[:found])
        count, first, kept, bound = 0, 0, 0, 0.0
        for last in (_FEW, _MANY):
            count = _model_conditions(posed, order, first, min(last, found), count, data, ref)
            if count == 0:
                return False
            kept, bound = _sum_up(posed, count)
            if bound > MARGIN * (1.0 + size_of(posed.total)):
                trace.counts[LEAVES] += 1
                write(trace, LEAF, 0, 0.0, box, posed.few, kept)
                return True
            if found <= last:
                break
            first = last
        wide = 0.0
        for k in range(1, m + 1):
            wide += ref.h[k]
        for q in range(m):
            rest = posed.total[REST] + posed.total[CUBE]
            posed.smear[q] = abs(posed.total[SLOPES + q]) + _RESTS * rest * ref.h[q + 1] / wide
        if not _cut_slabs(bound, kept, posed, box, ref, trace):
            return False
    return False


@compiled
def branch_and_bound(stack: Any, depth: int, data: Any, effort: Any, trace: Any) -> tuple[int, bool]:
    """Work on the boxes of a stack.

    The search also stops when the log is nearly full.

    Parameters
    ----------
    stack : ndarray, shape (STACK, 2, n+1)
        Lower and upper ends of the waypoint times per box, the next box last.
    depth : int
        Number of boxes.
    data : SplineData
        The task.
    effort : Effort
        Number of boxes, and what happens to undecided ones.
    trace : EventTrace
        Counters and log.

    Returns
    -------
    depth : int
        Boxes that are left; 0: the bound is proved, unless boxes were set aside.
    stuck : bool
        Whether the box at depth - 1 is undecided and too narrow to be split.
    """
    forms = data.forms
    n, dof = forms.n, data.x.shape[1]
    ref, posed = empty_reference(n, forms.degree, dof), _empty_posed(forms, dof)
    times = (np.zeros(n), np.zeros(n), np.zeros(n + 1), np.zeros(n + 1))
    box = Box(np.empty(n + 1), np.empty(n + 1))
    lo, hi = box
    last = trace.counts[BOXES] + effort.max_boxes
    while depth > 0 and trace.counts[BOXES] < last and has_room(trace, _TURNS * (2 * n + 1) + 2):
        depth -= 1
        copy(lo, stack[depth, 0])
        copy(hi, stack[depth, 1])
        trace.counts[BOXES] += 1
        if _reduced_to_nothing(box, data, ref, posed, times, trace):
            continue
        longest = 0.0
        for k in range(1, n):
            longest = max(longest, hi[k] - lo[k])
        x, most = 1, -1.0
        for k in range(1, n):
            width = hi[k] - lo[k]
            score = 0.0 if width < _NARROW * longest else posed.smear[k - 1] + 1e-9 * width
            if score > most:
                x, most = k, score
        if longest < effort.narrow * hi[n] or depth > STACK - 3:
            if not effort.aside:
                copy(stack[depth, 0], lo)
                copy(stack[depth, 1], hi)
                return depth + 1, True
            write(trace, ASIDE, 0, 0.0, box, posed.few, 0)
            continue
        middle = 0.5 * (lo[x] + hi[x])
        push_halves(stack, depth, box, x, middle)
        depth += 2
        write(trace, SPLIT, x, middle, box, posed.few, 0)
    return depth, False
