"""4-3-...-3-4: branch and bound over the box of x = 1 / T."""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.arithmetic.outward import down, up
from formulations.proofs.events import (
    ASIDE,
    BELOW,
    BOXES,
    EMPTIES,
    EMPTY,
    EVENTS,
    LEAF,
    LEAVES,
    SLABS,
    SPLIT,
    TURN,
    copy,
    write,
)
from formulations.proofs.four_three_four.lagrangian import lagrangian, share_least
from formulations.proofs.four_three_four.rows import candidates, linear
from formulations.proofs.four_three_four.velocities import (
    centres,
    enclose,
    inverse,
    inverse_rest,
    velocities,
)
from formulations.proofs.multipliers import minimax
from formulations.proofs.rows import MARGIN, MULTIPLIER, WIDTH

STACK = 2000
_TURNS = 6
_SWEEPS = 2


def events_per_box(n: int) -> int:
    """Most events of one box with n segments."""
    return _TURNS * (4 * n + 2) + 2


@compiled
def cut_by_total(lo: Any, hi: Any, n: int, L: float) -> bool:
    """Cut the box by T_k = L - the others, twice; returns False if nothing is left."""
    for _ in range(2):
        t_lo, t_hi = 0.0, 0.0
        for k in range(n):
            t_lo, t_hi = down(t_lo + down(1.0 / hi[k])), up(t_hi + up(1.0 / lo[k]))
        for k in range(n):
            most = up(L - down(t_lo - up(1.0 / hi[k])))
            least = down(L - up(t_hi - down(1.0 / lo[k])))
            if not most > 0.0:
                return False
            lo[k] = max(lo[k], down(1.0 / most))
            if least > 0.0:
                hi[k] = min(hi[k], up(1.0 / least))
            if not lo[k] <= hi[k]:
                return False
    return True


@compiled
def _single_row(k: int, side: int, count: int, n: int, a: Any, g: Any) -> tuple[int, float]:
    """Row that cuts most off variable k at one side to first order, and where, in [-1, 1]."""
    best, where = -1, 1.0
    sign = 1.0 - 2.0 * side
    for i in range(count):
        if not sign * g[i, k] > 0.0:
            continue
        y = -a[i]
        for m in range(n):
            if m != k:
                y += abs(g[i, m])
        y /= sign * g[i, k]
        if y < where:
            best, where = i, y
    return best, max(-1.0, where)


@compiled
def search(
    stack: Any, stack_v: Any, depth: int, d: Any, data: Any, n: int, L: float, floor: float,
    max_boxes: int, narrow: float, aside: bool, counts: Any, log: Any,
) -> tuple[int, bool]:  # fmt: skip
    """Work on the boxes in stack[:depth], at most max_boxes of them; returns (depth left, stuck).

    stack: (STACK, 2, n) lower and upper ends of x, the next box last; stack_v: (STACK, 2, dof, n + 1)
    the enclosures of the velocities at all waypoints. floor: an open segment no longer than this [s] is
    not split further. The rest as in the search of 3-5-3.
    """
    d_lo, d_hi = data[0], data[1]
    dof = d.shape[1]
    cap = dof * n * 17 + 1
    rows, few = np.zeros((cap, WIDTH)), np.zeros((n + 1, WIDTH))
    a, g, lam = np.empty(cap), np.empty((cap, n)), np.empty(cap)
    C, rest = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
    vc, G, R = np.zeros((dof, n + 1)), np.zeros((dof, n + 1, n)), np.zeros((dof, n + 1))
    V_lo, V_hi = np.zeros((dof, n + 1)), np.zeros((dof, n + 1))
    form, share = np.zeros((n, 6)), np.empty(n)
    lo, hi, c, half, is_open = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.zeros(n, np.bool_)
    ce, state = np.zeros((n + 1, 2)), np.zeros((n + 1, 2), np.int64)
    xi_lo, xi_hi = np.zeros(n + 1), np.zeros(n + 1)
    last = counts[BOXES] + max_boxes
    capacity = len(log[0])
    while depth > 0 and counts[BOXES] < last:
        if capacity > 0 and counts[EVENTS] + _TURNS * (4 * n + 2) + 2 > capacity:
            break
        depth -= 1
        copy(lo, stack[depth, 0])
        copy(hi, stack[depth, 1])
        for j in range(dof):
            copy(V_lo[j], stack_v[depth, 0, j])
            copy(V_hi[j], stack_v[depth, 1, j])
        counts[BOXES] += 1
        gone = False
        for _ in range(_TURNS):
            gone = not cut_by_total(lo, hi, n, L)
            write(log, counts, TURN, 0, 0.0, lo, hi, few, 0)
            if gone:
                counts[EMPTIES] += 1
                write(log, counts, EMPTY, 0, 0.0, lo, hi, few, 0)
                break
            for k in range(n):
                is_open[k] = hi[k] == np.inf
                c[k] = lo[k] if is_open[k] else 0.5 * (lo[k] + hi[k])
                half[k] = 0.0 if is_open[k] else 0.5 * (hi[k] - lo[k])
            centres(c, is_open, n, ce, state)
            inverse(ce, n, C)
            inverse_rest(ce, C, n, rest)
            velocities(d, ce, C, n, vc)
            for j in range(dof):
                for _ in range(_SWEEPS):
                    gone = gone or not enclose(
                        j,
                        d,
                        d_lo,
                        d_hi,
                        lo,
                        hi,
                        c,
                        ce,
                        state,
                        C,
                        rest,
                        vc,
                        n,
                        V_lo,
                        V_hi,
                        G,
                        R,
                        xi_lo,
                        xi_hi,
                    )
            if gone:
                counts[EMPTIES] += 1
                write(log, counts, EMPTY, 0, 0.0, lo, hi, few, 0)
                break
            count = candidates(rows, d, data, c, is_open, vc, n)
            count = linear(rows, count, d, data, n, L, c, lo, half, is_open, vc, G, R, a, g)
            if count == 0:
                break
            minimax(a, g, count, n, lam, 200)
            kept = 0
            for i in range(count):
                if lam[i] > 1e-13 and kept < n + 1:
                    copy(few[kept], rows[i])
                    few[kept, MULTIPLIER] = lam[i]
                    kept += 1
            # the whole box, then slabs of it, and last the slabs that single rows discard
            cut = False
            for single in range(-1, 2 * n):
                if single >= 0:
                    k, side = single // 2, single % 2
                    if is_open[k]:
                        continue
                    i, where = _single_row(k, side, count, n, a, g)
                    if i < 0 or where > 0.9:
                        continue
                    copy(few[0], rows[i])
                    few[0, MULTIPLIER] = 1.0
                    kept = 1
                const = lagrangian(few, kept, data, n, L, lo, hi, c, ce, state, C, V_lo, V_hi, form)
                total = const
                for k in range(n):
                    share[k] = share_least(form, k, c[k], lo[k], hi[k])
                    total = down(total + share[k])
                if total > MARGIN:
                    gone = True
                    counts[LEAVES] += 1
                    write(log, counts, LEAF, 0, 0.0, lo, hi, few, kept)
                    break
                for each in range(2 * n):
                    k, side = each // 2, each % 2
                    if is_open[k] or (single >= 0 and each != single):
                        continue
                    others = const
                    for m in range(n):
                        if m != k:
                            others = down(others + share[m])
                    width = hi[k] - lo[k]
                    part = 0.5
                    for _ in range(3 if single < 0 else 1):
                        if single >= 0:
                            edge = c[k] + (1.0 - 2.0 * side) * (where * half[k] + 1e-6 * width)
                        else:
                            edge = hi[k] - part * width if side == 0 else lo[k] + part * width
                        edge = min(max(edge, lo[k]), hi[k])
                        s_lo, s_hi = (edge, hi[k]) if side == 0 else (lo[k], edge)
                        if (
                            s_lo < s_hi
                            and down(others + share_least(form, k, c[k], s_lo, s_hi)) > MARGIN
                        ):
                            counts[SLABS] += 1
                            if side == 0:
                                hi[k] = edge
                            else:
                                lo[k] = edge
                            write(log, counts, BELOW + side, k, edge, lo, hi, few, kept)
                            cut = cut or single >= 0 or part > 0.2
                            gone = gone or not lo[k] < hi[k]
                            break
                        part *= 0.5
                if gone:  # the closed slabs cover the box
                    counts[EMPTIES] += 1
                    write(log, counts, EMPTY, 0, 0.0, lo, hi, few, 0)
                    break
            if gone or not cut:
                break
        if gone:
            continue
        x, widest = 0, -1.0
        for k in range(n):
            width = np.log(hi[k] / lo[k]) if hi[k] < np.inf else np.log(1.0 / (lo[k] * floor))
            if width > widest:
                x, widest = k, width
        if widest < narrow or depth > STACK - 3:
            if not aside:
                copy(stack[depth, 0], lo)
                copy(stack[depth, 1], hi)
                return depth + 1, True
            write(log, counts, ASIDE, 0, 0.0, lo, hi, few, 0)
            continue
        middle = np.sqrt(lo[x] * hi[x]) if hi[x] < np.inf else np.sqrt(lo[x] / floor)
        for child in range(2):
            copy(stack[depth, 0], lo)
            copy(stack[depth, 1], hi)
            for j in range(dof):
                copy(stack_v[depth, 0, j], V_lo[j])
                copy(stack_v[depth, 1, j], V_hi[j])
            stack[depth, 1 - child, x] = middle
            depth += 1
        write(log, counts, SPLIT, x, middle, lo, hi, few, 0)
    return depth, False
