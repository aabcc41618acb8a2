"""Quintic: a grid of cells for variables that conditions tie to their two neighbours only.

The domain of x_k is cut into cells. A path takes a cell of each variable; it holds all points whose
x_k lie in its cells. A triple (a, b, c) of cells of x_{k-1}, x_k, x_{k+1} stands for all paths through
them. Triples are discarded, never single paths:

    rows    g(x_{k-1}, x_k, x_{k+1}) > 0 on all of a triple, where g <= 0 is necessary
    sum     phi_0(x_0) + ... + phi_{n+1}(x_{n+1}) > 0 on every path through a triple, where the sum <= 0
            is necessary. Dynamic programming gives the least sum before and after each pair of cells,
            so the cost grows linearly with n

If some variable has no triple left, no point of the domain fulfils the conditions. The variables are
padded by one at each end that has a single cell. All sums are rounded to the safe side.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.arithmetic.intervals import sum_error


class CellChain:
    """Cells of n variables, and the triples that are left."""

    def __init__(self, lo: Array, hi: Array) -> None:
        """Begin with one cell per variable.

        Parameters
        ----------
        lo, hi : Array, shape (n+2,)
            The domain of the variables and of the padding.
        """
        self.n = len(lo) - 2
        self.lo, self.hi = [np.array([x]) for x in lo], [np.array([x]) for x in hi]
        self.triples: list[Any] = [np.zeros((3, 1), np.intp) for _ in range(self.n)]
        self._least: list[Array] = []

    @property
    def size(self) -> int:
        """Number of triples left."""
        return sum(t.shape[1] for t in self.triples)

    @property
    def empty(self) -> bool:
        """Whether no path is left."""
        return min(t.shape[1] for t in self.triples) == 0

    def discard_rows(self, k: int, before: Array, own: Array, after: Array) -> list[int]:
        """Discard the triples about variable k on which any condition is violated.

        Parameters
        ----------
        k : int
            The variable.
        before, own, after : Array, shape (m, cells)
            Least shares of m conditions on the cells of x_{k-1}, x_k, x_{k+1}.

        Returns
        -------
        list of int
            The conditions that discarded something.
        """
        triples, useful = self.triples[k], []
        for row, shares in enumerate(zip(before, own, after, strict=True)):
            if not triples.shape[1]:
                break
            a, b, c = (share[cell] for share, cell in zip(shares, triples, strict=True))
            # thirty times the rounding, so that a checker with other orders of operations agrees
            slack = 30.0 * sum_error(3, sum(np.abs(share).max() for share in shares))
            stay = ~(a + b + c > slack)
            if not stay.all():
                useful.append(row)
                triples = triples[:, stay]
        self.triples[k] = triples
        return useful

    def discard_sum(self, shares: list[Array], const: float, margin: float) -> tuple[float, int]:
        """Discard the triples through which every path has a sum above a margin.

        Parameters
        ----------
        shares : list of Array, shape (cells,)
            Least phi on the cells of each variable, padded.
        const : float
            Is added to the sum.
        margin : float
            A sum above it discards.

        Returns
        -------
        least : float
            Lower bound of the sums of all paths, before the discards.
        gone : int
            Number of triples discarded.
        """
        sizes = sum(float(np.abs(share).max()) for share in shares) + abs(const)
        threshold = margin + float(sum_error(2 * self.n + 6, sizes))
        ahead = [shares[0][:, None] + shares[1][None] + const]
        for k, (a, b, c) in enumerate(self.triples):
            ahead.append(self._least_of(k + 1, b, c, ahead[k][a, b] + shares[k + 2][c]))
        behind = np.zeros((len(shares[-2]), 1))
        before = self.size
        self._least = [np.zeros(0)] * self.n
        for k in range(self.n - 1, -1, -1):
            a, b, c = self.triples[k]
            rest = behind[b, c] + shares[k + 2][c]
            through = ahead[k][a, b] + rest
            behind = self._least_of(k, a, b, rest)
            stay = ~(through > threshold)
            self.triples[k], self._least[k] = self.triples[k][:, stay], through[stay]
        return float(ahead[-1].min()) - threshold, before - self.size

    def _least_of(self, k: int, first: Any, second: Any, values: Array) -> Array:
        """Least of the values per pair of cells of padded variables k and k + 1; infinite if none."""
        least = np.full((len(self.lo[k]), len(self.lo[k + 1])), np.inf)
        np.minimum.at(least, (first, second), values)
        return least

    def least_path(self) -> tuple[Array, Array]:
        """Lower and upper ends of the cells of the path with the least last sum, shape (n+2,) each."""
        cells = [0]
        for k, (triples, least) in enumerate(zip(self.triples, self._least, strict=True)):
            if k:
                on = (triples[:2] == np.array(cells[-2:])[:, None]).all(axis=0)
                least = np.where(on, least, np.inf)
            best = triples[:, least.argmin()].tolist()
            cells += best[1:] if not k else best[2:]
        return (
            np.array([lo[cell] for lo, cell in zip(self.lo, cells, strict=True)]),
            np.array([hi[cell] for hi, cell in zip(self.hi, cells, strict=True)]),
        )

    def cut(self, k: int, edges: Array) -> None:
        """Cut the cells of a variable; cells that no triple uses are dropped.

        Parameters
        ----------
        k : int
            The padded variable.
        edges : Array, shape (m,)
            Where to cut, ascending.
        """
        used = np.unique(self.triples[k - 1][1])
        lo, hi = self.lo[k][used], self.hi[k][used]
        first, last = np.searchsorted(edges, lo, "right"), np.searchsorted(edges, hi, "left")
        parts = np.maximum(last - first, 0) + 1
        start = np.concatenate([[0], np.cumsum(parts)])
        owner = np.repeat(np.arange(len(used)), parts)
        place = np.arange(start[-1]) - start[owner]
        inner = np.append(edges, np.inf)[np.minimum(first[owner] + place, len(edges))]
        new_hi = np.where(place == parts[owner] - 1, hi[owner], inner)
        new_lo = np.where(place == 0, lo[owner], np.append(0.0, new_hi[:-1]))
        children = np.full((len(self.lo[k]), 2), 0)
        children[used] = np.stack([start[:-1], parts], axis=1)
        self.lo[k], self.hi[k] = new_lo, new_hi
        for middle in range(max(k - 2, 0), min(k + 1, self.n)):
            position, triples = k - middle, self.triples[middle]
            child = children[triples[position]]
            triples, child = triples[:, child[:, 1] > 0], child[child[:, 1] > 0]
            copies = np.repeat(np.arange(triples.shape[1]), child[:, 1])
            ends = np.cumsum(child[:, 1])
            offset = np.arange(len(copies)) - np.repeat(ends - child[:, 1], child[:, 1])
            triples = triples[:, copies]
            triples[position] = child[copies, 0] + offset
            self.triples[middle] = triples
