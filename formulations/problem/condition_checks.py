"""Conditions that do not fit their problem are refused, in one line with key and value."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.limits import Limits

if TYPE_CHECKING:
    from formulations.problem.conditions import Conditions, Interval
    from formulations.problem.problem import Problem


def require_fitting(asked: Conditions, problem: Problem) -> None:
    """Refuse conditions that do not fit a problem.

    Parameters
    ----------
    asked : Conditions
        What is asked for.
    problem : Problem
        The problem that they are to be added to.

    Raises
    ------
    InputError
        In one line with key and value.
    """
    last = problem.n_segments
    for key in ("tolerance", "passage", "windows", "stops", "waits", "tool_zones"):
        for waypoint in getattr(asked, key):
            _require_index(f"conditions.{key}: waypoint", waypoint, last)
    for key in ("segment_times", "segment_limits", "segment_tool_speed"):
        for segment in getattr(asked, key):
            _require_index(f"conditions.{key}: segment", segment, last - 1)
    for segment, limits in asked.segment_limits.items():
        _require_limits(problem, segment, limits)
    for waypoint, zone in asked.tolerance.items():
        _require_zone(problem, waypoint, zone)
    if asked.torque is not None:
        asked.torque.require_fitting(problem)
    _require_times(asked, problem)
    _require_ends(asked, problem)
    _require_tool(asked, problem)


def _require_index(what: str, index: int, last: int) -> None:
    if isinstance(index, bool) or not isinstance(index, int | np.integer) or not 0 <= index <= last:
        raise InputError(f"{what} {index!r} is not there: 0 to {last}")


def _require_zone(problem: Problem, waypoint: int, zone: Array) -> None:
    where = f"conditions.tolerance: waypoint {waypoint}"
    found = np.asarray(zone, dtype=np.float64)
    if found.shape != (problem.dof,):
        raise InputError(f"{where}: expected {problem.dof} values, got shape {found.shape}")
    for joint, value in enumerate(found):
        if not (np.isfinite(value) and value >= 0.0):
            raise InputError(f"{where}: {problem.joint_name(joint)}: {value:g} is no distance")


def _require_limits(problem: Problem, segment: int, limits: Limits) -> None:
    where = f"conditions.segment_limits: segment {segment}"
    ends = problem.waypoints[segment : segment + 2]
    try:
        type(problem)(ends, limits, names=problem.names, units=problem.units)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    for key in ("acceleration", "jerk"):
        mine, whole = getattr(limits, key), getattr(problem.limits, key)
        differs = np.isfinite(mine) != np.isfinite(whole)
        if differs.any():
            joint = int(differs.argmax())
            raise InputError(
                f"{where}: {key} of {problem.joint_name(joint)} is {mine[joint]:g}, the problem's is "
                f"{whole[joint]:g}: both must be finite or neither"
            )


def _require_times(asked: Conditions, problem: Problem) -> None:
    last, total = problem.n_segments, asked.total
    if total is not None and not (np.isfinite(total) and total > 0.0):
        raise InputError(f"conditions.total: {total:g} s is not a positive time")
    for key, what in (("windows", "waypoint"), ("segment_times", "segment")):
        for index, interval in getattr(asked, key).items():
            _require_interval(f"conditions.{key}: {what} {index}", interval)
    for waypoint, wait in asked.waits.items():
        where = f"conditions.waits: waypoint {waypoint}: {wait:g} s"
        if not (np.isfinite(wait) and wait > 0.0):
            raise InputError(f"{where} is not a positive time")
        if waypoint in (0, last):
            raise InputError(f"{where} at an end, which is no part of the motion")
    before, earlier = 0, 0.0
    for waypoint, time in sorted(asked.passage.items()):
        if not (np.isfinite(time) and time >= 0.0):
            raise InputError(f"conditions.passage: waypoint {waypoint}: {time:g} s is no time")
        if waypoint == 0 and time != 0.0:
            raise InputError(f"conditions.passage: waypoint 0: {time:g} s, not the start, 0 s")
        if waypoint in asked.windows and not _holds(asked.windows[waypoint], time):
            raise InputError(
                f"conditions.passage: waypoint {waypoint}: {time:g} s is outside conditions.windows, "
                f"{list(asked.windows[waypoint])}"
            )
        moves = np.ptp(problem.waypoints[before : waypoint + 1], axis=0).any()
        if time < earlier or (moves and time <= earlier):
            raise InputError(
                f"conditions.passage: waypoint {waypoint}: {time:g} s is not after waypoint "
                f"{before} at {earlier:g} s"
            )
        before, earlier = waypoint, time
    end = asked.passage.get(last)
    if total is not None and end is not None and end != total:
        raise InputError(
            f"conditions.total: {total:g} s, but conditions.passage puts the last waypoint at {end:g} s"
        )
    if total is not None and earlier > total:
        raise InputError(
            f"conditions.passage: waypoint {before}: {earlier:g} s is after conditions.total, {total:g} s"
        )
    early, late = asked.windows.get(0, (0.0, np.inf))
    if not early <= 0.0 <= late:
        raise InputError(
            f"conditions.windows: waypoint 0: [{early:g}, {late:g}] s without the start, 0 s"
        )


def _require_interval(where: str, interval: Interval) -> None:
    found = np.asarray(interval, dtype=np.float64)
    if found.shape != (2,):
        raise InputError(f"{where}: expected [least, greatest], got {interval!r:.50}")
    low, high = found
    if not (np.isfinite(low) and low >= 0.0 and low <= high and high > 0.0):  # also for NaN
        raise InputError(f"{where}: [{low:g}, {high:g}] s holds no time")


def _holds(interval: Interval, time: float) -> bool:
    return interval[0] <= time <= interval[1]


def _require_ends(asked: Conditions, problem: Problem) -> None:
    last = problem.n_segments
    if asked.cyclic:
        _require_cycle(asked, problem)
    for end, segment, waypoint in (("start", 0, 0), ("end", last - 1, last)):
        for order, quantity in ((1, "velocity"), (2, "acceleration")):
            key, value = f"conditions.{end}_{quantity}", getattr(asked, f"{end}_{quantity}")
            if value is None:
                continue
            if isinstance(value, str):
                if value != "free":
                    raise InputError(f'{key}: {value!r:.50} is neither "free" nor a number per joint')
                found = np.full(problem.dof, np.nan)
            else:
                found = np.asarray(value, dtype=np.float64)
                _require_state(
                    key, found, asked.limits(problem)[segment].intervals[order - 1], order, problem
                )
            if waypoint in asked.stops and found.any():
                raise InputError(f"{key}: {value} at waypoint {waypoint}, which is a stop")


def _require_state(key: str, found: Array, intervals: Array, order: int, problem: Problem) -> None:
    if found.shape != (problem.dof,):
        raise InputError(f"{key}: expected {problem.dof} values, got {found.shape}")
    for joint, (value, (low, high)) in enumerate(zip(found, intervals, strict=True)):
        if not low <= value <= high:  # also true for NaN
            limit = high if value > 0.0 else -low
            raise InputError(
                f"{key}: {problem.joint_name(joint)}: {problem.amount(value, joint, order)} is over the "
                f"limit {problem.amount(limit, joint, order)}"
            )
        if order == 2 and value != 0.0 and not np.isfinite(problem.limits.jerk[joint]):
            raise InputError(
                f"{key}: {problem.joint_name(joint)} has no jerk limit, so its acceleration may jump"
            )


def _require_tool(asked: Conditions, problem: Problem) -> None:
    """Refuse limits on the tool that are no numbers, or of a problem without kinematics."""
    given = [] if asked.tool_speed is None else [("tool_speed", asked.tool_speed, "m/s")]
    given += [
        (f"segment_tool_speed: segment {k}", speed, "m/s")
        for k, speed in asked.segment_tool_speed.items()
    ]
    given += [(f"tool_zones: waypoint {k}", radius, "m") for k, radius in asked.tool_zones.items()]
    for where, value, unit in given:
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not (number and np.isfinite(value) and value > 0.0):
            raise InputError(f"conditions.{where}: {value!r:.50} is no positive number of {unit}")
        if problem.tool is None:
            raise InputError(
                f"conditions.{where}: {value:g} {unit} needs to know where the tool is: give the problem "
                "a robot or an arm"
            )
    ends = {0, problem.n_segments} & set(asked.tool_zones)
    if asked.cyclic and ends and len({asked.tool_zones.get(k) for k in (0, problem.n_segments)}) > 1:
        raise InputError(
            "conditions.cyclic: the first and the last waypoint are one: give both one radius in tool_zones"
        )


def _require_cycle(asked: Conditions, problem: Problem) -> None:
    for key in ("start_velocity", "end_velocity", "start_acceleration", "end_acceleration"):
        if getattr(asked, key) is not None:
            raise InputError(f"conditions.cyclic: the state at the start is free, so leave {key} out")
    ends = problem.waypoints[[0, -1]]
    if not np.array_equal(*ends):
        joint = int(np.abs(ends[1] - ends[0]).argmax())
        raise InputError(
            f"conditions.cyclic: {problem.joint_name(joint)} ends at "
            f"{problem.amount(ends[1, joint], joint)}, not at its start, "
            f"{problem.amount(ends[0, joint], joint)}"
        )
    boxes = asked.boxes(problem.dof)
    first, end = (boxes.get(k, np.zeros(problem.dof)) for k in (0, problem.n_segments))
    if not np.array_equal(first, end):
        raise InputError(
            "conditions.cyclic: the first and the last waypoint are one: give both one tolerance"
        )
