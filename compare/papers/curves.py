"""A column of panels: all joints of one motion, each in its colour."""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from compare.papers.panels import Curve
from compare.report.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION
from formulations import FAMILIES, Problem

JOINT_STYLE: list[tuple[Any, Any]] = [
    (colour, "-") for colour in (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK)
]


def all_joints(title: str, problem: Problem, durations: ArrayLike) -> tuple[str, list[Curve]]:
    """The problem's own spline with these durations (n_segments,) [s], as ``panels`` takes it."""
    trajectory = FAMILIES[problem.family].trajectory(problem, durations)
    return title, [
        Curve(f"joint {j + 1}", JOINT_STYLE[j % len(JOINT_STYLE)], problem, trajectory, j)
        for j in range(problem.dof)
    ]


def verdict_told(judged: dict[str, Any]) -> str:
    """What the check says, for a title. judged: of ``measure.judged``."""
    if judged["keeps"]:
        return "keeps its limits"
    if judged["stretch"] > 1.0:
        return f"breaks its limits until stretched by {judged['stretch']:.4g}"
    return judged["faults"][0] if judged["faults"] else "is no motion"
