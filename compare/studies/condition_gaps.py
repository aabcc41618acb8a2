"""How near motions under conditions come to their bounds: behind ``timebound condition_gaps``.

Of each condition random problems are drawn, with one to three joints, three to five waypoints, and a jerk
limit in four of five. A motion is found, its bound is proved, and where that leaves a gap a motion is looked
for near the relaxation. The independent check judges the motion, and the certificate of the bound is proved
again by the checker.
"""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from compare.check_certificate.answers import BadInput, Refused
from compare.check_certificate.verify import verify
from compare.screen import table
from compare.studies.conditioned_problems import KINDS, drawn_problem
from compare.studies.study import Call, Study, median_and_largest
from formulations import (
    NoFeasibleMotion,
    check,
    free_form,
    free_form_bound,
    proved_motion,
)

_TIME_LIMIT = 20.0  # s for a proof
_GAP = 5e-5  # asked for


@dataclass(frozen=True)
class ConditionAnswer:
    """One problem: times [s] of the motion, None where none was found, and of the bound.

    certified: the bound that the checker has proved again [s]. runtime, proof: for the first motion, and
    for the bound with what is found on the way [s].
    """

    kind: str
    seed: int
    joints: int
    segments: int
    seconds: float | None
    feasible: bool
    bound: float
    certified: float | None
    status: str
    runtime: float
    proof: float

    @property
    def gap(self) -> float:
        """Seconds over the bound, minus 1; infinite without a motion, or where nothing is proved."""
        if self.seconds is None or self.bound == 0.0:
            return np.inf
        return self.seconds / self.bound - 1.0


def answered(kind: str, seed: int) -> list[ConditionAnswer]:
    """Find a motion under a condition, bound it, and prove the bound again.

    Parameters
    ----------
    kind : str
        A key of ``KINDS``.
    seed : int
        Of the problem.

    Returns
    -------
    list of ConditionAnswer
        One row.
    """
    problem = drawn_problem(kind, seed)
    started = time.perf_counter()
    try:
        found = free_form(problem, tolerance=1e-4)
    except NoFeasibleMotion:
        motion, runtime = None, time.perf_counter() - started
        bound = free_form_bound(problem, gap=_GAP, time_limit=_TIME_LIMIT, record=True)
    else:
        runtime = time.perf_counter() - started
        found, bound = proved_motion(found, gap=_GAP, time_limit=_TIME_LIMIT, record=True)
        motion = found.trajectory
    feasible = motion is not None and check(problem, motion).feasible
    seconds = motion.seconds if motion is not None and feasible else None
    try:
        certified = _proved_again(bound.certificate)
    except (BadInput, Refused):
        certified = None
    return [
        ConditionAnswer(
            kind,
            seed,
            problem.dof,
            problem.n_segments,
            seconds,
            feasible,
            bound.seconds,
            certified,
            bound.ending,
            runtime,
            bound.runtime,
        )
    ]


def _proved_again(certificate: dict[str, Any] | None) -> float | None:
    if certificate is None:
        return None
    verify(certificate)
    return float.fromhex(certificate["seconds"])


def calls(count: int, kinds: tuple[str, ...] = tuple(KINDS)) -> list[Call]:
    """List the calls of the study.

    Parameters
    ----------
    count : int
        Problems of each condition.
    kinds : tuple of str
        Keys of ``KINDS``.

    Returns
    -------
    list of tuples
        Arguments of ``answered``.
    """
    return [(kind, seed) for kind in kinds for seed in range(count)]


@dataclass(frozen=True)
class ConditionSummary:
    """What matters of the problems of one condition.

    near: gap of at most 1e-4. below: motions faster than their bound. certified: bounds that the checker
    proved again to within 1e-3. gap, runtime, proof: median and largest.
    """

    kind: str
    problems: int
    found: int
    near: int
    below: int
    certified: int
    gap: tuple[float, float]
    runtime: tuple[float, float]
    proof: tuple[float, float]


def summarise(answers: list[ConditionAnswer]) -> list[dict[str, Any]]:
    """Sum the problems of each condition up.

    Parameters
    ----------
    answers : list of ConditionAnswer
        All rows.

    Returns
    -------
    list of dict
        A ``ConditionSummary`` each.
    """
    found = []
    for kind in dict.fromkeys(a.kind for a in answers):
        mine = [a for a in answers if a.kind == kind]
        found.append(
            asdict(
                ConditionSummary(
                    kind,
                    len(mine),
                    sum(a.seconds is not None for a in mine),
                    sum(a.gap <= 1e-4 for a in mine),
                    sum(a.gap < -1e-9 for a in mine),
                    sum(
                        a.certified is not None and a.certified >= a.bound * (1.0 - 1e-3) for a in mine
                    ),
                    median_and_largest([a.gap for a in mine]),
                    median_and_largest([a.runtime for a in mine]),
                    median_and_largest([a.proof for a in mine]),
                )
            )
        )
    return found


def as_text(answers: list[ConditionAnswer], summary: list[dict[str, Any]]) -> str:
    """Show a line per condition, and one per problem with a gap above 1e-4.

    Parameters
    ----------
    answers : list of ConditionAnswer
        All rows.
    summary : list of dict
        Of ``summarise``.

    Returns
    -------
    str
    """
    header = ["condition", "problems", "found", "gap <= 1e-4", "below bound", "certified"]
    header += ["median gap", "largest", "motion [s]", "proof [s]"]
    rows = [
        [
            s.kind, str(s.problems), str(s.found), str(s.near), str(s.below), str(s.certified),
            f"{s.gap[0]:.1e}", f"{s.gap[1]:.1e}", f"{s.runtime[0]:.2f}", f"{s.proof[0]:.2f}",
        ]
        for s in (ConditionSummary(**entry) for entry in summary)
    ]  # fmt: skip
    text = table(header, rows, right=tuple(range(1, 10)))
    far = [a for a in answers if not a.gap <= 1e-4]
    if far:
        lines = [f"{a.kind}, seed {a.seed}: gap {a.gap:.1e} ({a.status})" for a in far]
        text += "\n\nabove 1e-4:\n" + "\n".join(lines)
    return text


STUDY = Study(
    name="condition_gaps",
    row=ConditionAnswer,
    compute=answered,
    summarise=summarise,
    text=as_text,
)
