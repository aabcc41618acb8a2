"""Paper 000: what its items share."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from compare.audit.paper import Paper, Row
from compare.audit.paper_file import load_papers
from compare.benchmark.suite import Budget
from compare.papers.printed import tables
from compare.papers.wang_2025 import table_8 as table8
from formulations import FAMILIES, Problem, Trajectory, load
from formulations.problem.arrays import Array

TABLE_6, IN_FORCE = table8.LIMITS  # names of the two readings of joint 1's acceleration limit
SWARM = "mipso"


def paper() -> Paper:
    """Paper 000 as data."""
    return load_papers("sr4c")[0]


def budget() -> Budget:
    """Table 7."""
    settings = tables("sr4c")["swarm"]
    return Budget(settings["particles"], settings["iterations"])


def seconds(value: float) -> str:
    """A time, to the papers' digits."""
    return f"{value:.4f}"


def above(value: float, least: float) -> str:
    """By how much a time is above another one."""
    return f"{round(100.0 * (value / least - 1.0), 2) + 0.0:+.2f} %"  # no -0.00


def with_speed(velocity: float, acceleration: float) -> Problem:
    """Joint 1 of sr4c alone under a velocity [deg/s] and an acceleration limit [deg/s²]."""
    alone = load("sr4c").joint(0)
    speed, rate = np.radians([[velocity], [acceleration]])
    return replace(alone, limits=replace(alone.limits, velocity=speed, acceleration=rate))


def table_10_rows() -> list[tuple[float, Row]]:
    """Rows of Table 10 with their velocity limit [deg/s]."""
    rows = [row for row in paper().rows if row.where.startswith("Table 10")]
    return [(float(np.degrees(paper().stated[str(row.limits)].derivatives[0, 0])), row) for row in rows]


def spline(problem: Problem, durations: list[float]) -> Trajectory:
    """The motion of the problem's family."""
    return FAMILIES[problem.family].trajectory(problem, np.array(durations))


def peaks(trajectory: Trajectory) -> Array:
    """Peaks of |velocity| and |acceleration| per joint, (2, dof) [deg/s, deg/s²]."""
    found = [trajectory.extremes(order) for order in (1, 2)]
    return np.degrees([np.maximum(-e.low, e.high).max(axis=0) for e in found])
