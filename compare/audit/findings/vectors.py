"""What is wrong with one printed time vector, taken by itself.

A fault is reported only if it holds for every reading of the printed digits: of the times, of the
waypoints and of the limits.
"""

from __future__ import annotations

import numpy as np

from compare.audit.findings import Finding
from compare.audit.findings.other_limits import fits_other_limits
from compare.audit.motion.minima import crossing_times
from compare.audit.motion.printed_motion import ROOTS, PrintedMotion, joint_of, limits_told
from compare.audit.paper.digits import halves, values
from compare.audit.paper.words import amount, number, percent
from formulations.motion.verdict import QUANTITIES, TOLERANCE
from formulations.problem.arrays import Array


def motion_findings(motion: PrintedMotion) -> list[Finding]:
    """Judge one time vector.

    Parameters
    ----------
    motion : PrintedMotion
        The motion to judge.

    Returns
    -------
    list of Finding
        Its faults, or one note if there are none.
    """
    return motion_faults(motion) or [_kept(motion) if motion.stated else _slow(motion)]


def motion_faults(motion: PrintedMotion) -> list[Finding]:
    """Find what is wrong with one time vector.

    Parameters
    ----------
    motion : PrintedMotion
        The motion to judge.

    Returns
    -------
    list of Finding
        Empty if the paper states no limits for it.
    """
    row = motion.row
    if not motion.stated:
        return []
    found = position_faults(motion)
    crossing = crossing_times(motion.loosest, motion.halves)
    allowed = values(row.times) + halves(row.times)
    if (crossing > allowed[:, None]).any():
        found.append(_displacement(motion, crossing, allowed))
    if motion.impossible:
        found.append(_minimum(motion))
    if motion.breaks:
        found.append(_limits(motion))
    elif other := fits_other_limits(motion):
        found.append(other)
    return found


def position_faults(motion: PrintedMotion) -> list[Finding]:
    """Find position limits that every reading of the digits breaks.

    Parameters
    ----------
    motion : PrintedMotion
        The motion to judge.

    Returns
    -------
    list of Finding
    """
    paper, problem, found = motion.paper, motion.problem, []
    bounds = motion.loosest.limits.position
    low = np.minimum(bounds[:, 0], (problem.waypoints - motion.halves).min(axis=0))
    high = np.maximum(bounds[:, 1], (problem.waypoints + motion.halves).max(axis=0))
    for j, peak in enumerate(motion.peaks):
        for value, limit, over in (
            (peak.range_low[1], low[j], low[j] - peak.range_low[1]),
            (peak.range_high[0], high[j], peak.range_high[0] - high[j]),
        ):
            if over > problem.position_slack:
                text = (
                    f"joint {joint_of(motion, j)} goes to {amount(paper, float(value), 0)} or beyond, "
                    f"limit {amount(paper, float(limit), 0)}; slowing down does not mend that"
                )
                found.append(Finding(paper.name, "limits", motion.row.where, text))
    return found


def _slow(motion: PrintedMotion) -> Finding:
    """Compare a motion without stated limits with the optimum under the limits that it reaches itself."""
    bound = motion.implied_optimum
    text = (
        f"{motion.total:.4f} s is {number(motion.total / bound.upper)} times the best time under the limits "
        f"that the motion itself needs ({bound.upper:.4f} s for {limits_told(motion, motion.implied)})"
    )
    return Finding(motion.paper.name, "slow", motion.row.where, text)


def _displacement(motion: PrintedMotion, crossing: Array, allowed: Array) -> Finding:
    paper, limits = motion.paper, motion.problem.limits
    k, j = np.unravel_index(int((crossing / allowed[:, None]).argmax()), crossing.shape)
    limit = float(limits.velocity[j])
    mean = float(crossing[k, j] * limit / allowed[k])
    text = (
        f"segment {k + 1} takes joint {joint_of(motion, int(j))} over "
        f"{number(abs(motion.problem.displacements[k, j]) / paper.angle)} {paper.unit} in "
        f"{motion.row.times[k]} s: {amount(paper, mean, 1)} on average, limit "
        f"{amount(paper, limit, 1)}; displacement alone needs {crossing[k, j]:.4g} s"
    )
    numbers = {"mean": mean, "limit": limit, "factor": mean / limit}
    return Finding(paper.name, "displacement", motion.row.where, text, numbers=numbers)


def _minimum(motion: PrintedMotion) -> Finding:
    bound = motion.optimum
    assert bound is not None
    gap = motion.total / bound.seconds - 1.0
    text = (
        f"{motion.total:.4f} s is {percent(-gap)} below the certified minimum of {bound.seconds:.4f} "
        f"s: no durations of this spline keep the limits of {motion.row.limits} in that time"
    )
    numbers = {"seconds": motion.total, "minimum": bound.seconds, "gap": gap}
    return Finding(motion.paper.name, "minimum", motion.row.where, text, numbers=numbers)


def _limits(motion: PrintedMotion) -> Finding:
    paper, problem = motion.paper, motion.problem
    # the peak that needs the largest stretch
    need = (motion.least / motion.loosest.limits.derivatives) ** ROOTS
    order, j = (int(i) for i in np.unravel_index(int(need.argmax()), need.shape))
    value, least = float(motion.peaks[j].printed[order]), float(motion.least[order, j])
    limit = float(problem.limits.derivatives[order, j])
    k = order + 1
    text = (
        f"{QUANTITIES[k]} of joint {joint_of(motion, j)} reaches {amount(paper, value, k)} (at least "
        f"{amount(paper, least, k)} for every reading of the digits), {number(value / limit)} times "
        f"the limit of {amount(paper, limit, k)}; slowed down until every limit is kept, "
        f"{motion.total:.4f} s become {motion.honest:.4f} s"
    )
    numbers = {
        "value": value,
        "least": least,
        "limit": limit,
        "stretch": motion.verdict.stretch,
        "honest": motion.honest,
    }
    return Finding(paper.name, "limits", motion.row.where, text, numbers=numbers)


def _kept(motion: PrintedMotion) -> Finding:
    bound = motion.optimum
    assert bound is not None
    gap = motion.total / bound.upper - 1.0 if bound.upper > 0.0 else 0.0
    above = f"{percent(gap)} above the optimum" if gap > 0.0 else "at the optimum"
    kind = "keeps" if motion.verdict.stretch <= 1.0 + TOLERANCE else "rounding"
    word = "keeps" if kind == "keeps" else "keeps, within rounding,"
    text = f"{motion.total:.4f} s {word} the limits of {motion.row.limits}; {above}"
    return Finding(motion.paper.name, kind, motion.row.where, text)
