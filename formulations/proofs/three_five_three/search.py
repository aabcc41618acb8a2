"""3-5-3: branch and bound over the box of (r, q)."""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled, inlined
from formulations.proofs.conditions import MARGIN, MULTIPLIER, WIDTH
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
    Box,
    copy,
    has_room,
    push_halves,
    write,
)
from formulations.proofs.multipliers import minimax
from formulations.proofs.three_five_three.conditions import candidates, linearise
from formulations.proofs.three_five_three.data import RatioForm
from formulations.proofs.three_five_three.lagrangian import excess, middle_range

STACK = 400
MOST_ROWS = 4  # three variables: a basic solution has four multipliers
_TURNS = 8  # rounds of cuts on one box before it is split
_EVENTS_PER_BOX = 4 * _TURNS + 2


@inlined
def _discards(form: Any, n: int, few: Any, box: Any, data: Any) -> int:
    """Number of rows, in ``few``, whose Lagrangian is positive on the box; 0 if none was found."""
    rows, a, g, lam = form.rows, form.a, form.g, form.multipliers
    worst, alone = -1, 0.0
    for i in range(n):
        least = a[i] - abs(g[i, 0]) - abs(g[i, 1]) - abs(g[i, 2])
        if least > alone:
            worst, alone = i, least
    if worst >= 0:  # one row alone
        copy(few[0], rows[worst])
        few[0, MULTIPLIER] = 1.0
        if excess(few, 1, box, data) > MARGIN:
            return 1
    if minimax(a, g, n, 3, lam, 60) > -0.3:  # several rows together
        kept = 0
        for i in range(n):
            if lam[i] > 1e-14 and kept < MOST_ROWS:
                copy(few[kept], rows[i])
                few[kept, MULTIPLIER] = lam[i]
                kept += 1
        if excess(few, kept, box, data) > MARGIN:
            return kept
    return 0


@compiled
def _slab(form: Any, n: int, x: int, side: int) -> tuple[int, float]:
    """Row that cuts most off variable x at one side (0: above), and where, e in [-1, 1] times the sign."""
    a, g = form.a, form.g
    sign = 1.0 - 2.0 * side
    best, where = -1, 1.0
    for i in range(n):
        rest = a[i]
        for y in range(3):
            if y != x:
                rest -= abs(g[i, y])
        slope = sign * g[i, x]
        if slope > 0.0 and -rest / slope < where:
            where, best = -rest / slope, i
    return best, where


@inlined
def _cut_slabs(form: Any, n: int, few: Any, box: Any, data: Any, trace: Any) -> bool:
    """Cut off slabs of the box that single rows discard; returns whether any was."""
    lo, hi = box
    rows, middle, half = form.rows, form.c, form.h
    part = Box(np.empty(2), np.empty(2))
    cut = False
    for x in range(2):
        if not data.has[x] or half[x] <= 0.0:
            continue
        for side in range(2):
            i, e = _slab(form, n, x, side)
            if i < 0 or e > 0.9:
                continue
            e = max(-1.0, e + 1e-6)
            copy(part.lo, lo)
            copy(part.hi, hi)
            if side == 0:
                value = part.lo[x] = max(lo[x], middle[x] + e * half[x])
            else:
                value = part.hi[x] = min(hi[x], middle[x] - e * half[x])
            if not part.lo[x] < part.hi[x]:
                continue
            copy(few[0], rows[i])
            few[0, MULTIPLIER] = 1.0
            if excess(few, 1, part, data) > MARGIN:
                trace.counts[SLABS] += 1
                if side == 0:
                    hi[x] = value
                else:
                    lo[x] = value
                write(trace, BELOW + side, x, value, box, few, 1)
                cut = True
    return cut


@inlined
def _reduced_to_nothing(form: Any, few: Any, box: Any, data: Any, work: Any, trace: Any) -> bool:
    """Discard the box, or cut slabs off it as long as that helps; returns whether nothing is left."""
    lo, hi = box
    c, h = form.c, form.h
    for _ in range(_TURNS):
        t_lo, t_hi = middle_range(box, data)
        for x in range(2):
            c[x], h[x] = 0.5 * (lo[x] + hi[x]), 0.5 * (hi[x] - lo[x])
        c[2], h[2] = 0.5 * (t_lo + t_hi), 0.5 * (t_hi - t_lo)
        n = candidates(form, data, work)
        linearise(form, n, data)
        kept = _discards(form, n, few, box, data)
        if kept > 0:
            trace.counts[LEAVES] += 1
            write(trace, LEAF, 0, 0.0, box, few, kept)
            return True
        if not _cut_slabs(form, n, few, box, data, trace):
            return False
        for x in range(2):
            if data.has[x] and not lo[x] < hi[x]:  # the closed slabs together cover the box
                trace.counts[EMPTIES] += 1
                write(trace, EMPTY, 0, 0.0, box, few, 0)
                return True
    return False


@compiled
def branch_and_bound(stack: Any, depth: int, data: Any, effort: Any, trace: Any) -> tuple[int, bool]:
    """Work on the boxes of a stack.

    The search also stops when the log is nearly full.

    Parameters
    ----------
    stack : ndarray, shape (STACK, 2, 2)
        Lower and upper ends of (r, q) per box, the next box last.
    depth : int
        Number of boxes on it.
    data : RatioData
        The task.
    effort : Effort
        Number of boxes, and what happens to undecided ones.
    trace : EventTrace
        Counters and log.

    Returns
    -------
    depth : int
        Boxes that are left; 0: L is proved, unless boxes were set aside.
    stuck : bool
        Whether the box at depth - 1 is undecided and too narrow to be split.
    """
    has = data.has
    cap = 16 * data.d.shape[1] + 3
    form = RatioForm(
        np.empty(3), np.empty(3),
        np.zeros((cap, WIDTH)), np.empty(cap), np.empty((cap, 3)), np.empty(cap),
    )  # fmt: skip
    few = np.zeros((MOST_ROWS, WIDTH))
    work = np.zeros((8, 6))
    box = Box(np.empty(2), np.empty(2))
    lo, hi = box
    last = trace.counts[BOXES] + effort.max_boxes
    while depth > 0 and trace.counts[BOXES] < last and has_room(trace, _EVENTS_PER_BOX):
        depth -= 1
        copy(lo, stack[depth, 0])
        copy(hi, stack[depth, 1])
        trace.counts[BOXES] += 1
        if _reduced_to_nothing(form, few, box, data, work, trace):
            continue
        x, width = 0, -1.0
        for y in range(2):
            if has[y] and np.log(hi[y] / lo[y]) > width:
                x, width = y, np.log(hi[y] / lo[y])
        if width < effort.narrow or depth > STACK - 3:
            if not effort.aside:
                copy(stack[depth, 0], lo)
                copy(stack[depth, 1], hi)
                return depth + 1, True
            write(trace, ASIDE, 0, 0.0, box, few, 0)
            continue
        middle = np.sqrt(lo[x] * hi[x])
        push_halves(stack, depth, box, x, middle)
        depth += 2
        write(trace, SPLIT, x, middle, box, few, 0)
    return depth, False
