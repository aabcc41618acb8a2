"""Inequalities a x <= b in numbers: rows of one kind with a column for each term, and sparse matrices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from formulations.problem.arrays import Array, Indices, Truths

_LARGEST = 2.0**36  # coefficients below this are not scaled; HiGHS refuses those above 1e15


@dataclass(frozen=True)
class Rows:
    """Rows matrix x <= upper.

    Attributes
    ----------
    matrix : csr_array, shape (m, size)
    upper : Array, shape (m,)
    scale : Array, shape (m,)
        The power of two by which each row, as the equations above have it, was multiplied.
    largest : Array, shape (m,)
        The largest modulus of a coefficient in each row.
    """

    matrix: csr_array
    upper: Array
    scale: Array
    largest: Array

    def __len__(self) -> int:
        return len(self.upper)

    def __getitem__(self, which: Indices | Truths) -> Rows:
        return Rows(self.matrix[which], self.upper[which], self.scale[which], self.largest[which])

    @property
    def finite(self) -> Truths:
        """Which rows consist of finite numbers, (m,)."""
        return np.asarray(np.isfinite(self.largest) & np.isfinite(self.upper))

    def slacks(self, x: Array) -> Array:
        """By how much a point keeps each row.

        Parameters
        ----------
        x : Array, shape (size,)

        Returns
        -------
        Array, shape (m,)
        """
        return np.asarray(self.upper - self.matrix @ x)

    @staticmethod
    def joined(blocks: list[Rows]) -> Rows:
        """Put several blocks below one another.

        Parameters
        ----------
        blocks : list of Rows

        Returns
        -------
        Rows
        """
        parts = [block.matrix for block in blocks]
        before = np.cumsum([0, *(part.nnz for part in parts)])
        starts = [part.indptr[1:] + start for part, start in zip(parts, before[:-1], strict=True)]
        entries = (
            np.concatenate([getattr(part, name) for part in parts]) for name in ("data", "indices")
        )
        shape = (sum(part.shape[0] for part in parts), parts[0].shape[1])
        matrix = csr_array((*entries, np.concatenate([[0], *starts])), shape=shape)
        columns = [[b.upper, b.scale, b.largest] for b in blocks]
        return Rows(matrix, *(np.concatenate(column) for column in zip(*columns, strict=True)))


@dataclass(frozen=True)
class Terms:
    """Rows of one kind, not yet a matrix.

    Attributes
    ----------
    columns : Indices, shape (m, w)
    coefficients : Array, shape (m, w)
    upper, scale, largest : Array, shape (m,)
        As of ``Rows``.
    """

    columns: Indices
    coefficients: Array
    upper: Array
    scale: Array
    largest: Array

    def normal(self) -> Terms:
        """The same rows with largest coefficients between 1 and 2: powers of two do not round."""
        return self._scaled(np.exp2(-np.floor(np.log2(self.largest))))

    def in_range(self) -> Terms:
        """The same rows, made ``normal`` where a coefficient is too large for the solver."""
        high = (self.largest > _LARGEST) & np.isfinite(self.largest)
        if not high.any():
            return self
        return self._scaled(np.where(high, np.exp2(-np.floor(np.log2(self.largest))), 1.0))

    def _scaled(self, scale: Array) -> Terms:
        each = self.upper * scale, self.scale * scale, self.largest * scale
        return Terms(self.columns, self.coefficients * scale[:, None], *each)

    def violated(self, x: Array, tolerance: float) -> Truths:
        """Find the rows of finite numbers that a point violates.

        Parameters
        ----------
        x : Array, shape (size,)
        tolerance : float
            By more than this.

        Returns
        -------
        Truths, shape (m,)
        """
        excess = (self.coefficients * x[self.columns]).sum(axis=1) - self.upper
        finite = np.isfinite(self.largest) & np.isfinite(self.upper)
        return np.asarray(finite & (excess > tolerance))

    def rows(self, size: int) -> Rows:
        """Put the rows into a sparse matrix.

        Parameters
        ----------
        size : int
            Number of columns.

        Returns
        -------
        Rows
        """
        there = self.coefficients != 0.0
        starts = np.concatenate([[0], np.cumsum(there.sum(axis=1))])
        entries = self.coefficients[there], self.columns[there], starts
        matrix = csr_array(entries, shape=(len(there), size))
        return Rows(matrix, self.upper, self.scale, self.largest)
