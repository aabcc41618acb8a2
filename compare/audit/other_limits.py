"""Limits that a result fits although others are stated, and results too fast for them.

What a motion reaches is the least that its limits can have been. That they were not more is an
inference, drawn only where the motion is far from the optimum of the stated limits and next to that of
its own peaks. Whatever is then said of another result, that it is too fast for those, is proved.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from compare.audit.findings import Finding, amount, number, percent
from compare.audit.minima import crossing_times, impossible, minimum, with_limits
from compare.audit.motions import Motion, limits_told
from compare.audit.paper import Paper, Total
from formulations import Problem
from formulations.problem import Array
from formulations.trajectory import QUANTITIES

_SLOWER = 0.02  # at least so far above the optimum of the stated limits
_FITS = 0.001  # at most so far above that of the implied ones
_BELOW = 0.02  # at least one of these is so far below the stated one


def fits_other_limits(motion: Motion) -> Finding | None:
    """Stated limits were not in force: far above their optimum, next to the optimum of lower ones."""
    paper, stated = motion.paper, motion.problem.limits.derivatives
    # several joints with limits of their own fit anything; and a proof costs less than an optimum
    near = motion.seconds[0] / (1.0 + _SLOWER)
    if motion.row.joint is None or impossible(motion.problem, 0.0 * motion.halves, near):
        return None
    lower = motion.rounded < stated * (1.0 - _BELOW)
    lower &= np.isfinite(stated) & (motion.most < stated)
    if not lower.any() or motion.optimum is None:
        return None
    upper = motion.optimum.upper
    if not near > upper:
        return None
    fitting, gap = motion.implied_optimum, motion.implied_gap
    if not gap <= _FITS:
        return None
    text = (
        f"{motion.total:.4f} s is {percent(motion.total / upper - 1.0)} above the optimum under "
        f"{motion.row.limits} ({upper:.4f} s), but within {percent(max(gap, 0.0))} of the optimum "
        f"under the peaks it reaches: {_told(motion, lower)}"
    )
    numbers = {"seconds": motion.total, "stated": upper, "fitting": fitting.upper}
    return Finding(paper.name, "other limits", motion.row.where, text, False, numbers)


def _told(motion: Motion, lower: Any) -> str:
    """Peaks that lie below stated limits, per joint and derivative."""
    paper, stated = motion.paper, motion.problem.limits.derivatives
    parts = []
    for order, j in np.argwhere(lower):
        k = int(order) + 1
        parts.append(
            f"{QUANTITIES[k]} {amount(paper, float(motion.peaks[j].printed[order]), k)} (in round "
            f"numbers {number(float(motion.rounded[order, j]) / paper.angle)}) where "
            f"{number(float(stated[order, j]) / paper.angle)} is stated"
        )
    return "; ".join(parts)


def total_findings(paper: Paper, totals: Sequence[Total]) -> list[Finding]:
    """Totals whose time vectors are not printed: against the stated limits, one verdict per table."""
    found = []
    for group in _tables_of(totals):
        first = group[0]
        if first.limits is None or paper.waypoints is None:
            continue
        problem = paper.problem(first.joint, first.limits)
        fast = [t for t in group if too_fast(paper, t, problem)]
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
    """Whether no reading of a total's digits can keep the limits of a problem."""
    half = paper.halves_of(total.joint)
    displacement = crossing_times(problem, half).max(axis=1).sum()
    return bool(displacement > total.value.high) or impossible(problem, half, total.value.high)


def table_findings(motions: Sequence[Motion], totals: Sequence[Total]) -> list[Finding]:
    """Results that are faster than the limits allow which another result of the same joint fits."""
    found = []
    for motion in motions:
        if motion.row.of or motion.breaks or not _tells(motion):
            continue
        problem = with_limits(motion.problem, in_force(motion))
        bound = None
        mine = (motion.row.joint, motion.row.limits)
        for group in _tables_of(t for t in totals if (t.joint, t.limits) == mine):
            fast = [t for t in group if too_fast(motion.paper, t, problem)]
            if fast:
                bound = bound or minimum(problem)
                best = min(fast, key=lambda total: total.value.value)
                which = f"{len(fast)} of {len(group)} results, the best" if len(group) > 1 else ""
                found.append(_contradiction(motion, best.table, best.value.value, bound.seconds, which))
        for other in motions:
            if other is motion or (other.row.joint, other.row.limits) != mine or other.row.of:
                continue
            if impossible(problem, motion.halves, other.seconds[1]):
                bound = bound or minimum(problem)
                found.append(_contradiction(motion, other.row.where, other.total, bound.seconds))
    return found


def _tells(motion: Motion) -> bool:
    """Whether the limits a motion implies are those it was made under, by all that its numbers say."""
    if motion.stated:
        return fits_other_limits(motion) is not None
    return motion.implied_gap <= _FITS


def in_force(motion: Motion) -> Array:
    """Limits that a motion fits, to two digits and never above the stated ones, (3, dof)."""
    return np.minimum(motion.rounded, motion.problem.limits.derivatives)


def _contradiction(
    motion: Motion, where: str, seconds: float, least: float, which: str = ""
) -> Finding:
    paper, limits = motion.paper, in_force(motion)
    text = (
        f"{which} {seconds:.4f} s, {percent(1.0 - seconds / least)} below the certified minimum of "
        f"{least:.4f} s for {limits_told(motion, limits)}, the limits that {motion.row.where} fits: "
        f"not made under those"
    ).strip()
    numbers = {"seconds": seconds, "minimum": least, "gap": seconds / least - 1.0}
    return Finding(paper.name, "tables", where, text, numbers=numbers)


def _tables_of(totals: Iterable[Total]) -> list[list[Total]]:
    """Totals grouped by the table and method they stand for."""
    groups: dict[tuple[object, ...], list[Total]] = {}
    for total in totals:
        groups.setdefault((total.table, total.joint, total.limits), []).append(total)
    return list(groups.values())
