"""Wang 2025: what its tables and figures share."""

from __future__ import annotations

import numpy as np

from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.paper import Paper, PrintedTimes, load_papers, settings
from compare.benchmark.protocol import Budget

SWARM = "mipso"
PRINTED_TIMES, FIRST_PLAN = "printed times", "first plan"
ALONE = (
    "Joint 1 alone. A candidate that breaks a limit is out. The paper prints neither the search box nor the "
    "constants of PSO. It does not have the equations of IPSO, so IPSO cannot be run. "
)


def paper() -> Paper:
    """The numbers that the paper prints."""
    return load_papers("wang_2025")[0]


def boxes() -> dict[str, tuple[float, float]]:
    """Other readings of the search box, from the least time of a segment in Tables 9 and 10 [s].

    One ends at the greatest time in these tables, the other, as for Li 2022, at the first plan.

    Returns
    -------
    dict
        Least and greatest duration of a segment, by PRINTED_TIMES and FIRST_PLAN.
    """
    times = [time.value for row in paper().rows for time in row.times]
    first_plan = max(settings("wang_2025")["first_plan"]["times"])
    return {PRINTED_TIMES: (min(times), max(times)), FIRST_PLAN: (min(times), float(first_plan))}


def in_words(low: float, high: float) -> str:
    """Write a search box: 0.386 to 2.6606 s a segment.

    Parameters
    ----------
    low, high : float [s]
        Least and greatest duration of a segment.

    Returns
    -------
    str
    """
    return f"{low:g} to {high:g} s a segment"


def fitting_limits(row: PrintedTimes) -> tuple[float, float]:
    """Find the lowest limits of two digits that a printed vector of one joint keeps.

    Parameters
    ----------
    row : PrintedTimes
        The vector.

    Returns
    -------
    tuple of float [deg/s, deg/s^2]
        Velocity and acceleration.
    """
    velocity, acceleration, _ = np.degrees(PrintedMotion.of(paper(), row).rounded[:, 0])
    return float(velocity), float(acceleration)


def budget() -> Budget:
    """Population and iterations of Table 7."""
    swarm = settings("wang_2025")["swarm"]
    return Budget(swarm["population"], swarm["iterations"])
