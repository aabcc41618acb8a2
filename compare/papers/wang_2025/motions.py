"""Wang 2025, the three motions of Figs 7 to 9, 11 and 17 to 19: first plan, printed result, optimum."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from compare.audit.paper import settings
from compare.audit.paper.digits import values
from compare.papers.measure import judged, judged_row, least, peaks, spline
from compare.papers.pictures.panels import Curve, panels
from compare.papers.wang_2025.paper import paper
from compare.papers.words import seconds
from compare.report.style import BLUE, ORANGE, VERMILION
from formulations import load

PLAN, RULE, BEST = "2 s a segment, printed plan", "sec. 4.2.2, printed result", "certified optimum"
STYLES = {PLAN: (ORANGE, "-"), RULE: (VERMILION, "-"), BEST: (BLUE, "--")}


def motions(names: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Judge motions of all joints under Table 6, and measure their peaks and jumps.

    Parameters
    ----------
    names : sequence of str
        Keys of ``STYLES``.

    Returns
    -------
    dict
        By name what ``judged`` gives, peaks (velocity and acceleration by joint) and jumps at the waypoints (by
        order) [deg, s]; of the printed result also ``digits``, whether its rounding lets it keep the limits.
    """
    problem = load("sr4c")
    whole = next(row for row in paper().rows if row.joint is None)
    durations = {
        PLAN: lambda: settings("sr4c")["first_plan"]["times"],
        RULE: lambda: values(whole.times).tolist(),
        BEST: lambda: least(problem)["durations"],
    }
    found = {}
    for name in names:
        found[name] = judged(problem, durations[name]())
        trajectory = spline(problem, found[name]["durations"])
        found[name]["peaks"] = np.degrees(peaks(trajectory)).tolist()
        found[name]["jumps"] = np.degrees(trajectory.jumps.max(axis=1)).tolist()
    if RULE in found:
        found[RULE]["digits"] = judged_row(paper(), whole)["keeps"]
    return found


def curves(found: dict[str, dict[str, Any]]) -> Figure:
    """Draw angle, velocity and acceleration of every joint, with the limits of Table 6.

    Parameters
    ----------
    found : dict
        Of ``motions``.

    Returns
    -------
    Figure
    """
    problem = load("sr4c")
    splines = {name: spline(problem, m["durations"]) for name, m in found.items()}
    return panels([
        (f"joint {j + 1}", [Curve(label(name, found[name]), STYLES[name], problem, splines[name], j)
                            for name in found])
        for j in range(problem.dof)
    ])  # fmt: skip


def label(name: str, motion: dict[str, Any]) -> str:
    """Name a motion in a legend, with its time.

    Parameters
    ----------
    name : str
        A key of ``STYLES``.
    motion : dict
        Of ``motions``.

    Returns
    -------
    str
    """
    return f"{name}, {seconds(motion['seconds'])} s"
