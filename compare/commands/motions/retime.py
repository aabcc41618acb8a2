"""``timebound retime MOTION --limits FILE``: a path or a motion from elsewhere, timed anew."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

from compare.commands import DONE
from compare.commands.motions.problem_options import OwnRobotOptions, limits_for
from compare.commands.options import Export, Json, Rate, positive
from compare.screen import show, stages, table
from formulations import NoFeasibleMotion
from formulations.assessment import Assessment
from formulations.motion.files.motion_file import read_points
from formulations.retiming.export import export_retimed
from formulations.retiming.path import Path
from formulations.retiming.retime import WAYS, Retimed, retime


def retime_motion(
    motion: Annotated[
        str,
        Parameter(name="MOTION", help="Points in order: CSV, or a ROS JointTrajectory (JSON, YAML)."),
    ],
    /,
    *,
    own: OwnRobotOptions = None,
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

    --limits names MoveIt's YAML, with --robot or alone (the joints are then those that MOTION names), or a
    problem file or a shipped case, whose waypoints do not count.

    Parameters
    ----------
    tolerance
        How far the third motion may leave the straight lines between the points, in joint space.
    way
        The motion that --export writes; the fastest one that keeps every limit if left out.
    """
    points, limits = limits_for(read_points(motion), own)
    with stages(motion) as stage:
        ways = retime(points, limits, tolerance=tolerance, progress=stage)
    text = as_text(motion, len(points.times), tolerance, ways)
    if export is not None:
        text += f"\n\n{_export(export, rate, ways, way, Path.of(points))}"
    show(text, as_json(motion, tolerance, ways), json)
    return DONE


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
