"""An attempt to prove one bound, run in slices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.events import BOXES, EVENTS, N_COUNTS, empty_log

NARROW = 1e-11  # logarithmic width below which a box is undecided
_CAPACITY = 20_000  # events kept before they are moved out of the compiled search


class Anytime(Protocol):
    """What an attempt has proved by now: reached [s], and the events of its certificate."""

    @property
    def reached(self) -> float:
        """No motion of the family is faster [s]."""
        ...

    @property
    def events(self) -> list[list[Any]]:
        """What proves it, as a certificate writes it."""
        ...


@dataclass(frozen=True)
class Setup:
    """What a family's prover needs to begin: the domain, and one slice of the search.

    advance(depth, max_boxes, counts, log) -> (depth, stuck), see ``search``; durations(depth): those at
    the middle of the next box, (n_segments,) [s]. depth 0: L is below the sum of the least durations.
    impossible: why no search can prove L. short: with a middle segment of 3-5-3 on which nothing moves,
    tau and the discards for T2 <= tau (``three_five_three_short``). anytime: of a prover whose
    unfinished attempts prove something too.
    """

    n_variables: int
    most_rows: int
    depth: int
    advance: Callable[[int, int, Any, Any], tuple[int, bool]]
    durations: Callable[[int], Array]
    impossible: str = ""
    short: tuple[float, Array] | None = None
    anytime: Anytime | None = None


class Prover(Protocol):
    """A family's prover: everything for one attempt at the bound L [s]."""

    def __call__(
        self,
        problem: Problem,
        L: float,
        *,
        near: Array | None = None,
        narrow: float = NARROW,
        aside: bool = False,
        blur: Array | None = None,
    ) -> Setup:
        """Set the search up. near: the best durations known, (n_segments,) [s], a hint that no proof
        rests on. narrow, aside: see ``search``; a proof needs aside=False.
        blur: see ``data_of``.
        """
        ...


@dataclass(frozen=True)
class Log:
    """Events of a search: codes (m, 3), values (m,), boxes (m, 2, n), rows (m, most_rows, WIDTH)."""

    codes: Any
    values: Any
    boxes: Any
    rows: Any


class Proof:
    """Attempt to prove that no motion of the family takes L seconds or less.

    Stretching a feasible motion keeps it feasible, so if any took less than L, one would take exactly
    L; the search shows that none does. It is finished when ``proved`` or ``stuck``.
    """

    def __init__(self, setup: Setup, L: float, *, record: bool = False) -> None:
        self.setup, self.L = setup, L
        self.depth, self.stuck = setup.depth, bool(setup.impossible)
        self.counts = np.zeros(N_COUNTS, np.int64)
        self._log = empty_log(_CAPACITY if record else 0, setup.n_variables, setup.most_rows)
        self._moved: list[tuple[Any, ...]] = []

    @property
    def proved(self) -> bool:
        """Whether nothing of the domain is left: L is a lower bound."""
        return self.depth == 0 and not self.stuck

    @property
    def seconds(self) -> float:
        """The bound proved by now: L once ``proved``."""
        if self.proved:
            return self.L
        return min(self.setup.anytime.reached, self.L) if self.setup.anytime else 0.0

    @property
    def boxes(self) -> int:
        """Boxes worked on so far."""
        return int(self.counts[BOXES])

    def run(self, max_boxes: int) -> None:
        """Work on at most so many more boxes."""
        target = self.boxes + max_boxes
        while self.depth > 0 and not self.stuck and self.boxes < target:
            self.depth, self.stuck = self.setup.advance(
                self.depth, target - self.boxes, self.counts, self._log
            )
            self._move()

    def durations(self) -> Array:
        """Durations at the middle of the box to be worked on next, (n_segments,) [s]."""
        return self.setup.durations(self.depth)

    def _move(self) -> None:
        """Empty the log into a list."""
        if self.counts[EVENTS]:
            self._moved.append(tuple(part[: self.counts[EVENTS]].copy() for part in self._log))
            self.counts[EVENTS] = 0

    def log(self) -> Log:
        """Everything logged so far, in order."""
        if not self._moved:
            return Log(*(part[:0] for part in self._log))
        return Log(*(np.concatenate(parts) for parts in zip(*self._moved, strict=True)))
