"""What is asked for beyond waypoints and limits of joints, as the chart of motions draws it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from formulations import Conditions, Problem, Trajectory
from formulations.kinematics.jets import tool_motion
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.problem.joint_words import factors

_SAMPLES = 600  # of a curve that is no polynomial: torques, the tool's speed
_DIGITS = 6  # of them, and of limits


def demanded(problem: Problem, asked: Conditions, motions: Sequence[Trajectory]) -> dict[str, Any]:
    """Return zones, windows, waits, limits of segments, and curves of torque and of the tool's speed.

    Parameters
    ----------
    problem : Problem
    asked : Conditions
        In force for the motions.
    motions : sequence of Trajectory

    Returns
    -------
    dict
        ``joints``, in the problem's units: by waypoint ``zones`` (None without one), and by quantity
        ``segments``, the limits on each segment (None where they are the same on all). By waypoint ``windows``
        [s], None for no end, and ``waits`` [s]. ``panels``: quantity, ``joints`` with unit, limits and
        ``segments`` (one entry for all joints where it is the tool's), and ``curves`` by motion and joint.
    """
    demands, scales = Demands.of(problem, asked), 1.0 / factors(problem.units, problem.display_unit)
    jerk = np.stack([-demands.jerk, demands.jerk], axis=-1)
    by_order = [demands.position, demands.velocity, demands.acceleration, jerk]
    return {
        "joints": [
            {
                "zones": [
                    _interval(zone[j] * scales[j]) if zone[j, 0] < zone[j, 1] else None
                    for zone in demands.waypoints
                ],
                "segments": [_varying(limits[:, j] * scales[j]) for limits in by_order],
            }
            for j in range(problem.dof)
        ],
        "windows": [
            _interval(window) if k and (window[0] > 0.0 or np.isfinite(window[1])) else None
            for k, window in enumerate(demands.passages)  # all begin at 0 s
        ],
        "waits": [_rounded(wait) for wait in demands.waits],
        "panels": [*_torques(problem, asked, motions), *_tool(demands, motions)],
    }


def _torques(problem: Problem, asked: Conditions, motions: Sequence[Trajectory]) -> list[Any]:
    """The panel of torques, where they are limited; dry friction is taken off the limit."""
    if asked.torque is None:
        return []
    from formulations.dynamics import dynamics_of  # needs the extra dynamics

    arm, curves = dynamics_of(asked.torque), []
    for motion in motions:
        times = _times(motion)
        found = arm.torques(*(motion.at(times, order) for order in range(3)))
        curves.append([_curve(times, joint) for joint in found.T])
    units = ["N" if unit == "m" else "N m" for unit in problem.units]
    joints = [
        {"unit": unit, "limits": [-_rounded(most), _rounded(most)], "segments": None}
        for unit, most in zip(units, arm.available, strict=True)
    ]
    return [{"quantity": "torque", "joints": joints, "curves": curves}]


def _tool(demands: Demands, motions: Sequence[Trajectory]) -> list[Any]:
    """The panel of the tool's speed, where it is limited."""
    tool = demands.problem.tool
    if tool is None or not np.isfinite(demands.tool_speed).any():
        return []
    curves = []
    for motion in motions:
        times = _times(motion)
        _, velocity, _ = tool_motion(tool, *(motion.at(times, order) for order in range(3)))
        curves.append([_curve(times, np.linalg.norm(velocity, axis=0))])
    speeds = np.stack([np.full_like(demands.tool_speed, -np.inf), demands.tool_speed], axis=-1)
    limits = {"unit": "m/s", "limits": _interval(speeds[0]), "segments": _varying(speeds)}
    return [{"quantity": "tool speed", "joints": [limits], "curves": curves}]


def _times(motion: Trajectory) -> Array:
    """Evenly spaced, and where pieces meet [s]."""
    return np.unique(np.append(np.linspace(0.0, motion.seconds, _SAMPLES + 1), motion.breaks))


def _curve(times: Array, values: Array) -> list[list[float]]:
    return [[_rounded(t) for t in times], [_rounded(value) for value in values]]


def _varying(limits: Array) -> list[list[float | None]] | None:
    """Intervals by segment, (n_segments, 2); None where all are the same."""
    return None if (limits == limits[0]).all() else [_interval(pair) for pair in limits]


def _interval(pair: Array) -> list[float | None]:
    return [_rounded(value) if np.isfinite(value) else None for value in pair]


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")
