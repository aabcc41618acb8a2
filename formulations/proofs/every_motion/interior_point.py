"""A quadratic program in boxes whose rows touch neighbouring variables only, by an interior point method.

    minimise  c x + x Q x / 2   subject to   G x <= h,   l <= x <= u

The columns are ordered so that each row of G, and Q, stay within a narrow band. So do the normal equations,
and one step costs a time proportional to the number of variables (banded Cholesky). Each iteration is a
predictor and a corrector (Mehrotra 1992).

References
----------
Mehrotra 1992, "On the implementation of a primal-dual interior point method", SIAM Journal on Optimization
2, pp. 575-601.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded
from scipy.sparse import csr_array

from formulations.deadlines import NEVER, Deadline
from formulations.problem.arrays import Array

_ITERATIONS = 100
_TO_BOUNDARY = 0.995  # share of the way to the nearest bound that a step goes
_TINY = 1e-15  # slacks and multipliers stay above it
_START = 0.1  # of slacks and of complementarity products
_INSIDE, _CENTRED = (
    0.1,
    100.0,
)  # where a start is given: its least share of a box's width, and the products
_LESS, _PATIENCE, _NEAR = 0.9, 20, 1e-3  # rounding has ended the progress: what is left does not fall
_ROWS_MET = 1e-9  # a row may be violated by this much


@dataclass(frozen=True)
class BandedSolution:
    """A point and its multipliers.

    Attributes
    ----------
    x : Array, shape (n,)
    multipliers : Array, shape (m,)
        Of the rows, positive.
    converged : bool
    """

    x: Array
    multipliers: Array
    converged: bool


class _NormalEquations:
    """G' diag(w) G + Q + diag(d) in LAPACK's band storage; where each product goes is found once."""

    def __init__(self, matrix: csr_array, quadratic: csr_array | None) -> None:
        self.n = matrix.shape[1]
        counts, width = np.diff(matrix.indptr), 0
        rows, columns, products = [], [], []
        for w in np.unique(counts[counts > 0]):
            row = np.flatnonzero(counts == w)
            place = matrix.indptr[row][:, None] + np.arange(w)
            column, value = matrix.indices[place].astype(np.int64), matrix.data[place]
            i, j = np.tril_indices(w)
            below = np.maximum(column[:, i], column[:, j])
            left = np.minimum(column[:, i], column[:, j])
            width = max(width, int((below - left).max()))
            rows.append(np.repeat(row, len(i)))
            columns.append(((below - left) * self.n + left).ravel())
            products.append((value[:, i] * value[:, j]).ravel())
        entries = np.zeros((0, self.n))
        if quadratic is not None:
            parts = quadratic.tocoo()
            row, column = parts.coords
            lower = row >= column
            below, left = row[lower] - column[lower], column[lower]
            width = max(width, int(below.max(initial=0)))
            entries = np.zeros((width + 1, self.n))
            np.add.at(entries, (below, left), parts.data[lower])
        self.shape = (width + 1, self.n)
        self.quadratic = entries
        places = (np.concatenate(columns), np.concatenate(rows))
        self._from_weights = csr_array(
            (np.concatenate(products), places), shape=(self.shape[0] * self.n, matrix.shape[0])
        )

    def factor(self, weights: Array, diagonal: Array) -> Array | None:
        """Cholesky factor, or None where rounding leaves none."""
        band = (self._from_weights @ weights).reshape(self.shape)
        band[: len(self.quadratic)] += self.quadratic
        band[0] = (band[0] + diagonal) * (1.0 + 1e-13) + 1e-12
        try:
            return np.asarray(cholesky_banded(band, True, True, check_finite=False))
        except LinAlgError:
            return None


def minimise_in_band(
    cost: Array,
    matrix: csr_array,
    upper: Array,
    box: Array,
    quadratic: csr_array | None = None,
    *,
    tolerance: float,
    start: Array | None = None,
    deadline: Deadline = NEVER,
) -> BandedSolution:
    """Solve the program.

    Parameters
    ----------
    cost : Array, shape (n,)
    matrix : csr_array, shape (m, n)
        G; every row has an entry.
    upper : Array, shape (m,)
    box : Array, shape (n, 2)
        Finite, with an inside.
    quadratic : csr_array, shape (n, n), optional
        Q, positive semidefinite.
    tolerance : float
        The solve ends when the complementarity products sum to less than this share of the cost.
    start : Array, shape (n,), optional
        Where to begin, moved inside the box; the middle of the box if left out. Most rows should hold there.
    deadline : Deadline
        Looked at in each iteration.

    Returns
    -------
    BandedSolution
        Not converged where rounding or the deadline ended the solve; the point is then the last one.
    """
    turned = csr_array(matrix.T)
    normal = _NormalEquations(matrix, quadratic)
    low, high = box.T
    x, product = 0.5 * (low + high), _START
    if start is not None:
        edge, product = _INSIDE * (high - low), _CENTRED
        x = np.clip(start, low + edge, high - edge)
    s = np.maximum(upper - matrix @ x, _START)
    y, z_low, z_high = product / s, product / (x - low), product / (high - x)
    size = len(upper) + 2 * len(cost)
    converged, least, stuck = False, np.inf, 0

    def lengths(values: tuple[Array, ...], steps: tuple[Array, ...]) -> float:
        most = max(float((-d / v).max()) for d, v in zip(steps, values, strict=True))
        return 1.0 / max(most, 1.0)

    for _ in range(_ITERATIONS):
        under, over = np.maximum(x - low, _TINY), np.maximum(high - x, _TINY)
        slope = cost if quadratic is None else cost + quadratic @ x
        r_rows = upper - matrix @ x - s
        r_slope = -(slope + turned @ y - z_low + z_high)
        mu = _sum_of_products((s, y), (under, z_low), (over, z_high)) / size
        converged = mu * size < tolerance * (1.0 + abs(_sum_of_products((cost, x))))
        converged &= bool(np.abs(r_rows).max() < _ROWS_MET)
        converged &= bool(
            np.abs(r_slope).max() < max(1e-8, 10.0 * tolerance) * (1.0 + np.abs(cost).max())
        )
        left = mu * size + float(np.abs(r_slope).max())
        stuck = 0 if left < _LESS * least else stuck + bool(np.abs(r_rows).max() < _NEAR)
        least = min(least, left)
        if converged or stuck == _PATIENCE or deadline.over:
            break
        factor = normal.factor(y / s, z_low / under + z_high / over)
        if factor is None:
            break

        def step(
            to_rows: Array, to_low: Array, to_high: Array, factor: Array = factor
        ) -> tuple[Array, ...]:
            """The Newton step that adds these to the complementarity products."""
            right = r_slope - turned @ ((to_rows - y * r_rows) / s) + to_low / under - to_high / over  # noqa: B023
            dx = cho_solve_banded((factor, True), right, check_finite=False)
            left = turned @ (y / s * (matrix @ dx)) + (z_low / under + z_high / over) * dx  # noqa: B023
            left = left if quadratic is None else left + quadratic @ dx
            # once more for what is left: rounding costs many digits where rows are steep
            dx = dx + cho_solve_banded((factor, True), right - left, check_finite=False)
            ds = r_rows - matrix @ dx  # noqa: B023
            dy = (to_rows - y * ds) / s  # noqa: B023
            return dx, ds, dy, (to_low - z_low * dx) / under, (to_high + z_high * dx) / over  # noqa: B023

        dx, ds, dy, d_low, d_high = step(-s * y, -under * z_low, -over * z_high)
        ahead = lengths((s, under, over), (ds, dx, -dx))
        dual = lengths((y, z_low, z_high), (dy, d_low, d_high))
        if quadratic is not None:
            ahead = dual = min(ahead, dual)
        left = _sum_of_products(
            (s + ahead * ds, y + dual * dy),
            (under + ahead * dx, z_low + dual * d_low),
            (over - ahead * dx, z_high + dual * d_high),
        )
        aim = (left / size / mu) ** 3 * mu
        dx, ds, dy, d_low, d_high = step(
            aim - s * y - ds * dy, aim - under * z_low - dx * d_low, aim - over * z_high + dx * d_high
        )
        if not np.isfinite(dx).all():
            break
        ahead = _TO_BOUNDARY * lengths((s, under, over), (ds, dx, -dx))
        dual = _TO_BOUNDARY * lengths((y, z_low, z_high), (dy, d_low, d_high))
        if quadratic is not None:
            ahead = dual = min(ahead, dual)
        x = x + ahead * dx
        s, y, z_low, z_high = (
            np.maximum(value + length * change, _TINY)
            for value, length, change in (
                (s, ahead, ds),
                (y, dual, dy),
                (z_low, dual, d_low),
                (z_high, dual, d_high),
            )
        )
    return BandedSolution(x, y, converged)


def _sum_of_products(*pairs: tuple[Array, Array]) -> float:
    """Not by BLAS: its threads wait for one another on a busy machine, at every call."""
    return sum(float((a * b).sum()) for a, b in pairs)
