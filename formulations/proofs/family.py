"""The optimum and the certified lower bound of a spline family, and the registry of provers.

Branch and bound proves that no durations of the family take L seconds or less, for L = upper / (1 +
gap), where ``upper`` is the time of a verified motion. Every operation that carries the proof is rounded
outward. ``alternation`` lets proof and nonlinear program work in turn until they meet.

What the bound covers. It holds for every choice of durations whose spline keeps the velocity,
acceleration and jerk limits exactly and the position limits to within ``problem.position_slack``, the
slack of the check and of the swarms' objective. The check also accepts a relative excess of
``TOLERANCE`` over the derivative limits. A stretch by 1 + TOLERANCE removes this excess (acceleration
and jerk fall faster than velocity), so a motion that passes the check takes at least
``seconds / (1 + TOLERANCE)``: ``least_verified``. The bound itself is for the exact limits, because
these are what the problem states.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from formulations.deadlines import Deadline
from formulations.deadlines.deadline import Stop
from formulations.families import FAMILIES
from formulations.motion.verdict import TOLERANCE
from formulations.optima.family.exchange import Start
from formulations.optima.family.optimum import (
    FamilyOptimum,
    best_of,
    family_optimum,
    local_optimum,
)
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, NoFeasibleMotion
from formulations.problem.problem import Problem
from formulations.proofs.alternation import Alternation, verified
from formulations.proofs.b_spline import bound as b_spline
from formulations.proofs.certificate import certificate_of, certificate_of_proof
from formulations.proofs.displacement import exceeded_time
from formulations.proofs.domain import data_of
from formulations.proofs.four_three_four import bound as four_three_four
from formulations.proofs.four_three_four.parts import parts_of
from formulations.proofs.proof import Prover
from formulations.proofs.quintic import bound as quintic
from formulations.proofs.status import BoundStatus
from formulations.proofs.three_five_three import bound as three_five_three

PROVERS: dict[str, Prover] = {
    "3-5-3": three_five_three.begin,
    "4-3-4": four_three_four.begin,
    "quintic": quintic.begin,
    "b-spline-3": b_spline.prover_of(3),
    "b-spline-5": b_spline.prover_of(5),
}

# the boxes of a short proof cost about as much as the many starts that it replaces
_SHORT_PROOF, _SHORT_TIME = 10_000, 20.0  # boxes; s
_BETTER = 1e-12  # relative; a smaller improvement is rounding
_SMALLEST = 1e-150  # rad; squares and quotients of smaller displacements leave the range of floats


def affordable_gap(family: str) -> tuple[float, float]:
    """Say to which gap the bound of a family is proved where nothing else is asked for.

    Parameters
    ----------
    family : str
        Name of the family.

    Returns
    -------
    gap : float
        Relative gap.
    time_limit : float [s]
        What the proof may take.
    """
    # the boxes of a B-spline cost twenty times as much as those of the other families
    return (1e-3, 180.0) if family.startswith("b-spline") else (1e-7, 20.0)


@dataclass(frozen=True)
class FamilyBound:
    """What is proved of one family: no durations are faster than ``seconds``.

    Attributes
    ----------
    problem : Problem
        The problem, with the family that the bound is about.
    family : str
        Name of the family.
    seconds : float [s]
        Certified lower bound, valid whatever the status; 0 at worst.
    durations : Array, shape (n_segments,) [s], or None
        The best durations found.
    upper : float [s]
        Their verified total.
    boxes : int
        Boxes of all attempts.
    runtime : float [s]
        On this machine, NLP and compilation included.
    status : BoundStatus
        How the proof ended.
    reason : str
        Why it is undecided or not applicable; empty otherwise.
    certificate : dict or None
        The proof as plain data, if it was recorded.
    """

    problem: Problem
    family: str
    seconds: float
    durations: Array | None
    upper: float
    boxes: int
    runtime: float
    status: BoundStatus
    reason: str = ""
    certificate: dict[str, Any] | None = field(default=None, repr=False)

    @property
    def gap(self) -> float:
        """Upper / seconds - 1; 0 if nothing moves (then both are 0), infinite without a bound."""
        if self.seconds > 0.0:
            return self.upper / self.seconds - 1.0
        return 0.0 if self.upper == 0.0 else float("inf")

    @property
    def outcome(self) -> str:
        """Status and reason in one line."""
        return f"{self.status}: {self.reason}" if self.reason else str(self.status)

    @property
    def least_verified(self) -> float:
        """No motion of the family that passes the check is faster than this [s].

        The margin is the check's tolerance, and a thousandth of it for the rounding of the check itself.
        """
        return self.seconds * (1.0 - 1.001 * TOLERANCE)

    def __repr__(self) -> str:
        return f"FamilyBound({self.seconds:.9g} s, gap {self.gap:.2g}, {self.outcome})"


def family_bound(
    problem: Problem,
    *,
    family: str | None = None,
    gap: float = 1e-7,
    time_limit: float = 60.0,
    stop: Stop | None = None,
    most_boxes: int | None = None,
    optimum: FamilyOptimum | None = None,
    record: bool = False,
    progress: Callable[[float, int], None] | None = None,
) -> FamilyBound:
    """Prove a lower bound on the total time of a family's splines, with durations shared by all joints.

    For the bound of one joint alone, pass ``problem.joint(j)``.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    family : str, optional
        Name of the spline family; the problem's own by default.
    gap : float
        Relative gap asked for.
    time_limit : float [s]
        For the proof, apart from the NLP and from compiling. When it ends, the best bound proved so far
        is returned.
    stop : callable, optional
        Asked again and again whether to end now.
    most_boxes : int, optional
        The proof ends after so many boxes, too.
    optimum : FamilyOptimum, optional
        Motion to start from; by default that of ``proved_optimum``.
    record : bool
        Whether to keep the certificate.
    progress : callable, optional
        Is called with the bound so far [s] and the number of boxes.

    Returns
    -------
    FamilyBound
        The bound and how the proof ended.

    Raises
    ------
    UnsupportedProblem
        If the family has no spline for this problem.
    InputError
        If the gap is not positive, or the time limit negative.
    """
    started = time.perf_counter()
    if not (gap > 0.0 and np.isfinite(gap)):
        raise InputError(f"gap: {gap!r} is not a positive number")
    Deadline(time_limit)  # refuses what is no time
    chosen = FAMILIES[family or problem.family]
    chosen.require(problem)
    problem = replace(problem, family=chosen.name)

    def answer(
        seconds: float,
        durations: Array | None,
        upper: float,
        status: BoundStatus,
        reason: str = "",
        *,
        boxes: int = 0,
        certificate: dict[str, Any] | None = None,
    ) -> FamilyBound:
        runtime = time.perf_counter() - started
        return FamilyBound(
            problem, chosen.name, seconds, durations, upper, boxes, runtime, status, reason, certificate
        )

    if not problem.moving_joints:
        return answer(0.0, np.full(problem.n_segments, 0.0), 0.0, BoundStatus.PROVED)
    simple = exceeded_time(problem)
    if reason := _refusal(problem):
        known = None if optimum is None else optimum.durations
        upper = np.inf if optimum is None else optimum.seconds
        return answer(simple, known, upper, BoundStatus.NOT_APPLICABLE, reason)
    if optimum is None:
        try:
            optimum, proved = proved_optimum(problem, gap=gap, stop=stop, record=record)
        except NoFeasibleMotion as failure:
            return answer(simple, None, np.inf, BoundStatus.NOT_APPLICABLE, str(failure))
        if proved is not None:
            return replace(proved, runtime=time.perf_counter() - started)
    found = optimum.durations
    if chosen.name not in PROVERS:
        found, upper = verified(problem, found)
        certificate = certificate_of(problem, simple) if record else None
        reason = f"the family {chosen.name} has no prover: displacement over speed bounds it"
        return answer(simple, found, upper, BoundStatus.UNDECIDED, reason, certificate=certificate)
    prover = PROVERS[chosen.name]
    alternation = Alternation(
        problem,
        prover,
        found,
        least=simple,
        most_boxes=most_boxes,
        record=record,
        stop=stop,
        progress=progress,
        parts=parts_of if chosen.name == "4-3-4" else None,
    )
    status, reason = alternation.run(gap, time_limit)
    proof, certificate = alternation.best, None
    if record:
        if proof is not None and proof.seconds >= simple:
            certificate = certificate_of_proof(problem, proof)
        else:
            certificate = certificate_of(problem, simple)
    return answer(
        max(simple, proof.seconds if proof else 0.0),
        alternation.durations,
        alternation.upper,
        status,
        reason,
        boxes=alternation.boxes,
        certificate=certificate,
    )


def proved_optimum(
    problem: Problem,
    *,
    gap: float = 1e-7,
    starts: int | None = None,
    seed: int = 0,
    time_limit: float | None = None,
    stop: Stop | None = None,
    record: bool = False,
) -> tuple[FamilyOptimum, FamilyBound | None]:
    """Find the optimum of the problem's family from one start, where a short proof shows that it is one.

    The proof finds better basins on its way. Where it does not end within ``_SHORT_PROOF`` boxes, or
    the family has no prover, many starts take its place.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    gap : float
        Relative gap that the proof has to reach.
    starts : int, optional
        Number of starts, in place of one start and a proof.
    seed : int
        As in ``family_optimum``.
    time_limit : float, optional [s]
        For everything.
    stop : callable, optional
        Asked again and again whether to end now.
    record : bool
        Whether to keep the certificate.

    Returns
    -------
    optimum : FamilyOptimum
        The best motion found.
    bound : FamilyBound or None
        The bound, if the short proof reached the gap.

    Raises
    ------
    UnsupportedProblem, NoFeasibleMotion, NotFoundInTime
        As in ``family_optimum``.
    """
    deadline = Deadline(time_limit, stop)
    known: list[Start] = []
    if starts is None and problem.family in PROVERS and problem.moving_joints:
        with suppress(NoFeasibleMotion):
            one = family_optimum(problem, starts=1, seed=seed, time_limit=deadline.left, stop=stop)
            bound = family_bound(
                problem,
                gap=gap,
                time_limit=deadline.within(_SHORT_TIME).left,
                stop=stop,
                most_boxes=_SHORT_PROOF,
                optimum=one,
                record=record,
            )
            known.append(one.starts[0])
            if bound.upper < one.seconds * (1.0 - _BETTER) and bound.durations is not None:
                known.append(local_optimum(problem, bound.durations, deadline=deadline))
            best = best_of(problem, known)
            if bound.status is BoundStatus.PROVED and best.settled:
                return best, bound
            if deadline.over:
                return best, None
    many = family_optimum(problem, starts=starts, seed=seed, time_limit=deadline.left, stop=stop)
    return best_of(problem, [*many.starts, *known[1:]]), None


def _refusal(problem: Problem) -> str:
    """Why nothing beyond displacement over speed can be proved; empty if more can."""
    data = data_of(problem)
    unlimited = np.isinf(data.derivatives).all(axis=0)
    if unlimited.any():
        joint = problem.moving_joints[int(unlimited.argmax())]
        return f"{problem.joint_name(joint)} moves without a limit on velocity, acceleration or jerk"
    if (data.least[data.d != 0.0] < _SMALLEST).any():
        return f"a displacement is smaller than {_SMALLEST:g} rad"
    return ""
