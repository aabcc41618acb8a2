"""Limits that a result fits although others are stated, and results that are too fast for those limits.

The peaks of a motion are the lowest limits that it can have been made under. That its limits were no
higher is an inference. It is drawn only if the motion is far from the optimum under the stated limits and
close to the optimum under its own peaks. If another result is then called too fast for those limits, that
is proved.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from compare.audit.findings import Finding
from compare.audit.motion.minima import crossing_times, impossible, minimum
from compare.audit.motion.printed_motion import PrintedMotion, limits_told
from compare.audit.paper import Paper, Total, with_limits
from compare.audit.paper.words import amount, number, percent
from formulations import FamilyBound, Problem
from formulations.motion.verdict import QUANTITIES
from formulations.problem.arrays import Array

# relative distances that decide an inference
_SLOWER = 0.02  # the motion is at least this far above the optimum under the stated limits
_FITS = 0.001  # the motion is at most this far above the optimum under its own peaks
_NEEDED = 0.005  # a limit stays as stated if the motion is at most this far above the optimum then
_BELOW = 0.02  # a peak counts as lower if it is at least this far below the stated limit


def fits_other_limits(motion: PrintedMotion) -> Finding | None:
    """Find stated limits that were not in force for a motion.

    The motion is far above the optimum under the stated limits and close to the optimum under lower ones.

    Parameters
    ----------
    motion : PrintedMotion
        The motion to judge.

    Returns
    -------
    Finding or None
    """
    limits = fitted(motion)
    if limits is None or motion.optimum is None:
        return None
    paper, stated = motion.paper, motion.problem.limits.derivatives
    upper, fitting = motion.optimum.upper, minimum(with_limits(motion.problem, limits)).upper
    told = "; ".join(
        f"{QUANTITIES[order + 1]} {amount(paper, float(motion.peaks[0].printed[order]), order + 1)} "
        f"(in round numbers {number(float(motion.rounded[order, 0]) / paper.angle)}) where "
        f"{number(float(stated[order, 0]) / paper.angle)} is stated"
        for order in range(3)
        if limits[order, 0] < stated[order, 0]
    )
    gap = max(motion.total / fitting - 1.0, 0.0)
    text = (
        f"{motion.total:.4f} s is {percent(motion.total / upper - 1.0)} above the optimum under "
        f"{motion.row.limits} ({upper:.4f} s), but within {percent(gap)} of the optimum ({fitting:.4f} "
        f"s) under the peak it reaches: {told}"
    )
    numbers = {"seconds": motion.total, "stated": upper, "fitting": fitting}
    for order in np.flatnonzero(limits[:, 0] < stated[:, 0]):
        numbers[QUANTITIES[order + 1]] = float(limits[order, 0])
    return Finding(paper.name, "other limits", motion.row.where, text, False, numbers)


def fitted(motion: PrintedMotion) -> Array | None:
    """Lower as few limits as possible until the motion of one joint is close to their optimum.

    Parameters
    ----------
    motion : PrintedMotion
        The motion to judge.

    Returns
    -------
    Array, shape (3, 1) [rad/s, rad/s^2, rad/s^3], or None
        None if the stated limits fit, or if no lower ones do.
    """
    stated, lowest = motion.problem.limits.derivatives, motion.tightest.limits.derivatives
    # the peaks of several joints fit any motion; and a proof costs less than an optimum
    near = motion.seconds[0] / (1.0 + _SLOWER)
    if motion.row.joint is None or impossible(motion.tightest, 0.0 * motion.halves, near):
        return None
    lower = motion.rounded < lowest * (1.0 - _BELOW)
    lower &= np.isfinite(stated) & (motion.most < lowest)
    if not lower.any() or not near > minimum(motion.tightest).upper:
        return None
    if not motion.implied_gap <= _FITS:
        return None
    limits = np.where(lower, motion.implied, stated)
    for order in np.flatnonzero(lower[:, 0]):
        fewer = limits.copy()
        fewer[order] = stated[order]
        if not (fewer < stated).any():
            continue
        if motion.total <= minimum(with_limits(motion.problem, fewer)).upper * (1.0 + _NEEDED):
            limits = fewer
    return limits


def total_findings(paper: Paper, totals: Sequence[Total]) -> list[Finding]:
    """Check totals without a time vector against the certified minimum under the stated limits.

    Parameters
    ----------
    paper : Paper
        What the paper prints.
    totals : sequence of Total
        Totals without a time vector.

    Returns
    -------
    list of Finding
        One per table and method.
    """
    found = []
    for group in _tables_of(totals):
        first = group[0]
        if first.limits is None or paper.waypoints is None:
            continue
        problem = paper.problem(first.joint, first.limits)
        loosest = paper.loosest(problem, first.joint, first.limits)
        fast = [t for t in group if too_fast(paper, t, loosest)]
        if fast:
            bound = minimum(problem)
            best = min(t.value.value for t in fast)
            text = (
                f"{len(fast)} of {len(group)} results, the best {best:.4f} s, "
                f"{percent(1.0 - best / bound.seconds)} below the certified minimum of "
                f"{bound.seconds:.4f} s: no durations of this spline keep the limits of {first.limits} "
                f"in that time"
            )
            numbers = {"seconds": best, "minimum": bound.seconds}
            found.append(Finding(paper.name, "minimum", first.table, text, numbers=numbers))
    return found


def too_fast(paper: Paper, total: Total, problem: Problem) -> bool:
    """Whether a total is proved too short for every reading of its digits and of the waypoints.

    Parameters
    ----------
    paper : Paper
        What the paper prints.
    total : Total
        The total to judge.
    problem : Problem
        Gives the limits.

    Returns
    -------
    bool
    """
    half = paper.halves_of(total.joint)
    displacement = crossing_times(problem, half).max(axis=1).sum()
    return bool(displacement > total.value.high) or impossible(problem, half, total.value.high)


def table_findings(motions: Sequence[PrintedMotion], totals: Sequence[Total]) -> list[Finding]:
    """Find results that are too fast for the limits which another result of the same joint fits.

    Parameters
    ----------
    motions : sequence of PrintedMotion
        The paper's time vectors as motions.
    totals : sequence of Total
        Totals without a time vector.

    Returns
    -------
    list of Finding
    """
    found = []
    for motion in motions:
        limits = None if motion.row.joint is None or motion.breaks else in_force(motion)
        if limits is None:
            continue
        problem = with_limits(motion.loosest, limits)
        bound = None
        mine = (motion.row.joint, motion.row.limits)
        for group in _tables_of(t for t in totals if (t.joint, t.limits) == mine):
            fast = [t for t in group if too_fast(motion.paper, t, problem)]
            if fast:
                bound = bound or minimum(problem)
                best = min(fast, key=lambda total: total.value.value)
                which = f"{len(fast)} of {len(group)} results, the best" if len(group) > 1 else ""
                found.append(_contradiction(motion, limits, best.table, best.value.value, bound, which))
        for other in motions:
            if other is motion or (other.row.joint, other.row.limits) != mine or other.row.of:
                continue
            if impossible(problem, motion.halves, other.seconds[1]):
                bound = bound or minimum(problem)
                found.append(_contradiction(motion, limits, other.row.where, other.total, bound))
    return found


def in_force(motion: PrintedMotion) -> Array | None:
    """Infer the limits that the motion of one joint was made under, to two digits.

    Parameters
    ----------
    motion : PrintedMotion
        The motion to judge.

    Returns
    -------
    Array, shape (3, 1) [rad/s, rad/s^2, rad/s^3], or None
        Stated limits that fit are the highest that print alike. None if the numbers do not tell.
    """
    if not motion.stated:
        return motion.rounded if motion.implied_gap <= _FITS else None
    limits, stated = fitted(motion), motion.problem.limits.derivatives
    return (
        None
        if limits is None
        else np.where(
            limits < stated, np.minimum(motion.rounded, stated), motion.loosest.limits.derivatives
        )
    )


def _contradiction(
    motion: PrintedMotion,
    limits: Array,
    where: str,
    seconds: float,
    bound: FamilyBound,
    which: str = "",
) -> Finding:
    least = bound.seconds
    text = (
        f"{which} {seconds:.4f} s, {percent(1.0 - seconds / least)} below the certified minimum of "
        f"{least:.4f} s for {limits_told(motion, limits)}. {motion.row.where} fits these limits, so the "
        f"two were not made under the same ones"
    ).strip()
    numbers = {"seconds": seconds, "minimum": least, "gap": seconds / least - 1.0}
    return Finding(motion.paper.name, "tables", where, text, numbers=numbers)


def _tables_of(totals: Iterable[Total]) -> list[list[Total]]:
    """Group totals by table, method, joint and limits."""
    groups: dict[tuple[object, ...], list[Total]] = {}
    for total in totals:
        groups.setdefault((total.table, total.joint, total.limits), []).append(total)
    return list(groups.values())
