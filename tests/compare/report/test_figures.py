"""Figures show what the rows say."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import to_hex

from compare.report.figures.motion import _curves
from compare.report.style import VERMILION
from formulations import FAMILIES, Limits, Problem, check


def marked_as_broken(problem: Problem, order: int) -> bool:
    """Whether the figure draws any part of a motion as over its limit."""
    family = FAMILIES[problem.family]
    durations = np.full(problem.n_segments, 4.0)
    claimed = family.trajectory(problem, durations)
    assert check(problem, claimed).feasible
    figure, axes = plt.subplots()
    _curves(axes, problem, family.trajectory(problem, durations * 1.1), claimed, 0, order, 1.0)
    thick = [line for line in axes.lines if line.get_linewidth() == 3.0]
    assert all(to_hex(line.get_color()) == VERMILION.lower() for line in thick)
    plt.close(figure)
    return any(np.isfinite(line.get_ydata()).any() for line in thick)


def test_a_legal_position_at_a_positive_lower_limit_is_not_marked_as_broken() -> None:
    """The motion starts exactly on its lower limit of 1 rad and stays above it."""
    limits = Limits.of(1.0, 5.0, position=(1.0, 2.0), dof=1)
    problem = Problem.of([[1.0], [1.2], [1.6], [1.8]], limits)
    assert not marked_as_broken(problem, 0)


def test_a_legal_position_at_a_negative_upper_limit_is_not_marked_as_broken() -> None:
    limits = Limits.of(1.0, 5.0, position=(-2.0, -1.0), dof=1)
    problem = Problem.of([[-1.0], [-1.2], [-1.6], [-1.8]], limits)
    assert not marked_as_broken(problem, 0)
