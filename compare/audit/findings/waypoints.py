"""Printed joint angles beyond the limits of position that the same paper states."""

from __future__ import annotations

import numpy as np

from compare.audit.findings import Finding
from compare.audit.paper import Paper
from compare.audit.paper.words import amount
from formulations.problem.problem import POSITION_TOLERANCE


def waypoints_beyond(paper: Paper) -> list[Finding]:
    """Find waypoints that no reading of the digits brings within the stated limits of position.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Returns
    -------
    list of Finding
        One per waypoint and table of limits: its joint that is farthest outside.
    """
    if paper.waypoints is None or paper.halves is None:
        return []
    found = []
    for stated in paper.stated.values():
        columns = slice(None) if stated.joint is None else slice(stated.joint, stated.joint + 1)
        points, halves = paper.waypoints[:, columns], paper.halves[:, columns] + POSITION_TOLERANCE
        low, high = (stated.position + stated.position_halves * [-1.0, 1.0]).T
        beyond = np.maximum(low - points, points - high) - halves
        for i in np.flatnonzero((beyond > 0.0).any(axis=1)):
            j = int(beyond[i].argmax())
            joint = j if stated.joint is None else stated.joint
            limit = stated.position[j, int(points[i, j] > high[j])]
            text = (
                f"joint {joint + 1} is at {amount(paper, float(points[i, j]), 0)}, the limit of "
                f"{stated.name} is {amount(paper, float(limit), 0)}"
            )
            where = f"waypoint {i + 1}"
            found.append(Finding(paper.name, "limits", where, text))
    return found
