"""The fastest motion through a choice of a path's points that stays within a tolerance of the path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.optima.free_form import free_form
from formulations.problem.errors import NoFeasibleMotion
from formulations.problem.problem import Limits, Problem
from formulations.retiming.path import Path

_COARSE = 4.0  # the first choice of points has a polyline within this many tolerances
_ROUNDS = 16
_MOST = 80  # waypoints
_LEAST = 1000  # points to choose from: a sparse path gets further ones on its straight lines


@dataclass(frozen=True)
class FreeRetiming:
    """A motion near a path.

    Attributes
    ----------
    motion : Trajectory
    problem : Problem
        Its waypoints are the points of the path that the motion passes.
    deviation : float [rad]
        Largest distance in joint space between each part of the motion and its part of the path.
    """

    motion: Trajectory
    problem: Problem
    deviation: float


def by_free_form(
    path: Path,
    limits: Limits,
    tolerance: float,
    *,
    progress: Callable[[str], None] | None = None,
) -> FreeRetiming | str:
    """Find the fastest motion through a subset of the points of a path, within a tolerance of it.

    The first subset is that of Douglas and Peucker. While the motion leaves the path by more than the
    tolerance between two waypoints, the point of the path nearest to that place becomes a waypoint too.

    Parameters
    ----------
    path : Path
    limits : Limits
    tolerance : float [rad]
        Largest distance from the path in joint space.
    progress : callable, optional
        Called with one line before each round.

    Returns
    -------
    FreeRetiming or str
        The fastest motion within the tolerance that was found; or why there is none.
    """
    path = path.divided(_LEAST)
    chosen = path.simplified(_COARSE * tolerance)
    deviation = np.inf
    for _ in range(_ROUNDS):
        if len(chosen) > _MOST:
            return f"{len(chosen)} waypoints are needed to stay within {tolerance:g} rad, above {_MOST}"
        problem = Problem.of(path.points[chosen], limits, name="path", names=path.names)
        if progress is not None:
            progress(f"fastest motion through {len(chosen)} points")
        try:
            motion = free_form(problem).trajectory
        except NoFeasibleMotion as reason:
            return str(reason)
        assert motion is not None  # some joint moves
        deviation, added = _leaving(path, motion, chosen, tolerance)
        if deviation <= tolerance:
            return FreeRetiming(motion, problem, deviation)
        if not added:
            break
        chosen = sorted({*chosen, *added})
    return f"with {len(chosen)} waypoints it leaves the path by {deviation:.3g} rad"


def _leaving(
    path: Path, motion: Trajectory, chosen: list[int], tolerance: float
) -> tuple[float, list[int]]:
    """Largest distance of motion and path [rad], and points to be passed where it is too large."""
    added, largest = [], 0.0
    for (first, last), (start, end) in zip(
        pairwise(chosen), pairwise(motion.passage_times.tolist()), strict=True
    ):
        part = path.part(first, last)
        time, away = part.farthest(motion, start, end)
        away = max(away, part.left_out(motion, start, end))
        largest = max(largest, away)
        if away > tolerance and last > first + 1:
            inner = path.points[first + 1 : last]
            nearest = int(np.square(inner - motion.at(time)).sum(axis=1).argmin())
            # a point right beside a waypoint would not change much
            margin = (last - first) // 4
            added.append(
                int(np.clip(first + 1 + nearest, first + max(margin, 1), last - max(margin, 1)))
            )
    return largest, added
