"""Curves in small panels: a column per joint or motion, a row per quantity, motions over one another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from compare.papers.measure import spline
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, styled
from formulations import Problem, Trajectory
from formulations.motion.picture import samples
from formulations.motion.verdict import QUANTITIES, TOLERANCE

_JOINTS: list[tuple[Any, Any]] = [
    (colour, "-") for colour in (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK)
]
_PER = ("", "/s", "/s²", "/s³")


@dataclass(frozen=True)
class Curve:
    """One joint of a motion.

    Attributes
    ----------
    label : str
        In the legend.
    style : tuple
        Colour and line style.
    problem : Problem
        Gives the limits that the motion has to keep.
    trajectory : Trajectory
        The motion.
    joint : int
        From 0.
    """

    label: str
    style: tuple[Any, Any]
    problem: Problem
    trajectory: Trajectory
    joint: int = 0


@styled
def panels(columns: Sequence[tuple[str, Sequence[Curve]]], orders: Sequence[int] = (0, 1, 2)) -> Figure:
    """Draw curves with their limits dashed, and thick where they are beyond them.

    Limits that all curves of a panel share are black; others have the colour of their curve.

    Parameters
    ----------
    columns : sequence of (str, sequence of Curve)
        Title and curves of each column.
    orders : sequence of int
        Rows: 0 for position, 1 for velocity, and so on.

    Returns
    -------
    Figure
    """
    first = columns[0][1][0].problem
    unit = 180.0 / np.pi if first.display_unit == "deg" else 1.0
    size = (1.2 + (1.75 if len(columns) > 3 else 2.9) * len(columns), 1.0 + 1.75 * len(orders))
    figure, grid = plt.subplots(len(orders), len(columns), figsize=size, sharex="col", squeeze=False)
    legend: dict[str, Line2D] = {}
    for column, (title, curves) in enumerate(columns):
        for axes, order in zip(grid[:, column], orders, strict=True):
            for curve in curves:
                legend.setdefault(curve.label, _drawn(axes, curve, order, unit))
            _limits(axes, curves, order, unit)
            axes.tick_params(labelsize=7)
        grid[0, column].set_title(title, loc="left", fontsize=8.5)
        grid[-1, column].set_xlabel("time [s]", fontsize=8)
    for axes, order in zip(grid[:, 0], orders, strict=True):
        axes.set_ylabel(f"{QUANTITIES[order]}\n[{first.display_unit}{_PER[order]}]", fontsize=8)
    handles = [*legend.values(), Line2D([], [], color=BLACK, lw=0.9, ls="--", label="limit")]
    handles.append(Line2D([], [], color=GREY, lw=4.0, alpha=0.5, label="beyond it"))
    columns_of_legend = len(handles) if len(columns) > 3 else (len(handles) + 1) // 2
    figure.legend(
        handles=handles, loc="outside upper left", ncols=columns_of_legend, fontsize=8, frameon=False,
        columnspacing=1.4, handlelength=2.4,
    )  # fmt: skip
    return figure


def _drawn(axes: Axes, curve: Curve, order: int, unit: float) -> Line2D:
    colour, line = curve.style
    t, x = samples(curve.trajectory, curve.joint, order)
    low, high = _bounds(curve, order)
    slack = TOLERANCE * max(abs(low), abs(high)) if np.isfinite([low, high]).all() else 0.0
    beyond = np.where((x > high + slack) | (x < low - slack), x, np.nan)
    axes.plot(t, unit * beyond, color=colour, lw=4.5, alpha=0.35, solid_capstyle="butt")
    (drawn,) = axes.plot(t, unit * x, color=colour, ls=line, lw=1.3, label=curve.label)
    if order == 0:
        at = curve.trajectory.passage_times
        points = unit * curve.trajectory.at(at)[:, curve.joint]
        axes.plot(at, points, "o", color=colour, ms=2.5)
    return drawn


def _limits(axes: Axes, curves: Sequence[Curve], order: int, unit: float) -> None:
    """Draw the limits of a panel, except for position limits far away, which would flatten the curves."""
    low, high = axes.get_ylim()
    found: dict[float, list[Any]] = {}
    for curve in curves:
        for bound in _bounds(curve, order):
            if np.isfinite(bound) and (order > 0 or low <= unit * bound <= high):
                found.setdefault(round(unit * bound, 9), []).append(curve.style[0])
    for value, colours in found.items():
        colour = BLACK if len(colours) == len(curves) else colours[0]
        axes.axhline(value, color=colour, lw=0.9, ls="--", zorder=1)


def _bounds(curve: Curve, order: int) -> tuple[float, float]:
    if order == 0:
        low, high = curve.problem.position_bounds[curve.joint]
        return float(low), float(high)
    limit = float(curve.problem.limits.derivatives[order - 1, curve.joint])
    return -limit, limit


def all_joints(title: str, problem: Problem, durations: ArrayLike) -> tuple[str, list[Curve]]:
    """Prepare a column of ``panels`` with all joints of one motion.

    Parameters
    ----------
    title : str
        Of the column.
    problem : Problem
        Gives family and limits.
    durations : array_like, shape (n_segments,) [s]
        Of the spline.

    Returns
    -------
    (str, list of Curve)
    """
    trajectory = spline(problem, durations)
    return title, [
        Curve(f"joint {j + 1}", _JOINTS[j % len(_JOINTS)], problem, trajectory, j)
        for j in range(problem.dof)
    ]


def verdict_told(judged: dict[str, Any]) -> str:
    """Say in a title whether a motion keeps its limits.

    Parameters
    ----------
    judged : dict
        Of ``measure.judged``.

    Returns
    -------
    str
    """
    if judged["keeps"]:
        return "keeps its limits"
    if judged["stretch"] > 1.0:
        return f"breaks its limits until stretched by {judged['stretch']:.4g}"
    return judged["faults"][0] if judged["faults"] else "is no motion"
