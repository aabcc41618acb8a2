"""Certified lower bound of the quintic spline: no durations fit into a total time L.

Coordinates. x_k = 1 / T_k of the segments on which something moves.

Conditions. The mean rule makes the derivatives of piece k linear in x_{k-1}, x_k, x_{k+1} except for one
power of x_k (``conditions``). So for multipliers m >= 0 of any conditions the Lagrangian is separable,

    sum_k T_k - L + sum m g  =  const + sum_k phi_k(x_k),
    phi_k(x) = a_k x + (1 - w2_k) / x - w3_k / x^2.

Proof. If it is positive everywhere, the bound is proved at once. Otherwise the domain of each x_k is cut
into cells, and dynamic programming searches the chain of cells (``chain``): single conditions discard
triples of neighbouring cells, sums of conditions discard whole bundles of paths. The multipliers come
from linear programs about the best motion known and about paths that are left (``multipliers``).

Domain. T_k >= t_k = max |d_k| / v, v a bound on the joint's speed, and T_k <= L - sum of the other t.
A segment on which nothing moves may vanish, and no piece depends on its duration: x_k is fixed to 1,
and T_k >= 0 is left out of the total.

Events of the certificate: ["C", segment, edges] cuts cells; ["R", rows] are conditions tried one by one;
["L", rows] are the conditions of a sum.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.arithmetic.intervals import down, least_sum, up
from formulations.proofs.domain import LESS, MORE, data_of, duration_domain
from formulations.proofs.events import BOXES, EventTrace
from formulations.proofs.proof import NARROW, ProofSearch
from formulations.proofs.quintic.chain import CellChain
from formulations.proofs.quintic.conditions import PieceConditions, Pieces
from formulations.proofs.quintic.multipliers import propose_multipliers
from formulations.proofs.quintic.separable import least_share

_CELLS = 10  # per segment at the first cut
_KEPT = 6  # sets of multipliers that are tried again on finer cells
_MOST_ROWS = 60  # conditions tried one by one, per segment
_MANY = 100_000  # triples above which only one segment is cut per step
_MOST_TRIPLES = 4_000_000  # triples above which the search gives up
_MARGIN = 1e-12  # of L: with it, a checker that rounds in another way agrees
_WIDE = 0.4  # of the widest cell: cells wider than this are cut
_SHAPE = 0.1  # weight of a cell's width in log x beside its width in seconds
_VANISHING = 1e-10  # of L: duration given to a segment on which nothing moves


def begin(
    problem: Problem,
    L: float,
    *,
    near: Array | None = None,
    narrow: float = NARROW,
    aside: bool = False,
    blur: Array | None = None,
) -> ProofSearch:
    """Set up the attempt to prove that no quintic motion takes L seconds or less.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    L : float [s]
        The bound to prove.
    near : Array, shape (n_segments,) [s], optional
        Hint: the best durations known.
    narrow, aside, blur : optional
        As in ``formulations.proofs.proof.Prover``.

    Returns
    -------
    ProofSearch
        The search, at its beginning.
    """
    search = ChainSearch(problem, L, near, narrow, blur)

    def advance(depth: int, max_boxes: int, trace: EventTrace) -> tuple[int, bool]:
        trace.counts[BOXES] += search.chain.size
        search.step()
        if search.chain.empty:
            return 0, False
        return 1, search.stuck and not aside

    depth = 0 if search.void else 1
    return ProofSearch(search.n, 0, depth, advance, search.durations, anytime=search)


class ChainSearch:
    """One attempt: steps of discards and cuts until no path is left.

    ``reached`` [s] is the bound that the attempt has proved so far, even if it does not end.
    """

    def __init__(
        self, problem: Problem, L: float, near: Array | None, narrow: float, blur: Array | None
    ) -> None:
        data = data_of(problem, blur)
        self.n, self.L, self.narrow = len(data.d), L, narrow
        self.pieces, self._moving = Pieces(data), problem.moving_joints
        domain = duration_domain(data.shortest(L), L)
        moves = domain.shortest > 0.0
        self._moves = np.pad(moves, 1)
        self.void = domain.empty
        lo, hi = np.ones(self.n + 2), np.ones(self.n + 2)
        if not self.void:
            lo[self._moves] = LESS / domain.longest[moves]
            hi[self._moves] = MORE / domain.shortest[moves]
        self.chain, self._path = CellChain(lo, hi), (lo, hi)
        self._near = np.sqrt(lo * hi)
        if near is not None:
            self._near[self._moves] = 1.0 / near[moves]
            self._near = np.clip(self._near, lo, hi)
        self._rows = self.pieces.grid()
        self._kept: list[tuple[PieceConditions, Array]] = []
        self._turn = -1
        self._events: list[list[Any]] = []
        self.reached = 0.0
        self._last: list[Any] = ["L", []]

    @property
    def events(self) -> list[list[Any]]:
        """The events that prove ``reached``, as a certificate writes them."""
        return self._events if self.chain.empty else [*self._events, self._last]

    @property
    def stuck(self) -> bool:
        """Whether no further step is worth its time."""
        wide = max(np.log(hi / lo).max() for lo, hi in zip(self.chain.lo, self.chain.hi, strict=True))
        return bool(wide < self.narrow) or self.chain.size > _MOST_TRIPLES

    def durations(self, depth: int) -> Array:
        """Durations at the middle of the path with the least sum.

        Parameters
        ----------
        depth : int
            Is not used: a chain has no boxes.

        Returns
        -------
        Array, shape (n_segments,) [s]
            Almost 0 on a segment on which nothing moves.
        """
        lo, hi = self._path
        return np.where(self._moves, 1.0 / np.sqrt(lo * hi), _VANISHING * self.L)[1:-1]

    def step(self) -> None:
        """Discard what single conditions and sums can, then cut the cells that are left."""
        if not self._kept:
            self._discard(*self._proposed(self._near, self._near * 0.999, self._near * 1.001))
            cells = _CELLS
        else:
            self._discard_rows()
            self._discard_sums()
            cells = 2
        if not self.chain.empty:
            self._cut(cells)

    def _discard_sums(self) -> None:
        """Discard by the plain total, by the multipliers kept, and by new ones about the least path."""
        sets = [(self._rows[:0], np.zeros(0)), *self._kept]
        self._turn = (self._turn + 1) % len(sets)  # each has its own least path
        for turn, (rows, weights) in enumerate(sets):
            self._discard(rows, weights)
            if self.chain.empty:
                return
            if turn == self._turn:
                self._path = self.chain.least_path()
        lo, hi = self._path
        self._discard(*self._proposed(np.sqrt(lo * hi), lo, hi))

    def _proposed(self, x: Array, lo: Array, hi: Array) -> tuple[PieceConditions, Array]:
        """Propose multipliers, and keep them and all conditions tried for finer cells."""
        rows, weights, every = propose_multipliers(self.pieces, x, lo, hi, self._moves.astype(float))
        self._kept = [*self._kept[:1], *self._kept[1:][-_KEPT:], (rows, weights)]
        self._rows = PieceConditions.of([every, self._rows])
        return rows, weights

    def _discard(self, rows: PieceConditions, weights: Array) -> None:
        """Discard by a weighted sum of conditions.

        A motion that is left takes at least L plus the least sum; one that was discarded, at least L.
        """
        terms = [down(weights * part) for part in (rows.before, rows.own, rows.after)]
        place = np.concatenate([rows.segment + shift for shift in range(3)])
        a = least_sum(np.concatenate(terms), place, self.n + 2)
        held = up(weights * rows.limit)

        def most(order: int) -> Array:
            chosen = rows.order == order
            if not chosen.any():
                return np.zeros(self.n + 2)
            return -least_sum(-held[chosen], rows.segment[chosen] + 1, self.n + 2)

        b, c = down(self._moves - most(2)), most(3)
        const = down(-float(up(most(1).sum() * (1.0 + 1e-14))) - self.L)
        shares = [
            least_share(a[k], b[k], c[k], self.chain.lo[k], self.chain.hi[k]) for k in range(self.n + 2)
        ]
        least, gone = self.chain.discard_sum(shares, float(const), _MARGIN * self.L)
        event: list[Any] = ["L", [["t", (1.0).hex()], *self._plain(rows, weights)]]
        if gone:
            self._events.append(event)
        if min(self.L + least, self.L) > self.reached:
            self.reached, self._last = min(self.L + least, self.L), event

    def _discard_rows(self) -> None:
        """Discard by single conditions; keep those that discarded something."""
        useful = []
        for k in range(self.n):
            mine = np.flatnonzero(self._rows.segment == k)[:_MOST_ROWS]
            rows = self._rows[mine]
            cells = [(self.chain.lo[k + shift], self.chain.hi[k + shift]) for shift in range(3)]
            before, after = (
                np.minimum(*(down(part[:, None] * x) for x in cells[shift]))
                for shift, part in ((0, rows.before), (2, rows.after))
            )
            own = np.minimum(*(down(down(rows.own[:, None] * x) - _held(rows, x)) for x in cells[1]))
            useful.append(mine[self.chain.discard_rows(k, before, own, after)])
        self._rows = self._rows[np.concatenate(useful)]
        if len(self._rows):
            self._events.append(["R", self._plain(self._rows, np.ones(len(self._rows)))])

    def _cut(self, cells: int) -> None:
        """Cut the wider cells into so many parts, evenly in log x."""
        mean = self.L / max(self._moves.sum(), 1)
        widths = [
            1.0 / lo - 1.0 / hi + _SHAPE * mean * np.log(hi / lo)
            for lo, hi in zip(self.chain.lo, self.chain.hi, strict=True)
        ]
        widest = max(width.max() for width in widths)
        wanted = np.flatnonzero(self._moves)
        if self.chain.size > _MANY:
            wanted = wanted[[int(np.argmax([widths[k].max() for k in wanted]))]]
        for k in wanted.tolist():
            lo, hi = self.chain.lo[k], self.chain.hi[k]
            wide = widths[k] > (_WIDE * widest if cells == 2 else 0.0)
            powers = np.arange(1, cells) / cells
            edges = lo[wide, None] * (hi[wide] / lo[wide])[:, None] ** powers
            edges = np.sort(edges, axis=None)
            self.chain.cut(k, edges)
            self._events.append(["C", k - 1, [edge.hex() for edge in edges.tolist()]])

    def _plain(self, rows: PieceConditions, weights: Array) -> list[list[Any]]:
        """Conditions as a certificate writes them."""
        return [
            ["p", self._moving[joint], segment, order, place.hex(), int(sign), weight.hex()]
            for joint, segment, order, place, sign, weight in zip(
                *(part.tolist() for part in (rows.joint, rows.segment, rows.order)),
                *(part.tolist() for part in (rows.place, rows.sign, weights)),
                strict=True,
            )
        ]


def _held(rows: PieceConditions, x: Array) -> Array:
    """Upper bounds of limit / x^(order-1), shape (m, cells)."""
    power, held = rows.power[:, None], rows.limit[:, None]
    once = up(held / x)
    return np.where(power == 0, held, np.where(power == 1, once, up(once / x)))
