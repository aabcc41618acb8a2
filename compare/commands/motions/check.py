"""``timebound check PROBLEM MOTION``: a motion from elsewhere, judged as a controller would run it."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.commands import BROKEN, DONE
from compare.commands.motions.condition_options import ConditionOptions
from compare.commands.motions.problem_options import (
    FileOrRobot,
    OwnRobot,
    OwnRobotOptions,
    problem_of,
)
from compare.commands.options import Interpolation, Json, Tolerance
from compare.report.judged import FoundTable, distance, fault_tables, holding, mending, opening
from compare.screen import show, stages, table
from formulations import InputError
from formulations.assessment import Assessment, assess
from formulations.motion.files.motion_file import read_points_or_pieces
from formulations.motion.judgement import WAYPOINT_TOLERANCE
from formulations.problem.toml_file.plain_conditions import asked_as_json


def check_motion(
    file: FileOrRobot = None,
    motion: Annotated[
        str | None,
        Parameter(
            name="MOTION",
            help="The motion: .csv, .json or .yaml (a ROS JointTrajectory), .npz or .pieces.json.",
        ),
    ] = None,
    /,
    *,
    own: OwnRobotOptions = None,
    asked: ConditionOptions = None,
    interpolation: Interpolation = "auto",
    tolerance: Tolerance = WAYPOINT_TOLERANCE,
    bound: Annotated[bool, Parameter(negative="--no-bound")] = True,
    json: Json = None,
) -> int:
    """Judge a motion made elsewhere: its limits, its waypoints, and its gap to the fastest.

    The points of the file are joined as joint_trajectory_controller joins them: by straight lines where
    they have positions alone, by cubics where they have velocities too, by quintics where they have
    accelerations too. The motion between them is judged in continuous time, by exact extremes. In what is
    found, joints and waypoints count from 1. Without FILE, MOTION stands alone before --robot.

    Exit code: 0 if the motion keeps everything, 3 if it breaks something, 2 for bad input.

    Parameters
    ----------
    interpolation
        Join the points in this way instead.
    tolerance
        By how much a waypoint may be missed in each joint [rad; m for a prismatic joint].
    bound
        Prove a bound that no motion beats, and show the gap to it (seconds of work).
    """
    if motion is None and own is not None and own != OwnRobot():
        file, motion = None, file
    if motion is None:
        raise InputError("MOTION: missing: a problem FILE and MOTION are needed, or MOTION and --robot")
    problem = problem_of(file, own, asked)
    given = read_points_or_pieces(motion, problem.names)
    with stages(problem.name) as stage:
        stage("extremes, waypoints, bound")
        found = assess(
            problem,
            given,
            interpolation=interpolation,
            tolerance=tolerance,
            bound=bound,
        )
    show(as_text(motion, found), {**found.to_json(), **asked_as_json(problem)}, json)
    return DONE if found.judgement.feasible else BROKEN


def as_text(path: str, found: Assessment) -> str:
    """Say whether the motion is good, all that is wrong, what would mend it, and how far it is.

    Parameters
    ----------
    path : str
        File of the motion.
    found : Assessment
        What was found.

    Returns
    -------
    str
        The lines.
    """
    broken = "keeps" if found.judgement.feasible else "BREAKS"
    held = holding(found)
    joined, passed, *others = opening(found)
    return "\n".join(
        [
            f"{path}: {broken} what {found.problem.name} asks for",
            joined,
            f"{passed} (--tolerance)",
            *others,
            *map(_set, fault_tables(found)),
            "",
            *mending(found),
            *distance(found),
            *([] if held is None else [_set(held)]),
        ]
    )


def _set(one: FoundTable) -> str:
    return f"\n{table(one.header, one.rows, right=one.right)}"
