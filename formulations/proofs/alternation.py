"""Proof and nonlinear program in turn, until the bound and the best motion meet.

The NLP gives the upper bound to start from. Where the proof cannot discard a box, the NLP starts again
from its middle. If it finds a better motion there, the proof starts again from that motion.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np

from formulations.deadlines import Deadline
from formulations.deadlines.deadline import Stop
from formulations.families import FAMILIES
from formulations.motion.verdict import check
from formulations.optima.family.optimum import local_optimum
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem
from formulations.proofs.part import PartBound
from formulations.proofs.proof import Proof, ProofSearch, Prover
from formulations.proofs.status import BoundStatus

_DIRECT = 0.1  # share of the time limit for an attempt at the final gap, before coarser ones
_PARTS = 0.4  # share of the time limit after which no more parts are bounded
_SLICE = 0.02  # s between looks at the clock
_RESTARTS = 30  # better motions that the proof may find
_BETTER = 1e-12  # relative; a smaller improvement is rounding
_LOOK = 9.0  # the proof runs this many times as long as the last NLP, before the NLP runs again
_FIRST_LOOK = 0.03  # s that stand for that NLP at first


class Alternation:
    """The alternation for one problem.

    ``best`` is the best proof so far, ``durations`` (n_segments,) [s] and ``upper`` [s] are those of the
    best motion, and ``boxes`` counts the boxes of all attempts.
    """

    def __init__(
        self,
        problem: Problem,
        begin: Prover,
        durations: Array,
        *,
        least: float = 0.0,
        most_boxes: int | None = None,
        record: bool = False,
        stop: Stop | None = None,
        progress: Callable[[float, int], None] | None = None,
        parts: Callable[..., tuple[PartBound, ...]] | None = None,
    ) -> None:
        """Begin with one motion.

        Parameters
        ----------
        problem : Problem
            Waypoints and limits.
        begin : Prover
            The family's prover.
        durations : Array, shape (n_segments,) [s]
            Durations to start from.
        least : float [s]
            A bound that is known already: no attempt is made at less.
        most_boxes : int, optional
            Boxes of all attempts together, after which the alternation ends.
        record : bool
            Whether the proofs are kept for a certificate.
        stop : callable, optional
            Asked again and again whether to end now.
        progress : callable, optional
            Is called with the bound so far [s] and the number of boxes.
        parts : callable, optional
            Proves bounds of parts of the motion for a long search, see ``four_three_four.parts``.

        Raises
        ------
        InputError
            If the motion of these durations does not pass the check.
        """
        self.problem, self.record, self.progress = problem, record, progress
        self.begin: Callable[..., ProofSearch] = begin
        self.least, self.interrupt, self.parts = least, Deadline(None, stop), parts
        self.boxes, self.restarts = 0, 0
        self.most_boxes = np.inf if most_boxes is None else most_boxes
        self.best: Proof | None = None
        self.paused: Proof | None = None
        self.upper, self.durations = np.inf, durations
        self._adopt(durations)
        if not np.isfinite(self.upper):
            raise InputError("optimum: its motion does not pass the check")
        first = self._attempt(self.upper)
        first.run(1)  # compiles what a search needs, before the clock runs
        self.anytime = first.search.anytime is not None
        self.deadline = np.inf

    def run(self, gap: float, time_limit: float) -> tuple[BoundStatus, str]:
        """Prove the best bound that the time allows.

        A first attempt goes for the final gap, for a tenth of the time: it suffices for most problems.
        Then parts of the motion are bounded, if ``parts`` can, and the gaps go from coarse to fine, so
        that a time limit leaves a bound that is nearly as good; at last the first attempt is resumed.
        An anytime prover needs no coarse gaps, because its unfinished attempts are bounds as well: it
        goes for the final gap all the time. With a limit on the boxes there is the first attempt alone.

        Parameters
        ----------
        gap : float
            Relative gap asked for.
        time_limit : float [s]
            For the proofs, apart from the NLP and from compiling.

        Returns
        -------
        status : BoundStatus
            How it ended.
        reason : str
            Why it is undecided; empty otherwise.
        """
        started = time.perf_counter()
        short = np.isfinite(self.most_boxes)
        self.deadline = started + (1.0 if self.anytime or short else _DIRECT) * time_limit
        outcome = self._pursue(gap)
        if outcome[0] is BoundStatus.PROVED or self.anytime or short:
            return outcome
        steps = 6 if self._prepare(started + _PARTS * time_limit) else 1
        self.deadline = started + time_limit
        # each step costs a multiple of the one before where parts have to help: short ones lose less
        coarse = [10.0 ** (-e / steps) for e in range(12 * steps)]
        coarse = [step for step in coarse if step > 2.0 * gap]
        for step in [*coarse, gap]:
            if self.best is not None and self.upper / (1.0 + step) <= self.best.seconds:
                continue
            outcome = self._pursue(step)
            if outcome[0] is not BoundStatus.PROVED:
                return outcome
        return BoundStatus.PROVED, ""

    def _prepare(self, until: float) -> bool:
        """Prove bounds of parts of the motion for the prover to use; returns whether there are any."""
        if self.parts is None:
            return False

        def over() -> bool:
            return time.perf_counter() >= until or self.interrupt.over

        known = self.parts(
            self.problem,
            self.durations,
            self.upper,
            record=self.record,
            over=over,
            progress=self._count,
        )
        if known:  # an attempt that knows them is worth more than the one that was paused
            self.begin, self.paused = partial(self.begin, parts=known), None
        return bool(known)

    def _count(self, boxes: int) -> None:
        self.boxes += boxes
        if self.progress is not None:
            self.progress(self.best.seconds if self.best else 0.0, self.boxes)

    def _pursue(self, gap: float) -> tuple[BoundStatus, str]:
        """Prove upper / (1 + gap), from better and better motions as the proof finds them."""
        while True:
            # a little finer than asked, so that rounding does not leave the gap a digit above it;
            # and never less than what is known already
            L = max(self.upper / (1.0 + gap * (1.0 - 1e-6)), self.least)
            resumed = self.paused is not None and self.paused.L == L
            proof = self.paused if resumed and self.paused else self._attempt(L)
            improved = self._run(proof)
            if proof.seconds > (self.best.seconds if self.best else 0.0):
                self.best = proof
            if proof.proved:
                return BoundStatus.PROVED, ""
            if improved:
                self.restarts += 1
                continue
            if self.interrupt.over:
                return BoundStatus.INTERRUPTED, ""
            if not proof.stuck:
                self.paused = proof
                out_of_boxes = self.boxes >= self.most_boxes
                return BoundStatus.BOX_LIMIT if out_of_boxes else BoundStatus.TIME_LIMIT, ""
            if proof.search.impossible:
                return BoundStatus.UNDECIDED, proof.search.impossible
            self.restarts += 1
            if not self._improve(proof.durations()) or self.restarts > _RESTARTS:
                middle = np.array2string(proof.durations(), precision=6)
                return BoundStatus.UNDECIDED, f"the box about {middle} s"

    def _attempt(self, L: float) -> Proof:
        return Proof(self.begin(self.problem, L, near=self.durations), L, record=self.record)

    def _run(self, proof: Proof) -> bool:
        """Run an attempt until it ends or the time does; returns whether a better motion was found.

        For an anytime prover the NLP looks for one near what is left, a tenth of the time.
        """
        slice_, looked, cost = 32, time.perf_counter(), _FIRST_LOOK
        while not (proof.proved or proof.stuck):
            before, clock = proof.boxes, time.perf_counter()
            left = self.most_boxes - self.boxes
            if clock >= self.deadline or self.interrupt.over or left <= 0:
                break
            proof.run(int(min(slice_, left)))
            took = max(time.perf_counter() - clock, 1e-6)
            slice_ = int(min(max((proof.boxes - before) * _SLICE / took, 1.0), 2.0 * slice_))
            self._count(proof.boxes - before)
            clock = time.perf_counter()
            looks = self.anytime and not proof.proved and self.restarts < _RESTARTS
            if looks and clock - looked > _LOOK * cost:
                if self._improve(proof.durations()):
                    return True
                looked = time.perf_counter()
                cost = looked - clock
        return False

    def _improve(self, guess: Array) -> bool:
        """Whether the NLP finds a better motion from the durations of an undecided box."""
        before, paused = self.upper, time.perf_counter()
        self._adopt(guess)
        local = local_optimum(self.problem, guess, deadline=self.interrupt)
        if np.isfinite(local.seconds):
            self._adopt(local.durations)
        self.deadline += time.perf_counter() - paused  # the time limit is for the proof alone
        return self.upper < before * (1.0 - _BETTER)

    def _adopt(self, durations: Array) -> None:
        """Keep durations, stretched to feasibility, if they beat the best and pass the check."""
        stretched, seconds = verified(self.problem, durations)
        if seconds < self.upper:
            self.upper, self.durations = seconds, stretched


def verified(problem: Problem, durations: Array) -> tuple[Array, float]:
    """Stretch durations to feasibility, and let the independent check judge their motion.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    durations : Array, shape (n_segments,) [s]
        Durations of any shape.

    Returns
    -------
    durations : Array, shape (n_segments,) [s]
        Stretched, if that is possible.
    seconds : float [s]
        Their total; infinite if the motion does not pass the check.
    """
    family = FAMILIES[problem.family]
    stretched = durations * check(problem, family.trajectory(problem, durations)).stretch
    if not (np.isfinite(stretched).all() and (stretched > 0.0).all()):
        return durations, np.inf
    verdict = check(problem, family.trajectory(problem, stretched))
    return stretched, verdict.seconds if verdict.feasible else np.inf
