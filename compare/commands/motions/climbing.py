"""Climb the ladder of a problem for a command: rungs as asked for, progress on standard error, Ctrl-C."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from math import isinf
from typing import Any

from formulations import InputError, Ladder, Problem, ladder
from formulations.climb import RungResult
from formulations.costs.demand_costs import demand_costs
from formulations.costs.left_out import left_out
from formulations.deadlines import Deadline
from formulations.diagnosis import Diagnosis, diagnose
from formulations.rungs import LARGE, usual_rungs, with_needs
from formulations.rungs import without as leave_out

_COSTS = (
    60.0  # s for what the demands cost where no time limit is given: each takes as long as the motion
)
_LADDER = 0.75  # of a time limit for the rungs of a problem with demands; the costs have the rest
_BEFORE_LIMITS = 2.0 / 3.0  # of what is left, for the costs where limits are to be raised after them


def chosen_rungs(
    problem: Problem, rungs: tuple[str, ...] | None, without: tuple[str, ...] | None
) -> tuple[str, ...]:
    """List the rungs to be climbed, and say on standard error which are left out of a large problem.

    Parameters
    ----------
    problem : Problem
    rungs, without : tuple of str or None
        The options ``--rungs`` and ``--without``.

    Returns
    -------
    tuple of str
        Keys of ``RUNGS``.

    Raises
    ------
    InputError
        If no rung is left.
    """
    chosen = usual_rungs(problem) if rungs is None else with_needs(rungs)
    chosen = leave_out(chosen, without or ())
    if not chosen:
        raise InputError("--without: no rung is left")
    if rungs is None and problem.n_segments > LARGE:
        print(
            f"{problem.name}: {problem.n_segments} segments: the rungs of the family are left out, as they "
            f"take long beyond {LARGE}; --rungs family,family_lower asks for them",
            file=sys.stderr,
        )
    return chosen


def climb(
    problem: Problem,
    rungs: tuple[str, ...],
    deadline: Deadline,
    stage: Callable[[str], None],
    **options: Any,
) -> tuple[Ladder, Diagnosis | None]:
    """Climb rungs, each of which is said on standard error as it is known, and diagnose the fastest motion.

    Parameters
    ----------
    problem : Problem
    rungs : tuple of str
        Keys of ``RUNGS``.
    deadline : Deadline
        The climb ends when it is over, with what is known. Under demands the rungs have three quarters of it,
        so that something is left for what the demands cost; without an end, these costs take 60 s at most.
    stage : callable
        Called with the name of each stage as it begins.
    **options
        As in ``formulations.ladder``.

    Returns
    -------
    Ladder
    Diagnosis or None
        What limits the fastest motion, and what each demand costs, or why that is not known; None where there
        is no motion, or no demand and no time. No limit holds the smoothest motion in a given time up.
    """
    rungs_end = deadline
    if next(left_out(problem), None) is not None:
        rungs_end = deadline.within(_LADDER * deadline.left)
    answer = ladder(
        problem,
        rungs=rungs,
        time_limit=rungs_end.left,
        stop=deadline.stop,
        progress=stage,
        finished=lambda result: print(_line(problem.name, result), file=sys.stderr, flush=True),
        **options,
    )
    if answer.free_form is None:
        return answer, None
    if isinf(deadline.end):
        costs_end = deadline.within(_COSTS)
    else:  # without sensitivities no limit is known to hold the motion up
        share = 1.0 if answer.free_form.sensitivity is None else _BEFORE_LIMITS
        costs_end = deadline.within(share * deadline.left)
    costs = demand_costs(
        problem,
        found=answer.free_form,
        proof=answer.free_form_bound,
        deadline=costs_end,
        progress=lambda what: stage(f"what a motion takes without {what}"),
    )
    seconds = answer.free_form.seconds
    if deadline.over or problem.conditions.total is not None:
        known = Diagnosis(seconds, (), (), seconds, problem.names, costs)
        return answer, known if costs else None
    stage("what limits the fastest motion")
    return answer, replace(diagnose(problem, answer.free_form, deadline=deadline), costs=costs)


def unsolved(answer: Ladder) -> str:
    """Say why there is no motion at all.

    Parameters
    ----------
    answer : Ladder

    Returns
    -------
    str
        The reason; empty if there is a motion, or none was asked for.
    """
    upper = [rung for rung in answer.rungs.values() if rung.kind == "upper"]
    if not upper or any(rung.status == "ok" for rung in upper):
        return ""
    return next((rung.note for rung in upper if rung.key == "free_form" and rung.note), upper[0].note)


def _line(name: str, rung: RungResult) -> str:
    """One rung as soon as it is known."""
    found = str(rung.status) if rung.seconds is None else f"{rung.seconds:.9g} s"
    return f"{name}: {rung.key}: {found}, took {rung.runtime:.2f} s"
