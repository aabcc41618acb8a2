"""Where the variables of the descent stand, so that each row touches neighbouring ones only."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csr_array

from formulations.problem.arrays import Array, Indices
from formulations.proofs.every_motion.attaining_motion.chain_task import ChainTask
from formulations.proofs.every_motion.attaining_motion.reach_rows import ReachRows


class ChainColumns(NamedTuple):
    """Where the variables are: states of a waypoint, then the duration that follows and what it misses.

    e is empty where no position is free.
    """

    v: Indices
    a: Indices
    e: Indices
    T: Indices
    missed: Indices
    free: Indices
    size: int

    @staticmethod
    def of(task: ChainTask) -> ChainColumns:
        """Place the variables.

        Parameters
        ----------
        task : ChainTask

        Returns
        -------
        ChainColumns
        """
        K, n = task.displacements.shape
        many = 3 if task.in_zones else 2
        start = np.arange(K + 1) * (many * n + 2)
        v = start[:, None] + many * np.arange(n)
        e = v[:, : n if task.in_zones else 0] + 2
        T = start[:-1] + many * n
        size = K * (many * n + 2) + many * n
        free = np.ones(size, dtype=bool)
        for column, box in ((v, task.v_boxes), (v + 1, task.a_boxes)):
            free[column[box[..., 0] == box[..., 1]]] = False
        free[v[:, ~task.has_jerk] + 1] = False
        free[e[task.zones[:, : e.shape[1]] == 0.0]] = False
        return ChainColumns(v, v + 1, e, T, T + 1, np.flatnonzero(free), size)

    def of_rows(self, rows: ReachRows) -> Indices:
        """Return the columns of each row.

        Parameters
        ----------
        rows : ReachRows

        Returns
        -------
        Indices, shape (m, 6)
            Or (m, 8) in zones: T, v and a at both ends, e at both ends, and what is missed.
        """
        return np.column_stack([*self._around(rows.segment, rows.joint), self.missed[rows.segment]])

    def slopes(self, slopes: Array) -> Array:
        """Turn the slopes of rows into those of their columns.

        Parameters
        ----------
        slopes : Array, shape (m, 6)
            With T, v and a at both ends, and d.

        Returns
        -------
        Array, shape (m, 5)
            Or (m, 7) in zones, where d = e1 - e0.
        """
        if not self.e.size:
            return slopes[:, :5]
        return np.column_stack([slopes[:, :5], -slopes[:, 5], slopes[:, 5]])

    def _around(self, k: Indices, j: Indices) -> list[Indices]:
        found = [self.T[k], self.v[k, j], self.a[k, j], self.v[k + 1, j], self.a[k + 1, j]]
        return [*found, self.e[k, j], self.e[k + 1, j]] if self.e.size else found

    def quadratic(self, blocks: Array, of_v: Array, of_a: Array) -> csr_array:
        """Place second derivatives.

        Parameters
        ----------
        blocks : Array, shape (K, n, 5, 5)
            With T and with v and a at both ends; (K, n, 6, 6) in zones, with d.
        of_v, of_a : Array, shape (K + 1, n)
            Further ones of each state with itself.

        Returns
        -------
        csr_array, shape (size, size)
        """
        k, j = (np.asarray(index) for index in np.indices(blocks.shape[:2]))
        place = np.stack(self._around(k, j), axis=-1)
        if self.e.size:
            to_columns = np.vstack([np.eye(5, 7), [0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 1.0]])
            blocks = to_columns.T @ blocks @ to_columns
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
