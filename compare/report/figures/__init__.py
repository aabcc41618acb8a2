"""The pictures of one case, drawn from the store alone: bounds, gaps, convergence, motion."""

from compare.report.figures.bounds import ladder_figure
from compare.report.figures.convergence import convergence_figure
from compare.report.figures.gaps import gap_figure
from compare.report.figures.motion import motion_figure

__all__ = [
    "convergence_figure",
    "gap_figure",
    "ladder_figure",
    "motion_figure",
]
