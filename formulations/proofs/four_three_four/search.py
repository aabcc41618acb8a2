"""4-3-...-3-4: branch and bound over the box of x = 1 / T."""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled, inlined
from formulations.proofs.arithmetic.outward import down, up
from formulations.proofs.conditions import MARGIN, MULTIPLIER
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
    write,
)
from formulations.proofs.four_three_four.branching import choose_variable, middle_of, push_both_halves
from formulations.proofs.four_three_four.conditions import candidates, linearise
from formulations.proofs.four_three_four.data import (
    empty_enclosure,
    empty_form,
    empty_reference,
    empty_sums,
)
from formulations.proofs.four_three_four.lagrangian import share_least, sum_rows
from formulations.proofs.four_three_four.reference import place_reference
from formulations.proofs.four_three_four.velocities import enclose
from formulations.proofs.multipliers import minimax

STACK = 2000
_TURNS = 6  # rounds of cuts on one box before it is split
_SWEEPS = 2  # of the enclosure of the velocities per round


@inlined
def _cut_by_total(box: Any, data: Any) -> bool:
    """Cut the box by T_k = L - the others, twice; returns False if nothing is left.

    The least time of the others is the most that the parts and the ends of x imply together.
    """
    lo, hi, n, L, parts = box.lo, box.hi, data.n, data.L, data.parts
    before, after = np.zeros((2, n + 1))
    for _ in range(2):
        t_hi = 0.0
        for k in range(n):
            t_hi = up(t_hi + up(1.0 / lo[k]))
            before[k + 1] = down(before[k] + down(1.0 / hi[k]))
            for p in range(len(parts)):
                if parts[p, 1] == k + 1:
                    before[k + 1] = max(before[k + 1], down(before[int(parts[p, 0])] + parts[p, 2]))
        for k in range(n - 1, -1, -1):
            after[k] = down(after[k + 1] + down(1.0 / hi[k]))
            for p in range(len(parts)):
                if parts[p, 0] == k:
                    after[k] = max(after[k], down(after[int(parts[p, 1])] + parts[p, 2]))
        for k in range(n):
            most = up(L - down(before[k] + after[k + 1]))
            least = down(L - up(t_hi - down(1.0 / lo[k])))
            if not most > 0.0:
                return False
            lo[k] = max(lo[k], down(1.0 / most))
            if least > 0.0:
                hi[k] = min(hi[k], up(1.0 / least))
            if not lo[k] <= hi[k]:
                return False
    return True


@inlined
def _narrowed(box: Any, data: Any, reference: Any, velocities: Any, trace: Any, few: Any) -> bool:
    """Cut the box by the total, enclose the velocities on it; returns False if nothing is left."""
    left = _cut_by_total(box, data)
    write(trace, TURN, 0, 0.0, box, few, 0)
    if left:
        place_reference(reference, box, data, velocities)
        for j in range(data.d.shape[1]):
            for _ in range(_SWEEPS):
                left = left and enclose(j, data, box, reference, velocities)
    return left


@compiled
def _single_row(k: int, side: int, count: int, form: Any) -> tuple[int, float]:
    """Row that cuts most off variable k at one side to first order, and where, in [-1, 1]."""
    a, g = form.a, form.g
    best, where = -1, 1.0
    sign = 1.0 - 2.0 * side
    for i in range(count):
        if not sign * g[i, k] > 0.0:
            continue
        y = -a[i]
        for m in range(g.shape[1]):
            if m != k:
                y += abs(g[i, m])
        y /= sign * g[i, k]
        if y < where:
            best, where = i, y
    return best, max(-1.0, where)


@inlined
def _choose_rows(form: Any, count: int, n_segments: int) -> int:
    """Put the rows with the multipliers of the linear program into ``few``; returns their number.

    How much they depend on each velocity at a free end is kept for the choice of the variable to split.
    """
    few, lam, n = form.few, form.multipliers, form.g.shape[1]
    minimax(form.a, form.g, count, n, lam, 200)
    for k in range(n_segments, n):
        form.smear[k] = 0.0
        for i in range(count):
            form.smear[k] += lam[i] * abs(form.g[i, k])
    kept = 0
    for i in range(count):
        if lam[i] > 1e-13 and kept < n + 1:
            copy(few[kept], form.rows[i])
            few[kept, MULTIPLIER] = lam[i]
            kept += 1
    return kept


@inlined
def _cut_slabs(
    const: float, target: Any, kept: int, form: Any, sums: Any, box: Any, reference: Any, trace: Any
) -> tuple[bool, bool]:
    """Cut off slabs on which the Lagrangian is positive.

    target: the slab of a single row and where it begins, (2 k + side, e in [-1, 1]), or (-1, 0.0) for
    slabs of the box at both ends of every variable. Returns whether nothing is left, and whether
    enough was cut for another turn.
    """
    single, where = target
    lo, hi, c, least, shares = box.lo, box.hi, reference.c, sums.least, sums.shares
    n = len(c)
    gone, cut = False, False
    for each in range(2 * n):
        k, side = each // 2, each % 2
        if reference.is_open[k] or (single >= 0 and each != single):
            continue
        others = const
        for m in range(n):
            if m != k:
                others = down(others + least[m])
        width = hi[k] - lo[k]
        part = 0.5
        for _ in range(3 if single < 0 else 1):
            if single >= 0:
                edge = c[k] + (1.0 - 2.0 * side) * (where * reference.half[k] + 1e-6 * width)
            else:
                edge = hi[k] - part * width if side == 0 else lo[k] + part * width
            edge = min(max(edge, lo[k]), hi[k])
            s_lo, s_hi = (edge, hi[k]) if side == 0 else (lo[k], edge)
            if s_lo < s_hi and down(others + share_least(shares[k], c[k], s_lo, s_hi)) > MARGIN:
                trace.counts[SLABS] += 1
                if side == 0:
                    hi[k] = edge
                else:
                    lo[k] = edge
                write(trace, BELOW + side, k, edge, box, form.few, kept)
                cut = cut or single >= 0 or part > 0.2
                gone = gone or not lo[k] < hi[k]
                break
            part *= 0.5
    return gone, cut


@inlined
def _try_discards(
    form: Any, count: int, data: Any, box: Any, reference: Any, velocities: Any, sums: Any, trace: Any
) -> tuple[bool, bool]:
    """Discard the whole box, or slabs of it, by all rows together and then by single rows.

    Returns whether nothing is left, and whether enough was cut for another turn.
    """
    n, lo, hi = data.n, box.lo, box.hi
    kept = _choose_rows(form, count, n)
    cut = False
    for single in range(-1, 2 * n):
        where = 0.0
        if single >= 0:
            if reference.is_open[single // 2]:
                continue
            i, where = _single_row(single // 2, single % 2, count, form)
            if i < 0 or where > 0.9:
                continue
            copy(form.few[0], form.rows[i])
            form.few[0, MULTIPLIER] = 1.0
            kept = 1
        const = sum_rows(form.few, kept, data, box, reference, velocities, sums)
        total = const
        for k in range(n):
            sums.least[k] = share_least(sums.shares[k], reference.c[k], lo[k], hi[k])
            total = down(total + sums.least[k])
        if total > MARGIN:
            trace.counts[LEAVES] += 1
            write(trace, LEAF, 0, 0.0, box, form.few, kept)
            return True, cut
        gone, more = _cut_slabs(const, (single, where), kept, form, sums, box, reference, trace)
        cut = cut or more
        if gone:  # the closed slabs cover the box
            trace.counts[EMPTIES] += 1
            write(trace, EMPTY, 0, 0.0, box, form.few, 0)
            return True, cut
    return False, cut


@inlined
def _reduced_to_nothing(
    box: Any, data: Any, reference: Any, velocities: Any, form: Any, sums: Any, trace: Any
) -> bool:
    """Narrow the box turn by turn as long as that helps; returns whether nothing is left."""
    form.smear[:] = 0.0
    for _ in range(_TURNS):
        if not _narrowed(box, data, reference, velocities, trace, form.few):
            trace.counts[EMPTIES] += 1
            write(trace, EMPTY, 0, 0.0, box, form.few, 0)
            return True
        count = candidates(form.rows, data, reference)
        count = linearise(form, count, data, box, reference, velocities)
        if count == 0:
            return False
        gone, cut = _try_discards(form, count, data, box, reference, velocities, sums, trace)
        if gone:
            return True
        if not cut:
            return False
    return False


@compiled
def branch_and_bound(
    stack: Any, stack_v: Any, depth: int, data: Any, effort: Any, trace: Any
) -> tuple[int, bool]:
    """Work on the boxes of a stack.

    The search also stops when the log is nearly full.

    Parameters
    ----------
    stack : ndarray, shape (STACK, 2, n)
        Lower and upper ends of x per box, the next box last.
    stack_v : ndarray, shape (STACK, 2, dof, n + 1)
        Enclosures of the velocities at all waypoints per box.
    depth : int
        Number of boxes.
    data : RateData
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
    n, dof = data.n, data.d.shape[1]
    form, sums = empty_form(data), empty_sums(n, dof)
    reference, velocities = empty_reference(n, dof), empty_enclosure(n, dof)
    box = Box(np.empty(n), np.empty(n))
    lo, hi = box
    last = trace.counts[BOXES] + effort.max_boxes
    while depth > 0 and trace.counts[BOXES] < last and has_room(trace, _TURNS * (4 * n + 2) + 2):
        depth -= 1
        copy(lo, stack[depth, 0])
        copy(hi, stack[depth, 1])
        for j in range(dof):
            copy(velocities.lo[j], stack_v[depth, 0, j])
            copy(velocities.hi[j], stack_v[depth, 1, j])
        trace.counts[BOXES] += 1
        if _reduced_to_nothing(box, data, reference, velocities, form, sums, trace):
            continue
        x, widest = choose_variable(box, data, velocities, form.smear)
        if widest < effort.narrow or depth > STACK - 3:
            if not effort.aside:
                copy(stack[depth, 0], lo)
                copy(stack[depth, 1], hi)
                return depth + 1, True
            write(trace, ASIDE, 0, 0.0, box, form.few, 0)
            continue
        middle = middle_of(box, x, data, velocities)
        depth = push_both_halves(stack, stack_v, depth, box, x, middle, data, velocities)
        write(trace, SPLIT, x, middle, box, form.few, 0)
    return depth, False
