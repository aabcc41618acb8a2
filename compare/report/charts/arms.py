"""Every arm on one axis: what is published, what is left of it, the best spline, the fastest motion."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row
from compare.benchmark.summaries import best_row
from compare.report.papers_at_a_glance import CANNOT_BE_JUDGED, PaperAtAGlance

_KEPT = ("yes", "as far as its digits tell")


def arms_chart(
    cases: Iterable[str],
    ladders: Mapping[str, LadderRecord],
    rows: Iterable[Row],
    papers: Iterable[PaperAtAGlance],
    best: Mapping[str, float | None],
) -> dict[str, Any]:
    """Return a line per case, in units of the best motion of its family.

    Parameters
    ----------
    cases : iterable of str
    ladders : mapping of str to LadderRecord
    rows : iterable of Row
    papers : iterable of PaperAtAGlance
    best : mapping of str to float or None [s]
        The best motion of the family that is known, by case; cases without one are left out.

    Returns
    -------
    dict
        ``lines``: ``case``, ``best`` [s], ``barrier`` [1], and ``marks`` with kind, words and ``ratio`` [1].
    """
    printed = {paper.case: paper for paper in papers}
    every = list(rows)
    lines, said = [], []
    for case in cases:
        unit = best[case]
        if unit is None:
            continue
        rungs = ladders[case]["ladder"]
        marks = [_mark("family", "best of its family", unit, unit)]
        fastest = rungs["free_form"]["seconds"]
        if fastest is not None:
            marks.append(_mark("fastest", "fastest motion known", fastest, unit))
        paper = printed.get(case)
        # what cannot be judged was published for waypoints that are not printed: another task
        if paper is not None and paper.published is not None and paper.keeps != CANNOT_BE_JUDGED:
            broken = paper.stretch is not None or paper.leaves_position_limits
            kind = "broken" if broken else "kept" if paper.keeps in _KEPT else "unjudged"
            words = (
                "published, breaks limits" if broken else f"published; keeps its limits: {paper.keeps}"
            )
            marks.append(_mark(kind, words, paper.published, unit))
            said.append(f"{case}: published {paper.published / unit:.2f} times the best of its family")
            if paper.slowed is not None and paper.stretch:
                marks.append(_mark("slowed", "the same, slowed down to keep them", paper.slowed, unit))
        swarm = best_row(row for row in every if row.case == case)
        if swarm is not None and swarm.seconds is not None:
            marks.append(_mark("swarm", f"best swarm ({swarm.swarm})", swarm.seconds, unit))
        barrier = rungs["free_form_lower"]["seconds"]
        lines.append(
            {
                "case": case,
                "best": unit,
                "barrier": None if barrier is None else barrier / unit,
                "marks": marks,
            }
        )
    return {"lines": lines, "alt": f"{'; '.join(said) or 'No paper was audited'}."}


def _mark(kind: str, words: str, seconds: float, unit: float) -> dict[str, Any]:
    return {"kind": kind, "words": words, "seconds": seconds, "ratio": seconds / unit}
