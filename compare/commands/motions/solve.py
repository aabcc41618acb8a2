"""``timebound solve FILE``: every bound of one problem, on screen and as JSON."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Annotated, Any

from cyclopts import Parameter

from compare.commands import BAD_INPUT, DONE, FAILED, INTERRUPTED
from compare.commands.motions.climbing import chosen_rungs, climb, unsolved
from compare.commands.motions.condition_options import PlanConditionOptions
from compare.commands.motions.problem_options import FileOrRobot, OwnRobotOptions, problem_of
from compare.commands.options import (
    Export,
    Gap,
    Json,
    Rate,
    Rungs,
    Seed,
    Starts,
    TimeLimit,
    Without,
    writable,
)
from compare.interrupts import ctrl_c_stops
from compare.report.asked_words import sentences
from compare.screen import show, stages, table
from formulations import RUNGS, InputError, Ladder, Problem
from formulations.costs.demand_costs import DemandCost
from formulations.deadlines import Deadline
from formulations.optima.at_rate.export import check_export, export_motion
from formulations.problem.toml_file.plain_conditions import asked_as_json
from formulations.proofs.certificate import write_certificate

_LINES = 8  # of what limits the fastest motion, of what is asked for
_PROOF = {"lower": "proved", "upper": "verified", "reference": "discretised"}


def solve(
    file: FileOrRobot = None,
    /,
    *,
    own: OwnRobotOptions = None,
    asked: PlanConditionOptions = None,
    json: Json = None,
    certificate: Annotated[str | None, Parameter(metavar="FILE", validator=writable)] = None,
    motion_certificate: Annotated[str | None, Parameter(metavar="FILE", validator=writable)] = None,
    gap: Gap = 1e-3,
    rungs: Rungs = None,
    without: Without = None,
    time_limit: TimeLimit = None,
    export: Export = None,
    rate: Rate = None,
    seed: Seed = 0,
    starts: Starts = None,
) -> int:
    """Find every bound of one problem: what no motion can beat, and the best motions known.

    The rungs are listed from the shortest time to the longest. The gap is that between the fastest motion,
    free_form, and the bound on every motion, free_form_lower. Then it says which limits hold the motion up,
    and what each condition costs or saves: it solves the problem again without it. For that it takes 60 s at
    most, or what --time-limit leaves, a quarter of it at least; what was not computed is named.

    Parameters
    ----------
    certificate
        Write the proof of family_lower, for timebound check_certificate.
    motion_certificate
        Write the proof of free_form_lower, which holds for every motion.
    """
    problem = problem_of(file, own, asked)
    if export is not None:
        check_export(export, problem, rate)
    chosen = chosen_rungs(problem, rungs, without)
    deadline = Deadline(time_limit)
    with ctrl_c_stops() as stop, stages(problem.name) as stage:
        deadline.stop = stop
        answer, held = climb(
            problem,
            chosen,
            deadline,
            stage,
            seed=seed,
            certificate=bool(certificate or motion_certificate),
            gap=gap,
            starts=starts,
        )
        interrupted = stop()
    text = [
        f"{problem.name}: {problem.title}",
        f"{problem.dof} joints, {problem.n_segments} segments, family {problem.family}",
        *_asked(problem),
        "",
        as_text(answer),
    ]
    if held is not None and held.holds:
        text += ["\nwhat limits the fastest motion", *(f"  {line}" for line in held.lines()[:_LINES])]
    if held is not None and held.costs:
        text += ["\nwhat each demand costs", *(f"  {line}" for line in _costs(held.costs))]
    diagnosis = None if held is None else held.to_json()
    show("\n".join(text), {**answer.to_json(), **asked_as_json(problem), "diagnosis": diagnosis}, json)
    say = sys.stderr if json == "-" else sys.stdout
    if reason := unsolved(answer):
        print(f"error: {problem.name}: no motion was found: {reason}", file=sys.stderr)
        return BAD_INPUT
    if export is not None:
        print(f"\n{_export(export, problem, answer, rate)}", file=say)
    wanted = {
        "family_lower": (certificate, answer.bound),
        "free_form_lower": (motion_certificate, answer.free_form_bound),
    }
    code = INTERRUPTED if interrupted else DONE
    for key, (path, bound) in wanted.items():
        if path is None:
            continue
        if bound is None or bound.certificate is None:
            rung = answer.rungs.get(key)
            reason = (
                "it was not asked for"
                if rung is None
                else rung.note or "nothing was proved beyond the displacements"
            )
            print(f"{key}: no certificate was written: {reason}", file=sys.stderr)
            code = FAILED
        else:
            write_certificate(path, bound.certificate)
            print(f"\n{path}: proof of {_proved(bound.certificate):.9g} s, {key}", file=say)
    return code


def as_text(answer: Ladder) -> str:
    """Lay the ladder out as a table, shortest time first; rungs without a number last, with reasons.

    Parameters
    ----------
    answer : Ladder
        The rungs of one problem.

    Returns
    -------
    str
        The table, then the notes.
    """
    rungs = sorted(answer.rungs.values(), key=lambda r: (r.seconds is None, r.seconds or 0.0))
    rows = [
        [
            rung.key,
            "-" if rung.seconds is None else f"{rung.seconds:.6f} s",
            _PROOF[rung.kind] if rung.status == "ok" else str(rung.status),
            f"{rung.runtime:.2f} s",
            RUNGS[rung.key].meaning,
        ]
        for rung in rungs
    ]
    notes = [f"  {rung.key}: {rung.note}" for rung in rungs if rung.note]
    header = ["rung", "time", "status", "took", "what it is"]
    return "\n".join([table(header, rows, right=(1, 3)), "", "notes", *notes])


def _asked(problem: Problem) -> list[str]:
    """Say at the head of the ladder what is asked for beyond waypoints and limits of both directions."""
    said = sentences(problem, problem.conditions)
    if not problem.limits.symmetric:
        said.append("Its limits differ between the directions.")
    more = [f"and {len(said) - _LINES} demands more"] if len(said) > _LINES else []
    return ["asked for:", *(f"  {line}" for line in [*said[:_LINES], *more])] if said else []


def _costs(costs: Sequence[DemandCost]) -> list[str]:
    """What each demand costs, and which costs are not known, by reason."""
    lines = [cost.line for cost in costs if cost.seconds is not None]
    unknown: dict[str, list[str]] = {}
    for cost in costs:
        if cost.seconds is None:
            unknown.setdefault(cost.unknown, []).append(cost.what)
    for why, whats in unknown.items():
        more = "; a greater --time-limit computes more" if "was over" in why else ""
        lines.append(f"not computed, {why}{more}:")
        lines += [f"  {what}" for what in whats[:_LINES]]
        lines += [f"  and {len(whats) - _LINES} more"] if len(whats) > _LINES else []
    return lines


def _export(path: str, problem: Problem, answer: Ladder, rate: float | None) -> str:
    """Write the fastest motion that passed the check, and say which it is."""
    verified = {key: answer.rungs[key].seconds or 0.0 for key in answer.trajectories}
    verified = {key: value for key, value in verified.items() if answer.rungs[key].kind == "upper"}
    if not verified:
        raise InputError("--export: there is no verified motion")
    key = min(verified, key=lambda key: verified[key])
    written = export_motion(path, problem, answer.trajectories[key], rate)
    return "\n".join([f"{key}, {verified[key]:.9g} s", *written.lines()])


def _proved(certificate: dict[str, Any]) -> float:
    """The time that a certificate proves to be out of reach [s]."""
    return float.fromhex(certificate["seconds"])
