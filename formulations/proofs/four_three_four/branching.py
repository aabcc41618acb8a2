"""4-3-...-3-4: which variable of an undecided box to split."""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.events import copy
from formulations.proofs.four_three_four.ends import end_of

SHORT = 1e-10  # of L: an open segment this short is not split further
_LEFTMOST = 0.5  # with known parts: the first segment is split whose width is this share of the widest


@compiled
def choose_variable(box: Any, data: Any, velocities: Any, smear: Any) -> tuple[int, float]:
    """Which variable to split, and the largest width of a segment, in the logarithm of x.

    A segment: the widest. In a whole whose parts have known bounds: the first that is not much narrower,
    since what is left of the others is bounded without splitting them. Velocities at the free ends of a
    part: that which matters most to the rows chosen last, if it is wider than all segments.

    Parameters
    ----------
    box : Box
        Of x.
    data : RateData
        The task.
    velocities : VelocityEnclosure
        Over the box.
    smear : ndarray, shape (n_variables,)
        Of ``RateForm``.

    Returns
    -------
    x : int
        The variable.
    widest : float
        The width.
    """
    lo, hi, n, shortest = box.lo, box.hi, data.n, SHORT * data.L
    x, widest = 0, -1.0
    width = np.empty(n)
    for k in range(n):
        width[k] = np.log(hi[k] / lo[k]) if hi[k] < np.inf else np.log(1.0 / (lo[k] * shortest))
        if width[k] > widest:
            x, widest = k, width[k]
    if len(smear) == n and len(data.parts):
        x = 0
        while width[x] < _LEFTMOST * widest:
            x += 1
    most = 0.0
    for k in range(n, len(smear)):
        j, i = end_of(k, data.ends, data.d.shape[1])
        wide = velocities.hi[j, i] - velocities.lo[j, i]
        if smear[k] > most and wide > widest * data.speed[j]:
            most, x = smear[k], k
    return x, widest


@compiled
def middle_of(box: Any, x: int, data: Any, velocities: Any) -> float:
    """Where to split variable x.

    Parameters
    ----------
    box : Box
        Of x.
    x : int
        The variable.
    data : RateData
        The task.
    velocities : VelocityEnclosure
        Over the box.

    Returns
    -------
    float
        In the middle of a velocity, in the logarithm otherwise.
    """
    if x >= data.n:
        j, i = end_of(x, data.ends, data.d.shape[1])
        return float(0.5 * (velocities.lo[j, i] + velocities.hi[j, i]))
    if box.hi[x] < np.inf:
        return float(np.sqrt(box.lo[x] * box.hi[x]))
    return float(np.sqrt(box.lo[x] / (SHORT * data.L)))


@compiled
def push_both_halves(
    stack: Any, stack_v: Any, depth: int, box: Any, x: int, middle: float, data: Any, velocities: Any
) -> int:
    """Split a box at the middle of variable x, and push both halves; the upper half is the next.

    Parameters
    ----------
    stack, stack_v : ndarray
        As in ``search.branch_and_bound``.
    depth : int
        Number of boxes on the stack.
    box : Box
        Of x.
    x : int
        The variable.
    middle : float
        Where.
    data : RateData
        The task.
    velocities : VelocityEnclosure
        Over the box.

    Returns
    -------
    int
        The new depth.
    """
    for child in range(2):
        copy(stack[depth + child, 0], box.lo)
        copy(stack[depth + child, 1], box.hi)
        for j in range(data.d.shape[1]):
            copy(stack_v[depth + child, 0, j], velocities.lo[j])
            copy(stack_v[depth + child, 1, j], velocities.hi[j])
        if x < data.n:
            stack[depth + child, 1 - child, x] = middle
        else:
            j, i = end_of(x, data.ends, data.d.shape[1])
            stack_v[depth + child, 1 - child, j, i] = middle
    return depth + 2
