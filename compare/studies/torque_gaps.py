"""How far motions under torque limits are from their bounds: behind ``timebound torque_gaps``.

Random problems of an arm given by its URDF, such as a UR5: three or four waypoints within 1.5 rad of a
posture with the second link raised, 3.15 rad/s, 15 rad/s^2, 150 rad/s^3, with a payload, and 35 to 80 % of
the torques, but at least 1.15 times what holding takes.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from compare.studies.limit_gaps import LimitAnswer, answer, as_text, summarise
from compare.studies.study import Call, Study
from formulations import Conditions, Limits, Problem
from formulations.dynamics import dynamics_of
from formulations.problem.torque import Payload, TorqueLimits
from formulations.robot.robot import Robot

_RAISED = (1, -1.2)  # joint, and where the middle of its waypoints lies [rad]
_TOLERANCE = 1e-3


def arm(urdf: str | Path, payload: float) -> TorqueLimits:
    """Read an arm with its payload, 0.1 m in front of its last joint.

    Parameters
    ----------
    urdf : str or Path
    payload : float [kg]

    Returns
    -------
    TorqueLimits
        Of all joints that move.
    """
    load = Payload(payload, (0.0, 0.0, 0.1)) if payload > 0.0 else None
    return TorqueLimits.from_urdf(urdf, Robot.from_urdf(urdf).names, payload=load)


def drawn_problem(torque: TorqueLimits, seed: int) -> tuple[Problem, float]:
    """Draw a problem with torque limits.

    Parameters
    ----------
    torque : TorqueLimits
        The arm.
    seed : int
        The same seed draws the same problem.

    Returns
    -------
    Problem
    float
        The share of its torques that the arm may use.
    """
    dynamics = dynamics_of(torque)
    rng = np.random.default_rng(seed)
    points = rng.uniform(-1.5, 1.5, (int(rng.integers(3, 5)), dynamics.dof))
    joint, middle = _RAISED
    points[:, min(joint, dynamics.dof - 1)] += middle
    share = float(rng.uniform(0.35, 0.8))
    share = max(share, 1.15 * float((np.abs(dynamics.holding(points)) / dynamics.available).max()))
    problem = Problem(
        points,
        Limits.of(velocity=3.15, acceleration=15.0, jerk=150.0, dof=dynamics.dof),
        name=f"torque-{seed}",
        names=list(torque.joints),
        conditions=Conditions(torque=torque.scaled(share, dynamics.limits)),
    )
    return problem, share


def answered(urdf: str, payload: float, seed: int, time_limit: float | None) -> list[LimitAnswer]:
    """Find a motion within torque limits, and bound it.

    Parameters
    ----------
    urdf : str
        The file.
    payload : float [kg]
    seed : int
        Of the problem.
    time_limit : float or None [s]
        For the search.

    Returns
    -------
    list of LimitAnswer
        One row.
    """
    problem, share = drawn_problem(arm(urdf, payload), seed)
    return [answer(problem, seed, share, _TOLERANCE, time_limit)]


def calls(
    urdf: str, count: int, *, payload: float = 2.0, time_limit: float | None = None
) -> list[Call]:
    """List the calls of the study.

    Parameters
    ----------
    urdf : str
        The file.
    count : int
        Problems.
    payload : float [kg]
    time_limit : float or None [s]
        For each search.

    Returns
    -------
    list of tuples
        Arguments of ``answered``.
    """
    arm(urdf, payload)  # refuses a file that is none, before anything is computed
    return [(urdf, payload, seed, time_limit) for seed in range(count)]


STUDY = Study(
    name="torque_gaps",
    row=LimitAnswer,
    compute=answered,
    summarise=summarise,
    text=as_text,
)
