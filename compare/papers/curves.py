"""Joint curves: what the joints of one or more motions do, with the limits and where they break them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from compare.figures import samples
from compare.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, styled
from formulations import Problem, Trajectory
from formulations.problem import Array
from formulations.trajectory import QUANTITIES, TOLERANCE

JOINT_STYLE: list[tuple[Any, Any]] = [
    (BLUE, "-"), (VERMILION, "-"), (GREEN, "-"), (ORANGE, "-"), (PURPLE, "--"), (SKY, "--"),
    (BLACK, "-."),
]  # fmt: skip
_PER = ("", "/s", "/s²", "/s³")


@dataclass(frozen=True)
class Motion:
    """A motion to draw. title: whose it is, and what the check says of it."""

    title: str
    problem: Problem
    trajectory: Trajectory


@styled
def joint_curves(motions: Sequence[Motion], orders: Sequence[int] = (0, 1, 2)) -> Figure:
    """A column per motion, a row per quantity (order 0: position), a line per joint.

    Rows share their scale. Dashed: the limits of the first motion's task; thick: beyond its own limit.
    """
    first = motions[0].problem
    unit = 180.0 / np.pi if first.display_unit == "deg" else 1.0
    size = (1.6 + 3.6 * len(motions), 1.0 + 2.0 * len(orders))
    figure, grid = plt.subplots(
        len(orders), len(motions), figsize=size, sharex="col", sharey="row", squeeze=False
    )
    for column, motion in enumerate(motions):
        for axes, order in zip(grid[:, column], orders, strict=True):
            _lines(axes, motion, order, unit)
        grid[0, column].set_title(motion.title, loc="left", fontsize=8.5)
        grid[-1, column].set_xlabel("time [s]")
    for axes, order in zip(grid[:, 0], orders, strict=True):
        name = f"{QUANTITIES[order]} [{first.display_unit}{_PER[order]}]"
        axes.set_ylabel(f"{name}\n{_limits_told(first, order, unit)}", fontsize=8)
    handles = [
        Line2D([], [], color=colour, ls=line, lw=1.4, label=f"joint {j + 1}")
        for j, (colour, line) in enumerate(_styles(first.dof))
    ]
    handles.append(Line2D([], [], color=GREY, ls=":", lw=1.2, label="limit"))
    handles.append(Line2D([], [], color=BLACK, lw=4.0, alpha=0.35, label="beyond its limit"))
    figure.legend(
        handles=handles, loc="outside upper left", ncols=len(handles), fontsize=8, frameon=False,
        columnspacing=1.2, handlelength=2.2,
    )  # fmt: skip
    return figure


def _lines(axes: Axes, motion: Motion, order: int, unit: float) -> None:
    """All joints of one motion, one quantity."""
    bounds = _bounds(motion.problem, order)
    for j, (colour, line) in enumerate(_styles(motion.problem.dof)):
        t, x = samples(motion.trajectory, j, order)
        low, high = bounds[j]
        slack = TOLERANCE * max(abs(low), abs(high)) if np.isfinite(high) else 0.0
        beyond = np.where((x > high + slack) | (x < low - slack), x, np.nan)
        axes.plot(t, unit * beyond, color=colour, lw=4.0, alpha=0.35, solid_capstyle="butt")
        axes.plot(t, unit * x, color=colour, ls=line, lw=1.3)
    extent = [unit * bound for bound in np.unique(bounds[np.isfinite(bounds)])]
    low, high = axes.get_ylim()
    for value in extent:
        # a position range far away would flatten the curves
        if order > 0 or low <= value <= high:
            axes.axhline(value, color=GREY, lw=0.9, ls=":")
    for passage in motion.trajectory.passage_times[1:-1]:
        axes.axvline(passage, color=GREY, lw=0.4, alpha=0.6)


def _styles(dof: int) -> list[tuple[Any, Any]]:
    return [JOINT_STYLE[j % len(JOINT_STYLE)] for j in range(dof)]


def _bounds(problem: Problem, order: int) -> Array:
    """Least and greatest value allowed per joint, (dof, 2) [rad/s^order]."""
    if order == 0:
        return problem.position_bounds
    return problem.limits.derivatives[order - 1][:, None] * np.array([-1.0, 1.0])


def _limits_told(problem: Problem, order: int, unit: float) -> str:
    """The limits of all joints in words, as the lines of several can lie close together."""
    bounds = unit * _bounds(problem, order)
    if not np.isfinite(bounds).any():
        return "no limit"
    if order == 0:
        same = np.ptp(bounds, axis=0).max() == 0.0
        return f"limits {bounds[0, 0]:.4g} to {bounds[0, 1]:.4g}" if same else "limits per joint"
    values = sorted({f"{high:.4g}" for high in bounds[:, 1] if np.isfinite(high)}, key=float)
    return "limit ±" + " / ".join(values)
