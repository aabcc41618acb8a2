"""Where the variables of the descent stand, so that each row touches neighbouring ones only."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csr_array

from formulations.problem.arrays import Array, Indices, Truths
from formulations.proofs.every_motion.attaining_motion.reach_rows import ReachRows


class ChainColumns(NamedTuple):
    """Where the variables are: states of a waypoint, then the duration that follows and what it misses."""

    v: Indices
    a: Indices
    T: Indices
    missed: Indices
    free: Indices
    size: int

    @staticmethod
    def of(K: int, has_jerk: Truths) -> ChainColumns:
        """Place the variables.

        Parameters
        ----------
        K : int
            Number of segments.
        has_jerk : Truths, shape (n,)

        Returns
        -------
        ChainColumns
        """
        n = len(has_jerk)
        start = np.arange(K + 1) * (2 * n + 2)
        v = start[:, None] + 2 * np.arange(n)
        T = start[:-1] + 2 * n
        size = K * (2 * n + 2) + 2 * n
        free = np.ones(size, dtype=bool)
        for column in (v, v + 1):
            free[column[[0, -1]]] = False  # at rest
        free[v[:, ~has_jerk] + 1] = False
        return ChainColumns(v, v + 1, T, T + 1, np.flatnonzero(free), size)

    def of_rows(self, rows: ReachRows) -> Indices:
        """Return the columns of each row.

        Parameters
        ----------
        rows : ReachRows

        Returns
        -------
        Indices, shape (m, 6)
        """
        k, j = rows.segment, rows.joint
        ends = [self.v[k, j], self.a[k, j], self.v[k + 1, j], self.a[k + 1, j]]
        return np.column_stack([self.T[k], *ends, self.missed[k]])

    def quadratic(self, blocks: Array, of_v: Array, of_a: Array) -> csr_array:
        """Place second derivatives.

        Parameters
        ----------
        blocks : Array, shape (K, n, 5, 5)
            With T and with v and a at both ends.
        of_v, of_a : Array, shape (K + 1, n)
            Further ones of each state with itself.

        Returns
        -------
        csr_array, shape (size, size)
        """
        k, j = np.indices(blocks.shape[:2])
        ends = [self.v[k, j], self.a[k, j], self.v[k + 1, j], self.a[k + 1, j]]
        place = np.stack([self.T[k], *ends], axis=-1)
        row = np.broadcast_to(place[..., :, None], blocks.shape).ravel()
        column = np.broadcast_to(place[..., None, :], blocks.shape).ravel()
        states = np.concatenate([self.v.ravel(), self.a.ravel()])
        entries = np.concatenate([blocks.ravel(), of_v.ravel(), of_a.ravel()])
        where = (np.concatenate([row, states]), np.concatenate([column, states]))
        return csr_array(coo_array((entries, where), shape=(self.size, self.size)))


def stacked(blocks: list[tuple[Indices, Array]], size: int) -> csr_array:
    """Stack rows with given columns and values, block below block.

    Parameters
    ----------
    blocks : list of (Indices, Array), shape (m, w) each
    size : int
        Number of columns.

    Returns
    -------
    csr_array
    """
    counts = np.concatenate([np.full(len(values), values.shape[1]) for _, values in blocks])
    starts = np.concatenate([[0], np.cumsum(counts)])
    columns = np.concatenate([places.ravel() for places, _ in blocks])
    values = np.concatenate([values.ravel() for _, values in blocks])
    return csr_array((values, columns, starts), shape=(len(counts), size))
