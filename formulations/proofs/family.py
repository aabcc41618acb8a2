"""The certified global lower bound of a spline family, and the optimum it meets.

Branch and bound proves that no durations of the family take L seconds or less, for L = upper / (1 +
gap) (``bounds``); every operation that carries the proof is rounded outward. The NLP gives the upper
bound to start from; where the proof cannot discard a box, the NLP starts again from its middle, and the
proof from whatever better basin that finds, until they meet.

What the bound covers. It holds for every choice of durations whose spline keeps the velocity,
acceleration and jerk limits exactly and the position limits to within ``problem.position_slack``, the
slack of the check and of the swarms' objective. The check also lets a relative excess of ``TOLERANCE``
over the derivative limits pass. Stretching by 1 + TOLERANCE mends that (jerk and acceleration fall
faster than velocity), so what the check lets pass takes at least ``seconds / (1 + TOLERANCE)``:
``least_verified``. The bound is kept for the exact limits, as those are what the problem states.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from formulations.families import FAMILIES
from formulations.motion.trajectory import TOLERANCE, check
from formulations.optima.family.optimum import FamilyOptimum, family_optimum, polished
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, NoFeasibleMotion
from formulations.problem.problem import Problem
from formulations.proofs.certificate import certificate_of, certificate_of_proof
from formulations.proofs.domain import data_of
from formulations.proofs.every_motion.velocity_acceleration import velocity_acceleration_bound
from formulations.proofs.four_three_four import bound as four_three_four
from formulations.proofs.proof import Proof, Prover
from formulations.proofs.quintic import bound as quintic
from formulations.proofs.three_five_three import bound as three_five_three

PROVERS: dict[str, Prover] = {
    "3-5-3": three_five_three.begin,
    "4-3-4": four_three_four.begin,
    "quintic": quintic.begin,
}

# of a B-spline each piece depends on every duration: enclosures are of use only on boxes so narrow that
# there are too many
_EVERY_MOTION = "what is proved holds for every motion through the waypoints, not for B-splines alone"

_STRAIGHT = 0.1  # share of the time limit for going straight to the gap that was asked for
_SLICE = 0.02  # s between looks at the clock
_SMALLEST = 1e-150  # rad; squares and quotients of smaller displacements leave the range of floats
_RESTARTS = 30  # better basins the proof may find
_BETTER = 1e-12  # relative; less is rounding
_LOOK, _FIRST_LOOK = 9.0, 0.03  # times what the NLP took [s], before it is asked again; at first


@dataclass(frozen=True)
class FamilyBound:
    """What is proved of one family: no durations are faster than ``seconds``.

    seconds: certified lower bound [s], valid whatever the status; 0 at worst. durations: the best
    found, (n_segments,) [s], None if none are known; upper: their verified total [s]. boxes: of all
    attempts. runtime: s of this machine, NLP and compilation included. status: "proved" (the asked gap
    was reached), "time limit", "undecided: reason" or "not applicable: reason". certificate: plain
    data, if recorded.
    """

    problem: Problem
    family: str
    seconds: float
    durations: Array | None
    upper: float
    boxes: int
    runtime: float
    status: str
    certificate: dict[str, Any] | None = field(default=None, repr=False)

    @property
    def gap(self) -> float:
        """Upper / seconds - 1; 0 if nothing moves (then both are 0), infinite without a bound."""
        if self.seconds > 0.0:
            return self.upper / self.seconds - 1.0
        return 0.0 if self.upper == 0.0 else float("inf")

    @property
    def least_verified(self) -> float:
        """No motion of the family that passes the check is faster than this [s].

        Its tolerance, and a thousandth of that for the rounding of the check itself.
        """
        return self.seconds * (1.0 - 1.001 * TOLERANCE)


def family_bound(
    problem: Problem,
    *,
    family: str | None = None,
    gap: float = 1e-7,
    time_limit: float = 60.0,
    optimum: FamilyOptimum | None = None,
    record: bool = False,
    progress: Callable[[float, int], None] | None = None,
) -> FamilyBound:
    """Prove a lower bound on the total time of a family's splines, durations shared by all joints.

    gap: relative gap asked for. time_limit: s for the proof, apart from the NLP and from compiling;
    when it ends, the best bound proved by then is returned. optimum: start from it instead of solving
    the NLP. record: keep the certificate of the bound. progress(seconds, boxes): called as the proof
    goes on. One joint alone: pass ``problem.joint(j)``. Raises UnsupportedProblem where the family has
    no spline, InputError for a gap that is not positive.
    """
    started = time.perf_counter()
    if not (gap > 0.0 and np.isfinite(gap)):
        raise InputError(f"gap: {gap!r} is not a positive number")
    if not time_limit >= 0.0:
        raise InputError(f"time_limit: {time_limit!r} s is not a time")
    chosen = FAMILIES[family or problem.family]
    chosen.require(problem)
    problem = replace(problem, family=chosen.name)
    answer = partial(_answer, problem, started)
    if not problem.moving_joints:
        return answer(0.0, np.full(problem.n_segments, 0.0), 0.0, 0, "proved")
    simple = displacement_bound(problem)
    reason = _refusal(problem)
    if reason:
        known = None if optimum is None else optimum.durations
        upper = np.inf if optimum is None else optimum.seconds
        return answer(simple, known, upper, 0, f"not applicable: {reason}")
    try:
        found = (optimum or family_optimum(problem)).durations
    except NoFeasibleMotion as failure:
        return answer(simple, None, np.inf, 0, f"not applicable: {failure}")
    if chosen.name not in PROVERS:
        motions = velocity_acceleration_bound(problem)
        events = motions.events(problem.moving_joints) if motions.seconds > simple else []
        seconds = max(simple, motions.seconds)
        found, upper = _verified(problem, found)
        status = "proved" if upper <= seconds * (1.0 + gap) else f"undecided: {_EVERY_MOTION}"
        certificate = certificate_of(problem, seconds, events) if record else None
        return answer(seconds, found, upper, 0, status, certificate)
    pursuit = _Pursuit(problem, PROVERS[chosen.name], found, record, progress)
    status = pursuit.run(gap, time_limit)
    proof, certificate = pursuit.best, None
    seconds = max(simple, proof.seconds if proof else 0.0)
    if record:
        if proof is not None and proof.seconds >= simple:
            certificate = certificate_of_proof(problem, proof)
        else:
            certificate = certificate_of(problem, simple)
    return answer(seconds, pursuit.durations, pursuit.upper, pursuit.boxes, status, certificate)


def _answer(
    problem: Problem,
    started: float,
    seconds: float,
    durations: Array | None,
    upper: float,
    boxes: int,
    status: str,
    certificate: dict[str, Any] | None = None,
) -> FamilyBound:
    runtime = time.perf_counter() - started
    return FamilyBound(
        problem, problem.family, seconds, durations, upper, boxes, runtime, status, certificate
    )


def displacement_bound(problem: Problem) -> float:
    """Sum over the segments of displacement over top speed [s], rounded down; 0 if nothing moves."""
    if not problem.moving_joints:
        return 0.0
    data = data_of(problem)
    return float((data.least / data.derivatives[0]).max(axis=1).sum() * (1.0 - 1e-13))


def _refusal(problem: Problem) -> str:
    """Why no bound beyond the displacements can be proved; empty if one can."""
    data = data_of(problem)
    unlimited = np.isinf(data.derivatives).all(axis=0)
    if unlimited.any():
        joint = problem.moving_joints[int(unlimited.argmax())]
        return f"joint {joint + 1} moves without a limit on velocity, acceleration or jerk"
    if (data.least[data.d != 0.0] < _SMALLEST).any():
        return f"a displacement is smaller than {_SMALLEST:g} rad"
    return ""


def _verified(problem: Problem, durations: Array) -> tuple[Array, float]:
    """Durations stretched to feasibility and their total [s], infinite if they do not pass the check."""
    family = FAMILIES[problem.family]
    stretched = durations * check(problem, family.trajectory(problem, durations)).stretch
    if not (np.isfinite(stretched).all() and (stretched > 0.0).all()):
        return durations, np.inf
    verdict = check(problem, family.trajectory(problem, stretched))
    return stretched, verdict.seconds if verdict.feasible else np.inf


class _Pursuit:
    """Proof and NLP in turn: ``best`` is the best proof so far, ``upper`` the best motion's time."""

    def __init__(
        self,
        problem: Problem,
        begin: Prover,
        durations: Array,
        record: bool,
        progress: Callable[[float, int], None] | None,
    ) -> None:
        self.problem, self.begin, self.record, self.progress = problem, begin, record, progress
        self.simple = displacement_bound(problem)
        self.boxes, self.restarts = 0, 0
        self.best: Proof | None = None
        self.upper, self.durations = np.inf, durations
        self._adopt(durations)
        if not np.isfinite(self.upper):
            raise InputError("optimum: its motion does not pass the check")
        first = self._attempt(self.upper)
        first.run(1)  # compiles what a search needs, before the clock runs
        self.anytime = first.setup.anytime is not None
        self.deadline = np.inf

    def run(self, gap: float, time_limit: float) -> str:
        """Straight to the gap if that is cheap, else from coarse to fine: no time is lost.

        Where an unfinished attempt proves something too, straight to the gap all the time.
        """
        started = time.perf_counter()
        self.deadline = started + (1.0 if self.anytime else _STRAIGHT) * time_limit
        outcome = self._pursue(gap)
        if outcome == "proved" or self.anytime:
            return outcome
        self.deadline = started + time_limit
        rungs = [10.0**-e for e in range(12) if 10.0**-e > 2.0 * gap]
        for rung in [*rungs, gap]:
            if self.best is not None and self.upper / (1.0 + rung) <= self.best.seconds:
                continue
            outcome = self._pursue(rung)
            if outcome != "proved":
                return outcome
        return "proved"

    def _pursue(self, gap: float) -> str:
        """Prove upper / (1 + gap), from better and better motions as the proof finds them."""
        while True:
            # a little finer than asked, so that rounding does not leave the gap a digit above it
            # and never for less than the displacements give
            proof = self._attempt(max(self.upper / (1.0 + gap * (1.0 - 1e-6)), self.simple))
            improved = self._run(proof)
            if proof.seconds > (self.best.seconds if self.best else 0.0):
                self.best = proof
            if proof.proved:
                return "proved"
            if improved:
                self.restarts += 1
                continue
            if not proof.stuck:
                return "time limit"
            if proof.setup.impossible:
                return f"undecided: {proof.setup.impossible}"
            self.restarts += 1
            if not self._improve(proof.durations()) or self.restarts > _RESTARTS:
                return f"undecided: the box about {np.array2string(proof.durations(), precision=6)} s"

    def _attempt(self, L: float) -> Proof:
        return Proof(self.begin(self.problem, L, near=self.durations), L, record=self.record)

    def _run(self, proof: Proof) -> bool:
        """Run an attempt until it ends, the time does, or (then true) a better motion is found.

        For one, the NLP looks near what an anytime attempt cannot discard, a tenth of the time.
        """
        slice_, looked, cost = 32, time.perf_counter(), _FIRST_LOOK
        while not (proof.proved or proof.stuck):
            before, clock = proof.boxes, time.perf_counter()
            if clock >= self.deadline:
                break
            proof.run(slice_)
            took = max(time.perf_counter() - clock, 1e-6)
            slice_ = int(min(max((proof.boxes - before) * _SLICE / took, 1.0), 2.0 * slice_))
            self.boxes += proof.boxes - before
            if self.progress is not None:
                self.progress(self.best.seconds if self.best else 0.0, self.boxes)
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
        local = polished(self.problem, guess)
        if np.isfinite(local.seconds):
            self._adopt(local.durations)
        self.deadline += time.perf_counter() - paused  # the limit is the proof's alone
        return self.upper < before * (1.0 - _BETTER)

    def _adopt(self, durations: Array) -> None:
        """Keep durations, stretched to feasibility, if they beat the best and pass the check."""
        stretched, seconds = _verified(self.problem, durations)
        if seconds < self.upper:
            self.upper, self.durations = seconds, stretched
