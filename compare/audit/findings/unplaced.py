"""Times whose waypoints are not printed (Lu 2024): what holds for any waypoints at all."""

from __future__ import annotations

import numpy as np

from compare.audit.findings import Finding
from compare.audit.paper import Paper, StatedLimits
from compare.audit.paper.words import number
from formulations.problem.arrays import Array
from formulations.problem.joint_words import UNITS


def unplaced_findings(paper: Paper) -> list[Finding]:
    """Check whether times without waypoints can belong to the stated limits.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Returns
    -------
    list of Finding
    """
    found = [
        Finding(
            paper.name, "missing", "waypoints",
            f"{paper.n_waypoints} waypoints are used and none is printed: no time can be reproduced",
        )
    ]  # fmt: skip
    for total in paper.totals:
        stated = None if total.limits is None else paper.stated[total.limits]
        ranges = None if stated is None else _ranges(paper, stated)
        if stated is None or ranges is None:
            continue
        lowest = stated.derivatives - stated.derivative_halves
        most = longest_with_stops(paper.n_waypoints, ranges, lowest)
        if not total.value.low > most:
            continue
        other = "deg" if paper.unit == "rad" else "rad"
        rescaled = longest_with_stops(paper.n_waypoints, ranges, lowest * UNITS[other] / paper.angle)
        text = (
            f"{total.value} s is {number(total.value.value / most)} times the {most:.3g} s in which "
            f"this arm, under {total.limits}, crosses the whole range of its joints in every segment, "
            f"with a full stop at each waypoint: those limits do not explain it"
        )
        if rescaled >= total.value.high:
            text += f"; read in {other} ({rescaled:.3g} s) they can"
        found.append(Finding(paper.name, "other limits", total.table, text, False))
    return found


def _ranges(paper: Paper, stated: StatedLimits) -> Array | None:
    """Range of each joint [rad], by the stated limits of position or else by those of the arm."""
    position = stated.position
    if not np.isfinite(position).all() and paper.arm is not None:
        position = paper.arm.position if stated.joint is None else paper.arm.position[[stated.joint]]
    known = np.isfinite(position).all() and len(position) == stated.derivatives.shape[1]
    return position[:, 1] - position[:, 0] if known else None


def longest_with_stops(n_waypoints: int, ranges: Array, derivatives: Array) -> float:
    """Upper bound on the best time through any waypoints within the joint limits.

    It is the time of a motion that crosses the whole range of the slowest joint in every segment and stops
    at each waypoint. A rest-to-rest motion over d takes d/V + V/A, or 2 sqrt(d/A) if it does not reach V.
    There is no jerk limit.

    Parameters
    ----------
    n_waypoints : int
        Number of waypoints.
    ranges : Array, shape (dof,) [rad]
        The whole range of each joint.
    derivatives : Array, shape (3, dof) [rad/s, rad/s^2, rad/s^3]
        The limits.

    Returns
    -------
    float [s]
    """
    d = ranges
    velocity, acceleration, _ = derivatives
    reached = d * acceleration >= velocity**2
    each = np.where(reached, d / velocity + velocity / acceleration, 2.0 * np.sqrt(d / acceleration))
    return float((n_waypoints - 1) * each.max())
