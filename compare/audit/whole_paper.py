"""The audit of one paper: every time vector as a motion, every finding, as plain data."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from compare.audit.findings import FAULTS, NOTES, Finding
from compare.audit.findings.claims import claims_of
from compare.audit.findings.other_limits import table_findings, total_findings
from compare.audit.findings.points import points_of
from compare.audit.findings.together import ranking_findings, rule_findings
from compare.audit.findings.unplaced import unplaced_findings
from compare.audit.findings.vectors import motion_findings
from compare.audit.findings.waypoints import waypoints_beyond
from compare.audit.hints import QUESTIONS, Hint, hints_of
from compare.audit.judged import JudgedTimes
from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.motion.ranged import Undecided
from compare.audit.paper import Paper


@dataclass(frozen=True)
class Audit:
    """The motions of a paper, all findings about it, and changes that would explain some of them."""

    paper: Paper
    motions: tuple[PrintedMotion, ...]
    findings: tuple[Finding, ...]
    hints: tuple[Hint, ...] = ()

    @property
    def faults(self) -> list[Finding]:
        """What is wrong, in the order of FAULTS."""
        kinds = list(FAULTS)
        return sorted((f for f in self.findings if f.fault), key=lambda f: kinds.index(f.kind))

    @property
    def notes(self) -> list[Finding]:
        """What is not wrong."""
        return [f for f in self.findings if not f.fault]

    def rows(self) -> list[JudgedTimes]:
        """One record per time vector."""
        return [_judged(motion) for motion in self.motions]

    def to_json(self) -> dict[str, Any]:
        """Everything as strict JSON."""
        return {
            "paper": self.paper.name,
            "title": self.paper.title,
            "source": self.paper.source,
            "notes": self.paper.notes,
            "unit": self.paper.unit,
            "motions": [asdict(row) for row in self.rows()],
            "findings": [
                {
                    "kind": f.kind,
                    "meaning": (FAULTS | NOTES)[f.kind],
                    "fault": f.fault,
                    "proved": f.proved,
                    "where": f.where,
                    "text": f.text,
                    "numbers": f.numbers,
                }
                for f in [*self.faults, *self.notes]
            ],
            "hints": [{"question": QUESTIONS[h.kind], "text": h.text, **asdict(h)} for h in self.hints],
        }


def audit(paper: Paper, progress: Callable[[str], None] | None = None) -> Audit:
    """Judge every number of a paper.

    Parameters
    ----------
    paper : Paper
        What the paper prints.
    progress : callable, optional
        Called with a few words as the audit goes on.

    Returns
    -------
    Audit
    """
    findings = [*claims_of(paper), *points_of(paper), *waypoints_beyond(paper)]
    motions: list[PrintedMotion] = []
    if paper.waypoints is None:
        findings += unplaced_findings(paper)
    for row in paper.rows:
        if progress is not None:
            progress(row.where)
        try:
            motion = PrintedMotion.of(paper, row)
            findings += motion_findings(motion)
        except Undecided as reason:
            findings.append(Finding(paper.name, "missing", row.where, f"too few digits: {reason}"))
            continue
        motions.append(motion)
        if row.of:
            findings += rule_findings(motion, motions)
    if progress is not None:
        progress("totals")
    if any(not motion.stated for motion in motions):
        findings.append(_no_limits(motions))
    findings += total_findings(paper, paper.totals)
    findings += table_findings(motions, paper.totals)
    findings += ranking_findings(motions)
    if progress is not None:
        progress("hints")
    return Audit(paper, tuple(motions), tuple(findings), tuple(hints_of(paper, findings)))


def _no_limits(motions: Sequence[PrintedMotion]) -> Finding:
    paper = motions[0].paper
    peaks = ", ".join(
        f"{m.row.joint + 1}: {m.peaks[0].printed[0] / paper.angle:.4g}"
        for m in motions
        if m.row.joint is not None
    )
    text = f"no limits are printed; each at its own times, the joints reach [{paper.unit}/s] {peaks}"
    return Finding(paper.name, "missing", "limits", text)


def _judged(motion: PrintedMotion) -> JudgedTimes:
    """The numbers of one time vector."""
    paper, row = motion.paper, motion.row
    optimum, implied = motion.optimum, motion.implied_optimum
    low, printed, high = motion.stretch if motion.stated else (None, None, None)
    velocity, acceleration, jerk = (
        _shown([p.printed[order] / paper.angle for p in motion.peaks]) for order in range(3)
    )
    return JudgedTimes(
        where=row.where,
        by=row.by,
        joint=None if row.joint is None else row.joint + 1,
        times=[t.text for t in row.times],
        total=motion.total,
        printed_total=None if row.total is None else row.total.text,
        limits=row.limits,
        feasible=motion.kept.value,
        velocity=velocity,
        acceleration=acceleration,
        jerk=jerk,
        stretch=printed,
        stretch_low=low,
        stretch_high=high,
        honest=motion.honest if motion.stated else None,
        minimum=None if optimum is None else optimum.seconds,
        optimum=None if optimum is None else optimum.upper,
        implied=[_shown(line / paper.angle) for line in motion.implied],
        implied_minimum=implied.seconds,
        implied_optimum=implied.upper,
        implied_gap=motion.implied_gap if math.isfinite(motion.implied_gap) else None,
        displacement=_displacement(motion),
    )


def _displacement(motion: PrintedMotion) -> float:
    """Least time by displacement over velocity limit, stated or implied [s]."""
    limits = motion.problem.limits.velocity if motion.stated else motion.implied[0]
    return float((np.abs(motion.problem.displacements) / limits).max(axis=1).sum())


def _shown(numbers: Any) -> list[float | None]:
    return [float(v) if math.isfinite(v) else None for v in numbers]
