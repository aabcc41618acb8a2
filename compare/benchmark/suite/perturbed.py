"""The papers' cases with waypoints and limits changed by a few per cent."""

from __future__ import annotations

import math

import numpy as np

from compare.benchmark.suite.arms import DECIMALS
from compare.benchmark.suite.draws import Draws
from formulations import Limits, Problem, load

_GRID = 10**DECIMALS
_MOVED = 30  # per mille of a joint's range of motion by which each of its waypoints moves at most
_SCALED = 50  # per mille by which each limit changes at most


def perturbed(name: str, case: str) -> Problem:
    """Perturb a shipped case.

    Joints that stand still in the case stand still here. Position limits stay, and waypoints keep them:
    they are so far from the motion of each case that a change of some per cent does not reach them.

    Parameters
    ----------
    name : str
        Also names the stream of random numbers.
    case : str
        One of ``CASES``.

    Returns
    -------
    Problem
    """
    original, stream = load(case), Draws(name)
    limits = original.limits
    velocity, acceleration, jerk = (
        np.array([_scaled(v, stream) for v in values])
        for values in (limits.velocity, limits.acceleration, limits.jerk)
    )
    columns = [_moved(original, joint, stream) for joint in range(original.dof)]
    return Problem(
        np.array(columns).T / _GRID,
        Limits(velocity, acceleration, jerk, limits.position, limits.units),
        name=name,
        family=original.family,
        title=f"{original.title}, perturbed",
        source=f"{original.name} with waypoints moved by up to {_MOVED / 10:g} % of each joint's range of"
        f" motion and limits changed by up to {_SCALED / 10:g} %. {original.name}: {original.source}",
        display_unit=original.display_unit,
        names=original.names,
        units=original.units,
    )


def _scaled(limit: float, stream: Draws) -> float:
    if not math.isfinite(limit):
        return limit
    return round(limit * (1000 + stream.between(-_SCALED, _SCALED)) / 1000, DECIMALS)


def _moved(original: Problem, joint: int, stream: Draws) -> list[int]:
    """Waypoints of one joint, as whole numbers."""
    at = [round(float(v) * _GRID) for v in original.waypoints[:, joint]]
    most = (max(at) - min(at)) * _MOVED // 1000
    low, high = (_whole(v) for v in original.limits.position[joint])
    return [min(max(v + stream.between(-most, most), low), high) for v in at]


def _whole(limit: float) -> int:
    """A position limit on the grid, rounded towards zero; a number beyond all waypoints if infinite."""
    return int(limit * _GRID) if math.isfinite(limit) else int(math.copysign(10**12, limit))
