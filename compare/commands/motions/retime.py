"""``timebound retime MOTION --limits FILE``: a path or a motion from elsewhere, timed anew."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

from compare.commands import DONE
from compare.commands.motions.problem_options import names
from compare.commands.options import Export, Json, Rate, positive
from compare.screen import show, stages, table
from formulations import InputError, Limits, NoFeasibleMotion, load
from formulations.assessment import Assessment
from formulations.motion.files.motion_file import read_points
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.judgement import in_order_of
from formulations.retiming.export import export_retimed
from formulations.retiming.path import Path
from formulations.retiming.retime import WAYS, Retimed, retime
from formulations.robot import limits_of, robot_of


def retime_motion(
    motion: Annotated[
        str,
        Parameter(name="MOTION", help="Points in order: CSV, or a ROS JointTrajectory (JSON, YAML)."),
    ],
    /,
    *,
    limits: Annotated[
        tuple[str, ...],
        Parameter(metavar="FILE", n_tokens=1, consume_multiple=False, show_default=False),
    ] = (),
    robot: Annotated[str | None, Parameter(metavar="URDF")] = None,
    joints: Annotated[str | None, Parameter(metavar="NAME,..")] = None,
    unlimited: Annotated[str | None, Parameter(metavar="NAME,..")] = None,
    tolerance: Annotated[float, Parameter(metavar="RAD", validator=positive)] = 1e-2,
    way: Literal["toppra", "copp", "free_form"] | None = None,
    export: Export = None,
    rate: Rate = None,
    json: Json = None,
) -> int:
    """Time the path of a motion anew, in three ways side by side, each judged in continuous time.

    TOPP-RA and COPP keep to the path as it is; the former knows no jerk limit. The third is the fastest
    motion of all through some points of the path that stays within a tolerance of it. A motion that
    breaks a limit is stretched until it keeps it.

    Parameters
    ----------
    limits
        A problem file (TOML) or the name of a shipped case, whose limits count and not its waypoints; or
        MoveIt's joint_limits.yaml, several times if needed.
    robot
        The URDF that a joint_limits.yaml is laid over. Without it, that file must have all limits.
    joints
        The joints of a motion that names none, in order; all of the URDF that move if left out.
    unlimited
        acceleration, jerk or position: joints may have no such limit in these files.
    tolerance
        How far the third motion may leave the straight lines between the points, in joint space.
    way
        The motion that --export writes; the fastest one that keeps every limit if left out.
    """
    points, allowed = _with_limits(motion, limits, robot, joints, unlimited)
    with stages(motion) as stage:
        ways = retime(points, allowed, tolerance=tolerance, progress=stage)
    text = as_text(motion, len(points.times), tolerance, ways)
    if export is not None:
        text += f"\n\n{_export(export, rate, ways, way, Path.of(points))}"
    show(text, as_json(motion, tolerance, ways), json)
    return DONE


def _with_limits(
    motion: str,
    files: tuple[str, ...],
    robot: str | None,
    joints: str | None,
    unlimited: str | None,
) -> tuple[MotionPoints, Limits]:
    """Read the points, and the limits of their joints in the same order."""
    given = {"--joints": joints, "--unlimited": unlimited}
    if not files and robot is None:
        raise InputError("--limits: missing: a problem file, a shipped case, or a joint_limits.yaml")
    points = read_points(motion)
    are_yaml = [file.lower().endswith((".yaml", ".yml")) for file in files]
    if robot is None and not all(are_yaml):
        for key, value in given.items():
            if value is not None:
                raise InputError(f"{key}: given beside the problem file {files[0]}; leave it out")
        if len(files) > 1:
            raise InputError(
                f"--limits: {files[are_yaml.index(False)]} is a problem file; give it alone"
            )
        posed = load(files[0])
        points = in_order_of(posed.names, points)
        named, allowed = posed.names, posed.limits
    else:
        chosen = names(joints) or points.names
        if joints is not None:
            points = in_order_of(chosen, points)
        free = names(unlimited) or ()
        if robot is not None:
            arm = robot_of(robot, joints=chosen or None, limits=files, unlimited=free)
            named, allowed = arm.names, arm.limits
        elif chosen:
            named, allowed = chosen, limits_of(chosen, files, unlimited=free)
        else:
            raise InputError(
                f"{motion}: names no joints, so {files[0]} does not say which limit is whose; give "
                "--joints NAME,.. or --robot URDF"
            )
    width = points.positions.shape[1]
    if width != len(allowed.velocity):
        where = robot or ", ".join(files)
        raise InputError(f"{motion}: {width} joints, {where} has {len(allowed.velocity)}")
    return replace(points, names=points.names or named), allowed


def as_text(path: str, count: int, tolerance: float, ways: list[Retimed]) -> str:
    """Set the ways side by side.

    Parameters
    ----------
    path : str
        File of the points.
    count : int
        Number of points.
    tolerance : float [rad]
        Of the free motion.
    ways : list of Retimed

    Returns
    -------
    str
        A table, then what the judge says of each.
    """
    rows = [
        [
            way.key,
            "-" if way.judgement is None else f"{way.judgement.seconds:.5f} s",
            _verdict(way),
            "-" if way.kept is None else f"{way.kept.seconds:.5f} s",
            "-" if way.deviation is None else f"{way.deviation:.1e} rad",
        ]
        for way in ways
    ]
    header = ["way", "time", "limits", "when kept", "off the path"]
    notes = [f"  {way.key}: {WAYS[way.key]}{_note(way)}" for way in ways]
    return "\n".join(
        [
            f"{path}: {count} points; the free motion may leave them by {tolerance:g} rad",
            "",
            table(header, rows, right=(1, 3, 4)),
            "",
            *notes,
        ]
    )


def as_json(path: str, tolerance: float, ways: list[Retimed]) -> dict[str, Any]:
    """The same as plain data, with all that the judge found.

    Parameters
    ----------
    path : str
        File of the points.
    tolerance : float [rad]
        Of the free motion.
    ways : list of Retimed

    Returns
    -------
    dict
        Ready for strict JSON. ``seconds_kept`` is the time of the motion stretched until it keeps
        every limit.
    """
    found: dict[str, Any] = {}
    for way in ways:
        entry: dict[str, Any] = {"reason": way.reason or None}
        if way.problem is not None and way.judgement is not None:
            entry |= Assessment(way.problem, way.judgement, None, ()).to_json()
            entry["waypoints"] = len(way.problem.waypoints)
        entry["seconds_kept"] = None if way.kept is None else way.kept.seconds
        entry["deviation"] = way.deviation
        found[way.key] = entry
    return {"motion": path, "path_tolerance": tolerance, "ways": found}


def _verdict(way: Retimed) -> str:
    if way.judgement is None:
        return "no motion"
    if way.judgement.feasible:
        return "kept"
    worst = way.judgement.violations[:1]
    return f"{worst[0].quantity} x {worst[0].factor:.4g}" if worst else "broken"


def _note(way: Retimed) -> str:
    if way.reason:
        return f": {way.reason}"
    if way.key == "free_form" and way.problem is not None:
        return f", {len(way.problem.waypoints)} of them"
    return ""


def _export(path: str, rate: float | None, ways: list[Retimed], wanted: str | None, given: Path) -> str:
    """Write the fastest motion that keeps every limit, and say how the file was judged."""
    kept = {way.key: way for way in ways if way.kept is not None and way.key != "given"}
    if wanted is not None:
        kept = {key: way for key, way in kept.items() if key == wanted}
    if not kept:
        raise NoFeasibleMotion(
            f"{path}: not written: no motion of {wanted or 'any way'} keeps every limit"
            f"{_reasons(ways, wanted)}"
        )
    best = min(kept.values(), key=lambda way: way.kept.seconds if way.kept else np.inf)
    written = export_retimed(path, best, rate)
    away = given.farthest(written.motion)[1]
    return "\n".join([*written.lines(), f"  {best.key}; {away:.1e} rad off the path"])


def _reasons(ways: list[Retimed], wanted: str | None) -> str:
    """Why no stretch mends the ways: the end of a message."""
    found = []
    for way in ways:
        if way.key == "given" or wanted not in (None, way.key):
            continue
        violations = way.judgement.violations if way.judgement is not None else ()
        lasting = [peak for peak in violations if not np.isfinite(peak.stretch)]
        reason = way.reason or (str(lasting[0]) if lasting else "")
        found += [f"; {way.key}: {reason}"] if reason else []
    return "".join(found)
