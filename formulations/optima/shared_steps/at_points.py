"""A motion under limits on tool or torques whose jerk switches at points of a file only.

The steps of the given motion are rounded to whole periods, and the program is solved again with these steps:
the smoothest motion on them. Where there is none, or the check refuses it, all steps get a little longer.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from formulations.deadlines import NEVER
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import check
from formulations.optima.shared_steps.program import StepProgram
from formulations.optima.shared_steps.search import StepSearch
from formulations.optima.shared_steps.steps import Steps, sampled
from formulations.problem.arrays import Array, Indices
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.problem import Problem

_LONGER = (1.001, 1.004, 1.015, 1.05, 1.15)  # factors on all steps, tried in this order
_ROUNDS = 6  # of raising margins
_STEPS, _FEWEST = 14, 4  # per segment, where those of the motion cannot be taken
_SHARE = 1e-6  # of the torque limits, left for rounding
_SLOWER = 3e-4  # of the tool's speed: no stretch mends what the rounds leave


class MotionAtPoints(NamedTuple):
    """A motion that passed the check, and the points of its file [s]."""

    trajectory: Trajectory
    times: Array


def at_points(
    problem: Problem, trajectory: Trajectory, rate: float | None, asked: Conditions, shares: Array
) -> MotionAtPoints | None:
    """Find a motion near a given one that a file of points describes exactly.

    Parameters
    ----------
    problem : Problem
    trajectory : Trajectory
        A motion that keeps its limits and conditions.
    rate : float or None [1/s]
        Points per second. None: points where the steps meet, at whole nanoseconds.
    asked : Conditions
        In force, with limits on the tool or torque limits.
    shares : Array, shape (3, dof)
        Shares of velocity, acceleration and jerk limits that are left for the rounding of the file.

    Returns
    -------
    MotionAtPoints or None
        None where no motion passed the check.
    """
    left = 1.0 - shares
    given = Demands.of(problem, asked)
    demands = replace(
        given,
        velocity=given.velocity * left[0][:, None],
        acceleration=given.acceleration * left[1][:, None],
        jerk=given.jerk * left[2],
        tool_speed=given.tool_speed * (1.0 - _SLOWER),
    )
    search = StepSearch(demands, NEVER, None)
    period = 1e-9 if rate is None else 1.0 / rate
    for factor in _LONGER:
        steps, nodes = _rounded(_steps_of(trajectory, demands, period), factor, period)
        if (np.diff(nodes) < 1).any():
            continue
        program = StepProgram(demands, search.dynamics, steps, smoothest=True)
        program.margins += _SHARE
        for _ in range(_ROUNDS):
            found, converged, _ = program.solve(steps, even=False, fixed=True)
            if not converged:
                break
            motion = found.assembled(demands)
            verdict = check(problem, motion, conditions=asked)
            if verdict.feasible:
                points = nodes if rate is None else np.arange(nodes[-1] + 1)
                return MotionAtPoints(motion, _times(points, period))
            search.tighten(program, found, verdict)
    return None


def _steps_of(trajectory: Trajectory, demands: Demands, period: float) -> Steps:
    """The steps of the motion, if each segment has as many and none is shorter than a period."""
    S, n = len(demands.jerk), len(trajectory.durations)
    passed = np.searchsorted(trajectory.breaks, trajectory.passage_times - 0.5 * period)
    even = n % S == 0 and n // S >= _FEWEST and bool((np.diff(passed) == n // S).all())
    if even and trajectory.durations.min() > 2.0 * period:
        states = np.stack([trajectory.at(trajectory.breaks, order) for order in range(3)])
        return Steps(trajectory.durations.reshape(S, n // S), states)
    shortest = int(np.diff(trajectory.passage_times).min() / (2.0 * period))
    return sampled(trajectory, demands, int(np.clip(shortest, _FEWEST, _STEPS)))


def _rounded(steps: Steps, factor: float, period: float) -> tuple[Steps, Indices]:
    """Longer steps that begin and end at whole periods, and the numbers (S M + 1,) of these."""
    ends = np.cumsum(steps.durations.ravel()) * (factor / period)
    nodes = np.concatenate([[0], np.rint(ends)]).astype(np.intp)
    longer = steps.stretched(factor)
    durations = np.diff(_times(nodes, period)).reshape(steps.durations.shape)
    return Steps(durations, longer.states), nodes


def _times(points: Indices, period: float) -> Array:
    """Times of points, as whole nanoseconds [s]."""
    return np.asarray(np.rint(points * (period * 1e9)) / 1e9)
