"""Whether a motion keeps the limits on the tool: its speed between all samples, and the balls it must pass."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from formulations.motion.peaks import Peak
from formulations.motion.smoothness import TOLERANCE
from formulations.motion.tool_speed import ToolSpeed, tool_speed
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.problem.problem import Problem

TOOL_SPEED = "tool speed"


@dataclass(frozen=True)
class ToolPeak(Peak):
    """The place where the tool point is fastest in terms of its limit; its joint is -1, as all take part."""

    def unit_in(self, angle: str) -> str:
        """Say the unit of the value.

        Parameters
        ----------
        angle : {"rad", "deg"}
            Of no matter here.

        Returns
        -------
        str
        """
        return "m/s"

    def __str__(self) -> str:
        return (
            f"{self.quantity} in segment {self.segment + 1} at {self.time:.4f} s: {self.value:.6g} m/s, "
            f"limit {self.limit:.6g} m/s, factor {self.factor:.6g}"
        )


def tool_peaks(demands: Demands, trajectory: Trajectory) -> list[ToolPeak]:
    """Find the worst place of the tool's speed.

    Parameters
    ----------
    demands : Demands
        Their problem has a chain to the tool, if its speed is limited.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    list of ToolPeak
        One, or none where the speed is not limited.
    """
    limits = demands.tool_speed
    found = tool_speeds(demands.problem, trajectory, limits)
    if found is None:
        return []
    factors = found.speed / limits
    worst = int(factors.argmax())
    return [
        ToolPeak(
            quantity=TOOL_SPEED,
            joint=-1,
            segment=worst,
            time=float(found.time[worst]),
            value=float(found.speed[worst]),
            limit=float(limits[worst]),
            factor=float(factors[worst]),
            stretch=float(factors[worst]),
            unit="m",
        )
    ]


def tool_speeds(problem: Problem, trajectory: Trajectory, limits: Array) -> ToolSpeed | None:
    """Bound the speed of the tool on each segment.

    Parameters
    ----------
    problem : Problem
        With a chain to the tool, if its speed is limited.
    trajectory : Trajectory
        The motion.
    limits : Array, shape (n_segments,)
        [m/s]; infinite where there is none.

    Returns
    -------
    ToolSpeed or None
        None where no segment has a limit.
    """
    if problem.tool is None or not np.isfinite(limits).any():
        return None
    middles = trajectory.breaks[:-1] + 0.5 * trajectory.durations
    segments = np.searchsorted(trajectory.passage_times, middles) - 1
    return tool_speed(problem.tool, trajectory, np.clip(segments, 0, problem.n_segments - 1), limits)


def tool_faults(demands: Demands, trajectory: Trajectory, tolerance: float = 0.0) -> Iterator[str]:
    """Say which balls of the tool are missed.

    Parameters
    ----------
    demands : Demands
        Their problem has a chain to the tool, if there are balls.
    trajectory : Trajectory
        The motion; judged where it has a passage time for each waypoint.
    tolerance : float, default 0 [m]
        By how much a ball may be missed, beside rounding.

    Yields
    ------
    str
        A line each.
    """
    problem, times = demands.problem, trajectory.passage_times
    if problem.tool is None or len(times) != problem.n_segments + 1:
        return
    for waypoint in np.flatnonzero(np.isfinite(demands.tool_radius)).tolist():
        radius = float(demands.tool_radius[waypoint])
        passed, wanted = problem.tool.forward(
            np.stack([trajectory.at(times[waypoint]), problem.waypoints[waypoint]])
        )[:, :3, 3]
        distance = float(np.linalg.norm(passed - wanted))
        if distance > radius * (1.0 + TOLERANCE) + tolerance:
            yield (
                f"passes waypoint {waypoint + 1} with the tool {1e3 * distance:.6g} mm off, "
                f"{1e3 * radius:.6g} mm allowed"
            )
