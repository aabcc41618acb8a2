"""Joints together and methods side by side: the rule of the longest times, and the order of the totals."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from compare.audit.findings import Finding
from compare.audit.findings.other_limits import in_force
from compare.audit.motion.printed_motion import ROOTS, PrintedMotion
from compare.audit.paper.words import amount, number
from formulations.motion.verdict import QUANTITIES, TOLERANCE


def rule_findings(motion: PrintedMotion, rows: Sequence[PrintedMotion]) -> list[Finding]:
    """Check whether the longest time per segment keeps the limits that each joint alone keeps.

    Parameters
    ----------
    motion : PrintedMotion
        The motion with the longest times, of all joints.
    rows : sequence of PrintedMotion
        The motions of the single joints are among them.

    Returns
    -------
    list of Finding
        At most one.
    """
    paper, limits = motion.paper, np.full((3, motion.problem.dof), np.inf)
    shown = limits.copy()  # the same at the printed digits
    alone = {m.row.joint: m for m in rows if m.row in motion.row.of}
    for joint, one in alone.items():
        assert joint is not None
        if one.breaks:
            return []  # then there is nothing to keep
        other = in_force(one) if one.stated else one.rounded
        limits[:, joint] = (one.loosest.limits.derivatives if other is None else other)[:, 0]
        shown[:, joint] = np.minimum(limits[:, joint], one.problem.limits.derivatives[:, 0])
    need = (motion.least / limits) ** ROOTS
    if not need.max() > 1.0 + TOLERANCE:
        return []
    order, j = (int(i) for i in np.unravel_index(int(need.argmax()), need.shape))
    k, value, limit = order + 1, float(motion.peaks[j].printed[order]), float(shown[order, j])
    printed = np.stack([p.printed for p in motion.peaks], axis=1)
    stretch = float(((printed / shown) ** ROOTS).max())
    several = ", ".join(str(i + 1) for i in np.flatnonzero(need.max(axis=0) > 1.0 + TOLERANCE))
    text = (
        f"each joint alone keeps its limits; with the longest time per segment {QUANTITIES[k]} of "
        f"joint {j + 1} reaches {amount(paper, value, k)}, {number(value / limit)} times the "
        f"{amount(paper, limit, k)} of {alone[j].row.where} (joints beyond theirs: {several}); slowed "
        f"down until all are kept, {motion.total:.4f} s become {motion.total * stretch:.4f} s"
    )
    numbers = {"value": value, "limit": limit, "stretch": stretch}
    return [Finding(paper.name, "rule", motion.row.where, text, numbers=numbers)]


def ranking_findings(motions: Sequence[PrintedMotion]) -> list[Finding]:
    """Compare the order of the methods by published totals with the order by totals that keep the limits.

    Parameters
    ----------
    motions : sequence of PrintedMotion
        The paper's time vectors as motions.

    Returns
    -------
    list of Finding
        One per set of limits under which two methods change places for every reading of the digits.
    """
    wholes = [m for m in motions if m.row.of and m.stated]
    found = []
    for limits in dict.fromkeys(m.row.limits for m in wholes):
        group = sorted((m for m in wholes if m.row.limits == limits), key=lambda m: m.total)
        if not any(m.breaks for m in group):
            continue
        swapped = any(
            a.seconds[1] < b.seconds[0]
            and a.seconds[0] * max(a.stretch[0], 1.0) > b.seconds[1] * max(b.stretch[2], 1.0)
            for i, a in enumerate(group)
            for b in group[i + 1 :]
        )
        if swapped:
            before = ", ".join(f"{m.row.by} {m.total:.4g} s" for m in group)
            after = ", ".join(
                f"{m.row.by} {m.honest:.4g} s" for m in sorted(group, key=lambda m: m.honest)
            )
            text = (
                f"published: {before}; slowed down until speed, acceleration and jerk keep {limits}: "
                f"{after}"
            )
            found.append(Finding(motions[0].paper.name, "ranking", str(limits), text))
    return found
