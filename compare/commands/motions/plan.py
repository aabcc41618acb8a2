"""``timebound plan FILE``: the fastest motion alone, under further conditions."""

from __future__ import annotations

import sys

from compare.commands import DONE, FAILED, INTERRUPTED
from compare.commands.motions.condition_options import PlanConditionOptions
from compare.commands.motions.problem_options import FileOrRobot, OwnRobotOptions, problem_of
from compare.commands.options import Export, Gap, Json, Rate, TimeLimit
from compare.interrupts import ctrl_c_stops
from compare.screen import show, stages
from formulations import (
    FreeForm,
    FreeFormBound,
    InputError,
    NoFeasibleMotion,
    NotFoundInTime,
    Problem,
)
from formulations import plan as find_motion
from formulations.optima.at_rate.export import check_export, export_motion
from formulations.optima.free_form import SearchStatus
from formulations.problem.toml_file.plain_conditions import asked_as_json
from formulations.proofs.status import BoundStatus

_SHOWN = 20  # times of waypoints

_CUT_SHORT = {
    SearchStatus.TIME_LIMIT: "the time limit ended the search",
    SearchStatus.INTERRUPTED: "Ctrl-C ended the search",
}


def plan(
    file: FileOrRobot = None,
    /,
    *,
    own: OwnRobotOptions = None,
    asked: PlanConditionOptions = None,
    gap: Gap = 1e-3,
    time_limit: TimeLimit = None,
    no_bound: bool = False,
    export: Export = None,
    rate: Rate = None,
    json: Json = None,
) -> int:
    """Find the fastest motion through the waypoints of a problem, or the smoothest in a given time.

    Ctrl-C ends the search with the best motion that was verified until then, and exit code 130.

    Parameters
    ----------
    no_bound
        Prove nothing about how fast any motion could be, which saves some seconds.
    """
    problem = problem_of(file, own, asked)
    if export is not None:
        check_export(export, problem, rate)
    try:
        with ctrl_c_stops() as asked_to_stop, stages(problem.name) as stage:
            motion = find_motion(
                problem,
                gap=gap,
                bound=not no_bound,
                time_limit=time_limit,
                stop=asked_to_stop,
                progress=stage,
            )
            interrupted = asked_to_stop()
    except NotFoundInTime as reason:
        print(f"error: {problem.name}: {reason}", file=sys.stderr)
        return INTERRUPTED if asked_to_stop() else FAILED
    except NoFeasibleMotion as reason:
        raise NoFeasibleMotion(f"{problem.name}: {reason}") from None
    found, bound = motion.found, motion.proof
    text = as_text(problem, found, bound)
    if export is not None:
        if found.trajectory is None:
            raise InputError("--export: no joint moves, so there is no motion to write")
        written = export_motion(export, problem, found.trajectory, rate)
        text = "\n".join([text, "", *written.lines()])
    show(text, as_json(problem, found, bound), json)
    return INTERRUPTED if interrupted else DONE


def as_text(problem: Problem, found: FreeForm, bound: FreeFormBound | None = None) -> str:
    """Say how long the motion takes, when it passes the waypoints, and which limits it uses most.

    Parameters
    ----------
    problem : Problem
        The task.
    found : FreeForm
        Its motion, judged.
    bound : FreeFormBound, optional
        What is proved of every motion under the same conditions.

    Returns
    -------
    str
        The lines.
    """
    lines = [f"{problem.name}: {found.seconds:.9g} s ({found.method}, {found.ending})"]
    if found.status in _CUT_SHORT:
        lines.append(f"{_CUT_SHORT[found.status]}: this is the best verified motion until then")
    if found.trajectory is None or found.verdict is None:
        return lines[0]
    if bound is not None:
        lines.append(_proved(bound, found.conditions.total is not None))
    passed = [f"{time:.6g}" for time in found.trajectory.passage_times]
    if len(passed) > _SHOWN:  # --json holds them all
        passed = [*passed[: _SHOWN // 2], "...", *passed[-_SHOWN // 2 :]]
    lines.append(f"waypoints passed at {', '.join(passed)} s")
    lines.append("verified: keeps every limit; used most:")
    used = [peak for peak in found.verdict.peaks if peak.quantity != "position"]
    lines += [f"  {peak}" for peak in used[:3]]
    return "\n".join([*lines, *found.notes])


def _proved(bound: FreeFormBound, timed: bool) -> str:
    """How fast any motion could be, in one line; timed: whether the motion takes a time that was asked for."""
    if not bound.seconds > 0.0:
        return f"no bound was proved ({bound.ending})"
    if timed:
        return f"without a total time: proved that no motion takes less than {bound.seconds:.9g} s"
    line = f"proved: no such motion takes less than {bound.seconds:.9g} s, gap {bound.gap or 0.0:.2g}"
    return line if bound.status is BoundStatus.PROVED else f"{line} ({bound.ending})"


def as_json(problem: Problem, found: FreeForm, bound: FreeFormBound | None = None) -> dict[str, object]:
    """The same as plain data, with every peak; joints and segments count from 1, as in the text.

    Conditions stand in it as in a problem file, in rad, where waypoints count from 0.

    Parameters
    ----------
    problem : Problem
        The task.
    found : FreeForm
        Its motion, judged.
    bound : FreeFormBound, optional
        What is proved of every motion under the same conditions.

    Returns
    -------
    dict
        Ready for strict JSON.
    """
    passed = [] if found.trajectory is None else found.trajectory.passage_times.tolist()
    return {
        "problem": problem.name,
        **asked_as_json(problem),
        "seconds": found.seconds,
        "passage_times": passed,
        "method": found.method,
        "status": found.status.value,
        "reason": found.reason,
        "notes": list(found.notes),
        "peaks": [
            {
                "quantity": peak.quantity,
                "joint": None if peak.joint < 0 else peak.joint + 1,
                "name": peak.name or None,
                "segment": peak.segment + 1,
                "time": peak.time,
                "value": peak.value,
                "limit": peak.limit,
                "unit": peak.unit_in("rad"),
                "factor": peak.factor,
            }
            for peak in (() if found.verdict is None else found.verdict.peaks)
        ],
        "runtime": found.runtime,
        "bound": None if bound is None or not bound.seconds > 0.0 else bound.seconds,
        "gap": None if bound is None or not bound.seconds > 0.0 else bound.gap,
    }
