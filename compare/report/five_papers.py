"""The papers at a glance: what each published, what is left of it, what was wrong; from the store alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from compare.audit.findings import IN_SHORT
from compare.benchmark.statistics import bound_of


@dataclass(frozen=True)
class PaperRow:
    """One paper, or one reading of it. Times in s; None where there is none.

    key: of the paper, case: of the reading. published: the shortest total it prints for the whole arm,
    by: whose. keeps: its limits, in words. stretch: the least factor on its durations that keeps them,
    above 1 only; honest: the total after it; leaves: there is none, as its shape leaves the position
    limits at any speed. optimum: of its spline family, proved or not; fastest: of all motions known.
    faults: the kinds found, each with how often and whether one of them is proved.
    """

    key: str
    case: str
    title: str
    published: float | None
    by: str
    keeps: str
    stretch: float | None
    honest: float | None
    leaves: bool
    optimum: float | None
    proved: bool
    fastest: float | None
    faults: tuple[tuple[str, int, bool], ...]


def five_papers(
    audits: Mapping[str, Mapping[str, Any]],
    honest: Mapping[str, Iterable[Mapping[str, Any]]],
    ladders: Mapping[str, dict[str, Any]],
) -> list[PaperRow]:
    """A row per audited paper and variant, in the order of the papers' numbers (their titles).

    audits, honest, ladders: as the store gives them.
    """
    found = [
        _row(key, data, list(honest.get(data["paper"], ())), ladders.get(data["paper"]))
        for key, stored in audits.items()
        for data in stored["audits"]
    ]
    return sorted(found, key=lambda row: (row.title, row.case))


def _row(
    key: str,
    data: Mapping[str, Any],
    lines: list[Mapping[str, Any]],
    ladder: dict[str, Any] | None,
) -> PaperRow:
    totals = [line for line in lines if line["key"] == "published"]
    # a paper proposes the method with its shortest total
    best = min(totals, key=lambda line: line["seconds"], default=None)
    by = "" if best is None else best["by"]
    mended = next((line for line in lines if (line["key"], line["by"]) == ("feasible", by)), None)
    # through other waypoints than the paper's there is nothing to compare
    rungs = {} if ladder is None or mended is None else ladder["ladder"]
    stretch = None if best is None else best["stretch"]
    return PaperRow(
        key=key,
        case=data["paper"],
        title=data["title"],
        published=None if best is None else best["seconds"],
        by=by,
        keeps=_keeps(data, by, best),
        stretch=stretch if best is not None and best["keeps"] is False else None,
        honest=None if mended is None else mended["seconds"],
        leaves=mended is not None and mended["seconds"] is None,
        optimum=rungs.get("family", {}).get("seconds"),
        proved=ladder is not None and bound_of(ladder)[1] == "certified",
        fastest=rungs.get("free_form", {}).get("seconds"),
        faults=_faults(data["findings"]),
    )


def _keeps(data: Mapping[str, Any], by: str, best: Mapping[str, Any] | None) -> str:
    """Whether the published motion keeps its limits, in words."""
    if best is None or best["keeps"] is None:
        return "cannot be judged"
    whole = (m["feasible"] for m in data["motions"] if m["joint"] is None and m["by"] == by)
    word = next(whole, "cannot be judged")
    if word == "no limits":
        return "prints none; " + ("keeps" if best["keeps"] else "breaks") + " those assumed"
    return "as far as its digits tell" if word == "within rounding" else str(word)


def _faults(findings: Iterable[Mapping[str, Any]]) -> tuple[tuple[str, int, bool], ...]:
    wrong = [f for f in findings if f["fault"]]
    kinds = {kind: [f for f in wrong if f["kind"] == kind] for kind in IN_SHORT}
    return tuple(
        (IN_SHORT[kind], len(found), any(f["proved"] for f in found))
        for kind, found in kinds.items()
        if found
    )
