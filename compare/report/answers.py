"""The report's answers, computed from its rows: they stand before everything else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import floor

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row
from compare.benchmark.summaries import Summary, as_papers_run, best_claim, best_row
from compare.report.overview import AT_OPTIMUM
from compare.report.papers_at_a_glance import CANNOT_BE_JUDGED, PaperAtAGlance
from compare.report.words import percent
from compare.studies.zones import ZoneSaving


@dataclass(frozen=True)
class Answer:
    """One answer: a short sentence, what stands behind it, and where the page shows it."""

    text: str
    detail: str
    anchor: str


def answers(
    found: Mapping[tuple[str, str, str], Summary],
    rows: Sequence[Row],
    ladders: Mapping[str, LadderRecord],
    papers: Sequence[PaperAtAGlance],
    zones: Sequence[ZoneSaving] = (),
) -> list[Answer]:
    """Return the answers of a comparison.

    Parameters
    ----------
    found : mapping of (case, variant, swarm) to Summary
        Gaps are relative to the best motion known.
    rows : sequence of Row
        Judged again.
    ladders : mapping of str to LadderRecord
    papers : sequence of PaperAtAGlance
        Empty where no paper was audited.
    zones : sequence of ZoneSaving
        Empty where none was computed.

    Returns
    -------
    list of Answer
        Who reaches the optimum; how many claims break limits; what the papers' arms could do; whether a
        motion lies below a bound; what zones at the waypoints save.
    """
    made = [_reaching(found), _claims(rows), _papers(papers), _bounds(rows, ladders), _zones(zones)]
    return [answer for answer in made if answer is not None]


def _reaching(found: Mapping[tuple[str, str, str], Summary]) -> Answer | None:
    """Which swarms reach the optimum on every case, by variant of a coding, and which is nearest."""
    cases = {case for case, _, _ in found}
    swarms = {swarm for _, _, swarm in found}
    variants = list(dict.fromkeys(variant for _, variant, _ in found))
    if not variants:
        return None
    worst = _worst_gaps(found, len(cases))
    reach = {
        variant: [
            swarm for (where, swarm), gap in worst.items() if where == variant and gap <= AT_OPTIMUM
        ]
        for variant in variants
    }
    variant = max(reach, key=lambda name: len(reach[name]))
    others = "; ".join(f"{name}: {len(reach[name]) or 'none'}" for name in reach if name != variant)
    detail = f"In the {variant} coding: {', '.join(reach[variant]) or 'none'}."
    if others:
        detail += f" In the others: {others}."
    detail += f" Reached: the median gap of the seeds is at most {percent(AT_OPTIMUM)}."
    if worst:
        coding, swarm = min(worst, key=lambda key: worst[key])
        detail += (
            f" Nearest on its worst arm: {swarm} ({coding} coding), {percent(worst[coding, swarm])}."
        )
    count = len(reach[variant])
    where = "on the one arm" if len(cases) == 1 else f"on all {len(cases)} arms"
    text = f"{count or 'None'} of {len(swarms)} swarms reach{'es' if count < 2 else ''} the optimum {where}"
    return Answer(text, detail, "overview")


def _worst_gaps(
    found: Mapping[tuple[str, str, str], Summary], cases: int
) -> dict[tuple[str, str], float]:
    """The largest median gap over the cases, by variant and swarm, of those that have one on every case."""
    gaps: dict[tuple[str, str], list[float]] = {}
    for (_, variant, swarm), summary in found.items():
        if summary.gap_of_most is not None:
            gaps.setdefault((variant, swarm), []).append(summary.gap_of_most)
    return {key: max(mine) for key, mine in gaps.items() if len(mine) == cases}


def _claims(rows: Sequence[Row]) -> Answer | None:
    """How many motions of the papers' rule break limits, as it gives them."""
    by_rule = [
        row
        for case in dict.fromkeys(row.case for row in rows)
        for row in as_papers_run(r for r in rows if r.case == case)
    ]
    claims = [row for row in by_rule if row.claimed is not None]
    if not claims:
        return None
    broken = [row for row in claims if row.keeps_limits is False]
    detail = (
        "By the papers' own protocol: each joint is searched alone, then the longest time per segment is"
        " taken."
    )
    factors = [(row.stretch, row) for row in broken if row.stretch is not None]
    if factors:
        factor, row = max(factors, key=lambda pair: pair[0])
        detail += f" The worst has to be slowed down by {factor:.3g} ({row.swarm} on {row.case})."
    text = f"{len(broken):,} of {len(claims):,} claimed motions break their limits"
    return Answer(text, detail, "claims")


def _papers(papers: Sequence[PaperAtAGlance]) -> Answer | None:
    """What the papers' arms could really do beside what is published."""
    judged = [p for p in papers if p.published is not None and p.keeps != CANNOT_BE_JUDGED]
    if not judged:
        return None
    broken = [paper for paper in judged if paper.stretch]
    lines = []
    for paper in broken:
        line = f"{paper.case}: published {paper.published:.4g} s"
        if paper.slowed is not None:
            line += f", {paper.slowed:.4g} s once it keeps them"
        if paper.optimum is not None:
            line += f", best of its family {paper.optimum:.4g} s"
        lines.append(line)
    text = f"{len(broken) or 'None'} of {len(judged)} published totals belongs to a motion that breaks limits"
    if len(broken) > 1:
        text = f"{len(broken)} of {len(judged)} published totals belong to a motion that breaks limits"
    detail = (
        f"{'; '.join(lines)}."
        if lines
        else "Every published motion that can be judged keeps its limits."
    )
    return Answer(text, detail, "papers")


def _bounds(rows: Iterable[Row], ladders: Mapping[str, LadderRecord]) -> Answer | None:
    """Whether any verified motion lies below a certified bound."""
    verified = below = 0
    proved = set()
    for row in rows:
        rung = ladders[row.case]["ladder"]["family_lower"]
        if row.seconds is None or not rung["certified"] or rung["seconds"] is None:
            continue
        proved.add(row.case)
        verified += 1
        below += row.seconds < rung["seconds"]
    if not verified:
        return None
    text = f"{below or 'None'} of {verified:,} verified motions beat{'' if below > 1 else 's'} a proved bound"
    detail = (
        f"Each was compared with the certified lower bound of its family ({', '.join(sorted(proved))})."
    )
    return Answer(text, detail, "methods")


def _zones(zones: Sequence[ZoneSaving]) -> Answer | None:
    """What the widest zones at the inner waypoints save on each arm."""
    if not zones:
        return None
    widest = max(row.zone for row in zones)
    mine = sorted((row for row in zones if row.zone == widest), key=lambda row: -row.saved)
    most, least = mine[0].saved, mine[-1].saved
    many = f"{least:.2g} to {most:.2g}" if len(mine) > 1 else f"{most:.2g}"
    text = f"A zone of {widest:g} rad at each inner waypoint saves {many} s"
    each = [
        f"{row.case} {row.saved:.4f} of {row.exact:.4f} s"
        + (f" (proved: {floor(1e4 * row.least) / 1e4:.4f} s or more)" if row.least > 0.0 else "")
        for row in mine
    ]
    return Answer(text, f"{'; '.join(each)}.", "zones")


def headline(case: str, ladder: LadderRecord, rows: Sequence[Row]) -> str:
    """Return the answer for one case in two or three sentences.

    Parameters
    ----------
    case : str
    ladder : LadderRecord
    rows : sequence of Row
        Of this case; gaps are relative to the best motion known.

    Returns
    -------
    str
    """
    mine = [row for row in rows if row.case == case]
    optimum = ladder["ladder"]["family"]["seconds"]
    said = []
    if optimum is not None:
        said.append(f"The best motion of the family takes {optimum:.4f} s.")
    claim = best_claim(mine)
    if claim is not None and claim.claimed is not None and claim.seconds is not None:
        line = f"The shortest claim in the papers' coding is {claim.claimed:.4f} s ({claim.swarm})"
        if not claim.keeps_limits:
            line += f", which breaks limits ({claim.worst}) and takes {claim.seconds:.4f} s once it keeps them"
        said.append(f"{line}.")
    run = as_papers_run(mine)
    breaking = sum(row.keeps_limits is False for row in run)
    if run:
        said.append(f"{breaking} of {len(run)} motions of the papers' rule break limits.")
    best = best_row(mine)
    if best is not None and best.gap is not None:
        above = (
            "at the best motion known" if best.gap <= AT_OPTIMUM else f"{percent(best.gap)} above it"
        )
        said.append(f"The best swarm is {best.swarm} ({best.variant} coding), {above}.")
    return " ".join(said)
