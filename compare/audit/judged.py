"""One judged time vector as plain data: the record that goes from the audit through the store to the page."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class JudgedTimes:
    """What the audit says of one time vector; times in s, angles in the paper's unit.

    Attributes
    ----------
    where, by : str
        The place in the paper; the method.
    joint : int or None
        From 1; None for all joints together.
    times, printed_total : text
        As printed.
    total : float
        Sum of the durations.
    limits : str or None
        Name of the stated limits.
    feasible : str
        A value of ``Kept``.
    velocity, acceleration, jerk : list of float
        Peaks of each joint at the printed digits.
    stretch, stretch_low, stretch_high : float or None
        Least factor on all times that keeps the stated limits: at the printed digits, and over all
        readings of them.
    honest : float or None
        Total after that factor.
    minimum, optimum : float or None
        Certified bound and best known time under the stated limits.
    implied : list of (list of float or None)
        Lowest limits on velocity, acceleration and jerk that the motion keeps.
    implied_minimum, implied_optimum : float
        Certified bound and best known time under these.
    implied_gap : float or None
        Total over that optimum, minus 1.
    displacement : float
        Least time by displacement over velocity limit.
    """

    where: str
    by: str
    joint: int | None
    times: list[str]
    total: float
    printed_total: str | None
    limits: str | None
    feasible: str
    velocity: list[float | None]
    acceleration: list[float | None]
    jerk: list[float | None]
    stretch: float | None
    stretch_low: float | None
    stretch_high: float | None
    honest: float | None
    minimum: float | None
    optimum: float | None
    implied: list[list[float | None]]
    implied_minimum: float
    implied_optimum: float
    implied_gap: float | None
    displacement: float
