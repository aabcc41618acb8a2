"""Quintic: multipliers for a sum of conditions, from a linear program about one point.

To first order about x, with relative steps e in a box:

    minimise    sum_k T_k (1 - e_k) + penalty t      over e, t >= 0
    subject to  g_i(x) + sum_k dg_i/dx_k x_k e_k <= t size_i

The multipliers of its constraints are worth trying. The proof does not depend on them: the sum, rounded
outward, decides.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog

from formulations.problem.arrays import Array
from formulations.proofs.quintic.conditions import PieceConditions, Pieces

_PENALTY = 100.0  # of the total time, for conditions that no step in the box fulfils
_NEGLIGIBLE = 1e-12  # of the largest multiplier


def propose_multipliers(
    pieces: Pieces, x: Array, lo: Array, hi: Array, total: Array
) -> tuple[PieceConditions, Array, PieceConditions]:
    """Propose conditions and multipliers that discard much near one point.

    Parameters
    ----------
    pieces : Pieces
        Of the problem.
    x, lo, hi : Array, shape (n+2,) [1/s]
        The point, and the box in which the steps stay; padded.
    total : Array, shape (n+2,)
        1 where a duration counts in the total, else 0.

    Returns
    -------
    conditions : PieceConditions
        Those with a multiplier.
    weights : Array
        Their multipliers, > 0.
    every : PieceConditions
        All conditions that were tried.
    """
    every = pieces.peaks(x)
    values, slopes = every.at(x)
    steps = slopes * x
    sizes = np.abs(steps).sum(axis=1) + 1e-3 * np.abs(values)
    kept = sizes > 0.0
    every, values, steps, sizes = every[kept], values[kept], steps[kept], sizes[kept]
    times = total / x
    answer = linprog(
        np.append(-times, _PENALTY * times.sum()),
        A_ub=np.hstack([steps / sizes[:, None], -np.ones((len(every), 1))]),
        b_ub=-values / sizes,
        bounds=np.vstack([np.stack([lo / x - 1.0, hi / x - 1.0], axis=1), [0.0, np.inf]]),
        method="highs",
    )
    if answer.x is None:
        return every[:0], np.zeros(0), every
    found = -answer.ineqlin.marginals / sizes
    useful = found > _NEGLIGIBLE * max(found.max(), 0.0)
    return every[useful], found[useful], every
