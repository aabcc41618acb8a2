"""What is known of the task of a case: its paper's own result beside every time that can be proved.

One table per case, from stored data alone: the published motion; the same motion, slowed down until it
keeps its limits; the paper's swarm with the exact stretch; a full stop at each waypoint; the best of
the spline family and of all motions, each with its certified bound.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.paper import PAPERS, Paper, PrintedTimes, load_papers
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.pooled import pooled
from compare.benchmark.records.rows import Row
from compare.benchmark.summaries import median, times_of
from formulations import Problem
from formulations.motion.verdict import TOLERANCE

# the swarm that each paper proposes, in the reading that can be meant
SWARMS: dict[str, str] = {
    "sr4c": "mipso",
    "bagging": "mpso",
    "ur5": "issa",
    "ur5-corrected": "issa",
    "cobot": "pso-zhang-2025",
    "z1": "whale-lu-2024",
}
SHOWN_RUNGS: dict[str, str] = {
    "ruckig_stop_and_go": "Ruckig, full stop at each waypoint",
    "family": "the spline family's optimum",
    "family_lower": "no spline of the family is faster",
    "free_form": "the fastest motion known",
    "free_form_lower": "no motion at all is faster",
}


@dataclass(frozen=True, slots=True)
class KnownTime:
    """One line of the table.

    Attributes
    ----------
    what : str
        What takes this time, in words.
    seconds : float or None [s]
        None where there is none; then ``note`` says why.
    keeps : bool or None
        Whether the motion keeps its limits, as far as the printed digits tell; None for bounds and for
        what cannot be judged.
    key : str
        ``published``, ``feasible``, ``swarm``, or a rung of the ladder.
    by : str
        The method of a published motion.
    stretch : float or None
        Least factor on the durations of a published motion that keeps the limits.
    """

    what: str
    seconds: float | None
    keeps: bool | None
    note: str = ""
    key: str = ""
    by: str = ""
    stretch: float | None = None


def table_of_known_times(
    problem: Problem, ladder: LadderRecord, rows: Iterable[Row], *, allow: Collection[str] = ()
) -> list[KnownTime]:
    """Return the table of one case.

    Parameters
    ----------
    problem : Problem
        The problem of the case.
    ladder : LadderRecord
        Its stored bounds.
    rows : iterable of Row
        Rows of any cases; those of this one count.
    allow : collection of str
        Columns in which the rows of one cell may differ, as `records.pooled.pooled` takes them.

    Returns
    -------
    list of KnownTime
        Without published times if no paper belongs to the problem.
    """
    lines = []
    paper = paper_of_case(problem.name)
    if paper is not None:
        lines += _published(paper, problem)
    lines.append(_swarm(problem.name, rows, allow))
    for key, what in SHOWN_RUNGS.items():
        rung = ladder["ladder"].get(key)
        if rung is None:
            continue
        keeps = None if rung["kind"] == "lower" or rung["seconds"] is None else True
        note = rung["note"] if rung["seconds"] is None else ""
        lines.append(KnownTime(what, rung["seconds"], keeps, note, key))
    return lines


def paper_of_case(case: str) -> Paper | None:
    """Return the paper, or the reading of one, that a case comes from.

    Parameters
    ----------
    case : str

    Returns
    -------
    Paper or None
        None if no shipped paper has this case.
    """
    key = key_of_paper(case)
    return next((p for p in load_papers(key) if p.name == case), None) if key else None


def key_of_paper(case: str) -> str | None:
    """Return the name of the shipped paper that a case, or a variant of it, comes from.

    Parameters
    ----------
    case : str

    Returns
    -------
    str or None
        None if no shipped paper has this case.
    """
    for name in PAPERS:
        if any(paper.name == case for paper in load_papers(name)):
            return name
    return None


def _published(paper: Paper, problem: Problem) -> list[KnownTime]:
    """Totals of the whole arm as published, and what is left of them under the case's limits."""
    wholes = [row for row in paper.rows if row.joint is None]
    if not wholes:
        return [
            KnownTime(
                f"published ({t.by})", t.value.value, None,
                "its waypoints are not printed; all times below are for other waypoints",
                "published", t.by,
            )
            for t in paper.totals
            if t.joint is None
        ]  # fmt: skip
    return [line for row in wholes for line in _whole(paper, row, problem)]


def _whole(paper: Paper, row: PrintedTimes, problem: Problem) -> list[KnownTime]:
    """A published motion of the whole arm, and the same motion slowed down."""
    motion = PrintedMotion(paper, row, problem)
    verdict = motion.verdict
    total, note = motion.total, ""
    if row.total is not None and not row.total.low <= total <= row.total.high:
        note = f"its times add up to {total:.4f} s; the motion with these times is judged"
    claimed = total if row.total is None else row.total.value
    keeps, what = motion.stretch[0] <= 1.0 + TOLERANCE, f"the same ({row.by}), made feasible"
    published = KnownTime(
        f"published ({row.by})", claimed, keeps, note, "published", row.by, verdict.stretch
    )
    left = [p for p in verdict.peaks if p.quantity == "position" and p.factor > 1.0 + TOLERANCE]
    if left:  # the shape of a motion, and so its range, is the same at every speed
        reason = f"over the limit: {left[0]}"
        return [published, KnownTime(what, None, None, reason, "feasible", row.by)]
    assumed = "" if row.limits else "the paper prints no limits; those assumed for this case are kept"
    seconds = total * max(verdict.stretch, 1.0)
    return [published, KnownTime(what, seconds, True, assumed, "feasible", row.by)]


def _swarm(case: str, rows: Iterable[Row], allow: Collection[str]) -> KnownTime:
    """The paper's swarm on all durations at once, every candidate stretched to feasibility."""
    swarm = SWARMS.get(case, "")
    wanted = (case, "stretched", swarm)
    mine = pooled((r for r in rows if (r.case, r.variant, r.swarm) == wanted), allow=allow)
    what = f"its swarm ({swarm or 'none'}) with the exact stretch"
    seconds = median(times_of(mine))
    if seconds is None:
        return KnownTime(what, None, None, "not run" if not mine else "no verified motion", "swarm")
    return KnownTime(what, seconds, True, f"median of {len(mine)} seeds", "swarm")
