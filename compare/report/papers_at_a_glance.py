"""The papers at a glance: what each published, what is left of it, and what was wrong with it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from compare.audit.findings import IN_SHORT
from compare.benchmark.known_times import KnownTime
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import BoundProof
from compare.benchmark.summaries import bound_of

CANNOT_BE_JUDGED = "cannot be judged"


@dataclass(frozen=True)
class PaperAtAGlance:
    """One paper, or one reading of it.

    Attributes
    ----------
    key, case : str
        The paper; the case that this reading of it is.
    published : float or None [s]
        The shortest total time that it prints for the whole arm, by the method ``by``.
    keeps : str
        Whether this motion keeps its limits, in words.
    stretch : float or None
        Least factor on its durations that keeps the limits, where it breaks them.
    slowed : float or None [s]
        Its total time once it keeps the limits.
    leaves_position_limits : bool
        Whether it leaves the position limits, at any speed; then ``slowed`` is None.
    optimum : float or None [s]
        Of its spline family; ``proved`` says whether it is certified.
    fastest : float or None [s]
        The fastest motion known.
    faults : tuple of (kind, count, proved)
        Kinds of fault that were found, how often, and whether one of them is proved.
    """

    key: str
    case: str
    title: str
    published: float | None
    by: str
    keeps: str
    stretch: float | None
    slowed: float | None
    leaves_position_limits: bool
    optimum: float | None
    proved: bool
    fastest: float | None
    faults: tuple[tuple[str, int, bool], ...]


def papers_at_a_glance(
    audits: Mapping[str, Mapping[str, Any]],
    known_times: Mapping[str, Sequence[KnownTime]],
    ladders: Mapping[str, LadderRecord],
) -> list[PaperAtAGlance]:
    """Return one line per audited paper and reading of it, in the order of their titles.

    Parameters
    ----------
    audits : mapping of str to mapping
        By paper, as the store gives them.
    known_times : mapping of str to sequence of KnownTime
        By case.
    ladders : mapping of str to LadderRecord
        By case.

    Returns
    -------
    list of PaperAtAGlance
    """
    found = [
        _line(key, data, known_times.get(data["paper"], ()), ladders.get(data["paper"]))
        for key, stored in audits.items()
        for data in stored["audits"]
    ]
    return sorted(found, key=lambda paper: (paper.title, paper.case))


def _line(
    key: str,
    data: Mapping[str, Any],
    lines: Sequence[KnownTime],
    ladder: LadderRecord | None,
) -> PaperAtAGlance:
    totals = [line for line in lines if line.key == "published" and line.seconds is not None]
    # a paper proposes the method with its shortest total
    best = min(totals, key=lambda line: line.seconds or 0.0, default=None)
    by = "" if best is None else best.by
    slowed = next((line for line in lines if (line.key, line.by) == ("feasible", by)), None)
    breaks = best is not None and best.keeps is False
    # the paper's own waypoints are not known where nothing could be slowed down: nothing to compare
    rungs = {} if ladder is None or slowed is None else ladder["ladder"]
    optimum, fastest = rungs.get("family"), rungs.get("free_form")
    return PaperAtAGlance(
        key=key,
        case=data["paper"],
        title=data["title"],
        published=None if best is None else best.seconds,
        by=by,
        keeps=_keeps(data, by, best),
        stretch=best.stretch if best is not None and breaks else None,
        slowed=None if slowed is None else slowed.seconds,
        leaves_position_limits=slowed is not None and slowed.seconds is None,
        optimum=None if optimum is None else optimum["seconds"],
        proved=ladder is not None and bound_of(ladder)[1] is BoundProof.certified,
        fastest=None if fastest is None else fastest["seconds"],
        faults=_faults(data["findings"]),
    )


def _keeps(data: Mapping[str, Any], by: str, best: KnownTime | None) -> str:
    """Whether the published motion keeps its limits, in words."""
    if best is None or best.keeps is None:
        return CANNOT_BE_JUDGED
    whole = (m["feasible"] for m in data["motions"] if m["joint"] is None and m["by"] == by)
    word = next(whole, CANNOT_BE_JUDGED)
    if word == "no limits":
        return "prints none; " + ("keeps" if best.keeps else "breaks") + " those assumed"
    return "as far as its digits tell" if word == "within rounding" else str(word)


def _faults(findings: Iterable[Mapping[str, Any]]) -> tuple[tuple[str, int, bool], ...]:
    wrong = [f for f in findings if f["fault"]]
    kinds = {kind: [f for f in wrong if f["kind"] == kind] for kind in IN_SHORT}
    return tuple(
        (IN_SHORT[kind], len(found), any(f["proved"] for f in found))
        for kind, found in kinds.items()
        if found
    )
