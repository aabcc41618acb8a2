"""Motions of one problem beside each other: exact pieces, limits per joint, and the arm as it moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.report.charts.demanded import demanded
from compare.report.motion_picture import skeleton
from formulations import Conditions, Problem, Trajectory
from formulations.motion.verdict import QUANTITIES
from formulations.problem.arrays import Array
from formulations.problem.joint_words import factors, shown_unit

if TYPE_CHECKING:
    from formulations.arms import Arm
    from formulations.robot import Robot

SLACK = 1e-6
"""Share of a limit that is rounding."""
_DIGITS = 9  # of a coefficient: far below what a screen resolves
_FRAMES, _MOST_FRAMES = 60, 600  # of the moving arm; straight lines between them
_MOST_NUMBERS = 30_000  # of a motion's pieces; beyond, the page would be too large
_INTERVALS = 400  # of a motion that is drawn by its extremes


@dataclass(frozen=True)
class ShownMotion:
    """A motion as the page shows it.

    Attributes
    ----------
    kind : str
        What decides its colour: ``published``, ``family``, ``fastest`` or ``given``.
    title : str
        What it is, with its time and whether it keeps its limits.
    trajectory : Trajectory
    slack : float
        Share of a limit by which it may be exceeded before the picture marks it.
    """

    kind: str
    title: str
    trajectory: Trajectory
    slack: float = SLACK


def motions_chart(
    problem: Problem, motions: Sequence[ShownMotion], asked: Conditions | None = None
) -> dict[str, Any]:
    """Return the pieces of each motion in the problem's own units, and the limits.

    Parameters
    ----------
    problem : Problem
    motions : sequence of ShownMotion
        Of all its joints.
    asked : Conditions, optional
        What is in force beyond waypoints and limits.

    Returns
    -------
    dict
        ``joints``: name, ``units`` and ``limits`` of position to jerk (None where there is none), and
        waypoints; ``motions``: title, kind, passage times and, by piece, durations [s] and ascending
        coefficients by joint. A motion of very many pieces has ``curves`` in their place: by joint and
        quantity, times [s] and values, the exact extremes of each of 400 short intervals. With conditions,
        what ``demanded`` returns too.
    """
    scales = 1.0 / factors(problem.units, problem.display_unit)
    joints = []
    for j in range(problem.dof):
        bounds = [problem.position_bounds[j], *problem.limits.ranges[:, j]]
        joints.append(
            {
                "name": problem.joint_name(j),
                "moves": j in problem.moving_joints,
                "units": [shown_unit(problem.units[j], problem.display_unit, k) for k in range(4)],
                "limits": [[_finite(limit * scales[j]) for limit in pair] for pair in bounds],
                "waypoints": [_short(x * scales[j]) for x in problem.waypoints[:, j]],
            }
        )
    more: dict[str, Any] = {}
    if asked is not None and not asked.none:
        more = demanded(problem, asked, [motion.trajectory for motion in motions])
        joints = [one | two for one, two in zip(joints, more.pop("joints"), strict=True)]
    return more | {
        "quantities": list(QUANTITIES),
        "joints": joints,
        "motions": [
            {
                "kind": motion.kind,
                "title": motion.title,
                "slack": motion.slack,
                "passages": [_short(t) for t in motion.trajectory.passage_times],
                **_curves_or_pieces(motion.trajectory, scales),
            }
            for motion in motions
        ],
        "alt": "; ".join(motion.title for motion in motions) + ".",
    }


def _curves_or_pieces(trajectory: Trajectory, scales: Array) -> dict[str, Any]:
    """Its exact pieces, or what the picture shows of very many."""
    if trajectory.coefficients.size > _MOST_NUMBERS:
        curves = [_curves(trajectory, order) for order in range(len(QUANTITIES))]
        return {
            "curves": [
                [
                    [
                        [float(f"{t:.5g}") for t in times[:, j]],
                        [_short(x * scales[j]) for x in values[:, j]],
                    ]
                    for times, values in curves
                ]
                for j in range(trajectory.dof)
            ]
        }
    return {
        "durations": [_short(t) for t in trajectory.durations],
        "pieces": [
            [[_short(c * scales[j]) for c in joint] for j, joint in enumerate(piece)]
            for piece in trajectory.coefficients
        ],
    }


def _curves(trajectory: Trajectory, order: int) -> tuple[Array, Array]:
    """Times and values of the least and the greatest value of each short interval, (2 n, dof) each."""
    found = trajectory.extremes(order)
    grid = np.linspace(0.0, trajectory.seconds, 4 * _INTERVALS + 1)
    even = np.broadcast_to(grid[:, None], (len(grid), trajectory.dof))
    times = np.concatenate([even, found.time_low, found.time_high])
    values = np.concatenate([trajectory.at(grid, order), found.low, found.high])
    lane = np.minimum((times / trajectory.seconds * _INTERVALS).astype(int), _INTERVALS - 1)
    drawn = np.empty((2, 2 * _INTERVALS, trajectory.dof))
    for j in range(trajectory.dof):
        rows = np.lexsort((values[:, j], lane[:, j]))  # each interval by its values
        first = np.searchsorted(lane[rows, j], np.arange(_INTERVALS))
        last = np.append(first[1:], len(rows)) - 1
        ends = np.sort(np.stack([rows[first], rows[last]]), axis=0)
        ends = np.take_along_axis(ends, times[ends, j].argsort(axis=0, kind="stable"), axis=0).T.ravel()
        drawn[:, :, j] = times[ends, j], values[ends, j]
    return drawn[0], drawn[1]


def arm_chart(
    arm: Arm | Robot,
    motions: Sequence[ShownMotion],
    problem: Problem,
    asked: Conditions | None = None,
) -> dict[str, Any]:
    """Return the arm as a chain of points along each motion.

    Parameters
    ----------
    arm : Arm or Robot
    motions : sequence of ShownMotion
    problem : Problem
    asked : Conditions, optional
        What is in force beyond waypoints and limits.

    Returns
    -------
    dict
        ``motions``: title, kind, seconds, ``times`` [s], ``frames`` (frame, point, xyz) [m]; ``stops``: the
        tool at each waypoint [m]; ``balls``: waypoint, from 0, and radius [m] of each zone of the tool.
    """
    shown = []
    for motion in motions:
        frames = np.clip(4 * len(motion.trajectory.passage_times), _FRAMES, _MOST_FRAMES)
        times = np.linspace(0.0, motion.trajectory.seconds, int(frames) + 1)
        points = skeleton(arm, motion.trajectory.at(times))
        keep = _distinct(points)
        shown.append(
            {
                "kind": motion.kind,
                "title": motion.title,
                "seconds": motion.trajectory.seconds,
                "frames": np.round(points[:, keep], 3).tolist(),
            }
        )
    tool = skeleton(arm, problem.waypoints)[:, -1]
    balls = {} if asked is None else asked.tool_zones
    title = getattr(arm, "title", arm.name)
    return {
        "motions": shown,
        "stops": np.round(tool, 3).tolist(),
        "balls": [[k, float(radius)] for k, radius in sorted(balls.items())],
        "alt": f"{title} as a stick figure that can be turned and played: "
        + "; ".join(motion.title for motion in motions)
        + ".",
    }


def _distinct(points: Array) -> Array:
    """Which points (frame, point, xyz) differ from the one before them in any frame."""
    steps = np.abs(np.diff(points, axis=1)).max(axis=(0, 2))
    return np.concatenate([[True], steps > 1e-6])


def _short(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")


def _finite(value: float) -> float | None:
    return _short(value) if np.isfinite(value) else None
