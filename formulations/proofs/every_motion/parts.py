"""The bound in narrower and narrower boxes, which are split where narrowing ends.

A motion may pass a waypoint at far apart times, say on its way out or on its way back. Then two regions of a
box hold motions that are nearly the fastest, and every relaxation between them is loose. So the box of a
duration is split, each part is narrowed by itself, and the bound is the least one of all parts (branch and
bound). The part with the least bound is split first.

References
----------
Land & Doig 1960, "An automatic method of solving discrete programming problems", Econometrica 28,
pp. 497-520.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from formulations.deadlines import Deadline
from formulations.problem.arrays import Array
from formulations.proofs.every_motion.events import Event, EventLog, rows_of
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.in_band import least_time, long_chain
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram, LPSolution
from formulations.proofs.every_motion.relaxation.propagation import propagate
from formulations.proofs.every_motion.relaxation.relaxed_problem import DOWN, RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.tightening import FEW, MANY, tighten

_ROUNDS, _TOLERANCE = 100, 1e-9  # of cuts
_STEPS = 30  # of narrower boxes
_SLOW = 0.1  # of the way to the target: a step that gains less needs better bounds, or a split
_MARGIN = 1e-10  # of the bound, for the checker's own boxes and rows
_IN_VAIN = 4  # splits without a gain, after which there are no more
_DEEPEST = 50  # splits inside each other


@dataclass(eq=False)
class Part:
    """Boxes, what is proved of the motions in them, and what is written down of it.

    Attributes
    ----------
    boxes : Boxes
    cuts : Cuts
    depth : int
        How many splits it is away from the whole.
    bound : float [s]
        The best one so far, with all waits.
    empty : bool
        Whether no motion is left in the boxes.
    log : EventLog
    end : tuple
        How many events the best bound needs, and the event that ends its proof.
    """

    boxes: Boxes
    cuts: Cuts
    depth: int = 0
    bound: float = 0.0
    empty: bool = False
    log: EventLog = field(default_factory=EventLog)
    end: tuple[int, list[Event]] = (0, [])

    def close(self) -> None:
        """End the events with the proof of the best bound."""
        kept, last = self.end
        self.log.events[kept:] = last


class PartedProof:
    """The proof of one bound on all motions of at most ``horizon`` seconds.

    Attributes
    ----------
    bound : float [s]
        0 where nothing was proved.
    least : Part
        The part with this bound.
    """

    def __init__(
        self,
        relaxed: RelaxedProblem,
        horizon: float,
        target: float,
        typical: Array,
        deadline: Deadline,
        *,
        for_checker: bool,
    ) -> None:
        """Take what is to be proved.

        Parameters
        ----------
        relaxed : RelaxedProblem
            For this horizon.
        horizon : float [s]
            The time H, with all waits.
        target : float [s]
            The bound to stop at.
        typical : Array, shape (n_segments,) [s]
            Units of the durations.
        deadline : Deadline
        for_checker : bool
            Whether a checker has to be able to follow the proof from its events.
        """
        self.relaxed, self.horizon, self.target = relaxed, horizon, min(target, horizon)
        self.units, self.deadline, self.for_checker = relaxed.units(typical), deadline, for_checker

    def prove(self, boxes: Boxes, cuts: Cuts, *, stuck_at: float = 0.0) -> list[Event]:
        """Narrow boxes and split them, until the target is reached or no split gains anything.

        Parameters
        ----------
        boxes : Boxes
            They hold every motion of at most ``horizon`` seconds.
        cuts : Cuts
            To begin with.
        stuck_at : float, optional [s]
            The bound in these boxes, where narrowing them any more is known to gain nothing.

        Returns
        -------
        list
            The events, as ``events`` describes them, if they are for a checker.
        """
        root = self._narrowed(Part(boxes, cuts), stuck_at, MANY if stuck_at else FEW)
        open_parts, in_vain = [root], 0
        while in_vain < _IN_VAIN and not self.deadline.over:
            least = min(open_parts, key=lambda part: part.bound)
            if least.bound >= self.target or least.depth == _DEEPEST or least.empty:
                break
            halves = self._split(least)
            if halves is None:
                break
            gained = any(half.bound >= self.target for half in halves)
            open_parts.remove(least)
            open_parts += halves
            now = min(part.bound for part in open_parts)
            gained |= now - least.bound > _SLOW * (self.target - least.bound)
            in_vain = 0 if gained else in_vain + 1
        for part in open_parts:
            part.close()
        self.least = min(open_parts, key=lambda part: part.bound)
        self.bound = self.least.bound
        return root.log.events

    def frame(self, boxes: Boxes) -> Frame:
        """Pose the rows in the boxes of a part.

        Parameters
        ----------
        boxes : Boxes

        Returns
        -------
        Frame
        """
        return Frame(self.relaxed, boxes, self.units)

    def _split(self, part: Part) -> list[Part] | None:
        """Split the widest duration; None where that proves less, as at the end of the time.

        Of a long chain every duration is as wide, and no split of one of them gains anything.
        """
        if long_chain(self.frame(part.boxes)):
            return None
        low, high = part.boxes.durations[: self.relaxed.n_segments].T
        k = int(np.argmax(high - low))
        at = 0.5 * float(low[k] + high[k])
        if not low[k] < at < high[k]:
            return None
        halves = []
        for side in (0, 1):
            durations = part.boxes.durations.copy()
            durations[k, 1 - side] = at
            boxes = Boxes(
                durations, part.boxes.accelerations, part.boxes.offsets, part.boxes.velocities
            )
            halves.append(self._narrowed(Part(boxes, part.cuts, part.depth + 1)))
        if min(half.bound for half in halves) < part.bound:
            return None
        part.log.split(self.relaxed, k, at, [half.log.events for half in halves])
        return halves

    def _narrowed(self, part: Part, before: float = 0.0, rounds: int = FEW) -> Part:
        """Narrow the boxes of a part as long as that gains something."""
        record = part.log if self.for_checker else None
        boxes, cuts = propagate(self.relaxed, part.boxes), part.cuts
        part.log.renewed()
        for _ in range(_STEPS):
            if boxes.empty:  # the events end with "E", or with the "P" that leaves a box empty
                part.log.without_time(self.relaxed, boxes)
                return self._nothing_left(part, [])
            program = LinearProgram(self.frame(boxes), cuts, for_checker=self.for_checker)
            solution = least_time(
                program,
                rounds=_ROUNDS,
                tolerance=_TOLERANCE,
                deadline=self.deadline,
                ceiling=self.relaxed.horizon,
            )
            if solution.empty:
                return self._nothing_left(part, self._last("E", program, solution))
            bound = min((solution.bound + self.relaxed.waits) * DOWN, self.horizon)
            bound *= 1.0 - _MARGIN if self.for_checker else 1.0
            if bound > part.bound:
                part.bound = bound
                part.end = len(part.log.events), self._last("F", program, solution)
            slow = bound - before < _SLOW * (self.target - before)
            stuck = slow and rounds == MANY
            if part.bound >= self.target or self.deadline.over or stuck:
                break
            before, rounds = bound, MANY if slow else rounds
            boxes, cuts = tighten(program, solution, self.deadline, record, rounds)
        part.boxes, part.cuts = boxes, cuts
        return part

    def _last(self, letter: str, program: LinearProgram, solution: LPSolution) -> list[Event]:
        return [[letter, rows_of(program, solution.multipliers)]] if self.for_checker else []

    def _nothing_left(self, part: Part, last: list[Event]) -> Part:
        part.bound, part.empty = self.horizon, True
        part.end = len(part.log.events), last
        return part
