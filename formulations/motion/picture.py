"""A motion as a picture: position to jerk of each joint, with its limits and waypoints.

This is the one module of the package that draws. Matplotlib is loaded when a picture is asked for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import QUANTITIES
from formulations.problem.arrays import Array
from formulations.problem.joint_words import factors, shown_unit
from formulations.problem.problem import Problem

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_CURVE, _LIMIT = "#0072b2", "#000000"


def motion_picture(problem: Problem, motion: Trajectory, title: str = "") -> Figure:
    """Draw position, velocity, acceleration and, where it is limited, jerk of the joints that move.

    Parameters
    ----------
    problem : Problem
        Waypoints (dots), limits (dashed), names and units of the joints.
    motion : Trajectory
        The motion.
    title : str, optional
        Above the picture.

    Returns
    -------
    Figure
        A row per quantity, a column per joint; of pyplot, so ``plt.show()`` shows it.
    """
    import matplotlib.pyplot as plt

    orders = range(4 if problem.limits.has_jerk else 3)
    joints = problem.moving_joints or list(range(problem.dof))
    figure, grid = plt.subplots(
        len(orders),
        len(joints),
        figsize=(1.2 + 2.0 * len(joints), 0.8 + 1.6 * len(orders)),
        sharex=True,
        squeeze=False,
        layout="constrained",
    )
    scales = 1.0 / factors(problem.units, problem.display_unit)
    for column, j in enumerate(joints):
        for order in orders:
            axes = grid[order][column]
            times, values = samples(motion, j, order)
            axes.plot(times, values * scales[j], color=_CURVE, lw=1.4)
            for limit in _limits(problem, j, order, float(np.abs(values).max())):
                axes.axhline(limit * scales[j], color=_LIMIT, lw=0.8, ls="--")
            axes.set_ylabel(
                f"{QUANTITIES[order]}\n[{shown_unit(problem.units[j], problem.display_unit, order)}]"
            )
            axes.tick_params(labelsize=7)
        if len(motion.passage_times) == len(problem.waypoints):
            dots = problem.waypoints[:, j] * scales[j]
            grid[0][column].plot(motion.passage_times, dots, "o", color=_CURVE, ms=3)
        grid[0][column].set_title(problem.joint_name(j), fontsize=9)
        grid[-1][column].set_xlabel("time [s]")
    figure.suptitle(title)
    return figure


def _limits(problem: Problem, joint: int, order: int, extent: float) -> list[float]:
    """Limits to be drawn; a position limit far away would flatten the curve."""
    if order == 0:
        ends = problem.position_bounds[joint].tolist()
        return [end for end in ends if np.isfinite(end) and abs(end) < 2.0 * extent]
    ends = problem.limits.ranges[order - 1, joint].tolist()
    return [end for end in ends if np.isfinite(end)]


def samples(motion: Trajectory, joint: int, order: int) -> tuple[Array, Array]:
    """Return the points of a curve; pieces are sampled apart, so that a jump of the jerk is vertical.

    Parameters
    ----------
    motion : Trajectory
    joint : int
    order : int
        Derivative: 0 position to 3 jerk.

    Returns
    -------
    times : Array, shape (m,) [s]
    values : Array, shape (m,) [rad/s^order]
    """
    s = np.linspace(1e-9, 1.0 - 1e-9, 60)
    t = (motion.breaks[:-1, None] + motion.durations[:, None] * s).ravel()
    return t, motion.at(t, order)[:, joint]
