"""Position to jerk of the best motion of one case, with its limits; and the best claim beside it."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row, durations_of
from compare.benchmark.summaries import best_claim, best_row
from compare.report.style import BLACK, BLUE, GREY, VERMILION, styled
from formulations import FAMILIES, Problem, Trajectory, check
from formulations.motion.picture import samples
from formulations.motion.verdict import QUANTITIES
from formulations.problem.joint_words import factors, shown_unit


@styled
def motion_figure(problem: Problem, ladder: LadderRecord, rows: Sequence[Row]) -> Figure:
    """Draw position to jerk of the best motion, its limits, and the best claim in the papers' coding.

    The claimed motion is thick where it breaks a limit.

    Parameters
    ----------
    problem : Problem
    ladder : LadderRecord
        Its bounds; the optimum of the family is drawn where no swarm has a verified motion.
    rows : sequence of Row
        Its rows.

    Returns
    -------
    Figure
    """
    family = FAMILIES[problem.family]
    best = best_row(rows)
    optimum = np.array(ladder["durations"]["family"])
    title, motion = "optimum of the family (NLP)", family.trajectory(problem, optimum)
    if best is not None:
        title = f"best swarm: {best.swarm}, {best.variant}, {best.seconds:.4f} s"
        motion = family.trajectory(problem, durations_of(best))
    claim = best_claim(rows)
    claimed = None if claim is None else _claimed_motion(problem, claim)

    scales = 1.0 / factors(problem.units, problem.display_unit)
    joints = problem.moving_joints
    figure, grid = plt.subplots(
        4, len(joints), figsize=(1.2 + 2.0 * len(joints), 7.2), sharex=True, squeeze=False
    )
    for column, j in enumerate(joints):
        for order, name in enumerate(QUANTITIES):
            axes = grid[order][column]
            _curves(axes, problem, motion, claimed, j, order, float(scales[j]))
            if column == 0 or problem.units[j] != problem.units[joints[column - 1]]:
                unit = shown_unit(problem.units[j], problem.display_unit, order)
                axes.set_ylabel(f"{name}\n[{unit}]")
            axes.tick_params(labelsize=7)
        grid[0][column].set_title(problem.joint_name(j), fontsize=9)
        grid[3][column].set_xlabel("time [s]")
    handles = [
        Line2D([], [], color=BLUE, lw=1.4),
        Line2D([], [], color=BLACK, lw=0.8, ls="--"),
    ]
    labels = [title, "limit"]
    if claimed is not None and claim is not None:
        verdict = check(problem, claimed)
        words = "keeps the limits" if verdict.feasible else f"breaks limits: {verdict.worst}"
        handles.append(Line2D([], [], color=VERMILION, lw=1.0))
        labels.append(f"papers' coding ({claim.swarm}), as claimed, {claim.claimed:.4f} s: {words}")
    figure.legend(handles, labels, loc="outside upper left", fontsize=8, frameon=False)
    return figure


def _claimed_motion(problem: Problem, row: Row) -> Trajectory:
    """The motion that a row claims: the verified one, faster by one factor on all durations."""
    assert row.claimed is not None
    assert row.seconds is not None
    durations = durations_of(row) * (row.claimed / row.seconds)
    return FAMILIES[problem.family].trajectory(problem, durations)


def _curves(
    axes: Axes,
    problem: Problem,
    motion: Trajectory,
    claimed: Trajectory | None,
    joint: int,
    order: int,
    unit: float,
) -> None:
    """One joint, one quantity."""
    t, x = samples(motion, joint, order)
    low, high = (
        problem.position_bounds[joint] if order == 0 else problem.limits.ranges[order - 1, joint]
    )
    extent = np.abs(x).max()
    if claimed is not None:
        tc, xc = samples(claimed, joint, order)
        axes.plot(tc, xc * unit, color=VERMILION, lw=0.9, alpha=0.8)
        # the slack widens the range whatever the signs of its ends
        slack = 1e-6 * max(abs(limit) for limit in (low, high, 0.0) if np.isfinite(limit))
        over = np.where((xc > high + slack) | (xc < low - slack), xc, np.nan)
        axes.plot(tc, over * unit, color=VERMILION, lw=3.0)
        extent = max(extent, np.abs(xc).max())
    axes.plot(t, x * unit, color=BLUE, lw=1.4)
    for limit in (low, high):
        # a position limit far away would flatten the curve
        if np.isfinite(limit) and (order > 0 or abs(limit) < 2.0 * extent):
            axes.axhline(limit * unit, color=BLACK, lw=0.8, ls="--")
    if order == 0:
        axes.plot(motion.passage_times, problem.waypoints[:, joint] * unit, "o", color=BLUE, ms=3)
    for passage in motion.passage_times[1:-1]:
        axes.axvline(passage, color=GREY, lw=0.4, alpha=0.6)
