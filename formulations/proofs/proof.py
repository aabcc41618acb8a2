"""An attempt to prove one bound, run in slices so that a time limit can be kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.events import BOXES, EVENTS, EventTrace, Log, empty_trace
from formulations.proofs.part import PartBound

NARROW = 1e-11  # logarithmic width below which a box is undecided
_CAPACITY = 20_000  # events kept before they are moved out of the compiled search


class Anytime(Protocol):
    """A search whose unfinished attempts prove something too."""

    @property
    def reached(self) -> float:
        """The bound proved so far [s]."""
        ...

    @property
    def events(self) -> list[list[Any]]:
        """The events that prove it, as a certificate writes them."""
        ...


@dataclass(frozen=True)
class ProofSearch:
    """What a family's prover hands over: the domain, and one slice of the search.

    Attributes
    ----------
    n_variables, most_rows : int
        Variables of a box, and rows of an event.
    depth : int
        Number of boxes to begin with; 0 if L is below the sum of the least durations.
    advance : callable
        (depth, max_boxes, trace) -> (depth, stuck), see ``branch_and_bound`` of the families.
    durations : callable
        depth -> the durations at the middle of the next box, shape (n_segments,) [s].
    impossible : str
        Why no search can prove L; empty if one can.
    short : (float, Array) or None
        For 3-5-3 with a middle segment on which nothing moves: tau [s], and the discards for T2 <= tau.
    anytime : Anytime or None
        For a prover whose unfinished attempts prove something too.
    turns_cut : bool
        Whether a turn cuts the box by a search of roots, so that a certificate states the box after it.
    parts : tuple of PartBound
        Bounds of parts of the motion that the search uses.
    """

    n_variables: int
    most_rows: int
    depth: int
    advance: Callable[[int, int, EventTrace], tuple[int, bool]]
    durations: Callable[[int], Array]
    impossible: str = ""
    short: tuple[float, Array] | None = None
    anytime: Anytime | None = None
    turns_cut: bool = False
    parts: tuple[PartBound, ...] = ()


class Prover(Protocol):
    """A family's prover."""

    def __call__(
        self,
        problem: Problem,
        L: float,
        *,
        near: Array | None = None,
        narrow: float = NARROW,
        aside: bool = False,
        blur: Array | None = None,
    ) -> ProofSearch:
        """Set up one attempt to prove the bound L.

        Parameters
        ----------
        problem : Problem
            Waypoints and limits; something moves, and every moving joint has a limit.
        L : float [s]
            The bound to prove.
        near : Array, shape (n_segments,) [s], optional
            The best durations known: a hint that no proof rests on.
        narrow : float
            Logarithmic width below which a box is undecided.
        aside : bool
            Whether undecided boxes are set aside; a proof needs False.
        blur : Array, shape (n_segments, dof) [rad], optional
            By how much each displacement may differ, see ``domain.data_of``.

        Returns
        -------
        ProofSearch
            The search, at its beginning.
        """
        ...


class Proof:
    """Attempt to prove that no motion of the family takes L seconds or less.

    A feasible motion stays feasible when it is stretched. So if one took less than L, one would take
    exactly L, and the search shows that none does. An attempt ends ``proved`` or ``stuck``.
    """

    def __init__(self, search: ProofSearch, L: float, *, record: bool = False) -> None:
        """Begin an attempt.

        Parameters
        ----------
        search : ProofSearch
            From the family's prover, for the same L.
        L : float [s]
            The bound to prove.
        record : bool
            Whether the events are kept for a certificate.
        """
        self.search, self.L = search, L
        self.depth, self.stuck = search.depth, bool(search.impossible)
        self._trace = empty_trace(_CAPACITY if record else 0, search.n_variables, search.most_rows)
        self._moved: list[tuple[Any, ...]] = []

    @property
    def proved(self) -> bool:
        """Whether nothing of the domain is left: L is a lower bound."""
        return self.depth == 0 and not self.stuck

    @property
    def seconds(self) -> float:
        """The bound proved so far [s]: L once ``proved``."""
        if self.proved:
            return self.L
        return min(self.search.anytime.reached, self.L) if self.search.anytime else 0.0

    @property
    def boxes(self) -> int:
        """Number of boxes worked on so far."""
        return int(self._trace.counts[BOXES])

    def run(self, max_boxes: int) -> None:
        """Work on more boxes.

        Parameters
        ----------
        max_boxes : int
            Most boxes of this call.
        """
        target = self.boxes + max_boxes
        while self.depth > 0 and not self.stuck and self.boxes < target:
            self.depth, self.stuck = self.search.advance(self.depth, target - self.boxes, self._trace)
            self._empty_trace()

    def durations(self) -> Array:
        """Durations at the middle of the next box, shape (n_segments,) [s]."""
        return self.search.durations(self.depth)

    def log(self) -> Log:
        """Everything logged so far, in order."""
        if not self._moved:
            return Log(*(part[:0] for part in self._trace[1:]))
        return Log(*(np.concatenate(parts) for parts in zip(*self._moved, strict=True)))

    def _empty_trace(self) -> None:
        """Move the logged events out of the compiled search."""
        counts = self._trace.counts
        if counts[EVENTS]:
            self._moved.append(tuple(part[: counts[EVENTS]].copy() for part in self._trace[1:]))
            counts[EVENTS] = 0
