"""Every rung of the ladder, in one list: ``RUNGS``. Pictures, tables, tests and JSON follow from it.

A reference has a file of its own in ``references``, and its entry stands there. The rungs that combine
others (the optimum and bound of the family, those of every motion) are found by the functions below.
"""

from __future__ import annotations

from collections.abc import Callable, Collection

import numpy as np

from formulations.climb import Climb, Ladder, RungResult
from formulations.deadlines import Deadline
from formulations.deadlines.deadline import Stop
from formulations.families import FAMILIES
from formulations.motion.verdict import TOLERANCE, check
from formulations.optima.family.papers_rule import longest_segment
from formulations.optima.free_form import FreeForm, free_form, proved_motion
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem
from formulations.problem.size import require_moderate
from formulations.proofs.each_joint import each_joint_alone
from formulations.proofs.every_motion.bound import free_form_bound
from formulations.proofs.family import affordable_gap, family_bound, proved_optimum
from formulations.proofs.status import BoundStatus
from formulations.references.copp_ import COPP_FAMILY_PATH
from formulations.references.displacement import DISPLACEMENT
from formulations.references.reference import Outcome, Rung, RungKind, Takes
from formulations.references.ruckig_ import RUCKIG_END_TO_END, RUCKIG_STOP_AND_GO
from formulations.references.toppra_ import TOPPRA_CUBIC, TOPPRA_FAMILY_PATH
from formulations.references.toppra_torque_ import TOPPRA_TORQUE

LARGE = 30  # segments; of larger problems the rungs of the family are computed on demand
_SHARE, _TIME_LIMIT = 0.5, 20.0  # of the time that is left, for one optimum; s, for another rung


def ladder(
    problem: Problem,
    *,
    seed: int = 0,
    certify: bool = True,
    certificate: bool = False,
    gap: float = 1e-3,
    rungs: Collection[str] | None = None,
    starts: int | None = None,
    time_limit: float | None = None,
    stop: Stop | None = None,
    progress: Callable[[str], None] | None = None,
    finished: Callable[[RungResult], None] | None = None,
) -> Ladder:
    """Compute every bound of one problem.

    A method that cannot be used or that fails does not end the ladder: its rung says so.

    Parameters
    ----------
    problem : Problem
        The task; see ``load``.
    seed : int
        Seed of the NLP's starts.
    certify : bool
        Whether to prove ``family_lower``, which takes most of the time on large problems.
    certificate : bool
        Whether to keep the proofs, in ``bound.certificate`` and ``free_form_bound.certificate``.
    gap : float
        Relative gap aimed at between ``free_form`` and ``free_form_lower``.
    rungs : collection of str, optional
        Keys of ``RUNGS``; those that they need are computed too. ``usual_rungs`` if left out.
    starts : int, optional
        Number of starts of the family's NLP. By default it starts once, and a proof shows that no
        durations are faster; where the proof is not short, it starts many times.
    time_limit : float, optional [s]
        For all rungs together. The searches then end with what they have, and a rung that has not begun
        says so.
    stop : callable, optional
        Asked again and again whether to end now.
    progress : callable, optional
        Called with the key of each rung before it is computed.
    finished : callable, optional
        Called with the result of each rung as soon as it is there.

    Returns
    -------
    Ladder
        One result per rung; ``to_json`` makes it plain data.

    Examples
    --------
    >>> import formulations as f
    >>> limits = f.Limits.of(velocity=2.0, acceleration=1.0, dof=1)
    >>> found = f.ladder(f.Problem.of([[0.0], [1.0], [3.0]], limits))
    >>> found.seconds("displacement")
    1.5
    >>> found.rungs["free_form"].status.value
    'ok'
    """
    require_moderate(problem)
    wanted = usual_rungs(problem) if rungs is None else with_needs(rungs)
    climb = Climb(problem, seed, certify, certificate, gap, Deadline(time_limit, stop), starts)
    chosen = {key: rung for key, rung in RUNGS.items() if key in wanted}
    return climb.run(chosen, progress or (lambda key: None), finished or (lambda result: None))


def usual_rungs(problem: Problem) -> tuple[str, ...]:
    """List the rungs that are computed where none are named.

    The optimum of a spline family takes minutes beyond ``LARGE`` segments, and its bound does not get
    near it. So of larger problems the rungs of the family are computed on demand only.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    tuple of str
        Keys of ``RUNGS``.
    """
    return tuple(RUNGS) if problem.n_segments <= LARGE else without(RUNGS, ["family"])


def with_needs(keys: Collection[str]) -> tuple[str, ...]:
    """Add the rungs that the chosen ones cannot do without.

    Parameters
    ----------
    keys : collection of str
        Keys of ``RUNGS``.

    Returns
    -------
    tuple of str
        In the order of ``RUNGS``.

    Raises
    ------
    InputError
        If there is no such rung.
    """
    if unknown := [key for key in keys if key not in RUNGS]:
        raise InputError(f"rungs: {unknown[0]!r} is not known (known: {', '.join(RUNGS)})")
    wanted = {*keys, *(need for key in keys for need in RUNGS[key].needs)}
    return tuple(key for key in RUNGS if key in wanted)


def without(keys: Collection[str], left_out: Collection[str]) -> tuple[str, ...]:
    """Leave rungs out, and all that need them.

    Parameters
    ----------
    keys, left_out : collection of str
        Keys of ``RUNGS``.

    Returns
    -------
    tuple of str
        In the order of ``RUNGS``.
    """
    gone = {key for key in RUNGS if {key, *RUNGS[key].needs} & set(left_out)}
    return tuple(key for key in RUNGS if key in keys and key not in gone)


def _free_form_lower(climb: Climb) -> Outcome:
    if not climb.problem.moving_joints and climb.problem.conditions.none:
        return Outcome.ok(0.0, note="nothing moves")
    options = {"gap": climb.gap, **climb.proof(_TIME_LIMIT)}
    if climb.free_form is None:
        asked = climb.problem.conditions.without_total(climb.problem)
        found = free_form_bound(climb.problem, conditions=asked, **options)
    else:
        upper = climb.seconds("free_form")
        climb.free_form, found = proved_motion(climb.free_form, upper=upper, **options)
        if upper is None or climb.free_form.seconds < upper:
            climb.record(RUNGS["free_form"], _of_motion(climb.free_form), climb.free_form.runtime)
    climb.free_form_bound = found
    note = f"by {found.method}"
    if found.gap is not None:
        note += f", gap {found.gap:.2g}"
    if found.status != "proved":
        note += f"; {found.ending}"
    # the simple bounds hold too; where one is as good, it is the one that is named
    simple = {key: climb.seconds(key) or 0.0 for key in ("displacement", "ruckig_end_to_end")}
    best = max(simple, key=lambda key: simple[key])
    if simple[best] >= found.seconds:
        return Outcome.ok(simple[best], note=f"that of {best}")
    return Outcome.ok(found.seconds, note=note)


def _free_form(climb: Climb) -> Outcome:
    if not climb.problem.moving_joints and climb.problem.conditions.none:
        return Outcome.ok(0.0, note="nothing moves")
    found = free_form(
        climb.problem,
        tolerance=climb.gap,
        time_limit=_SHARE * climb.deadline.left,
        stop=climb.deadline.stop,
    )
    climb.free_form = found
    # splines and stop-and-go are motions too; the fastest one of all is reported
    others = {key: climb.seconds(key) for key in ("family", "ruckig_stop_and_go")}
    for key, seconds in others.items():
        if seconds is not None and seconds < found.seconds and key in climb.trajectories:
            return Outcome.ok(
                seconds,
                durations=np.diff(climb.trajectories[key].passage_times),
                trajectory=climb.trajectories[key],
                note=f"that of {key}; the program's takes {found.seconds:.9g} s",
            )
    return _of_motion(found)


def _of_motion(found: FreeForm) -> Outcome:
    note = "; ".join([found.method, *found.notes, *([found.ending] * (found.status != "ok"))])
    return Outcome.ok(found.seconds, durations=found.durations, trajectory=found.trajectory, note=note)


def _family(climb: Climb) -> Outcome:
    left, gap = _SHARE * climb.deadline.left, affordable_gap(climb.problem.family)[0]
    optimum, bound = proved_optimum(
        climb.problem, gap=gap, time_limit=left, record=climb.certificate, **climb.search
    )
    verdict = optimum.verdict
    if not verdict.feasible:
        return Outcome.failed(f"did not pass the check: {verdict.faults[0]}")
    climb.optimum, climb.bound = optimum, bound if climb.certify else None
    return Outcome.ok(
        verdict.seconds,
        durations=optimum.durations,
        trajectory=optimum.trajectory,
        note=f"{optimum.family}; {optimum.agreement}"
        + ("; stopped before all starts had ended" if optimum.stopped else ""),
    )


def _family_lower(climb: Climb) -> Outcome:
    if not climb.certify:
        return Outcome.not_applicable("not asked for")
    if climb.optimum is None:
        return Outcome.not_applicable("there is no family optimum to start from")
    gap, time_limit = affordable_gap(climb.problem.family)
    climb.bound = bound = climb.bound or family_bound(
        climb.problem, gap=gap, optimum=climb.optimum, **climb.proof(time_limit)
    )
    whole = climb.seconds("free_form_lower") or 0.0
    refused = bound.status is BoundStatus.NOT_APPLICABLE
    if refused and not whole > bound.seconds:
        return Outcome.not_applicable(bound.reason)
    state = bound.reason if refused else bound.outcome
    note = f"{bound.boxes} boxes, gap {bound.gap:.2g}" if bound.boxes else state
    if bound.boxes and bound.status is not BoundStatus.PROVED:
        note += f", {state}"
    if bound.upper < climb.optimum.seconds * (1.0 - gap):
        note += f"; the proof found a faster motion, {bound.upper:.9g} s"
    if whole > bound.seconds:  # its splines are motions
        left = climb.optimum.seconds / whole - 1.0
        return Outcome.ok(whole, note=f"that of all motions, gap {left:.2g}; {note}")
    return Outcome.ok(bound.seconds, note=note)


def _longest_segment(climb: Climb) -> Outcome:
    if climb.optimum is None:
        return Outcome.not_applicable("there is no family optimum")
    climb.alone = each_joint_alone(climb.problem, time_limit=climb.deadline.left, **climb.search)
    moving = [optimum.durations for optimum in climb.alone if optimum is not None]
    if not moving:
        return Outcome.ok(climb.optimum.seconds, note="nothing moves")
    rule = longest_segment(climb.problem, moving)
    trajectory = FAMILIES[climb.problem.family].trajectory(climb.problem, rule.durations)
    verdict = check(climb.problem, trajectory)
    claim = f"claims {rule.claimed.sum():.6g} s"
    if not verdict.feasible:
        return Outcome.failed(f"{claim}; no stretch mends it: {verdict.faults[0]}")
    kept = rule.stretch <= 1.0 + TOLERANCE
    broken = "keeps the limits" if kept else f"needs a stretch of {rule.stretch:.6g}"
    return Outcome.ok(
        verdict.seconds, durations=rule.durations, trajectory=trajectory, note=f"{claim}, {broken}"
    )


RUNGS: dict[str, Rung] = {
    rung.key: rung
    for rung in (
        DISPLACEMENT,
        RUCKIG_END_TO_END,
        Rung(
            key="free_form_lower",
            kind=RungKind.LOWER,
            name="best bound on any motion",
            meaning="no motion is faster: the best such bound",
            find=_free_form_lower,
            takes=Takes.CLIMB,
            certified=True,
            after=("displacement", "ruckig_end_to_end", "free_form"),
            knows_conditions=True,
        ),
        Rung(
            key="free_form",
            kind=RungKind.UPPER,
            name="fastest motion known",
            meaning="fastest verified motion through the waypoints",
            find=_free_form,
            takes=Takes.CLIMB,
            certified=True,
            after=("ruckig_stop_and_go", "family"),
            knows_conditions=True,
        ),
        RUCKIG_STOP_AND_GO,
        Rung(
            key="family_lower",
            kind=RungKind.LOWER,
            name="certified bound of the family",
            meaning="no durations in the family are faster, certified",
            find=_family_lower,
            takes=Takes.CLIMB,
            certified=True,
            after=("family", "free_form_lower"),
            needs=("family",),
        ),
        Rung(
            key="family",
            kind=RungKind.UPPER,
            name="optimum of the family",
            meaning="exact NLP optimum of the family",
            find=_family,
            takes=Takes.CLIMB,
            certified=True,
        ),
        Rung(
            key="family_longest_segment",
            kind=RungKind.UPPER,
            name="each joint alone, longest time per segment, stretched",
            meaning="each joint alone, longest time per segment, stretched",
            find=_longest_segment,
            takes=Takes.CLIMB,
            certified=True,
            after=("family",),
            needs=("family",),
        ),
        TOPPRA_FAMILY_PATH,
        TOPPRA_CUBIC,
        TOPPRA_TORQUE,
        COPP_FAMILY_PATH,
    )
}

REFERENCES: dict[str, Callable[[Problem], Outcome]] = {
    key: rung.find for key, rung in RUNGS.items() if rung.takes is Takes.PROBLEM
}
