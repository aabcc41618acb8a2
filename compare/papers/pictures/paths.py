"""The path of the tool in space: three views, the printed points, and the tool at the joint angles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from compare.report.style import BLACK, styled
from formulations import Trajectory
from formulations.arms import Arm
from formulations.problem.arrays import Array

_VIEWS = (("from above", 0, 1), ("from the front", 0, 2), ("from the side", 1, 2))
_AXES = "xyz"
_HALO = [withStroke(linewidth=2.5, foreground="white")]


def tool_path(arm: Arm, trajectory: Trajectory, count: int = 400) -> Array:
    """Sample the positions of the tool at even times.

    Parameters
    ----------
    arm : Arm
        Gives the kinematics.
    trajectory : Trajectory
        The motion of its joints.
    count : int
        Number of samples.

    Returns
    -------
    Array, shape (count, 3) [m]
    """
    times = np.linspace(0.0, trajectory.seconds, count)
    return np.asarray(arm.chain.forward(trajectory.at(times))[:, :3, 3])


def length(path: Array) -> float:
    """Length of a path.

    Parameters
    ----------
    path : Array, shape (n, 3) [m]
        Its points.

    Returns
    -------
    float [m]
    """
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


@styled
def path_views(
    arm: Arm,
    motions: Sequence[tuple[str, tuple[Any, Any], Trajectory]],
    points: Array,
    names: Sequence[str],
) -> Figure:
    """Draw three views of the paths of several motions.

    Parameters
    ----------
    arm : Arm
        Gives the kinematics.
    motions : sequence of (str, tuple, Trajectory)
        Label, style and motion.
    points : Array, shape (n, 3) [m]
        As printed.
    names : sequence of str
        Of the points.

    Returns
    -------
    Figure
    """
    figure, grid = plt.subplots(1, 3, figsize=(10.4, 4.0))
    for axes, (title, right, up) in zip(grid, _VIEWS, strict=True):
        for label, (colour, line), trajectory in motions:
            path = 1e3 * tool_path(arm, trajectory)
            axes.plot(path[:, right], path[:, up], color=colour, ls=line, lw=1.4, label=label)
        stops = 1e3 * arm.chain.forward(motions[0][2].at(motions[0][2].passage_times))[:, :3, 3]
        axes.plot(
            stops[:, right], stops[:, up], "o", mfc="none", mec=BLACK, ms=8, label="joint angles, by FK"
        )
        printed = 1e3 * points
        axes.plot(printed[:, right], printed[:, up], "x", color=BLACK, ms=5, label="printed points")
        spots = _apart(printed[:, [right, up]], names)
        for spot, name in spots:
            axes.annotate(name, spot, textcoords="offset points", xytext=_aside(spot, spots), fontsize=8,
                          ha="center", va="center", path_effects=_HALO)  # fmt: skip
        axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.12)
        axes.set_xlabel(f"{_AXES[right]} [mm]")
        axes.set_ylabel(f"{_AXES[up]} [mm]")
        axes.set_title(title, loc="left")
    handles, labels = grid[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False, fontsize=8)
    return figure


def _aside(spot: Any, spots: list[tuple[Any, str]]) -> tuple[float, float]:
    """Place of a label in points: away from the nearest other point."""
    away = min((spot - other for other, _ in spots if other is not spot), key=np.linalg.norm)
    x, y = 12.0 * away / np.linalg.norm(away)
    return float(x), float(y)


def _apart(spots: Array, names: Sequence[str]) -> list[tuple[Any, str]]:
    """Give points that coincide in a view one label: 4, 5."""
    near = 0.02 * float(np.ptp(spots, axis=0).max())
    found: list[tuple[Any, str]] = []
    for spot, name in zip(spots, names, strict=True):
        for i, (other, known) in enumerate(found):
            if np.abs(spot - other).max() <= near:
                found[i] = (other, f"{known}, {name}")
                break
        else:
            found.append((spot, name))
    return found
