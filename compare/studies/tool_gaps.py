"""How far motions under a limit of the tool's speed are from their bounds: behind ``timebound tool_gaps``.

Random problems of the UR5 of Zhou 2025: 3 to 5 waypoints, joints within 1.5 rad, 3.14 rad/s, 10 rad/s^2,
100 rad/s^3, tool at 0.2 to 1 m/s.
"""

from __future__ import annotations

import numpy as np

from compare.studies.limit_gaps import LimitAnswer, answer, as_text, summarise
from compare.studies.study import Call, Study
from formulations import Conditions, Problem
from formulations.arms import load_arm

_TOLERANCE = 1e-2  # of the search, on eight steps per segment


def drawn_problem(seed: int) -> Problem:
    """Draw a problem with a limit of the tool's speed.

    Parameters
    ----------
    seed : int
        The same seed draws the same problem.

    Returns
    -------
    Problem
    """
    rng = np.random.default_rng(seed)
    points = rng.uniform(-1.5, 1.5, (int(rng.integers(3, 6)), 6))
    return Problem(
        points,
        {"velocity": 3.14, "acceleration": 10.0, "jerk": 100.0},
        name=f"ur5-tool-{seed}",
        tool=load_arm("ur5").tool,
        conditions=Conditions(tool_speed=float(rng.uniform(0.2, 1.0))),
    )


def answered(seed: int, time_limit: float | None) -> list[LimitAnswer]:
    """Find a motion under a limit of the tool's speed, and bound it.

    Parameters
    ----------
    seed : int
        Of the problem.
    time_limit : float or None [s]
        For the search.

    Returns
    -------
    list of LimitAnswer
        One row.
    """
    problem = drawn_problem(seed)
    speed = problem.conditions.tool_speed
    assert speed is not None
    return [answer(problem, seed, speed, _TOLERANCE, time_limit)]


def calls(count: int, time_limit: float | None = None) -> list[Call]:
    """List the calls of the study.

    Parameters
    ----------
    count : int
        Problems.
    time_limit : float or None [s]
        For each search.

    Returns
    -------
    list of tuples
        Arguments of ``answered``.
    """
    return [(seed, time_limit) for seed in range(count)]


STUDY = Study(
    name="tool_gaps",
    row=LimitAnswer,
    compute=answered,
    summarise=summarise,
    text=as_text,
)
