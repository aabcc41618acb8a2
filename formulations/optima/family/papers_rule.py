"""The rule of the papers: plan each joint alone, then take the longest time per segment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.families import FAMILIES
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem


@dataclass(frozen=True)
class LongestSegment:
    """What the rule gives (Wang 2025, sec. 2.2; Li 2022, sec. 3; Zhou 2025, sec. 5.2).

    Attributes
    ----------
    claimed : Array, shape (n_segments,) [s]
        The durations that the rule gives.
    stretch : float
        The least factor on them that keeps the derivative limits; above 1, the motion of the rule
        breaks these limits.
    position_excess : float [rad]
        How far the motion leaves the position limits; no stretch changes that.
    """

    claimed: Array
    stretch: float
    position_excess: float

    @property
    def durations(self) -> Array:
        """The claimed durations, stretched only if they break a limit, shape (n_segments,) [s]."""
        return self.claimed * max(self.stretch, 1.0)


def longest_segment(problem: Problem, per_joint: list[Array]) -> LongestSegment:
    """Apply the rule to the durations of single joints.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits of all joints.
    per_joint : list of Array, shape (n_segments,) [s]
        The durations of each moving joint, planned alone.

    Returns
    -------
    LongestSegment
        The durations of the rule, and whether their motion keeps the limits.

    Raises
    ------
    InputError
        If the list is empty.
    """
    if not per_joint:
        raise InputError("longest_segment: no joint moves")
    claimed = np.max(per_joint, axis=0)
    chosen = FAMILIES[problem.family]
    return LongestSegment(
        claimed=claimed,
        stretch=float(chosen.stretch(problem, claimed[None])[0]),
        position_excess=float(chosen.position_excess(problem, claimed[None])[0]),
    )
