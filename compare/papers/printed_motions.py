"""Printed time vectors as motions: what the independent check says, and what the rounding leaves open."""

from __future__ import annotations

from typing import Any

from compare.audit.motions import Motion
from compare.audit.paper import Paper, Row
from formulations import Verdict
from formulations.motion.verdict import QUANTITIES


def printed(paper: Paper, row: Row) -> dict[str, Any]:
    """A printed row under its stated limits: plain JSON.

    keeps: yes, no, or that the digits leave it open; most: the limit used most, in words.
    """
    motion = Motion.of(paper, row)
    keeps = "no" if motion.breaks else "yes" if motion.keeps else "within rounding"
    return {
        "where": row.where,
        "times": [str(time) for time in row.times],
        "total": None if row.total is None else str(row.total),
        "seconds": motion.total,
        "keeps": keeps,
        "stretch": motion.verdict.stretch,
        "most": used_most(motion.verdict),
    }


def used_most(verdict: Verdict) -> str:
    """Which derivative limit a motion uses most, and how much of it."""
    peaks = [peak for peak in verdict.peaks if peak.quantity != QUANTITIES[0]]
    if not peaks:
        return "nothing limited"
    peak = max(peaks, key=lambda p: p.stretch)
    return f"{peak.quantity} of joint {peak.joint + 1}, {100 * peak.factor:.1f} % of its limit"
