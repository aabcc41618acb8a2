"""Numbers written for people: amounts with their unit, percentages."""

from __future__ import annotations

import numpy as np

from compare.audit.paper.records import Paper


def amount(paper: Paper, value: float, order: int) -> str:
    """Write a position or a derivative of a joint for people: 418.7 deg/s.

    Parameters
    ----------
    paper : Paper
        Gives the unit of angle.
    value : float [rad/s^order]
        The number.
    order : int
        0 for position, 1 for velocity, and so on.

    Returns
    -------
    str
    """
    power = {1: "/s", 2: "/s^2", 3: "/s^3"}.get(order, "")
    return f"{number(value / paper.angle)} {paper.unit}{power}"


def number(value: float) -> str:
    """Write a number for people: four significant digits, no decimals from a thousand on.

    Parameters
    ----------
    value : float
        The number.

    Returns
    -------
    str
    """
    if not np.isfinite(value):
        return "unlimited"
    return f"{value:.4g}" if abs(value) < 1000.0 else f"{value:.0f}"


def percent(ratio: float) -> str:
    """Write a ratio as a percentage of three digits: 0.47 %, 35.5 %.

    Parameters
    ----------
    ratio : float
        1 is the whole.

    Returns
    -------
    str
    """
    return f"{100.0 * ratio:.3g} %"
