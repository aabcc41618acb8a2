"""``timebound view FILE [MOTION]``: one page about a problem, or about a motion beside its problem."""

from __future__ import annotations

import re
import sys
import webbrowser
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from compare.commands import BAD_INPUT, BROKEN, DONE, INTERRUPTED
from compare.commands.motions.climbing import chosen_rungs, climb, unsolved
from compare.commands.motions.condition_options import ConditionOptions
from compare.commands.motions.problem_options import (
    FileOrRobot,
    OwnRobot,
    OwnRobotOptions,
    known_arm,
    problem_of,
)
from compare.commands.options import Gap, Interpolation, Rungs, TimeLimit, Tolerance, Without, writable
from compare.files import output_folder, write_text
from compare.interrupts import ctrl_c_stops
from compare.report.view_page import view_page
from compare.report.viewed import Viewed
from compare.screen import stages
from formulations import Conditions, NoFeasibleMotion, Problem, plan
from formulations.assessment import beside
from formulations.deadlines import Deadline
from formulations.motion.files.motion_file import read_points_or_pieces
from formulations.motion.judgement import WAYPOINT_TOLERANCE, judge

_PLANNED = 0.75  # of a time limit for motion and bound under conditions; the ladder has the rest
_LONGEST, _SHOWN = 80, 40  # characters of the name of a page, and of that of a motion on it


def view(
    file: FileOrRobot = None,
    motion: Annotated[
        str | None,
        Parameter(
            name="MOTION",
            help="A motion to be judged: .csv, .json or .yaml (a ROS JointTrajectory), .npz or .pieces.json.",
        ),
    ] = None,
    /,
    *,
    own: OwnRobotOptions = None,
    asked: ConditionOptions = None,
    interpolation: Interpolation = "auto",
    tolerance: Tolerance = WAYPOINT_TOLERANCE,
    out: Annotated[str | None, Parameter(metavar="PAGE", validator=writable)] = None,
    show: Annotated[bool | None, Parameter(name="--open", negative="--no-open")] = None,
    gap: Gap = 1e-3,
    rungs: Rungs = None,
    without: Without = None,
    time_limit: TimeLimit = None,
) -> int:
    """Write one page about a problem, or about a motion, and open it: answers, limits, curves, the arm.

    The page holds all that it needs, so that it can be sent to somebody. With MOTION it begins with what that
    motion breaks. The arm is that of the case, of the key robot or arm in FILE, or of --robot.

    Exit code: 0, 3 if MOTION breaks something, 2 for bad input and where there is no motion at all, 130 if
    interrupted; the page then has what was known.

    Parameters
    ----------
    interpolation
        Join the points of MOTION in this way instead of the way that the controller would.
    tolerance
        By how much MOTION may miss a waypoint in each joint [rad; m for a prismatic joint].
    out
        The page; named after the problem if left out.
    show
        Open the page in the browser; done if left out where the output is a terminal.
    """
    if file is not None and motion is None and own is not None and own != OwnRobot():
        file, motion = None, file
    problem = problem_of(file, own, asked)
    conditions = problem.conditions
    arm = known_arm(file, own)
    judged = None
    if motion is not None:
        judged = judge(
            problem,
            read_points_or_pieces(motion, problem.names),
            interpolation=interpolation,
            tolerance=tolerance,
        )
    path = Path(out or page_name(problem))
    output_folder(path.parent)  # says so at once if it cannot be written to
    chosen = chosen_rungs(problem, rungs, without)
    deadline = Deadline(time_limit)
    planned, remarks = None, []
    with ctrl_c_stops() as stop, stages(problem.name) as stage:
        deadline.stop = stop
        if not conditions.none:
            try:
                planned = plan(
                    problem,
                    gap=gap,
                    time_limit=None if time_limit is None else _PLANNED * time_limit,
                    stop=stop,
                    progress=stage,
                )
            except NoFeasibleMotion as reason:
                remarks.append(f"No motion was found that keeps the conditions: {reason}.")
        # the ladder is that of the problem without conditions: what they cost is seen beside it
        alone = replace(problem, conditions=Conditions())
        answer, held = climb(alone, chosen, deadline, stage, gap=gap)
        interrupted = stop()
    bound = answer.free_form_bound
    if not conditions.none:
        bound = None if planned is None else planned.proof
    given = None if judged is None else beside(problem, judged, bound)
    failed = bool(remarks)
    if why := unsolved(answer):
        failed = failed or conditions.none
        remarks.append(
            f"No motion was found{'' if conditions.none else ' without the conditions'}: {why}."
        )
    if interrupted:
        remarks.append("This was interrupted: the page shows what was known until then.")
    page = view_page(
        Viewed(
            answer,
            held,
            conditions,
            planned,
            given,
            _short(Path(motion or "").name),
            arm,
            tuple(remarks),
        )
    )
    write_text(path, page)
    print(f"{path}: {len(page.encode()) / 1e6:.1f} MB")
    if (sys.stdout.isatty() if show is None else show) and not webbrowser.open(path.resolve().as_uri()):
        print(f"no browser was found; open {path} in one", file=sys.stderr)
    if interrupted:
        return INTERRUPTED
    if given is not None:
        return DONE if given.judgement.feasible else BROKEN
    for remark in remarks:
        print(f"{'error: ' * failed}{problem.name}: {remark}", file=sys.stderr)
    return BAD_INPUT if failed else DONE


def _short(name: str) -> str:
    """A file's name as it fits beside a chart."""
    return name if len(name) <= _SHOWN else f"{name[: _SHOWN // 2]}…{name[-_SHOWN // 2 :]}"


def page_name(problem: Problem) -> str:
    """Name a page after its problem: a file in the current folder, whatever the problem is called.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    str
        Letters, digits, dots, hyphens and underscores, and ``.html``.
    """
    name = re.sub(r"[^\w.-]+", "_", problem.name).strip("._-")
    return f"{name[:_LONGEST] or 'problem'}.html"
