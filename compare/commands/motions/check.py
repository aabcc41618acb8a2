"""``timebound check PROBLEM MOTION``: a motion from elsewhere, judged as a controller would run it."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from cyclopts import Parameter

from compare.commands import BROKEN, DONE
from compare.commands.motions.condition_options import ConditionOptions, conditions_of
from compare.commands.motions.problem_options import (
    FileOrRobot,
    OwnRobot,
    OwnRobotOptions,
    problem_of,
)
from compare.commands.options import Json, positive
from compare.screen import show, stages, table
from formulations import InputError
from formulations.assessment import Assessment, assess
from formulations.motion.files.motion_file import read_points
from formulations.motion.judgement import WAYPOINT_TOLERANCE
from formulations.motion.peaks import QUANTITIES, Peak
from formulations.motion.smoothness import Jump
from formulations.problem.joint_words import factors, shown_unit

_LINES = 8  # of a table of what holds the motion up, and of jumps


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
    interpolation: Literal["auto", "linear", "cubic", "quintic"] = "auto",
    tolerance: Annotated[
        float, Parameter(name="--tolerance", metavar="RAD", validator=positive)
    ] = WAYPOINT_TOLERANCE,
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
    problem = problem_of(file, own)
    conditions = conditions_of(asked, problem)
    points = read_points(motion)
    with stages(problem.name) as stage:
        stage("extremes, waypoints, bound")
        found = assess(
            problem,
            points,
            interpolation=interpolation,
            tolerance=tolerance,
            conditions=conditions,
            bound=bound,
        )
    show(as_text(motion, found), found.to_json(), json)
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
    judged, problem = found.judgement, found.problem
    broken = "keeps" if judged.feasible else "BREAKS"
    count = len(judged.motion.durations)
    joined = {"linear": "straight lines", "cubic": "cubics", "quintic": "quintics"}
    how = joined.get(judged.interpolation, "exact polynomials")
    passed = len(problem.waypoints) - len(judged.missed)
    return "\n".join(
        [
            f"{path}: {broken} what {problem.name} asks for",
            f"{judged.seconds:.6g} s; {how} between {count + 1} points, as a controller joins them",
            f"{passed} of {len(problem.waypoints)} waypoints passed within {judged.tolerance:g} rad "
            "(--tolerance)",
            *_faults(found),
            "",
            *_mending(found),
            *_distance(found),
            *_holding(found),
        ]
    )


def _faults(found: Assessment) -> list[str]:
    """A table for each kind of fault that there is."""
    judged = found.judgement
    lines = []
    if judged.violations:
        header = ["broken limit", "joint", "time", "value", "limit", "factor"]
        rows = [_limit_row(found, peak) for peak in judged.violations]
        lines += ["", table(header, rows, right=(2, 3, 4, 5))]
    jumps = [(jump, f"{jump.count} of {len(judged.motion.durations) - 1}") for jump in judged.jumps]
    rests = [(jump, _place(jump)) for jump in judged.not_at_rest]
    for title, found_jumps in (
        ("jump between pieces", jumps),
        ("not at rest" if judged.conditions.none else "not as asked for", rests),
    ):
        if found_jumps:
            header = [title, "joint", "time", "size", "where"]
            rows = [_jump_row(found, jump, where) for jump, where in found_jumps]
            lines += ["", table(header, rows, right=(2, 3))]
    if judged.missed_total is not None:
        lines += ["", f"it takes {judged.seconds:.9g} s; asked for were {judged.missed_total:.9g} s"]
    if judged.missed:
        header = ["missed waypoint", "joint", "nearest at", "off by"]
        asked = judged.conditions.passage
        if asked:
            header[2] = "nearest, or asked, at"
        rows = [
            [
                f"{miss.waypoint + 1} of {len(found.problem.waypoints)}",
                _joint(found, miss.joint),
                f"{miss.time:.4f} s",
                found.problem.amount(miss.distance, miss.joint, digits=3),
            ]
            for miss in judged.missed
        ]
        lines += ["", table(header, rows, right=(2, 3))]
    return lines


def _mending(found: Assessment) -> list[str]:
    """What a uniform stretch would do."""
    judged = found.judgement
    factor = judged.stretch_for_limits
    if judged.feasible:
        if 0.0 < factor < 1.0 - 1e-6 and not judged.is_paced:
            return [f"at the same pace throughout it could take {factor:.6g} times its time"]
        return []
    if judged.is_mended_by_stretch:
        return [
            f"stretched by {factor:.6g}, to {factor * judged.seconds:.6g} s, it would keep everything"
        ]
    places = dict.fromkeys(_place(jump) for jump in judged.not_at_rest)
    kinds = " and ".join(dict.fromkeys(jump.quantity for jump in judged.jumps))
    reasons = {
        "a position limit is broken": any(p.quantity == "position" for p in judged.violations),
        "waypoints are missed": judged.missed,
        f"the {kinds} jumps": judged.jumps,
        f"it moves {' and '.join(places)}": places,
        "times or velocities are asked for": judged.is_paced,
    }
    why = [reason for reason, holds in reasons.items() if holds]
    lines = [f"no uniform stretch mends it: {', '.join(why)}"]
    if factor > 1.0:
        lines.append(f"stretched by {factor:.6g} it would keep the limits that a stretch can mend")
    return lines


def _distance(found: Assessment) -> list[str]:
    """How far it is from the bound."""
    judged, bound = found.judgement, found.bound
    if bound is None or found.gap is None:
        return []
    what = "the limits" if judged.conditions.none else "the limits and conditions"
    lines = [f"no motion that keeps {what} takes less than {bound.seconds:.6g} s (proved)"]
    if judged.feasible:
        lines[0] += f"; this one: {100.0 * found.gap:.3g} % more"
    elif found.gap < 0.0:
        lines.append(f"this one is {-100.0 * found.gap:.3g} % faster than any such motion can be")
    if not judged.feasible and found.gap_when_mended is not None:
        lines.append(f"stretched until it keeps them: {100.0 * found.gap_when_mended:.3g} % more")
    return lines


def _holding(found: Assessment) -> list[str]:
    """What holds it up: near the optimum the shares of the limits, else the limits used most."""
    judged = found.judgement
    if found.is_near_the_optimum and found.holds:
        header = ["held up by", "joint", "segment", "for"]
        rows = [
            [hold.quantity, _joint(found, hold.joint), f"{hold.segment + 1}", f"{hold.seconds:.3g} s"]
            for hold in found.holds[:_LINES]
        ]
        return ["", table(header, rows, right=(2, 3))]
    used = [peak for peak in judged.peaks if peak.quantity != "position" and peak.factor > 0.0]
    if not judged.feasible or not used:
        return []
    header = ["limit used most", "joint", "time", "value", "limit", "factor"]
    rows = [_limit_row(found, peak) for peak in used[:_LINES]]
    return ["", table(header, rows, right=(2, 3, 4, 5))]


def _place(jump: Jump) -> str:
    """Where the motion moves though it should not."""
    return "at the ends" if jump.waypoint is None else f"at waypoint {jump.waypoint + 1}, a stop"


def _limit_row(found: Assessment, peak: Peak) -> list[str]:
    unit, scale = _unit(found, peak.quantity, peak.joint)
    limit = peak.limit if peak.quantity == "position" else np.copysign(peak.limit, peak.value)
    return [
        f"{peak.quantity} [{unit}]",
        _joint(found, peak.joint),
        f"{peak.time:.4f} s",
        f"{peak.value / scale:.6g}",
        f"{limit / scale:.6g}",
        f"{peak.factor:.6g}",
    ]


def _jump_row(found: Assessment, jump: Jump, where: str) -> list[str]:
    unit, scale = _unit(found, jump.quantity, jump.joint)
    name = f"{jump.quantity} [{unit}]"
    return [name, _joint(found, jump.joint), f"{jump.time:.4f} s", f"{jump.size / scale:.3g}", where]


def _unit(found: Assessment, quantity: str, joint: int) -> tuple[str, float]:
    """The unit in which a quantity of a joint is shown, and SI units per unit."""
    own, angle = found.problem.units[joint], found.problem.display_unit
    return shown_unit(own, angle, QUANTITIES.index(quantity)), float(factors([own], angle)[0])


def _joint(found: Assessment, joint: int) -> str:
    names = found.judgement.names
    return f"{joint + 1} {names[joint]}" if names else f"{joint + 1}"
