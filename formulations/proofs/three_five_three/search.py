"""3-5-3: branch and bound over the box of (r, q)."""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
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
    copy,
    write,
)
from formulations.proofs.multipliers import minimax
from formulations.proofs.rows import MARGIN, MULTIPLIER, WIDTH
from formulations.proofs.three_five_three.lagrangian import excess, middle_range
from formulations.proofs.three_five_three.rows import candidates, linear

STACK = 400
MOST_ROWS = 4  # three variables: a basic solution has four multipliers
_TURNS = 8
EVENTS_PER_BOX = 4 * _TURNS + 2


@compiled
def search(
    stack: Any, depth: int, d: Any, data: Any, has: Any, shortest: Any, L: float,
    max_boxes: int, narrow: float, aside: bool, counts: Any, log: Any,
) -> tuple[int, bool]:  # fmt: skip
    """Work on the boxes in stack[:depth], at most max_boxes of them; returns (depth left, stuck).

    stack: (STACK, 2, 2) lower and upper ends of (r, q), the next box last. Depth 0: nothing is left,
    L is proved. stuck: stack[depth - 1] is narrower than ``narrow`` (in its logarithm) and undecided;
    with ``aside`` such boxes are set aside instead and the search goes on (then nothing is proved).
    Stops early, too, when the log is nearly full.
    """
    rows = np.zeros((16 * d.shape[1] + 3, WIDTH))
    few = np.zeros((MOST_ROWS, WIDTH))
    a, g, lam = np.empty(len(rows)), np.empty((len(rows), 3)), np.empty(len(rows))
    work = np.zeros((8, 6))
    c, h = np.empty(3), np.empty(3)
    lo, hi, s_lo, s_hi = np.empty(2), np.empty(2), np.empty(2), np.empty(2)
    last = counts[BOXES] + max_boxes
    capacity = len(log[0])
    while depth > 0 and counts[BOXES] < last:
        if capacity > 0 and counts[EVENTS] + EVENTS_PER_BOX > capacity:
            break
        depth -= 1
        copy(lo, stack[depth, 0])
        copy(hi, stack[depth, 1])
        counts[BOXES] += 1
        gone = False
        for _ in range(_TURNS):
            t_lo, t_hi = middle_range(lo, hi, has, L)
            for x in range(2):
                c[x], h[x] = 0.5 * (lo[x] + hi[x]), 0.5 * (hi[x] - lo[x])
            c[2], h[2] = 0.5 * (t_lo + t_hi), 0.5 * (t_hi - t_lo)
            n = candidates(rows, d, data[2], c, has, L, work)
            linear(rows, n, d, data, has, shortest, L, c, h, a, g)
            # discard by one row alone ...
            worst, alone = -1, 0.0
            for i in range(n):
                least = a[i] - abs(g[i, 0]) - abs(g[i, 1]) - abs(g[i, 2])
                if least > alone:
                    worst, alone = i, least
            kept = 0
            if worst >= 0:
                copy(few[0], rows[worst])
                few[0, MULTIPLIER] = 1.0
                kept = 1
                gone = excess(few, kept, lo, hi, data, has, shortest, L) > MARGIN
            # ... or by rows together
            if not gone and minimax(a, g, n, 3, lam, 60) > -0.3:
                kept = 0
                for i in range(n):
                    if lam[i] > 1e-14 and kept < MOST_ROWS:
                        copy(few[kept], rows[i])
                        few[kept, MULTIPLIER] = lam[i]
                        kept += 1
                gone = excess(few, kept, lo, hi, data, has, shortest, L) > MARGIN
            if gone:
                counts[LEAVES] += 1
                write(log, counts, LEAF, 0, 0.0, lo, hi, few, kept)
                break
            # else cut slabs off by single rows
            cut = False
            for x in range(2):
                if not has[x] or h[x] <= 0.0:
                    continue
                lo_e, hi_e, lo_i, hi_i = -1.0, 1.0, -1, -1
                for i in range(n):
                    rest = a[i]
                    for y in range(3):
                        if y != x:
                            rest -= abs(g[i, y])
                    if g[i, x] > 0.0 and -rest / g[i, x] < hi_e:
                        hi_e, hi_i = -rest / g[i, x], i
                    if g[i, x] < 0.0 and -rest / g[i, x] > lo_e:
                        lo_e, lo_i = -rest / g[i, x], i
                for side in range(2):
                    i, e = (hi_i, hi_e) if side == 0 else (lo_i, -lo_e)
                    if i < 0 or e > 0.9:
                        continue
                    e = max(-1.0, e + 1e-6)
                    copy(s_lo, lo)
                    copy(s_hi, hi)
                    if side == 0:
                        value = s_lo[x] = max(lo[x], c[x] + e * h[x])
                    else:
                        value = s_hi[x] = min(hi[x], c[x] - e * h[x])
                    if not s_lo[x] < s_hi[x]:
                        continue
                    copy(few[0], rows[i])
                    few[0, MULTIPLIER] = 1.0
                    if excess(few, 1, s_lo, s_hi, data, has, shortest, L) > MARGIN:
                        counts[SLABS] += 1
                        if side == 0:
                            hi[x] = value
                        else:
                            lo[x] = value
                        write(log, counts, BELOW + side, x, value, lo, hi, few, 1)
                        cut = True
            for x in range(2):
                if cut and has[x] and not lo[x] < hi[x]:
                    gone = True  # the closed slabs together cover it
            if gone:
                counts[EMPTIES] += 1
                write(log, counts, EMPTY, 0, 0.0, lo, hi, few, 0)
                break
            if not cut:
                break
        if gone:
            continue
        x, width = 0, -1.0
        for y in range(2):
            if has[y] and np.log(hi[y] / lo[y]) > width:
                x, width = y, np.log(hi[y] / lo[y])
        if width < narrow or depth > STACK - 3:
            if not aside:
                copy(stack[depth, 0], lo)
                copy(stack[depth, 1], hi)
                return depth + 1, True
            write(log, counts, ASIDE, 0, 0.0, lo, hi, few, 0)
            continue
        middle = np.sqrt(lo[x] * hi[x])
        for child in range(2):
            copy(stack[depth, 0], lo)
            copy(stack[depth, 1], hi)
            stack[depth, 1 - child, x] = middle
            depth += 1
        write(log, counts, SPLIT, x, middle, lo, hi, few, 0)
    return depth, False
