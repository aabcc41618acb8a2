"""What a paper should have found: its own result beside everything that is known of its task.

One table per case, from stored data alone: published; the same, slowed down until it keeps the
limits; the paper's swarm with the exact stretch; a full stop at each waypoint; the best of the spline
family and of all motions, each with its certified bound.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.paper import PAPERS, Paper, PrintedTimes, load_papers
from formulations import Problem
from formulations.motion.trajectory import TOLERANCE

# the swarm that each paper proposes, resolved
SWARMS: dict[str, str] = {
    "sr4c": "mipso",
    "bagging": "mpso",
    "ur5": "issa",
    "ur5-corrected": "issa",
    "cobot": "pso-004",
    "z1": "whale-003",
}
RUNGS: dict[str, str] = {
    "ruckig_stop_and_go": "Ruckig, full stop at each waypoint",
    "family": "the spline family's optimum",
    "family_lower": "no spline of the family is faster",
    "free_form": "the fastest motion known",
    "free_form_lower": "no motion at all is faster",
}


@dataclass(frozen=True)
class Line:
    """One line of the table. seconds: None where there is none; then note says why.

    keeps: the limits, as far as the printed digits tell; None for bounds and for what cannot be judged.
    key: published, feasible, swarm, or a rung of the ladder. by: whose, if published. stretch: least
    factor on all durations that keeps the limits.
    """

    what: str
    seconds: float | None
    keeps: bool | None
    note: str = ""
    key: str = ""
    by: str = ""
    stretch: float | None = None


def honest_table(
    problem: Problem, ladder: Mapping[str, Any], rows: Iterable[dict[str, Any]]
) -> list[Line]:
    """The table of one case. ladder: its stored ladder; rows: those of the store, any cases."""
    lines = []
    paper = paper_of(problem.name)
    if paper is not None:
        lines += _published(paper, problem)
    lines.append(_swarm(problem.name, rows))
    rungs = ladder["ladder"]
    for key, what in RUNGS.items():
        rung = rungs.get(key)
        if rung is None:
            continue
        keeps = None if rung["kind"] == "lower" or rung["seconds"] is None else True
        note = rung["note"] if rung["seconds"] is None else ""
        lines.append(Line(what, rung["seconds"], keeps, note, key))
    return lines


def paper_of(case: str) -> Paper | None:
    """The paper, or the reading of one, that a case comes from."""
    key = key_of_paper(case)
    return next((p for p in load_papers(key) if p.name == case), None) if key else None


def key_of_paper(case: str) -> str | None:
    """Name of the shipped paper that a case or a variant of it comes from."""
    for name in PAPERS:
        if any(paper.name == case for paper in load_papers(name)):
            return name
    return None


def _published(paper: Paper, problem: Problem) -> list[Line]:
    """Totals of the whole arm as published, and what is left of them under the case's limits."""
    wholes = [row for row in paper.rows if row.joint is None]
    if not wholes:
        return [
            Line(
                f"published ({t.by})", t.value.value, None,
                "through waypoints that are not printed; all below is through other ones",
                "published", t.by,
            )
            for t in paper.totals
            if t.joint is None
        ]  # fmt: skip
    return [line for row in wholes for line in _whole(paper, row, problem)]


def _whole(paper: Paper, row: PrintedTimes, problem: Problem) -> list[Line]:
    motion = PrintedMotion(paper, row, problem)
    verdict = motion.verdict
    total, note = motion.total, ""
    if row.total is not None and not row.total.low <= total <= row.total.high:
        note = f"its times add up to {total:.4f} s; they are judged"
    claimed = total if row.total is None else row.total.value
    keeps, what = motion.stretch[0] <= 1.0 + TOLERANCE, f"the same ({row.by}), made feasible"
    lines = [Line(f"published ({row.by})", claimed, keeps, note, "published", row.by, verdict.stretch)]
    slower = "" if row.limits else "the paper prints no limits: under those assumed for this case"
    kept = [fault for fault in verdict.faults if "position of joint" in fault]
    if kept:  # a shape that leaves the position limits leaves them at any speed
        return [*lines, Line(what, None, None, kept[0], "feasible", row.by)]
    seconds = total * max(verdict.stretch, 1.0)
    return [*lines, Line(what, seconds, True, slower, "feasible", row.by)]


def _swarm(case: str, rows: Iterable[dict[str, Any]]) -> Line:
    """The paper's swarm on all durations at once, every candidate stretched to feasibility."""
    swarm = SWARMS.get(case, "")
    mine = [
        row["seconds"]
        for row in rows
        if (row["case"], row["coding"], row["swarm"]) == (case, "stretched", swarm)
    ]
    verified = [seconds for seconds in mine if seconds is not None]
    what = f"its swarm ({swarm or 'none'}) with the exact stretch"
    if not verified:
        return Line(what, None, None, "not run" if not mine else "no verified motion", "swarm")
    return Line(what, float(np.median(verified)), True, f"median of {len(mine)} seeds", "swarm")
